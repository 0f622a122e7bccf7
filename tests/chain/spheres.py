"""A lattice of spheres in uniform shear, as MercuryDPM would write it, imported, measured, exported: closed forms all the way.

usage: spheres.py DRUMLIN FOLDER_OF_THIS_TEST
"""

import csv
import math

import h5py

from command import given, read_json, require

SIDE, LEVELS, RATE, SNAPSHOTS = 4, 6, 0.3, 24
PUSH = (1.0, 2.0, 3.0)  # forces along x, y, z: of cells of 1 d the stress
DESCRIPTION = f"""
format = "drumlin-import-1"
title = "A lattice of spheres"
dimensions = 3
[files]
grains = ["lattice.data"]
contacts = ["lattice.fstat"]
[grains]
density_kg_m3 = 1.0
mean_diameter_m = 1.0
[gravity]
acceleration_m_s2 = 1.0
direction_deg = -66
[periodic_x]
length_m = {SIDE}
[periodic_y]
length_m = {SIDE}
"""


def index(a, b, c):
    return (c * SIDE + b % SIDE) * SIDE + a % SIDE


def write_lattice(folder):
    """Each contact from both sides; across the period each with an image of the other, whose id is beyond those of the grains."""
    folder.mkdir()
    places = [(a, b, c) for c in range(LEVELS) for b in range(SIDE) for a in range(SIDE)]
    with open(folder / "lattice.data", "w", encoding="utf-8") as grains, open(folder / "lattice.fstat", "w", encoding="utf-8") as contacts:
        for time in range(SNAPSHOTS):
            grains.write(f"{len(places)} {time} 0 0 0 {SIDE} {SIDE} {LEVELS}\n")
            contacts.write(f"# {time} 1\n# 0 0 0 {SIDE} {SIDE} {LEVELS}\n# 0.5 0.5 0 0 0 0\n")
            for a, b, c in places:
                x = (a + 0.5 + RATE * (c + 0.5) * time) % SIDE
                grains.write(f"{x!r} {b + 0.5} {c + 0.5} {RATE * (c + 0.5)!r} 0 0 0.5 0 0 0 0 0 0 0\n")
                for axis, push in enumerate(PUSH):
                    other = [a, b, c]
                    other[axis] += 1
                    if other[2] == LEVELS:
                        continue
                    normal = [float(k == axis) for k in range(3)]
                    across = len(places) * (max(other[:2]) == SIDE)
                    for i, j, sign in ((index(*other), index(a, b, c), 1), (index(a, b, c), index(*other), -1)):
                        j += across
                        contacts.write(f"{time} {i} {j} 0 0 0 0 0 {push} 0 {' '.join(repr(sign * n) for n in normal)} 0 0 0\n")


def require_no_layers_across_a_period(drumlin, folder):
    """A box that repeats along all of its axes has no height."""
    frame = "ITEM: TIMESTEP\n{}\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS pp pp pp\n0 4\n0 4\n0 4\nITEM: ATOMS id x y z vx vy vz radius\n1 1 1 1 0 0 0 0.5\n2 3 3 3 0 0 0 0.5\n"
    (folder / "lattice" / "dump").write_text(frame.format(0) + frame.format(1), encoding="utf-8")
    closed = DESCRIPTION.split("[periodic_x]")[0].replace("lattice.data", "dump").replace('contacts = ["lattice.fstat"]', "step_s = 1.0")
    (folder / "lattice" / "closed.toml").write_text(closed, encoding="utf-8")
    drumlin("import", folder / "lattice" / "closed.toml", "-o", folder / "closed")
    for axis, height in (("y", "z"), ("x", "z"), ("z", "y")):
        _, error = drumlin("measure", folder / "closed", "--along", axis, code=2)
        require(f"period_{height}: is above 0, along the height of the view (allowed: a box that is periodic across layers is not measured)" in error, error)


def require_rings_and_height(drumlin, folder):
    """A cube of spheres that turns about y as one, in an open box: rings and height have the components along y, maps of unknown contacts no stress."""
    spin, along_y, half = 0.5, 0.25, 3
    places = [(a + 0.5, b + 0.5, c + 0.5) for c in range(-half, half) for b in range(-half, half) for a in range(-half, half)]
    with open(folder / "lattice" / "turning", "w", encoding="utf-8") as dump:
        for time in range(4):
            dump.write(f"ITEM: TIMESTEP\n{time}\nITEM: NUMBER OF ATOMS\n{len(places)}\nITEM: BOX BOUNDS ff ff ff\n" + f"{-half} {half}\n" * 3 + "ITEM: ATOMS id x y z vx vy vz radius\n")
            dump.writelines(f"{number} {x} {y} {z} {spin * z} {along_y} {-spin * x} 0.5\n" for number, (x, y, z) in enumerate(places, 1))
    opened = DESCRIPTION.split("[periodic_x]")[0].replace("lattice.data", "turning").replace('contacts = ["lattice.fstat"]', "step_s = 1.0")
    (folder / "lattice" / "turning.toml").write_text(opened, encoding="utf-8")
    drumlin("import", folder / "lattice" / "turning.toml", "-o", folder / "turning")
    drumlin("measure", folder / "turning", "--radial", "0,0", "--height=-3,3", "--parts", "maps")
    measured = folder / "turning" / "measured"
    require((measured / "radial.png").exists() and (measured / "height.png").exists() and (measured / "maps.png").exists(), "figures")
    rings = table(measured / "radial.csv")
    for row in rings[1:half - 1]:
        for name, expected in {"v_t": spin * row["r"], "v_y": along_y, "temperature": 0, "sigma_yy_kinetic": 0, "sigma_ry_kinetic": 0}.items():
            close(row[name], expected, f"{name} at r = {row['r']}")
    height = table(measured / "height.csv")
    close(height[half]["v_y"], along_y, "v_y over the height")
    require("fabric_yy" not in rings[0] and "p_space" not in height[0], f"{list(rings[0])} {list(height[0])} of unknown contacts")
    with h5py.File(measured / "maps.h5") as maps:
        require(not (maps["fields/fabric_yy"][:] == maps["fields/fabric_yy"][:]).any(), "a fabric of unknown contacts")


