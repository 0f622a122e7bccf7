"""Drums of several sizes at one Froude number: what is measured on each, its powers of D/d, and what the continuum makes of the same drums.

usage: drum_sizes.py RECORD.json --law LAW.toml --runs RUN... [--flows LAW=STUDY...] [--speeds RUN...]
       drum_sizes.py RECORD.json --picture PICTURE.png
Each RUN is measured with maps; LAW is a table mu(I), which |s|/p of the flowing layer at x = 0 is set beside; each STUDY is what `drumlin compare --study RUN... FLOW -o STUDY` left of one flow. phi counts from below the axis,
positive downslope, as in bed_edges.py.
"""

import argparse
import json
import pathlib
import tomllib

import numpy
import style
import whole_file
from bed_edges import ANGLES, fields_of, rounded, slip_length, wall_of
from drum_maps import read_maps

plt = style.plt
SCALARS = ("theta_deg", "theta_com_deg", "Q", "H", "shear_rate", "lambda", "I_th", "nu_bulk", "k_flowing")
SLIP_AT = (-60, -30, 0)  # deg
FITTED = {"theta_deg": r"$\theta$", "H": "$H$", "shear_rate": r"$\dot\gamma$", "slip_-60": r"slip of the wall at $-60\degree$"}
HALF = 0.33  # share of the drum's area that discs cover, between the two fillings


def flowing_of(run, depth, law):
    """|s|/p of the flowing layer above -depth, that of the law at the same I, means weighted by sigma_zz."""
    _, c = style.read_profiles(run / "measured" / "profiles.csv")
    z, xx, zz, xz, rate = (numpy.array(c[name]) for name in ("z", "sigma_xx", "sigma_zz", "sigma_xz", "shear_rate"))
    at = (z > -depth) & (z < -2)
    p = (xx + zz)[at] / 2
    mu = numpy.interp(numpy.log(abs(rate[at]) / numpy.sqrt(p)), numpy.log(law["I"]), law["mu"])
    ratio = numpy.hypot(xz, (xx - zz) / 2)[at] / p
    return {"stress_ratio": float(numpy.average(ratio, weights=zz[at])), "law": float(numpy.average(mu, weights=zz[at]))}


def layer_of(run):
    """|s|/p where I is 0.02 to 0.03 within half a radius of the middle, and by how much its axes lag behind those of the strain rate (deg)."""
    header, grids = read_maps(run / "measured" / "maps.h5")
    value = {name: numpy.ma.filled(field, numpy.nan) for name, field in grids.items() if field.ndim == 2}
    near = (abs(grids["x"]) < float(header["drum_radius"]) / 2)[None, :]
    with numpy.errstate(invalid="ignore"):
        taken = near & (value["I"] > 0.02) & (value["I"] < 0.03) & (value["nu"] > 0.7)
    lag, ratio = value["axis_angle_deg"][taken], value["mu"][taken]
    return {"lag_deg": float(numpy.nanmean(lag)), "stress_ratio": float(numpy.nanmean(ratio)), "nodes": int(numpy.isfinite(ratio).sum())}


def run_of(run, law):
    measured, record = (json.loads((run / name).read_text()) for name in ("measured/measured.json", "run.json"))
    scene = tomllib.loads((run / "scene.toml").read_text())
    fields, radius, rotation = fields_of(run)
    wall = wall_of(fields, radius, rotation)
    count = scene["grains"]["generated"]["count"]
    found = {"run": run.name, "diameter_mm": 2 * scene["walls"][0]["radius_mm"], "D": 2 * radius, "rotation_rpm": scene["stages"][-1]["motions"][0]["speed_rpm"],
             "grains": count, "filling": "half" if count / (2 * radius) ** 2 > HALF else "35 %", "friction": scene["effects"]["friction"]["grain_grain"],
             "turns": scene["stages"][-1]["turns"], "seed": scene["seed"], "revision": record["revision"], "cpu_seconds": record["cpu_seconds"],
             "steady": measured["steadiness"]["steady"]}
    found |= {name: {key: measured[name][key] for key in ("value", "ci99")} for name in SCALARS}
    found |= {f"slip_{angle}": {"value": wall["slip"][ANGLES.index(angle)]} for angle in SLIP_AT}
    return found | {"slip_length": slip_length(wall), "layer": layer_of(run), "flowing": flowing_of(run, found["H"]["value"], law)}


