"""A run written out as another program would, imported and measured: the same profiles as those of the run itself.

usage: importing.py DRUMLIN FOLDER_OF_THIS_TEST
"""

import csv
import math
import random

import h5py
import numpy

from command import given, read_json, require

DESCRIPTION = """
format = "drumlin-import-1"
title = "The tiny drum again"
reduced = true
[grains]
density_kg_m3 = 2700
mean_diameter_m = {diameter}
[drum]
radius_m = 0.05
speed_rpm = 15
turns_before = 1
"""

CSV = """
[csv]
grains = ["grains-*.csv"]
contacts = ["contacts.csv"]
"""

# Millimetres, milliseconds, grams; discs 4 mm deep.
LAMMPS = """
[lammps]
grains = ["dump.drum"]
step_s = 1e-3
length_unit_m = 1e-3
time_unit_s = 1e-3
mass_unit_kg = 1e-3
contacts = ["dump.contacts"]
contact_ids = ["c_pairs[1]", "c_pairs[2]"]
contact_forces = ["c_forces[2]", "c_forces[3]"]
force_on = "second"
depth_m = 4e-3
"""


class Snapshot:
    """What other programs write of a snapshot: SI, x to the right, z up, spin clockwise."""

    def __init__(self, file):
        with h5py.File(file) as stored:
            length, time, density = (stored[f"scales/{name}"][()] for name in ("length_m", "time_s", "density_kg_m3"))
            self.step, self.time_s = int(stored["step"][()]), stored["time"][()] * time
            grains = {name: values[:] for name, values in stored["grains"].items()}
            self.x, self.z, self.radius = (grains[name] * length for name in ("x", "z", "radius"))
            self.v_x, self.v_z = (grains[name] * length / time for name in ("v_x", "v_z"))
            self.spin = grains["spin"] / time
            contacts = {name: values[:].astype(float) for name, values in stored["contacts"].items()}
            force = density * length**3 / time**2 / stored["time_step"][()]  # N per metre of depth
            self.i, self.j = contacts["i"].astype(int), contacts["j"].astype(int)
            self.n_x, self.n_z = contacts["normal_x"], contacts["normal_z"]
            self.f_n, self.f_t = contacts["impulse_n"] * force, contacts["impulse_t"] * force
            self.f_x = self.f_n * self.n_x + self.f_t * self.n_z
            self.f_z = self.f_n * self.n_z - self.f_t * self.n_x


def shuffled(count, seed):
    order = list(range(count))
    random.Random(seed).shuffle(order)
    return order


def text_of(values):
    return [repr(float(value)) if not isinstance(value, int) else str(value) for value in values]


def write_csv(folder, snapshots):
    """A file of grains per snapshot, all contacts in one file; rows in no order, ids that do not begin at 0."""
    folder.mkdir()
    with open(folder / "contacts.csv", "w", encoding="utf-8") as contacts:
        contacts.write("# by hand\ntime_s,i,j,normal_x,normal_z,f_n_N_m,f_t_N_m\n")
        for number, s in enumerate(snapshots):
            # Numbers without leading zeros: 9 comes before 10.
            with open(folder / f"grains-{number}.csv", "w", encoding="utf-8") as grains:
                grains.write("id,time_s,x_m,z_m,v_x_m_s,v_z_m_s,colour,spin_anticlockwise_rad_s,radius_m\n")
                for g in shuffled(len(s.x), number):
                    grains.write(",".join([str(3 * g + 7), *text_of([s.time_s, s.x[g], s.z[g], s.v_x[g], s.v_z[g]]), "red",
                                           *text_of([-s.spin[g], s.radius[g]])]) + "\n")
            for c in range(len(s.i)):
                wall = s.j[c] < 0
                contacts.write(",".join(text_of([s.time_s, int(3 * s.i[c] + 7), int(s.j[c] if wall else 3 * s.j[c] + 7),
                                                 s.n_x[c], s.n_z[c], s.f_n[c], s.f_t[c]])) + "\n")


def write_lammps(folder, snapshots):
    """Two files of several frames; contacts without those of the wall, which such a dump does not hold."""
    folder.mkdir()
    gram, depth = 1e-3, 4e-3
    force = depth / (gram * 1e-3 / 1e-3**2)  # N per metre -> g mm/ms2
    with open(folder / "dump.drum", "w", encoding="utf-8") as grains, \
            open(folder / "dump.contacts", "w", encoding="utf-8") as contacts:
        for number, s in enumerate(snapshots):
            head = f"ITEM: TIMESTEP\n{s.step}\nITEM: NUMBER OF {{}}\n{{}}\nITEM: BOX BOUNDS ff ff pp\n-60 60\n-60 60\n-2 2\n"
            grains.write(head.format("ATOMS", len(s.x)) + "ITEM: ATOMS id type vx vy radius omegaz x ys z\n")
            for g in shuffled(len(s.x), 100 + number):
                grains.write(" ".join([str(g + 1), "1", *text_of(
                    [s.v_x[g], s.v_z[g], 1e3 * s.radius[g], -1e-3 * s.spin[g], 1e3 * s.x[g], (1e3 * s.z[g] + 60) / 120, 0])]) + "\n")
            inside = [c for c in range(len(s.i)) if s.j[c] >= 0]
            contacts.write(head.format("ENTRIES", len(inside)) +
                           "ITEM: ENTRIES c_forces[1] c_forces[2] c_forces[3] c_pairs[1] c_pairs[2]\n")
            for c in inside:
                contacts.write(" ".join(text_of([0.0, -force * s.f_x[c], -force * s.f_z[c], int(s.i[c]) + 1, int(s.j[c]) + 1])) + "\n")


