"""Runs a small drum through run, measure, calibrate, flow and compare, and prints a hash of each result.

Two revisions whose hashes agree compute the same numbers. Left out are times, memory, machine, revision and figures.

usage: result_hashes.py BUILD_FOLDER FOLDER [--scene NAME] [--law LAW.toml] [--rename OLD=NEW]...
  FOLDER  receives the results; what is in it already is not computed again
  --scene NAME  the scenes data/scenes/NAME.toml and NAME-flow.toml (default: drum-smoke)
  --law LAW.toml  the flow's law, in place of the one that was calibrated
  --rename OLD=NEW  hashes the key OLD of JSON files under the name NEW, where a revision renamed it
  --without-intervals  leaves out the half widths of intervals as well, where a revision changed their definition
"""

import argparse
import csv
import hashlib
import json
import pathlib
import re
import subprocess

import h5py

ROOT = pathlib.Path(__file__).resolve().parents[2]
# What differs between two runs of one revision, or between machines.
PROVENANCE = re.compile(r"(^|_)(seconds|second|revision|compiler|machine|processors|build_type|build|load|memory_mb|mb|bytes|threads|"
                        r"cpu|wall|date|time_of_day|cost|costs|timings|command|html|format)($|_)")


INTERVAL = re.compile(r"(^|_)(ci99|interval_factor|inside_interval|inside_band|by_interval|interval_rms|explained.*|accuracy|averaging)($|_)|_band$")


def table_of(text, left_out):
    """A CSV text without the header lines and columns whose names are left out."""
    lines = [line for line in text.splitlines() if not (line.startswith("#") and left_out(line[1:].split("=")[0].strip()))]
    start = next((i for i, line in enumerate(lines) if not line.startswith("#")), len(lines))
    rows = list(csv.reader(lines[start:]))
    kept = [i for i, name in enumerate(rows[0]) if not left_out(name)] if rows else []
    return "\n".join(lines[:start] + [",".join(row[i] for i in kept if i < len(row)) for row in rows])


def without(value, names, left_out):
    if isinstance(value, dict):
        return {names.get(key, key): without(entry, names, left_out) for key, entry in value.items() if not left_out(key)}
    if isinstance(value, list):
        return [without(entry, names, left_out) for entry in value]
    return value


def content_of(file, names, left_out):
    """What counts of a file, as bytes; None for files that are looked at, not computed with."""
    if file.suffix == ".json":
        return json.dumps(without(json.loads(file.read_text(encoding="utf-8")), names, left_out), sort_keys=True).encode()
    if file.suffix == ".h5":
        parts = []
        with h5py.File(file) as image:
            def add(name, item):
                if name == "header":
                    lines = item[()].tobytes().decode().splitlines()
                    parts.append("\n".join(line for line in lines if not left_out(line.split("=")[0].strip())).encode())
                elif isinstance(item, h5py.Dataset) and not any(left_out(part) for part in name.split("/")):
                    # A text counts as its bytes, which older files have in its place.
                    kind = "uint8" if item.dtype.kind == "S" else str(item.dtype)
                    parts.append(name.encode() + kind.encode() + item[()].tobytes())
            image.visititems(add)
        return b"\n".join(parts)
    if file.suffix == ".csv":
        return table_of(file.read_text(encoding="utf-8"), left_out).encode()
    return file.read_bytes() if file.suffix == ".toml" else None


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--scene", default="drum-smoke")
    parser.add_argument("--law", type=pathlib.Path)
    parser.add_argument("--rename", action="append", default=[])
    parser.add_argument("--without-intervals", action="store_true")
    given = parser.parse_args()

    def left_out(name):
        return bool(PROVENANCE.search(name) or given.without_intervals and INTERVAL.search(name))

    names = dict(entry.split("=", 1) for entry in given.rename)
    drumlin = (given.build / "drumlin").resolve()
    folder = given.folder.resolve()
    folder.mkdir(parents=True, exist_ok=True)
    scenes = ROOT / "data" / "scenes"
    law = str(given.law.resolve()) if given.law else "law.toml"

    def step(result, *words):
        if not (folder / result).exists():
            subprocess.run([drumlin, *map(str, words)], cwd=folder, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    step("run/run.json", "run", scenes / f"{given.scene}.toml", "-o", "run", "--threads", "2")
    step("run/measured/measured.json", "measure", "run")
    step("law.toml", "calibrate", "run", "-o", "law.toml", "--accept-unsteady")
    step("flow/flow.json", "flow", scenes / f"{given.scene}-flow.toml", "--rheology", law, "-o", "flow")
    step("comparison/comparison.json", "compare", "run", "flow", "-o", "comparison", "--accept-unsteady")

    groups = {"run": ["run/scene.toml", "run/run.json", "run/log.csv", "run/snapshots/*"], "measurement": ["run/measured/**/*"],
              "law": ["law.*", "law*/**/*"], "flow": ["flow/**/*"], "comparison": ["comparison/**/*"]}
    for name, patterns in groups.items():
        total = hashlib.sha256()
        files = sorted({file for pattern in patterns for file in folder.glob(pattern) if file.is_file()})
        count = 0
        for file in files:
            content = content_of(file, names, left_out)
            if content is None:
                continue
            count += 1
            digest = hashlib.sha256(content).hexdigest()
            total.update(f"{file.relative_to(folder)} {digest}\n".encode())
            if "snapshots" not in file.parts:
                print(f"    {digest[:16]}  {file.relative_to(folder)}")
        print(f"{total.hexdigest()[:16]}  {name} ({count} files)")


if __name__ == "__main__":
    main()