def powers_of(runs):
    """d ln q/d ln D of the half filled drums of each friction, by least squares over the runs, with 99 % interval; `scatter`: rms residual of ln q."""
    powers = {}
    for friction in sorted({run["friction"] for run in runs}):
        here = [run for run in runs if run["filling"] == "half" and run["friction"] == friction]
        size = numpy.log([run["D"] for run in here])
        if numpy.ptp(size) < 0.1 or len(here) < 4:
            continue
        for name in (*FITTED, "lambda", "I_th"):
            value = numpy.log([run[name]["value"] for run in here])
            (power, _), (square, *_), *_ = numpy.polyfit(size, value, 1, full=True)
            scatter = float(numpy.sqrt(square / (len(here) - 2)))
            half = style.student_99(len(here) - 2) * scatter / numpy.sqrt(((size - size.mean()) ** 2).sum())
            powers.setdefault(str(friction), {})[name] = {"value": float(power), "ci99": float(half), "scatter": scatter, "runs": len(here)}
    return powers


def flow_of(law, study, diameters):
    """Both sides of one speed, read at the same places; errors as targets have them. `diameters`: of the runs by name."""
    content = json.loads((study / "study.json").read_text())
    speed, = content["speeds"]
    errors = {"_".join(filter(None, (target["quantity"], target.get("zone")))): target["value"] for target in speed["targets"]}
    sides = {key: {side: speed["scalars"][key][side] for side in ("particles", "continuum")} for key in ("theta_deg", "H", "shear_rate", "lambda", "I_th")}
    return {"law": law, "diameter_mm": diameters[speed["particles"][0]], "effects": content["effects"], "fitted_on": content["fitted_on"],
            "particles": speed["particles"], "scalars": sides, "errors": errors, "cpu_seconds": speed["seconds"]["continuum"]}


def number(entry):
    return entry["value"] if isinstance(entry, dict) else entry


def draw(record, picture):
    style.use_style()
    figure, panels = plt.subplots(2, 2, figsize=(7.5, 9))
    kinds = sorted({(run["filling"], run["friction"]) for run in record["runs"]}, key=lambda kind: (kind[0] != "half", -kind[1]))
    for axes, (name, title) in zip(panels.flat, FITTED.items()):
        for (filling, friction), marker, colour in zip(kinds, "osD^", [style.PARTICLES, *style.OTHERS]):
            here = [run for run in record["runs"] if (run["filling"], run["friction"]) == (filling, friction)]
            full = "full" if filling == "half" else "none"
            axes.plot([run["D"] for run in here], [run[name]["value"] for run in here], marker, color=colour, fillstyle=full, ls="none",
                      label=f"particles, {filling}, friction {friction:g}")
        for law, marker in zip(dict.fromkeys(flow["law"] for flow in record["continuum"]), "x+1423"):
            flows = [flow for flow in record["continuum"] if flow["law"] == law and name in flow["scalars"]]
            axes.plot([flow["diameter_mm"] / 3.3 for flow in flows], [number(flow["scalars"][name]["continuum"]) for flow in flows], marker, ms=9,
                      color=style.CONTINUUM, ls="none", label=f"continuum, {law}")
        axes.set_xscale("log")
        axes.set_yscale("log")
        axes.set_xticks([45, 91, 136, 273], ["45", "91", "136", "273"])
        axes.minorticks_off()
        axes.yaxis.set_major_locator(style.matplotlib.ticker.LogLocator(subs=(1, 1.5, 2, 3, 5, 7)))
        axes.yaxis.set_major_formatter(style.matplotlib.ticker.FuncFormatter(lambda value, _: f"{value:g}"))
        axes.set_xlabel("$D/d$")
        axes.set_title(title + {"theta_deg": " [deg]", "H": " [d]"}.get(name, ""))
    figure.get_layout_engine().set(rect=(0, 0.2, 1, 0.8))
    figure.legend(*panels.flat[0].get_legend_handles_labels(), loc="lower center", ncol=2)
    style.save(figure, picture, False)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("record", type=pathlib.Path)
    parser.add_argument("--law", type=pathlib.Path)
    parser.add_argument("--runs", type=pathlib.Path, nargs="+")
    parser.add_argument("--flows", nargs="+", default=[])
    parser.add_argument("--speeds", type=pathlib.Path, nargs="+", default=[])
    parser.add_argument("--picture", type=pathlib.Path)
    options = parser.parse_args()
    if options.picture:
        draw(json.loads(options.record.read_text()), options.picture)
        return
    law = tomllib.loads(options.law.read_text())["mu"]
    runs = sorted((run_of(run, law) for run in options.runs), key=lambda run: (run["filling"] != "half", -run["friction"], run["D"], run["seed"]))
    diameters = {run["run"]: run["diameter_mm"] for run in runs}
    flows = [flow_of(law, pathlib.Path(study), diameters) for law, study in (entry.split("=", 1) for entry in options.flows)]
    record = {"format": "drumlin-sizes-1", "runs": runs, "powers": powers_of(runs), "continuum": flows, "other_speeds": {run.name: layer_of(run) for run in options.speeds}}
    text = json.dumps(json.loads(json.dumps(rounded(record)), parse_constant=lambda _: None), indent=1)
    whole_file.write_text(options.record, text + "\n")


if __name__ == "__main__":
    main()
