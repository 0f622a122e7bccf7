"""What `drumlin import` starts once it has read the description and claimed its output: writes the snapshots. The report so far is printed after
each, a line of JSON.

usage: command.py OUTPUT
  OUTPUT  folder that holds import.toml, the description with all defaults, files.json, lists of files by what they hold (grains, contacts), and the
          folder snapshots
"""

import dataclasses
import json
import pathlib
import sys
import tomllib

import numpy as np

from drumlin.hdf5 import write_hdf5
from drumlin.importing.run import Import

WORDS = {
    "time": ("sqrt(d/g)", "since the start"), "time_step": ("sqrt(d/g)", "that led here"),
    "wall/angle": ("rad", "of the first wall that rotates, clockwise"), "wall/spin": ("sqrt(g/d)", "of the first wall that rotates, clockwise"),
    "container/x": ("d", "middle of the first circular container"), "container/z": ("d", "middle of the first circular container"),
    "container/radius": ("d", "0: no circular container"), "gravity_x": ("g", "body acceleration"), "gravity_z": ("g", "body acceleration"),
    "velocity_window": ("sqrt(d/g)", "time that the displacements cover"), "period_x": ("d", "length of a periodic domain; 0: open"),
    "scales/length_m": ("m", "one unit of length, d"), "scales/time_s": ("s", "one unit of time, sqrt(d/g)"),
    "scales/density_kg_m3": ("kg/m3", "one unit of density, rho0"), "grains/x": ("d", "centre, to the right"), "grains/z": ("d", "centre, upwards"),
    "grains/v_x": ("sqrt(g d)", "velocity to the right"), "grains/v_z": ("sqrt(g d)", "velocity upwards"), "grains/radius": ("d", "radius"),
    "grains/spin": ("sqrt(g/d)", "angular velocity, clockwise"), "grains/displacement_x": ("d", "to the right, over the velocity window"),
    "grains/displacement_z": ("d", "upwards, over the velocity window"), "contacts/i": ("1", "grain i"),
    "contacts/j": ("1", "grain j, or -1 - w for shape w of the walls"), "contacts/normal_x": ("1", "unit normal from j to i"),
    "contacts/normal_z": ("1", "unit normal from j to i"), "contacts/impulse_n": ("rho0 d^2 sqrt(g d)", "on i along the normal"),
    "contacts/impulse_t": ("rho0 d^2 sqrt(g d)", "on i along (n_z, -n_x)"),
    "period_y": ("d", "length of a periodic domain; 0: open"), "period_z": ("d", "length of a periodic domain; 0: open"),
    "grains/y": ("d", "centre, across x and z"), "grains/v_y": ("sqrt(g d)", "velocity along y"), "contacts/normal_y": ("1", "unit normal from j to i")}
WORDS |= {f"grains/omega_{axis}": ("sqrt(g/d)", f"angular velocity about {axis}") for axis in "xyz"}
WORDS |= {f"contacts/force_{axis}": ("rho0 g d^3", f"on i along {axis}") for axis in "xyz"}
WORDS |= {f"tilt_{axes}": ("d", f"displacement of the image along {axes[1]}, along {axes[0]}") for axes in ("xy", "xz", "yz")}


def main(output):
    sys.stdout.reconfigure(encoding="utf-8", errors="surrogateescape")
    np.seterr(all="ignore")  # what is too large is refused
    output = pathlib.Path(output)
    snapshots = Import(tomllib.loads((output / "import.toml").read_text(encoding="utf-8")),
                       json.loads((output / "files.json").read_text(encoding="utf-8")))
    for s in snapshots:
        scales = dataclasses.asdict(snapshots.report.scales)
        write_hdf5(output / "snapshots" / f"{s['step']:06}.h5",
                   {"format": "drumlin-snapshot-1"} | s | {f"scales/{name}": value for name, value in scales.items()}, WORDS)
        print(json.dumps(dataclasses.asdict(snapshots.report)), flush=True)
    print(json.dumps(dataclasses.asdict(snapshots.report)))


if __name__ == "__main__":
    main(*sys.argv[1:])
