"""Shear stress and strain rate below the surface of a drum, particles beside continua with other laws.

usage: bed_laws.py PICTURE --runs RUN... --flows NAME=FLOWRUN...
All are registered by the drum's axis; means over |x| < 10 d of maps.h5, of the runs with the 99 % interval of their mean where they are three
or more. The strain rate of the particles is that of displacements from snapshot to snapshot where their maps have it (the bed).
"""

import argparse
import pathlib

import numpy as np
import scipy.special
import style
from drum_maps import read_maps

HALF_WIDTH = 10  # d


def over_depth(folder):
    """Heights above the drum's axis (d), sigma_xz and strain rate there."""
    header, grids = read_maps(folder)
    middle = np.abs(grids["x"]) < HALF_WIDTH
    rate = grids["strain_rate"]
    if "displacement_strain_rate" in grids:
        moved = grids["displacement_strain_rate"]
        rate = np.ma.where(np.ma.getmaskarray(moved), rate, moved)
    stress = grids["sigma_xz"][:, middle].mean(axis=1)
    return grids["z"] - float(header["axis_depth"]), [stress, np.ma.log10(rate[:, middle].mean(axis=1))], float(header["axis_depth"])


def mean_of(runs):
    """Heights of the first run, [mean, half width] of both quantities, and the mean depth of the axis."""
    found = [over_depth(run / "measured" / "maps.h5") for run in runs]
    z = found[0][0]
    both = []
    for k in range(2):
        values = np.array([np.interp(z, heights, of[k].filled(np.nan), left=np.nan, right=np.nan) for heights, of, _ in found])
        width = np.full(len(z), np.nan)
        if len(runs) > 2:
            width = scipy.special.stdtrit(len(runs) - 1, 0.995) * values.std(axis=0, ddof=1) / np.sqrt(len(runs))
        both.append((values.mean(axis=0), width))
    return z, both, float(np.mean([depth for _, _, depth in found]))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("picture", type=pathlib.Path)
    parser.add_argument("--runs", type=pathlib.Path, nargs="+", required=True)
    parser.add_argument("--flows", nargs="+", required=True, metavar="NAME=FLOWRUN")
    options = parser.parse_args()
    style.use_style()
    figure, panels = style.panels(2, 2, 5, sharey=True)
    z, particles, depth = mean_of(options.runs)
    for axes, (mean, width) in zip(panels, particles):
        axes.fill_betweenx(z + depth, mean - width, mean + width, color=style.PARTICLES, alpha=0.3, linewidth=0)
        axes.plot(mean, z + depth, color=style.PARTICLES, linewidth=3, label="particles")
    for (name, folder), colour, line in zip((flow.split("=", 1) for flow in options.flows), [style.OTHERS[1], style.OTHERS[2], style.CONTINUUM], [":", "--", "-"]):
        heights, values, _ = over_depth(pathlib.Path(folder) / "maps.h5")
        for axes, value in zip(panels, values):
            axes.plot(value, heights + depth, color=colour, linestyle=line, label=style.plain(name, 60))
    panels[0].set_xlabel(style.axis_label("sigma_xz"))
    panels[0].set_ylabel(style.axis_label("z"))
    panels[1].set_xlabel(r"$\log_{10}$ $2|D|$  [$\sqrt{g/d}$]")
    panels[0].set_ylim(-60, 2)
    style.room_above(panels[0], 0.35)
    panels[1].legend(loc="upper left")
    style.save(figure, options.picture, False)


if __name__ == "__main__":
    main()
