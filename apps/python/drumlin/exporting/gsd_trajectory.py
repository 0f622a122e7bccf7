"""run.gsd in the schema of HOOMD-blue, for OVITO, freud and HOOMD; needs the package gsd (Debian: python3-gsd)."""

import numpy as np

from ..errors import InputError


class GsdTrajectory:
    """Grains with their diameters; contacts between grains are bonds, with their forces as log/bonds/force_N (of discs per metre)."""

    finished = "run.gsd"

    def __init__(self, folder):
        try:
            import gsd.hoomd
        except ImportError as error:
            raise InputError("export --to gsd: the package gsd is needed (Debian: python3-gsd)") from error
        self.frame = getattr(gsd.hoomd, "Frame", None) or gsd.hoomd.Snapshot
        self.file = gsd.hoomd.open(name=str(folder / "run.gsd"), mode="wb")

    def add(self, s):
        frame = self.frame()
        # The box of HOOMD lies about the origin: one that is open holds all grains where they are.
        length = np.where(s.period > 0, s.period, 2 * (np.abs(s.place) + s.radius[:, None]).max(axis=0))
        xy, xz, yz = s.tilt
        image = np.where(s.period > 0, np.floor(s.place / length + 0.5), 0).astype(np.int32)
        edges = np.array([[length[0], xy, xz], [0, length[1], yz], [0, 0, length[2]]])
        frame.configuration.step, frame.configuration.dimensions = s.step, 3 if s.spheres else 2
        frame.configuration.box = [*length, xy / length[1], xz / length[2], yz / length[2]]
        frame.particles.N, frame.particles.types, frame.particles.image = len(s.radius), ["grain"], image
        frame.particles.position, frame.particles.velocity = s.place - image @ edges.T, s.velocity
        frame.particles.diameter, frame.particles.mass = 2 * s.radius, s.mass
        inside = s.j >= 0
        frame.bonds.N, frame.bonds.types, frame.bonds.group = int(inside.sum()), ["contact"], np.column_stack([s.i[inside], s.j[inside]]).astype(np.uint32)
        frame.log = {"time": [s.time], "periodic": (s.period > 0).astype(np.uint8), "bonds/force_N": s.force[inside]}
        if s.omega is not None:
            frame.log["particles/omega"] = s.omega
        self.file.append(frame)

    def close(self):
        self.file.close()
