"""The law of plane shear set against the chute, and the other way round (docs/scenes.md).

usage: scene_laws.py SHEAR.json CHUTE.json -o FOLDER
Both files are what scene_numbers.py left. FOLDER gets laws.json (errors of what one geometry says of the other) and laws.png.
"""

import argparse
import json
import math
import pathlib

import numpy
import script
import style
import whole_file

plt = style.plt


def law_of(points):
    """(I, mu, nu) in ascending order of I: means of the runs of one title."""
    titles = {}
    for point in points:
        titles.setdefault(point["title"], []).append(point)
    means = [[float(numpy.mean([value(run) for run in runs])) for value in (lambda r: r["I"], lambda r: r["mu"], lambda r: r["nu"])] for runs in titles.values()]
    return numpy.array(sorted(means)).T


def points_of_shear(runs):
    return [{"title": run["title"], "I": run["I"], "mu": run["mu"]["value"], "mu_ci99": run["mu"]["ci99"], "nu": run["nu"]["value"]} for run in runs]


def points_of_chute(runs):
    return [{"title": run["title"], "I": run["I"]["value"], "mu": run["mu"], "nu": run["nu"]} for run in runs if run["I"]["value"] > 1e-3]


def bagnold(inertial, nu, slope_deg, height):
    """Speed at the surface over that at the base, with I and nu alike at every depth."""
    pull = nu * math.cos(math.radians(slope_deg))
    return 2 / 3 * inertial * math.sqrt(4 / math.pi * pull) * height ** 1.5


def transfers(shear, chute, chute_runs):
    inertial, mu, nu = law_of(shear)
    chute_inertial, chute_mu, chute_nu = law_of(chute)
    ahead, back = [], []
    for run in chute_runs:
        predicted = float(numpy.interp(run["mu"], mu, inertial))
        volume = float(numpy.interp(predicted, inertial, nu))
        speed = bagnold(predicted, volume, run["slope_deg"], run["height"])
        flows = run["I"]["value"] > 1e-3
        ahead.append({"slope_deg": run["slope_deg"], "I": run["I"]["value"], "I_from_shear": predicted, "nu": run["nu"], "nu_from_shear": volume,
                      "surface_speed": run["surface_speed"], "surface_speed_from_shear": speed, "flows": bool(flows),
                      "I_error": predicted / run["I"]["value"] - 1 if flows else None, "speed_error": speed / run["surface_speed"] - 1 if flows else None,
                      "da_cruz_I": max(0.0, (run["mu"] - 0.25) / 1.1)})
    for value, asked, volume in zip(inertial, mu, nu):
        if chute_inertial[0] <= value <= chute_inertial[-1]:
            predicted, packed = float(numpy.interp(value, chute_inertial, chute_mu)), float(numpy.interp(value, chute_inertial, chute_nu))
            back.append({"I": float(value), "mu": float(asked), "mu_from_chute": predicted, "mu_error": predicted / asked - 1,
                         "nu": float(volume), "nu_from_chute": packed, "nu_error": packed / volume - 1})
    pooled = numpy.array([[p["I"], p["mu"]] for p in shear + chute]).T
    slope, constant = numpy.polyfit(pooled[0], pooled[1], 1)
    rest = pooled[1] - slope * pooled[0] - constant
    line = {"mu_at_rest": float(constant), "slope": float(slope), "rms": float(numpy.sqrt((rest ** 2).mean())), "largest": float(numpy.abs(rest).max())}
    return {"format": "drumlin-scene-laws-1", "pooled_line": line, "chute_from_shear": ahead, "shear_from_chute": back,
            "law_of_shear": {"I": inertial.tolist(), "mu": mu.tolist(), "nu": nu.tolist()}}


def drawn(shear, chute, file):
    style.use_style()
    figure, axes = plt.subplots(2, 1, figsize=(6.4, 7), sharex=True)
    for axis, name in zip(axes, ("mu", "nu")):
        axis.set_xscale("log")
        errors = [point["mu_ci99"] for point in shear] if name == "mu" else None
        axis.errorbar([p["I"] for p in shear], [p[name] for p in shear], yerr=errors, fmt="o", color=style.PARTICLES, label="plane shear")
        axis.plot([p["I"] for p in chute], [p[name] for p in chute], "s", color=style.CONTINUUM, label="chute: mu = tan(slope)" if name == "mu" else "chute")
        axis.set_ylabel(r"$\mu$" if name == "mu" else r"$\nu$")
    axes[1].legend(loc="lower left")
    axes[1].set_xlabel("$I$")
    style.save(figure, file, reduced=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("shear")
    parser.add_argument("chute")
    parser.add_argument("-o", "--output", required=True, type=pathlib.Path)
    options = parser.parse_args()
    chute_runs = script.content_of(options.chute)["runs"]
    shear, chute = points_of_shear(script.content_of(options.shear)["runs"]), points_of_chute(chute_runs)
    options.output.mkdir(parents=True, exist_ok=True)
    text = json.dumps(transfers(shear, chute, chute_runs), indent=1) + "\n"
    whole_file.write_text(options.output / "laws.json", text)
    drawn(shear, chute, options.output / "laws.png")


if __name__ == "__main__":
    main()
