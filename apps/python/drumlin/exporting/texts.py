"""Text for LAMMPS and OVITO: a dump of the style custom with one of the style local, and extended XYZ."""

import numpy as np


def rows(table, kinds):
    """Lines of numbers; `kinds`: d for a whole number, else its format."""
    pattern = " ".join("%d" if kind == "d" else "%.9g" for kind in kinds) + "\n"
    return "".join(pattern % tuple(row) for row in table.tolist())


def omega_of(s):
    return np.zeros_like(s.place) if s.omega is None else s.omega


class LammpsDump:
    """grains.dump and contacts.dump. Ids are the places of the grains from 1 on, walls are below 0."""

    finished = "grains.dump"

    def __init__(self, folder):
        self.grains, self.contacts = (open(folder / name, "w", encoding="utf-8") for name in ("grains.dump", "contacts.dump"))

    def add(self, s):
        low, length = s.box()
        xy, xz, yz = s.tilt
        ends = ["pp" if period > 0 else "ff" for period in s.period]
        bounds = [(low[k], low[k] + length[k]) for k in range(3)]
        tilted = bool(np.any(s.tilt))
        if tilted:
            bounds[0] = (bounds[0][0] + min(0, xy, xz, xy + xz), bounds[0][1] + max(0, xy, xz, xy + xz))
            bounds[1] = (bounds[1][0] + min(0, yz), bounds[1][1] + max(0, yz))
        box = f"ITEM: BOX BOUNDS {'xy xz yz ' if tilted else ''}{' '.join(ends)}\n"
        box += "".join("%.16g %.16g%s\n" % (*bound, f" {tilt:.16g}" if tilted else "") for bound, tilt in zip(bounds, s.tilt))
        head = f"ITEM: UNITS\nsi\nITEM: TIME\n{s.time:.16g}\nITEM: TIMESTEP\n{s.step}\nITEM: NUMBER OF "
        axes = "xu yu zu" if np.any(s.period > 0) else "x y z"
        count = len(s.radius)
        table = np.column_stack([np.arange(1, count + 1), np.ones(count), s.place, s.velocity, s.radius, omega_of(s)])
        self.grains.write(f"{head}ATOMS\n{count}\n{box}ITEM: ATOMS id type {axes} vx vy vz radius omegax omegay omegaz\n" + rows(table, "dd" + "g" * 10))
        table = np.column_stack([s.i + 1, np.where(s.j >= 0, s.j + 1, s.j), s.force, s.normal])
        self.contacts.write(f"{head}ENTRIES\n{len(s.i)}\n{box}ITEM: ENTRIES i j fx fy fz nx ny nz\n" + rows(table, "dd" + "g" * 6))

    def close(self):
        self.grains.close()
        self.contacts.close()


class ExtendedXyz:
    """run.xyz, without contacts."""

    finished = "run.xyz"

    def __init__(self, folder):
        self.file = open(folder / "run.xyz", "w", encoding="utf-8")

    def add(self, s):
        low, length = s.box()
        xy, xz, yz = s.tilt
        lattice = " ".join(f"{value:.16g}" for value in (length[0], 0, 0, xy, length[1], 0, xz, yz, length[2]))
        count = len(s.radius)
        periodic = " ".join("T" if period > 0 else "F" for period in s.period)
        self.file.write(f'{count}\nLattice="{lattice}" Origin="{low[0]:.16g} {low[1]:.16g} {low[2]:.16g}" pbc="{periodic}" Time={s.time:.16g} Step={s.step} '
                        "Properties=species:S:1:id:I:1:pos:R:3:velo:R:3:radius:R:1:angular_velocity:R:3\n")
        table = np.column_stack([np.arange(1, count + 1), s.place, s.velocity, s.radius, omega_of(s)])
        self.file.write("".join("X " + line + "\n" for line in rows(table, "d" + "g" * 10).splitlines()))

    def close(self):
        self.file.close()
