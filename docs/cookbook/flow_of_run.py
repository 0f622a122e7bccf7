"""The flow scene of a particle run in layers: the same grains, weight, slope, pressure and speed of the wall, so that the two are a pair.

usage: flow_of_run.py RUN (--nu NU | --rheology LAW.toml) -o FLOW.toml
RUN is a folder of `drumlin run`: grains that are periodic in x, between two walls without gravity (plane_shear) or on one wall down a slope
(incline). The height of the layer is the area of its discs over nu and the period, as the fill of a drum crosses to its continuum: a wall of glued
discs, which the grains enter, then counts for what it holds. Pressure and speed of the upper wall are those that its last stage asks for.
"""

import argparse
import json
import math
import pathlib
import sys
import tomllib

import h5py
import numpy
import whole_file


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("run", type=pathlib.Path)
    law = parser.add_mutually_exclusive_group(required=True)
    law.add_argument("--nu", type=float, help="volume fraction of the continuum")
    law.add_argument("--rheology", type=pathlib.Path, help="law that the continuum will be solved with: its nu")
    parser.add_argument("-o", "--output", type=pathlib.Path, required=True)
    return parser.parse_args()


def text_of(value):
    return json.dumps(value) if isinstance(value, (bool, str)) else repr(float(value))


def table(name, entries):
    return f"\n[{name}]\n" + "".join(f"{key} = {text_of(value)}\n" for key, value in entries.items())


def driven_wall(scene, length_mm):
    """Speed and pressure of the wall that the last stage presses and drags."""
    for motion in scene["stages"][-1].get("motions", []):
        speed = motion.get("velocity_mm_s", [0, 0])[0]
        if motion["kind"] == "pressure":
            return speed, motion["pressure_pa"]
        if motion["kind"] == "force":
            return speed, motion["force_n_m"] / (1e-3 * length_mm)
    sys.exit("the last stage presses no wall with a force or a pressure: no plane shear")


def geometry_of(scene, height_mm, period_mm):
    gravity = scene.get("effects", {}).get("gravity")
    if gravity is None:
        speed, pressure = driven_wall(scene, period_mm)
        if not speed > 0:
            sys.exit("the pressed wall is not dragged towards +x: no plane shear")
        return "plane_shear", {"gap_mm": height_mm, "wall_speed_mm_s": speed, "pressure_pa": pressure}
    slope = 90 + gravity["direction_deg"]
    if not 0 < slope < 89:
        sys.exit(f"gravity points along {gravity['direction_deg']} deg: no layer on a slope that runs towards +x")
    return "incline", {"height_mm": height_mm, "slope_deg": slope}


def main():
    options = arguments()
    scene = tomllib.loads((options.run / "scene.toml").read_text(encoding="utf-8"))
    report = json.loads((options.run / "run.json").read_text(encoding="utf-8"))
    if "periodic_x" not in scene:
        sys.exit(f"{options.run}: is not periodic in x, and so no flow in layers")
    nu = options.nu or tomllib.loads(options.rheology.read_text(encoding="utf-8"))["packing"]["nu"]
    d_mm, period_mm = 1e3 * report["scales"]["length_m"], scene["periodic_x"]["x_max_mm"] - scene["periodic_x"]["x_min_mm"]
    with h5py.File(sorted((options.run / "snapshots").glob("*.h5"))[-1]) as snapshot:
        area = math.pi * float(numpy.sum(snapshot["grains/radius"][:] ** 2))
    name, entries = geometry_of(scene, area * d_mm ** 2 / (nu * period_mm), period_mm)
    sizes = scene["grains"]["generated"]
    text = f'format = "drumlin-flow-scene-1"\ntitle = {json.dumps(scene["title"])}\nreduced = {text_of(scene.get("reduced", False))}\n'
    text += table(name, entries)
    text += table("grains", {key: sizes[key] for key in ("diameter_min_mm", "diameter_max_mm")} | {"density_kg_m3": scene["grains"]["density_kg_m3"]})
    # No strength at a free surface, and none between plates, beyond a hundredth of a grain's weight.
    text += table("mesh", {"surface_cell": 0.5}) + table("regularisation", {"pressure": 0.01})
    whole_file.write_text(options.output, text)


if __name__ == "__main__":
    main()