def profiles_of(run):
    with open(run / "measured" / "profiles.csv", newline="", encoding="utf-8") as stream:
        rows = list(csv.DictReader(line for line in stream if not line.startswith("#")))
    return {name: [float(row[name]) if row[name] else math.nan for row in rows] for name in rows[0]}


def require_same(own, other, names, tolerance, layers=slice(None)):
    for name in names:
        largest = max(abs(value) for value in own[name][layers] if math.isfinite(value))
        for a, b in zip(own[name][layers], other[name][layers], strict=True):
            require(math.isnan(a) == math.isnan(b) and not abs(a - b) > tolerance * largest,
                    f"{name}: {b} instead of {a}, the largest is {largest}")


def imported(drumlin, folder, description, *words):
    (folder / "import.toml").write_text(description, encoding="utf-8")
    run = folder.with_name(folder.name + "-run")
    text, _ = drumlin("import", folder / "import.toml", "-o", run, *words)
    drumlin("measure", run, "--parts", "forces", "--overwrite")
    return run, text


def main():
    with given() as (drumlin, here, folder):
        run = folder / "run"
        # Without a window: what other programs write are velocities at an instant.
        drumlin("run", here / "tiny-drum.toml", "-o", run, "--set", "output.velocity_window_s=0",
                "--set", "stages.2.snapshots=12")
        drumlin("measure", run, "--parts", "forces")
        own = profiles_of(run)
        diameter = read_json(run / "run.json")["scales"]["length_m"]
        snapshots = [Snapshot(file) for file in sorted((run / "snapshots").iterdir())]
        description = DESCRIPTION.format(diameter=repr(diameter))

        write_csv(folder / "csv", snapshots)
        csv_run, text = imported(drumlin, folder / "csv", description + CSV)
        require("12 snapshots of 350 grains" in text and "not used: colour" in text, text)
        require_same(own, profiles_of(csv_run), own, 1e-6)
        forces, measured = (read_json(one / "measured" / "measured.json")["forces"]["zones"]["bulk"] for one in (run, csv_run))
        require(math.isclose(forces["a_n"]["value"], measured["a_n"]["value"], rel_tol=1e-4), f"{forces} {measured}")
        require(read_json(csv_run / "run.json")["imported"] is True, "does not say that it is imported")

        write_lammps(folder / "lammps", snapshots)
        lammps_run, text = imported(drumlin, folder / "lammps", description + LAMMPS)
        other = profiles_of(lammps_run)
        text, _ = drumlin("import", folder / "lammps" / "import.toml", "-o", folder / "bare", "--set", "lammps.contacts=[]")
        require("no stress will be measured" in text, text)
        text, _ = drumlin("measure", folder / "bare", "--parts", "voronoi,forces,maps")
        require("next: drumlin calibrate" in text and "drumlin report" not in text, text)
        bare = profiles_of(folder / "bare")
        still = [name for name in own if not all(math.isnan(value) for value in bare[name])]  # no contact enters them
        require_same(own, other, still, 1e-6)
        # Normals along the centres instead of those of a step before; contacts with the drum are missing.
        require_same(own, other, ["sigma_zz", "sigma_xz"], 0.02, slice(4, None))

        require_same(own, bare, ["v_x", "nu", "omega"], 1e-6)
        for column in ("sigma_zz", "sigma_xz", "sigma_zz_grains", "I", "mu", "k", "coordination"):
            require(all(math.isnan(value) for value in bare[column]), f"{column}: {bare[column]}: not known, and not 0")
        with h5py.File(folder / "bare" / "measured" / "maps.h5") as maps:
            for field in ("sigma_zz", "p", "mu", "coordination", "fabric_xx", "wall_z", "residual_z"):
                require(numpy.isnan(maps[f"fields/{field}"][:]).all(), f"a map of {field}, which is not known")
            require(numpy.nanmax(maps["fields/nu"][:]) > 0.7, "no map of the volume fraction")
        scalars = read_json(folder / "bare" / "measured" / "measured.json")
        require(scalars["k_flowing"]["value"] is None and scalars["forces"] is None, "a number that was not measured")
        require("overlap_mean" not in scalars, "an accuracy that is not known")

        # One that only a measurement can read, and what must not be lost.
        _, error = drumlin("plot", csv_run, code=2)
        require("imported run" in error and "drumlin export --to" in error, error)
        drumlin("import", folder / "csv" / "import.toml", "-o", csv_run, code=2)
        text, _ = drumlin("import", folder / "csv" / "import.toml", "-o", csv_run, "--resume")
        require("done already" in text, text)
        (folder / "csv" / "grains-5.csv").write_text("time_s,x_m,z_m,v_x_m_s,v_z_m_s,radius_m\n1,0,0,0,nan,1e-3\n")
        _, error = drumlin("import", folder / "csv" / "import.toml", "-o", csv_run, "--resume", code=2)
        require("other inputs" in error, f"frames that have changed since: {error}")
        _, error = drumlin("import", folder / "csv" / "import.toml", "-o", folder / "broken", code=2)
        require("grains-5.csv:2: v_z_m_s: \"nan\" is no number" in error, error)
        require(not (folder / "broken" / "run.json").exists(), "half an import passes for a run")


if __name__ == "__main__":
    main()
