"""What the amount of the stress leaves over where it follows I alone, place by place in the bed: several runs beside one another.

usage: amount_over_place.py PICTURE --runs RUN... [--record FILE.json]
Each RUN has measured/maps.h5 with displacement fields. |s|/p less the straight line in ln I through all nodes of all runs with I below
1e-3, means over blocks of 10 d x 4 d, at least 3 d below the surface and 4 d from the wall. What differs from place to place and is the
same in every run is no noise: no law |s|/p = f(I) has it.
"""

import argparse
import json
import math
import pathlib

import numpy
import style
import whole_file
from result_files import read_maps

plt = style.plt
BED_I, LEAST_I = 1e-3, 3.8e-6
BLOCK = (10, 4)  # d
LEAST_NODES = 10


def bed_of(run):
    """x, z, |s|/p and ln I at the nodes of the bed where both are known."""
    header, x, z, f, _ = read_maps(run / "measured" / "maps.h5")
    x, z = numpy.meshgrid(x, z)
    inertial = f["displacement_I"]
    with numpy.errstate(invalid="ignore", divide="ignore"):
        columns = [f["mu"], numpy.log(inertial)]
        here = numpy.hypot(x, z - float(header["axis_depth"])) < float(header["drum_radius"]) - 4
        here &= (z < -3) & (f["nu"] >= 0.6) & (inertial > LEAST_I) & (inertial < BED_I) & numpy.isfinite(sum(columns))
    return x[here], z[here], [column[here] for column in columns]


def blocks_of(x, z, left):
    """Mean of what is left over by block."""
    found = {}
    for place, value in zip(zip(numpy.rint(x / BLOCK[0]).astype(int), numpy.rint(z / BLOCK[1]).astype(int)), left):
        found.setdefault((int(place[0]), int(place[1])), []).append(value)
    return {place: float(numpy.mean(values)) for place, values in found.items() if len(values) >= LEAST_NODES}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("picture", type=pathlib.Path)
    parser.add_argument("--runs", type=pathlib.Path, nargs="+", required=True)
    parser.add_argument("--record", type=pathlib.Path, help="file for the numbers")
    options = parser.parse_args()
    if len(options.runs) < 2:
        parser.error("one run does not tell a pattern from noise: two runs at least")
    beds = [bed_of(run) for run in options.runs]
    amounts, ln_I = numpy.concatenate([columns for _, _, columns in beds], axis=1)
    slope, level = numpy.polyfit(ln_I, amounts, 1)
    blocks = [blocks_of(x, z, amount - level - slope * logarithm) for x, z, (amount, logarithm) in beds]
    places = sorted(set.intersection(*(set(found) for found in blocks)))
    left = numpy.array([[found[place] for place in places] for found in blocks])
    rms = float(numpy.sqrt(numpy.mean(left**2)))
    of_seeds = float(numpy.sqrt(numpy.mean(numpy.var(left, axis=0, ddof=1))))
    correlations = numpy.corrcoef(left)[numpy.triu_indices(len(blocks), 1)]
    decades = slope * math.log(10)
    record = {"format": "drumlin-amount-over-place-1", "runs": [run.name for run in options.runs], "level": float(level), "slope": float(slope),
              "blocks": len(places), "rms": rms, "rms_between_runs": of_seeds, "correlations": [float(c) for c in correlations],
              "decades_of_shear_rate": rms / decades, "decades_between_runs": of_seeds / decades,
              "places": [[BLOCK[0] * i, BLOCK[1] * k, *map(float, left[:, n])] for n, (i, k) in enumerate(places)]}
    if options.record:
        whole_file.write_text(options.record, json.dumps(record, indent=1) + "\n")

    style.use_style()
    rows = (len(blocks) + 1) // 2
    figure, panels = plt.subplots(rows, 2, figsize=(14, 0.6 + 3 * rows), sharex=True, sharey=True, squeeze=False)
    limit = max(abs(left.min()), abs(left.max()))
    for axes, run, values in zip(panels.flat, options.runs, left):
        shown = axes.scatter([BLOCK[0] * i for i, _ in places], [BLOCK[1] * k for _, k in places], c=values, cmap="RdBu_r", vmin=-limit, vmax=limit,
                             marker="s", s=190)
        axes.set_title(style.plain(run.name, 60), fontsize=11)
        axes.set_xlabel("x [d]")
        axes.set_ylabel("z [d]")
    for axes in panels.flat[len(blocks):]:
        axes.set_visible(False)
    figure.colorbar(shown, ax=list(panels.flat), label="|s|/p less its law over I")
    figure.suptitle(f"rms {rms:.4f} ({rms / decades:.2f} decades of shear rate); between runs {of_seeds:.4f} ({of_seeds / decades:.2f})", fontsize=12)
    style.save(figure, options.picture, False)
    print(f"|s|/p = {level:.3f} + {slope:.4f} ln I; left: rms {rms:.4f}, between runs {of_seeds:.4f}, correlations "
          + ", ".join(f"{c:.2f}" for c in correlations))


if __name__ == "__main__":
    main()
