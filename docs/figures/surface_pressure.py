"""The least pressure of the continuum's law, read off the surface layer of the particles.

usage: surface_pressure.py PICTURE RUN... [--record FILE.json]
Each RUN has measured/profiles.csv. The pressure p = (sigma_xx + sigma_zz)/2 grows along a straight line below the surface; the continuum's
surface, where its p vanishes, is where that line does. The particles' pressure there is what the law takes in its place, p_min. Read for
lines through the layers from 3 to 8 d below the particles' own surface; from 4 to 12 d and from 2 to 6 d say what that choice moves.
"""

import argparse
import json
import pathlib
import statistics

import numpy
import style
import whole_file

plt = style.plt
WINDOWS = {"3 to 8 d": (3, 8), "4 to 12 d": (4, 12), "2 to 6 d": (2, 6)}
STANDARD = "3 to 8 d"


def pressure_of(run):
    """Height above the particles' own surface, pressure, speed of rotation in turns per minute."""
    header, columns = style.read_profiles(run / "measured" / "profiles.csv")
    z, xx, zz = (numpy.array(columns[name]) for name in ("z", "sigma_xx", "sigma_zz"))
    pressure = (xx + zz) / 2
    second = (float(header["diameter_m"]) / 9.81) ** 0.5
    return z, pressure, float(header["rotation"]) / second * 60 / (2 * numpy.pi)


def line_through(z, pressure, window):
    """Slope per d and height where the line vanishes."""
    inside = (-z > window[0]) & (-z < window[1])
    slope, level = numpy.polyfit(z[inside], pressure[inside], 1)
    return slope, -level / slope


def surface_of(run):
    z, pressure, rpm = pressure_of(run)
    found = {"run": run.name, "rpm": round(rpm, 2)}
    for name, window in WINDOWS.items():
        slope, height = line_through(z, pressure, window)
        found[name] = {"slope": float(slope), "height": float(height), "p_min": float(numpy.interp(height, z, pressure))}
    return found


def draw(runs, surfaces, mean, picture):
    style.use_style()
    figure, axes = plt.subplots(figsize=(7.4, 5.2))
    for number, (run, surface) in enumerate(zip(runs, surfaces)):
        z, pressure, _ = pressure_of(run)
        axes.plot(z - surface[STANDARD]["height"], pressure, ".", color=style.PARTICLES, label=None if number else "particles")
    depth = numpy.linspace(-6, 3, 200)
    line = statistics.fmean(surface[STANDARD]["slope"] for surface in surfaces) * depth
    axes.plot(depth, line, color="0.5", lw=1, label="weight alone")
    for value, marks in ((mean, "-"), (0.4, "--")):
        axes.plot(depth, (line + numpy.sqrt(line**2 + 4 * value**2)) / 2, marks, color=style.CONTINUUM, label=rf"the law's p, $p_\mathrm{{min}}$ = {value:.2g}")
    axes.set_xlim(-6, 3)
    axes.set_ylim(-0.3, 4.5)
    axes.set_xlabel("height above the continuum's surface [d]")
    axes.set_ylabel(r"$p$  [$\rho_0 g d$]")
    axes.legend()
    style.save(figure, picture, False)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("picture", type=pathlib.Path)
    parser.add_argument("runs", type=pathlib.Path, nargs="+", metavar="RUN")
    parser.add_argument("--record", type=pathlib.Path, help="file for the numbers")
    options = parser.parse_args()
    surfaces = [surface_of(run) for run in options.runs]
    values = [surface[STANDARD]["p_min"] for surface in surfaces]
    mean = statistics.fmean(values)
    spread = statistics.stdev(values) if len(values) > 1 else float("nan")
    print("| run | " + " | ".join(f"p_min, {name}" for name in WINDOWS) + " | surface above the particles' own (d) |")
    print("|---|" + "---|" * (len(WINDOWS) + 1))
    for surface in surfaces:
        print(f"| {surface['run']} | " + " | ".join(f"{surface[name]['p_min']:.3f}" for name in WINDOWS) + f" | {surface[STANDARD]['height']:.2f} |")
    print(f"mean {mean:.3f}, standard deviation {spread:.3f} over {len(values)} runs")
    if options.record:
        whole_file.write_text(options.record, json.dumps({"format": "drumlin-surface-pressure-1", "mean": mean, "standard_deviation": spread,
                                                          "standard": STANDARD, "runs": surfaces}, indent=1) + "\n")
    draw(options.runs, surfaces, mean, options.picture)


if __name__ == "__main__":
    main()
