#!/usr/bin/python3
"""Reads every file that Drumlin leaves: prints one line about each, draws four of them.

usage: read_results.py FILE_OR_FOLDER... [-o PICTURE.png]

Take what you need from it: each reader below stands alone. Only numpy, h5py, matplotlib and Python 3.11.
"""

import argparse
import csv
import json
import pathlib
import sys
import tomllib

import h5py
import matplotlib

matplotlib.use("Agg")
import matplotlib.collections  # noqa: E402  (the backend must be chosen first)
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402


def read_table(path):
    """(header, columns) of any CSV file here: lines "# key = value", a line of names, rows. Empty fields become NaN."""
    lines = path.read_text(encoding="utf-8").splitlines()
    comments = [line[1:].partition("=") for line in lines if line.startswith("#")]
    rows = list(csv.reader(line for line in lines if line and not line.startswith("#")))

    def column(values):
        try:
            return np.array([float(value) if value else np.nan for value in values])
        except ValueError:
            return np.array(values)  # words: the stage of a log, the zone of a distribution

    header = {key.strip(): value.strip() for key, equals, value in comments if equals}
    return header, {name: column([row[i] for row in rows[1:]]) for i, name in enumerate(rows[0])}


def read_snapshot(file):
    """Arrays of a snapshot by name, "grains/x" and so on; forces instead of impulses."""
    arrays = {}
    file.visititems(lambda name, entry: arrays.update({name: entry[()]}) if isinstance(entry, h5py.Dataset) else None)
    if "contacts/impulse_n" in arrays:
        for part in ("n", "t"):
            arrays[f"force_{part}"] = arrays[f"contacts/impulse_{part}"] / arrays["time_step"][0]
    return arrays


def value_of(content, name):
    """A number of measured.json: (value, half width of its 99 % interval); NaN for what was not measured."""
    entry = content.get(name)
    value, half = (entry.get("value"), entry.get("ci99")) if isinstance(entry, dict) else (entry, None)
    return (np.nan if value is None else value), (np.nan if half is None else half)


def text_of(data):
    return bytes(np.asarray(data).reshape(-1)[0] if np.asarray(data).dtype.kind in "SO" else np.asarray(data)).decode().rstrip("\0")


def about_hdf5(path, found):
    with h5py.File(path) as file:
        if "fclib_local" in file:
            mu = file["fclib_local/vectors/mu"][:]
            return f"contact problem: {len(mu)} contacts, W with {len(file['fclib_local/W/x'])} entries, mu up to {mu.max():.2f}"
        kind = text_of(file["format"][()])
        if kind == "drumlin-snapshot-1":
            snapshot = found["snapshot"] = read_snapshot(file)
            force = snapshot.get("force_n")
            forces = "contacts not known" if force is None else f"{len(force)} contacts" + (f", strongest {force.max():.1f}" if len(force) else "")
            return f"snapshot: time {snapshot['time'][0]:.2f}, {len(snapshot['grains/x'])} grains, {forces}"
        if kind == "drumlin-maps-1":
            rows, columns = len(file["z"]), len(file["x"])
            if "nu" not in file["fields"]:  # both sides of a comparison
                return f"maps: {len(file['fields'])} fields on {columns} x {rows} nodes"
            if path.parent.name == "measured":  # the continuum's volume fraction is one number
                found["maps"] = {"x": file["x"][:], "z": file["z"][:], "nu": file["fields/nu"][:]}
            return f"maps: {len(file['fields'])} fields on {columns} x {rows} nodes, nu up to {np.nanmax(file['fields/nu'][:]):.3f}"
        return f"{kind}: {', '.join(file.get('grains', file))}"


def about_json(path, found):
    content = json.loads(path.read_text(encoding="utf-8"))
    kind = content.get("format", "JSON")
    reduced = " (reduced)" if content.get("reduced") else ""
    if kind == "drumlin-measured-1":
        found["measured"] = content
        return "measured" + reduced + ": " + ", ".join("{} = {:.4g} +- {:.2g}".format(name, *value_of(content, name)) for name in ("theta_deg", "Q", "H"))
    if kind == "drumlin-run-1":
        return f"run{reduced}: {content['status']}, {content['grains']} grains, {content['snapshots']} snapshots, d = {content['scales']['length_m']:.4g} m"
    if kind == "drumlin-flow-run-2":
        return f"continuum{reduced}: theta = {content['theta_deg']:.2f} deg, Q = {content['Q']:.3g}"
    if kind == "drumlin-comparison-1":
        verdict = content["verdict"]
        return f"comparison{reduced}: {verdict['met']} targets met, {verdict['missed']} missed, {verdict['not_measured']} not measured"
    return f"{kind}{reduced}: " + ", ".join(list(content)[1:5])


