"""Shear over normal traction along the drum's wall: particles from their slices along x, continuum from its maps.

usage: wall_traction_figures.py PICTURE --particles RUN... --flows FLOWRUN... [--labels LABEL...]
Prints the numbers; the second panel shows the particles speed by speed.
"""

import argparse
import collections
import math
import pathlib

import result_files
import style

plt = style.plt
ABOVE_WALL = 5  # d; nearer the layers of discs along the wall show


def traction(xx, zz, xz, x, below_axis):
    """(angle from below the axis in deg, shear / normal traction) on the circle through x, below_axis; stresses compression positive."""
    angle = math.atan2(x, below_axis)
    n, t = (math.sin(angle), -math.cos(angle)), (math.cos(angle), math.sin(angle))
    on_n = (xx * n[0] - xz * n[1], -xz * n[0] + zz * n[1])
    normal, shear = n[0] * on_n[0] + n[1] * on_n[1], t[0] * on_n[0] + t[1] * on_n[1]
    return math.degrees(angle), shear / normal


def between(z, values, at):
    for i in range(len(z) - 1):
        if z[i] <= at <= z[i + 1]:
            share = (at - z[i]) / (z[i + 1] - z[i])
            return (1 - share) * values[i] + share * values[i + 1]
    return math.nan


def of_run(run):
    """{angle: ratio} of a run, each the mean over 6 d of depth around the circle."""
    points = {}
    for path in sorted((run / "measured" / "slices").glob("*.csv")):
        header, columns = style.read_profiles(path)
        x, radius = float(header["position"]), float(header["drum_radius"]) - ABOVE_WALL
        ratios = []
        for r in (radius - 6, radius - 4, radius - 2, radius):
            below = math.sqrt(r * r - x * x)
            at = float(header["axis_depth"]) - below
            angle, ratio = traction(*(between(columns["z"], columns[name], at) for name in ("sigma_xx", "sigma_zz", "sigma_xz")), x, below)
            ratios.append(ratio)
        points[round(math.degrees(math.asin(x / (radius - 3))))] = sum(ratios) / len(ratios)
    return dict(sorted(points.items()))


def of_flow(flow, angles):
    names = ("sigma_xx", "sigma_zz", "sigma_xz")
    header, x, z, fields, _ = result_files.read_maps(flow / "maps.h5", names)
    radius, axis = float(header["drum_radius"]) - ABOVE_WALL, float(header["axis_depth"])
    ratios = []
    for angle in angles:
        several = []
        for r in (radius - 6, radius - 4, radius - 2, radius):
            at_x, below = r * math.sin(math.radians(angle)), r * math.cos(math.radians(angle))
            i, j = round((at_x - x[0]) / (x[1] - x[0])), round((axis - below - z[0]) / (z[1] - z[0]))
            inside = 0 <= i < len(x) and 0 <= j < len(z)
            several.append(traction(*(field[j, i] for field in map(fields.get, names)), at_x, below)[1] if inside else math.nan)
        ratios.append(sum(several) / len(several))
    return ratios


def rpm_of(run):
    header, _ = style.read_profiles(run / "measured" / "profiles.csv")
    return round(float(header["rotation"]) / math.sqrt(float(header["diameter_m"]) / 9.81) * 30 / math.pi, 2)


def shown(angles, ratios):
    return "  ".join(f"{angle:+.0f}: {ratio:.3f}" for angle, ratio in zip(angles, ratios))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("picture")
    parser.add_argument("--particles", nargs="+", type=pathlib.Path, required=True)
    parser.add_argument("--flows", nargs="+", type=pathlib.Path, required=True)
    parser.add_argument("--labels", nargs="+", help="of the flows (default: names of their folders)")
    options = parser.parse_args()
    style.use_style()
    runs = collections.defaultdict(list)
    for run in options.particles:
        runs[rpm_of(run)].append(of_run(run))
    flow_rpm = 6 if 6 in runs else min(runs)
    figure, (upper, lower) = style.panels(2, height=4, sharey=True)
    colors = plt.cm.viridis([0.9 * i / max(1, len(runs) - 1) for i in range(len(runs))])
    for (rpm, found), color in zip(sorted(runs.items()), colors):
        angles = list(found[0])
        mean = [sum(run[angle] for run in found) / len(found) for angle in angles]
        print(f"particles {rpm:g} rpm ({len(found)} runs)  {shown(angles, mean)}")
        lower.plot(angles, mean, "o-", color=color, label=f"{rpm:g} rpm")
        if rpm == flow_rpm:
            for run in found:
                upper.plot(angles, list(run.values()), "o", markersize=3, color=style.PARTICLES, alpha=0.6)
            upper.plot(angles, mean, "o-", color=style.PARTICLES, markersize=7, label=f"particles, {rpm:g} rpm")
    angles = list(range(-60, 61, 4))
    for flow, label, color in zip(options.flows, options.labels or [flow.name for flow in options.flows], [style.CONTINUUM] + style.OTHERS):
        ratios = of_flow(flow, angles)
        print(f"{label}  {shown(angles[5::5], ratios[5::5])}")
        upper.plot(angles, ratios, "-", color=color, label=f"continuum, {label}")
    for axes, title in ((upper, "Both sides"), (lower, "Particles at all speeds")):
        axes.set_xlabel("angle from below the axis  [deg]; + downslope")
        axes.set_title(title)
        axes.legend()
    upper.set_ylabel("shear / normal traction near the wall")
    style.save(figure, options.picture, False)


if __name__ == "__main__":
    main()
