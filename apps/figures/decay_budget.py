"""What sets lambda: slopes of ln(shear rate), ln I and mu over the window of lambda, of particles and flows.

usage: decay_budget.py PROFILES_FOLDER...   (RUN or FLOWRUN; the continuum in the window below its own H)

In a local law ln I = (mu - a)/b, so that 1/lambda is nearly (dmu/dz)/b with b the slope of mu over ln I in the window.
"""

import json
import math
import pathlib
import sys

import style


def slope(x, y):
    mean_x, mean_y = sum(x) / len(x), sum(y) / len(y)
    return sum((a - mean_x) * (b - mean_y) for a, b in zip(x, y)) / sum((a - mean_x) ** 2 for a in x)


def budget(folder):
    """(lambda, dmu/dz, b, least and greatest log10 I) from -H - 8 to -H - 2."""
    measured = folder / "measured"
    profiles, scalars = (measured / "profiles.csv", measured / "measured.json") if measured.exists() else (folder / "profiles.csv", folder / "flow.json")
    H = json.loads(scalars.read_text(encoding="utf-8"))["H"]
    H = H["value"] if isinstance(H, dict) else H
    _, columns = style.read_profiles(profiles)
    rows = [i for i, z in enumerate(columns["z"]) if -H - 8 <= z <= -H - 2 and columns["shear_rate"][i] > 0]
    z, mu = [columns["z"][i] for i in rows], [columns["mu"][i] for i in rows]
    rate, inertial = ([math.log(columns[name][i]) for i in rows] for name in ("shear_rate", "I"))
    return 1 / slope(z, rate), slope(z, mu), slope(z, mu) / slope(z, inertial), min(inertial) / math.log(10), max(inertial) / math.log(10)


def main():
    print("run, lambda, dmu/dz, b = dmu/dln I, log10 I")
    for folder in map(pathlib.Path, sys.argv[1:]):
        length, rise, b, low, high = budget(folder)
        print(f"{folder.name}, {length:.2f}, {rise:.5f}, {b:.4f}, {low:.2f} ... {high:.2f}")


if __name__ == "__main__":
    main()
