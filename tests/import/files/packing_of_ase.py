"""Writes ase.xyz and ase-distances.txt with ASE 3.22.1 (Debian): python3 packing_of_ase.py. Grains that fly freely in a tilted box, in mm and s,
and their distances at the end, across the border."""
import ase
import ase.io
import numpy as np

random = np.random.default_rng(1)
grains = ase.Atoms("Si5", positions=10 * random.random((5, 3)), cell=[[10, 0, 0], [2, 9, 0], [1, -1, 8]], pbc=[True, True, False])
grains.arrays |= {"id": np.array([5, 3, 1, 2, 4]), "velo": random.normal(size=(5, 3)), "radius": 1 + 0.1 * random.random(5),
                  "angular_velocity": random.normal(size=(5, 3)), "shade": random.random(5)}
frames = []
for step in range(3):
    frames.append(grains.copy())
    frames[-1].info = {"Time": 0.5 * step, "note": "a = b"}
    grains.positions += 0.5 * grains.arrays["velo"]
ase.io.write("ase.xyz", frames, format="extxyz")
order = np.argsort(grains.arrays["id"])
np.savetxt("ase-distances.txt", frames[-1].get_all_distances(mic=True)[order][:, order], "%.9g")
