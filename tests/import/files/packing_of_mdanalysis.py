"""Writes mdanalysis.h5md, to be packed by gzip -n, and mdanalysis-distances.txt with MDAnalysis 2.4.2 (Debian): python3 packing_of_mdanalysis.py. Grains
that fly freely in a tilted box, in nm and ps, and their distances at the end, across the border. Radii, which MDAnalysis does not write, h5py adds."""
import h5py
import MDAnalysis
import numpy as np
from MDAnalysis.lib.distances import distance_array

random = np.random.default_rng(2)
places, speeds = 100 * random.random((5, 3)), random.normal(size=(5, 3))
universe = MDAnalysis.Universe.empty(5, trajectory=True, velocities=True)
with MDAnalysis.Writer("mdanalysis.h5md", n_atoms=5, n_frames=3, lengthunit="nm", velocityunit="nm/ps", timeunit="ps", contiguous=True) as writer:
    for step in range(3):
        moment = universe.trajectory.ts
        moment.positions, moment.velocities = places + 10 * step * speeds, speeds
        moment.dimensions = [100, 90, 80, 85, 95, 70]
        moment.frame, moment.time = step, 10.0 * step
        writer.write(universe.atoms)
np.savetxt("mdanalysis-distances.txt", distance_array(moment.positions, moment.positions, box=moment.dimensions) * 1e-10, "%.7g")
with h5py.File("mdanalysis.h5md", "a") as file:
    file["particles/trajectory/radius"] = np.linspace(1, 2, 5, dtype="f4")
    file["particles/trajectory/radius"].attrs["unit"] = "nm"
