#!/usr/bin/python3
"""Reads every file that Drumlin leaves: prints one line about each, draws four of them.

usage: PYTHONPATH=build/python read_results.py FILE_OR_FOLDER... [-o PICTURE.png]

Take what you need from it. The package `drumlin` reads; where it is not at hand, apps/figures/result_files.py does with numpy and h5py alone.
"""

import argparse
import pathlib
import sys

import drumlin
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (the backend must be chosen first)
import numpy as np  # noqa: E402


def about_hdf5(path, found):
    content = drumlin.read(path)
    if content.format == "contact problem":
        return f"contact problem: {len(content.mu)} contacts, W with {content.W.nnz} entries, mu up to {content.mu.max():.2f}"
    if content.format == "drumlin-snapshot-1":
        found["snapshot"] = content
        force = content.get("force_n")
        forces = "contacts not known" if force is None else f"{len(force)} contacts" + (f", strongest {force.max():.1f}" if len(force) else "")
        return f"snapshot: time {content.time:.2f}, {len(content.x)} grains, {forces}"
    if content.format == "drumlin-maps-1":
        fields = [name for name in content if np.ndim(content[name]) == 2 and not name.endswith("_ci99")]
        text = f"maps: {len(fields)} fields on {len(content.x)} x {len(content.z)} nodes"
        if "nu" not in content:  # both sides of a comparison
            return text
        if path.parent.name == "measured":  # the continuum's volume fraction is one number
            found["maps"] = content
        return text + f", nu up to {np.nanmax(content.nu):.3f}"
    return f"{content.format}: {', '.join(content)}"


def about_json(path, found):
    content = drumlin.read(path)
    kind = content.get("format", "JSON")
    reduced = " (reduced)" if content.get("reduced") else ""
    if kind == "drumlin-measured-1":
        scalars = ("{} = {:.4g} +- {:.2g}".format(name, *drumlin.value_of(content, name)) for name in ("theta_deg", "Q", "H"))
        return f"measured{reduced}: {', '.join(scalars)}"
    if kind == "drumlin-run-1":
        return f"run{reduced}: {content['status']}, {content['grains']} grains, {content['snapshots']} snapshots, d = {content['scales']['length_m']:.4g} m"
    if kind == "drumlin-flow-run-2":
        return f"continuum{reduced}: theta = {content['theta_deg']:.2f} deg, Q = {content['Q']:.3g}"
    if kind == "drumlin-comparison-1":
        verdict = content["verdict"]
        return f"comparison{reduced}: {verdict['met']} targets met, {verdict['missed']} missed, {verdict['not_measured']} not measured"
    return f"{kind}{reduced}: " + ", ".join(list(content)[1:5])


def about_csv(path, found):
    table = drumlin.read(path)
    length = len(next(iter(table.values())))
    if path.name == "forces.csv" and table.format == "drumlin-profiles-1":
        return f"forces: {length} layers, |tau|/p up to {np.nanmax(table.stress_ratio):.2f}"
    if path.name == "profiles.csv" and path.parent.name == "measured":
        found["profiles"] = table
    if path.name == "force_distributions.csv":
        found["distributions"] = table
    if path.name == "log.csv":
        return f"log: {length} lines, residual {np.mean(table.residual):.1e} in the mean"
    place = f", at x = {table.header['position']} d" if "position" in table.header else ""
    return f"{table.format or 'table'}: {length} rows of {', '.join(list(table)[:5])}, ...{place}"


def about_toml(path, _):
    content = drumlin.read(path)
    if content.get("format") == "drumlin-rheology-1":
        return f"law: {drumlin.Law(path).words}"
    stages = f", {len(content['stages'])} stages, effects {', '.join(content['effects'])}" if "stages" in content else ""
    return f"{content.get('format', 'TOML')}: {content.get('title', '')}{stages}"


READERS = {".h5": about_hdf5, ".json": about_json, ".csv": about_csv, ".toml": about_toml}


def draw(found, picture):
    plt.rcParams["font.size"] = 12
    figure, panels = plt.subplots(2, 2, figsize=(7.1, 6), constrained_layout=True)
    grains, profile, force, field = panels.flat
    if "snapshot" in found:
        s = found["snapshot"]
        discs = drumlin.plot.grains(grains, s, np.hypot(s.v_x, s.v_z))
        grains.set(title="Speed of the grains, last snapshot")
        figure.colorbar(discs, ax=grains, shrink=0.7)
    if "profiles" in found:
        drumlin.plot.profile(profile, found["profiles"], "v_x")
        profile.set(title="v_x with its 99 % interval")
    if "distributions" in found:
        d = found["distributions"]
        for zone in dict.fromkeys(d["zone"]):
            chosen = (d["zone"] == zone) & (d["quantity"] == "f_n") & (d["contacts"] > 0)
            force.semilogy((d["from"] + d["to"])[chosen] / 2, d["value"][chosen], label=zone)
        force.set(xlabel="f_n / mean", ylim=(1e-3, None), title="Normal forces")
        force.legend()
    if "maps" in found:
        drumlin.plot.field(field, found["maps"], "nu", label="Volume fraction")
    figure.savefig(picture, dpi=110)


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("places", nargs="+", type=pathlib.Path)
    parser.add_argument("-o", "--output", type=pathlib.Path)
    options = parser.parse_args()
    found, printed = {}, False
    for place in options.places:
        files = sorted(place.rglob("*")) if place.is_dir() else [place]
        series = [[file for file in files if file.parent.name == folder][:-1] for folder in ("snapshots", "grains")]
        for file in files:
            # Private to the program, and of many snapshots the last one.
            if file.suffix not in READERS or file.name.startswith("checkpoint") or any(file in earlier for earlier in series):
                continue
            print(f"{file}: {READERS[file.suffix](file, found)}")
            printed = True
    if not printed:
        sys.exit("nothing of Drumlin's was found")
    if options.output and found:
        draw(found, options.output)
        print(f"{options.output}: drawn")


if __name__ == "__main__":
    main()
