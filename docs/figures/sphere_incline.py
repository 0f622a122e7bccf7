"""Spheres down a rough incline beside published laws: numbers of the core of each measured run, and their picture.

usage: sphere_incline.py RUN... -o FILE.json [--picture FILE.png]
RUN: imported spheres with a free surface, measured by `drumlin measure` (space.csv). The core is 3 d off the base and the surface.
"""

import argparse
import json
import math
import pathlib

import numpy as np

import script
import style
import whole_file

plt = style.plt
MARGIN = 3.0  # d
JOP = (0.383, 0.643, 0.279)  # Jop, Forterre, Pouliquen 2006, glass beads
COLUMNS = ("nu", "coordination", "temperature", "I_invariant", "mu_invariant", "N1_over_p", "N2_over_p")


def jop(number):
    low, high, scale = JOP
    return low + (high - low) / (1 + scale / number)


def mean_of(columns, name, core):
    """Over the layers of the core; its half width is the mean of theirs, as neighbours move together."""
    values, widths = columns[name][core], columns.get(f"{name}_ci99")
    return {"value": float(values.mean())} | ({} if widths is None else {"ci99": float(widths[core].mean())})


def row_of(run):
    measured = script.content_of(run / "measured" / "measured.json")
    _, layers = style.read_profiles(run / "measured" / "profiles.csv")
    _, space = style.read_profiles(run / "measured" / "space.csv")
    layers, space = ({name: np.asarray(values) for name, values in table.items()} for table in (layers, space))
    z = layers["z"]
    core = (z <= -MARGIN) & (z >= z[0] + MARGIN)
    row = {"run": run.name, "steady": measured["steadiness"]["steady"], "reasons": measured["steadiness"]["reasons"], "layers": int(core.sum()),
           "snapshots": measured["settings"]["snapshots"], "provenance": measured["provenance"]["measurement"]["revision"], "theta_deg": measured["settings"]["frame_angle_deg"]}
    row |= {name: mean_of(layers, name, core) for name in ("I", "mu", "k", "shear_rate")} | {name: mean_of(space, name, core) for name in COLUMNS}
    # Weight of what lies above, by the measured volume fractions; of a layer its middle.
    weight = np.cumsum(layers["nu"][::-1])[::-1] - layers["nu"] / 2
    down = math.cos(math.radians(row["theta_deg"]))
    row["sigma_zz_over_weight"] = {"value": float((layers["sigma_zz"][core] / (weight[core] * down)).mean())}
    row["I_spread"] = float(layers["I"][core].std() / layers["I"][core].mean())
    row["mu_jop"] = jop(row["I"]["value"])
    row["mu_over_tan_theta"] = row["mu"]["value"] / math.tan(math.radians(row["theta_deg"]))
    return row, {"z": z, "v_x": layers["v_x"], "mu": layers["mu"], "I": layers["I"], "core": core}


def draw(rows, curves, picture):
    style.use_style()
    figure, (left, right) = plt.subplots(1, 2, figsize=(9, 4.2))
    number = np.geomspace(0.01, 1, 100)
    left.plot(number, jop(number), color="0.5", label="Jop et al. 2006, glass beads")
    for row, curve in zip(rows, curves):
        name = f"{row['theta_deg']:.0f} deg"
        points = left.plot(curve["I"][curve["core"]], curve["mu"][curve["core"]], ".", alpha=0.5)
        left.errorbar(row["I"]["value"], row["mu"]["value"], row["mu"]["ci99"], row["I"]["ci99"], fmt="o", color=points[0].get_color(), label=name)
        right.plot(curve["v_x"], curve["z"], color=points[0].get_color(), label=name)
    left.set(xscale="log", xlabel="$I$", ylabel=r"$\mu$", xlim=(0.01, 1), ylim=(0.35, 0.65))
    right.set(xlabel=r"$v_x/\sqrt{gd}$", ylabel="$z/d$")
    left.legend()
    right.legend()
    style.save(figure, picture, False)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("runs", nargs="+", type=pathlib.Path)
    parser.add_argument("-o", dest="output", required=True, type=pathlib.Path)
    parser.add_argument("--picture", type=pathlib.Path)
    options = parser.parse_args()
    found = [row_of(run) for run in options.runs]
    rows = sorted((row for row, _ in found), key=lambda row: row["theta_deg"])
    whole_file.write_text(options.output, json.dumps({"format": "drumlin-sphere-incline-1", "runs": rows}, indent=1) + "\n")
    if options.picture:
        draw([row for row, _ in found], [curve for _, curve in found], options.picture)


if __name__ == "__main__":
    main()