def table(file):
    with open(file, newline="", encoding="utf-8") as stream:
        return [{name: float(value) if value else math.nan for name, value in row.items()}
                for row in csv.DictReader(line for line in stream if not line.startswith("#"))]


def close(found, expected, what):
    require(abs(found - expected) <= 1e-9, f"{what}: {found} instead of {expected}")


def main():
    with given() as (drumlin, _, folder):
        write_lattice(folder / "lattice")
        (folder / "lattice" / "import.toml").write_text(DESCRIPTION, encoding="utf-8")
        run = folder / "run"
        text, _ = drumlin("import", folder / "lattice" / "import.toml", "-o", run)
        require(f"{SNAPSHOTS} snapshots of 96 grains" in text, text)
        text, _ = drumlin("measure", run, "--parts", "maps")
        require("next: drumlin " in text and "scene.toml" not in text, f"{text}\nan imported run has no scene")
        space, layers = table(run / "measured" / "space.csv"), table(run / "measured" / "profiles.csv")
        require(len(space) == LEVELS and len(layers) == LEVELS, f"{len(space)} layers")
        p = sum(PUSH) / 3
        for level in range(1, LEVELS - 1):
            row, seen = space[level], layers[level]
            for name, expected in {"nu": math.pi / 6, "sigma_xx": 1, "sigma_yy": 2, "sigma_zz": 3, "sigma_xz": 0, "shear_rate": RATE, "p_space": p, "temperature": 0,
                                   "N1_over_p": -2 / p, "N2_over_p": 1 / p, "coordination": 6, "fabric_yy": 1 / 3, "I_invariant": RATE / math.sqrt(p)}.items():
                close(row[name], expected, f"{name} of level {level}")
            for name, expected in {"nu": math.pi / 6, "sigma_xx": 1, "sigma_zz": 3, "shear_rate": RATE, "I": RATE / math.sqrt(3), "k": 1 / 3, "mu": 0}.items():
                close(seen[name], expected, f"{name} of level {level}, seen along y")
        settings = read_json(run / "measured" / "measured.json")["settings"]
        require(settings["spheres"]["depth"] == SIDE and settings["geometry"] == "layers", f"{settings}")
        with h5py.File(run / "measured" / "maps.h5") as maps:
            # The kernel sums over lattice planes 1 d apart, as wide as they are: it is uniform away from top and bottom.
            row = abs(maps["z"][:] - space[LEVELS // 2]["z"]).argmin()
            nu, zz, yy, xy, v_y = (maps[f"fields/{name}"][row] for name in ("nu", "sigma_zz", "sigma_yy", "sigma_xy", "v_y"))
            for axes in ("xx", "yy", "zz"):
                require(abs(maps[f"fields/fabric_{axes}"][row] - 1 / 3).max() < 1e-9, f"fabric_{axes}")
            require(abs(nu - math.pi / 6).max() < 1e-6 and abs(zz - 3).max() < 1e-2 and abs(yy - 2).max() < 1e-2, f"{nu} {zz} {yy}")
            require(abs(xy).max() < 1e-9 and abs(v_y).max() < 1e-9, f"{xy} {v_y}")
        # Through a slab of two rows.
        drumlin("measure", run, "--parts", "maps", "--slab", "1,3", "--overwrite")
        with h5py.File(run / "measured" / "maps.h5") as maps:
            require(abs(maps["fields/sigma_yy"][row] - yy).max() < 1e-9, "sigma_yy of a slab")
        for row, half in zip(space, table(run / "measured" / "space.csv")):
            for name in ("nu", "sigma_zz", "sigma_yy", "shear_rate", "coordination"):
                require(math.isnan(row[name]) == math.isnan(half[name]) and not abs(row[name] - half[name]) > 1e-9, f"{name} of a slab: {half[name]}, {row[name]}")
        require_no_layers_across_a_period(drumlin, folder)
        require_rings_and_height(drumlin, folder)
        for words in (["--along", "z"], ["--slab", "3,1"], ["--slab", "0,9"], ["--parts", "voronoi"], ["--grains", "last"]):
            _, error = drumlin("measure", run, *words, "--overwrite", code=2)
        drumlin("plot", run, code=2)
        drumlin("export", run, "--to", "vtkhdf")
        with h5py.File(run / "vtkhdf" / "run.vtkhdf") as file:
            require(int(file["VTKHDF/Steps"].attrs["NSteps"]) == SNAPSHOTS, "not all steps")


if __name__ == "__main__":
    main()
