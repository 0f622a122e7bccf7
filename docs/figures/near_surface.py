"""What the particles say of the law near a free surface: |s|/p over I = 2|D|/sqrt(p + w) for several w, and the surface of flows beside theirs.

usage: near_surface.py RECORD.json --fitted RUN... --predicted RUN... --flows RUN=FLOWRUN...
A table over ln I, straight in I above its last knot, is fitted to the fitted runs, each with the same weight, at nodes of maps.h5 with I > 1e-2, more than 1.5 d
below nu = 0.7 and within 0.4 radii of the middle. Residuals: root mean squares, and means over layers below nu = 0.7.
"""

import argparse
import json
import pathlib

import numpy as np
import whole_file
from drum_maps import read_maps

WEIGHTS = (0, 1, 2, 3, 4, 5, 6, 8)  # rho0 g d
KNOTS = np.log([0.01, 0.015, 0.022, 0.032, 0.045, 0.06])
LAYERS = (1.5, 4, 7, 11, 16)  # d
ENDS = (-60, -50, -40, 40, 50, 60)  # d along the surface


def top_of(grids, least):
    """Height up to which each column is so dense, d."""
    nu, z = np.ma.filled(grids["nu"], 0), grids["z"]
    dense = nu[:-1] >= least
    rows, columns = dense.shape[0] - 1 - dense[::-1].argmax(axis=0), np.arange(nu.shape[1])
    inside, outside = nu[rows, columns], nu[rows + 1, columns]
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.where(dense.any(axis=0), z[rows] + (z[1] - z[0]) * (inside - least) / (inside - outside), np.nan)


def samples_of(run):
    header, grids = read_maps(run / "measured" / "maps.h5")
    x, z = np.meshgrid(grids["x"], grids["z"])
    rate, p, ratio, inertial = (np.ma.filled(grids[name], np.nan) for name in ("strain_rate", "p", "mu", "I"))
    depth = top_of(grids, 0.7)[None, :] - z
    with np.errstate(invalid="ignore"):
        taken = (inertial > 1e-2) & (depth > LAYERS[0]) & (abs(x) < 0.4 * float(header["drum_radius"])) & np.isfinite(ratio)
    return {"rate": rate[taken], "p": p[taken], "ratio": ratio[taken], "depth": depth[taken]}


def basis(samples, w):
    ln_i = np.log(samples["rate"]) - np.log(samples["p"] + w) / 2
    hats = [np.interp(ln_i, KNOTS, row) for row in np.eye(len(KNOTS))]
    return np.column_stack([*hats, np.maximum(np.exp(ln_i) - np.exp(KNOTS[-1]), 0)])


def fit_of(fitted, predicted, w):
    rows = np.vstack([basis(run, w) / np.sqrt(len(run["p"])) for run in fitted.values()])
    values = np.concatenate([run["ratio"] / np.sqrt(len(run["p"])) for run in fitted.values()])
    law = np.linalg.lstsq(rows, values, rcond=None)[0]
    found = {"w": w, "rms_fitted": 0, "runs": {}}
    for name, run in (fitted | predicted).items():
        off = run["ratio"] - basis(run, w) @ law
        layers = [off[(run["depth"] >= low) & (run["depth"] < high)] for low, high in zip(LAYERS, LAYERS[1:])]
        found["runs"][name] = {"rms": rms(off), "layers": [float("%.3g" % layer.mean()) if len(layer) > 9 else None for layer in layers]}
    found["rms_fitted"] = rms([found["runs"][name]["rms"] for name in fitted])
    return found


def rms(values):
    return float("%.4g" % np.sqrt(np.mean(np.square(values))))


def surface_of(folder):
    """theta, its angle by the centre of mass (deg), and heights of nu = 0.4 above that in the middle (d)."""
    header, grids = read_maps(folder / "maps.h5")
    nu = np.ma.filled(grids["nu"], 0)
    x, z = np.meshgrid(grids["x"], grids["z"] - float(header["axis_depth"]))
    theta, tilt = float(header["theta_deg"]), np.degrees(np.arctan2(-(x * nu).sum(), -(z * nu).sum()))
    top = np.interp((0, *ENDS), grids["x"], top_of(grids, 0.4))
    return {"theta_deg": round(theta, 3), "theta_com_deg": round(theta + float(tilt), 3), "heights": [round(float(h), 2) for h in top[1:] - top[0]]}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("record", type=pathlib.Path)
    for name in ("fitted", "predicted"):
        parser.add_argument("--" + name, type=pathlib.Path, nargs="+", required=True)
    parser.add_argument("--flows", nargs="+", default=[], metavar="RUN=FLOWRUN")
    options = parser.parse_args()
    fitted, predicted = ({run.name: samples_of(run) for run in runs} for runs in (options.fitted, options.predicted))
    record = {"format": "drumlin-near-surface-1", "fitted": list(fitted), "layers_d": LAYERS, "fits": [fit_of(fitted, predicted, w) for w in WEIGHTS], "x_d": ENDS, "surfaces": {}}
    for pair in options.flows:
        run, flow = (pathlib.Path(side) for side in pair.split("=", 1))
        record["surfaces"][run.name] = {"particles": surface_of(run / "measured"), "continuum": surface_of(flow)}
    whole_file.write_text(options.record, json.dumps(record) + "\n")


if __name__ == "__main__":
    main()
