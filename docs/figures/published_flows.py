"""Flows of regions beside published ones: columns and silos of Lagree, Staron, Popinet, judged by data/limits/pair.toml.

usage: published_flows.py -o FILE.json CASE=FLOWRUN...
CASE: lagree-column, staron-column-0.5, staron-column-6 (data/pair/heights.csv), or silo:HALF_WIDTH (data/pair/silo-rates.csv); flows of
data/scenes/published-column-flow.toml and published-silo-flow.toml. PYTHONPATH holds the package (build/python).
"""

import argparse
import csv
import json
import pathlib

from drumlin.figures import whole_file
from drumlin.pair import comparison, frames, judgement
from drumlin.study.tables import plain

DATA = pathlib.Path(__file__).absolute().parents[2] / "data"
CURVES = {"lagree-column": ("continuum", 0.5), "staron-column-0.5": ("discs", 0.5), "staron-column-6": ("discs", 6.0)}


def rows_of(name):
    with open(DATA / "pair" / name, encoding="utf-8") as lines:
        return [{key: float(value) if key not in ("of", "time") else value for key, value in row.items()}
                for row in csv.DictReader(line for line in lines if not line.startswith("#"))]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("cases", nargs="+")
    parser.add_argument("-o", dest="output", required=True)
    options = parser.parse_args()
    limits, found, silos = judgement.read_pair_limits(DATA / "limits" / "pair.toml"), {}, {}
    for case, folder in (words.split("=", 1) for words in options.cases):
        flow, read = json.loads((pathlib.Path(folder) / "flow.json").read_text(encoding="utf-8")), frames.read_frames(pathlib.Path(folder) / "frames.h5")
        facts = {key: flow[key] for key in ("cells", "steps", "iterations", "cpu_seconds", "checks")} | {
            "revision": flow["provenance"]["revision"], "accuracy": {key: (flow["accuracy"] or {}).get(key) for key in ("height_rms_largest", "order", "height_error")}}
        if case.startswith("silo:"):
            silos[float(case[5:])] = read
            found[case] = facts
            continue
        of, aspect = CURVES[case]
        table = [row for row in rows_of("heights.csv") if row["of"] == of and row["aspect"] == aspect]
        found[case] = facts | {"row": judgement.against_heights(limits, case, read, table)}
    for row in judgement.against_rates(limits, silos, rows_of("silo-rates.csv")):
        found[f"silo:{row['half_width']:g}"]["row"] = row
    whole_file.write_text(pathlib.Path(options.output), json.dumps(plain(comparison.as_lists({"format": "drumlin-published-flows-1", "cases": found})), indent=1) + "\n")


if __name__ == "__main__":
    main()