def about_csv(path, found):
    first = path.read_text(encoding="utf-8").partition("\n")[0]
    header, columns = read_table(path)
    length = len(next(iter(columns.values())))
    if path.name == "forces.csv" and first == "# drumlin-profiles-1":
        found["forces"] = columns
        return f"forces: {length} layers, |tau|/p up to {np.nanmax(columns['stress_ratio']):.2f}"
    if path.name == "profiles.csv" and path.parent.name == "measured":
        found["profiles"] = columns
    if path.name == "force_distributions.csv":
        found["distributions"] = columns
    if path.name == "log.csv":
        return f"log: {length} lines, residual {np.mean(columns['residual']):.1e} in the mean"
    kind = first[2:] if first.startswith("# drumlin-") else "table"
    place = f", at x = {header['position']} d" if "position" in header else ""
    return f"{kind}: {length} rows of {', '.join(list(columns)[:5])}, ...{place}"


def about_toml(path, _):
    content = tomllib.loads(path.read_text(encoding="utf-8"))
    if content.get("format") == "drumlin-rheology-1":
        return "law: mu = {a:.3f} {b:+.4f} ln I, I = {I_min:.1e} ... {I_max:.1e}".format(**content["mu"])
    stages = f", {len(content['stages'])} stages, effects {', '.join(content['effects'])}" if "stages" in content else ""
    return f"{content.get('format', 'TOML')}: {content.get('title', '')}{stages}"


READERS = {".h5": about_hdf5, ".json": about_json, ".csv": about_csv, ".toml": about_toml}


def draw(found, picture):
    figure, panels = plt.subplots(2, 2, figsize=(12, 10), constrained_layout=True)
    grains, profile, force, field = panels.flat
    if "snapshot" in found:
        s = found["snapshot"]
        x, z, radius = s["grains/x"], s["grains/z"], s["grains/radius"]
        discs = matplotlib.collections.EllipseCollection(2 * radius, 2 * radius, 0, units="xy", offsets=np.column_stack([x, z]),
                                                         transOffset=grains.transData, array=np.hypot(s["grains/v_x"], s["grains/v_z"]))
        grains.add_collection(discs)
        grains.set(xlim=(x.min() - 1, x.max() + 1), ylim=(z.min() - 1, z.max() + 1), aspect="equal", title="Speed of the grains, last snapshot")
        figure.colorbar(discs, ax=grains, shrink=0.7)
    if "profiles" in found:
        p = found["profiles"]
        profile.plot(p["z"], p["v_x"], "o-", markersize=3)
        profile.fill_between(p["z"], p["v_x"] - p["v_x_ci99"], p["v_x"] + p["v_x_ci99"], alpha=0.3)
        profile.set(xlabel="z [d]", title="v_x with its 99 % interval")
    if "distributions" in found:
        d = found["distributions"]
        for zone in dict.fromkeys(d["zone"]):
            chosen = (d["zone"] == zone) & (d["quantity"] == "f_n") & (d["contacts"] > 0)
            force.semilogy((d["from"] + d["to"])[chosen] / 2, d["value"][chosen], label=zone)
        force.set(xlabel="f_n / mean", ylim=(1e-3, None), title="Normal forces")
        force.legend()
    if "maps" in found:
        m = found["maps"]
        figure.colorbar(field.pcolormesh(m["x"], m["z"], m["nu"], shading="nearest"), ax=field, shrink=0.7)
        field.set(aspect="equal", title="Volume fraction")
    figure.savefig(picture, dpi=90)


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("places", nargs="+", type=pathlib.Path)
    parser.add_argument("-o", "--output", type=pathlib.Path)
    options = parser.parse_args()
    found = {}
    for place in options.places:
        files = sorted(place.rglob("*")) if place.is_dir() else [place]
        series = [[file for file in files if file.parent.name == folder][:-1] for folder in ("snapshots", "grains")]
        for file in files:
            # Private to the program, and of many snapshots the last one.
            if file.suffix not in READERS or file.name.startswith("checkpoint") or any(file in earlier for earlier in series):
                continue
            print(f"{file}: {READERS[file.suffix](file, found)}")
    if not found:
        sys.exit("nothing of Drumlin's was found")
    if options.output:
        draw(found, options.output)
        print(f"{options.output}: drawn")


if __name__ == "__main__":
    main()
