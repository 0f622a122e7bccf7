"""Spheres down a rough incline beside published laws: numbers of the core of each measured run, and their picture.

usage: sphere_incline.py RUN... -o FILE.json [--law LAW.json] [--flows FLOWRUN...] [--picture FILE.png]
RUN: imported spheres with a free surface, measured by `drumlin measure` (space.csv). The core is 3 d off the base and the surface.
LAW.json: what `drumlin calibrate RUN... --law jop` leaves beside the law. FLOWRUN: the incline of that law at the slope of a run, z = 0 the surface of both.
"""

import argparse
import json
import math
import pathlib

import numpy as np

import script
import style
import whole_file

MARGIN = 3.0  # d
JOP = (0.383, 0.643, 0.279)  # Jop, Forterre, Pouliquen 2006, glass beads
LIMITS = {"mu": 0.03, "rms": 0.15, "rms_of_shape": 0.05}  # data/spheres/expected.md
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
    tan = math.tan(math.radians(row["theta_deg"]))
    row["I_jop"] = JOP[2] / ((JOP[1] - JOP[0]) / (tan - JOP[0]) - 1) if tan > JOP[0] else None
    row["mu_over_tan_theta"] = row["mu"]["value"] / tan
    return row, {"z": z, "v_x": layers["v_x"], "mu": layers["mu"], "I": layers["I"], "core": core}


def law_of(record):
    """The form that was chosen: coefficients of Jop's form (mu_s, mu_2 - mu_s, I_0), and between what they lie in 99 % of the draws."""
    form = next(form for form in script.content_of(record)["forms"] if form["chosen"])
    return {name: form[name] for name in ("form", "coefficients", "ranges", "rms_misfit", "points")} | {"curve": form["curve"]}


def beside_flow(run, row, curve):
    """The flow at the slope of a row beside its spheres: speeds at the surface, and the rms of the difference over the core as a share of that of the spheres;
    without what both have at the lowest layer of the core: their shapes."""
    flow = script.content_of(run / "flow.json")
    _, columns = style.read_profiles(run / "profiles.csv")
    z, core = curve["z"], curve["core"]
    computed = np.interp(z, np.asarray(columns["z"]), np.asarray(columns["v_x"]))
    surface = float(np.interp(0, z, curve["v_x"]))
    off = computed - curve["v_x"]
    rms = {name: float(np.sqrt(np.mean((off[core] - base) ** 2)) / surface) for name, base in (("rms", 0.0), ("rms_of_shape", off[core][0]))}
    return {"run": run.name, "surface_speed": flow["surface_speed"], "surface_speed_of_spheres": surface} | rms, (z, computed)


def draw(rows, curves, law, flows, picture):
    style.use_style()
    figure, (upper, lower) = style.panels(2, height=3.8)
    number = np.geomspace(0.01, 1, 100)
    upper.plot(number, jop(number), color="0.5", label="Jop et al. 2006, glass beads")
    if law:
        curve = law["curve"]
        upper.fill_between(curve["I"], curve["low"], curve["high"], color="0.85")
        upper.plot(curve["I"], curve["value"], color="black", label="fitted in Jop's form")
    for z, computed in flows:
        lower.plot(computed, z, "--", color="0.4", linewidth=1)
    for row, curve in zip(rows, curves):
        name = f"{row['theta_deg']:.0f} deg"
        points = upper.plot(curve["I"][curve["core"]], curve["mu"][curve["core"]], ".", alpha=0.5)
        upper.errorbar(row["I"]["value"], row["mu"]["value"], row["mu"]["ci99"], row["I"]["ci99"], fmt="o", color=points[0].get_color(), label=name)
        lower.plot(curve["v_x"], curve["z"], color=points[0].get_color(), label=name)
    upper.set(xscale="log", xlabel="$I$", ylabel=r"$\mu$", xlim=(0.01, 1), ylim=(0.35, 0.65))
    lower.set(xlabel=r"$v_x/\sqrt{gd}$", ylabel="$z/d$")
    upper.legend()
    lower.legend()
    style.save(figure, picture, False)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("runs", nargs="+", type=pathlib.Path)
    parser.add_argument("-o", dest="output", required=True, type=pathlib.Path)
    parser.add_argument("--law", type=pathlib.Path)
    parser.add_argument("--flows", nargs="*", default=[], type=pathlib.Path)
    parser.add_argument("--picture", type=pathlib.Path)
    options = parser.parse_args()
    found = sorted((row_of(run) for run in options.runs), key=lambda of: of[0]["theta_deg"])
    law, flows = law_of(options.law) if options.law else None, []
    for flow in options.flows:
        slope = script.content_of(flow / "flow.json")["theta_deg"]
        row, curve = min(found, key=lambda of: abs(of[0]["theta_deg"] - slope))
        row["flow"], lines = beside_flow(flow, row, curve)
        flows.append(lines)
    rows = [row for row, _ in found]
    record = {"format": "drumlin-sphere-incline-1", "jop": JOP, "limits": LIMITS, "runs": rows} | ({"law": {name: law[name] for name in law if name != "curve"}} if law else {})
    whole_file.write_text(options.output, json.dumps(record, indent=1) + "\n")
    if options.picture:
        draw(rows, [curve for _, curve in found], law, flows, options.picture)


if __name__ == "__main__":
    main()
