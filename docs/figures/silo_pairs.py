"""Rates of discharge of pairs of silos, each side over its own steady part, before and after the offset of each (data/limits/pair.toml).

usage: silo_pairs.py -o FILE.json WIDTH=PARTICLES.h5,FLOWRUN...
WIDTH of the slot, d; PARTICLES.h5: frames of `drumlin measure RUN... --at`, until half has left; FLOWRUN: the continuum's flow. PYTHONPATH holds the package.
"""

import argparse
import json
import pathlib

import numpy as np

from drumlin.figures import whole_file
from drumlin.pair import frames, judgement, measures
from drumlin.study.tables import plain

LIMITS = pathlib.Path(__file__).absolute().parents[2] / "data/limits/pair.toml"


def rates(read):
    floor = measures.floor_height(read)
    return np.array([measures.rate(measures.Mean(read, floor, [run])) for run in range(len(read.runs))])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("pairs", nargs="+")
    parser.add_argument("-o", dest="output", required=True)
    options = parser.parse_args()
    contents, slots = [], []
    for words in options.pairs:
        width, paths = words.split("=", 1)
        particles, flow = paths.split(",")
        value, half = measures.interval(rates(frames.read_frames(particles)))
        made = json.loads((pathlib.Path(flow) / "flow.json").read_text(encoding="utf-8"))
        slots.append({"width": float(width), "particles": float(value), "ci99": float(half), "continuum": float(rates(frames.read_frames(pathlib.Path(flow) / "frames.h5"))[0]),
                      "checks": made["checks"], "cpu_seconds": made["cpu_seconds"], "revision": made["provenance"]["revision"]})
        contents.append({"slot_width": float(width), "rate": {"particles": slots[-1]["particles"], "continuum": slots[-1]["continuum"]}})
    found = judgement.rate_offsets(judgement.read_pair_limits(LIMITS), contents)
    for slot, row in zip(slots, found["rows"]):
        slot["after_offset"] = row
    record = {"format": "drumlin-silo-pairs-1", "k": {side: float(k) for side, k in found["k"].items()}, "slots": slots}
    whole_file.write_text(pathlib.Path(options.output), json.dumps(plain(record), indent=1) + "\n")


if __name__ == "__main__":
    main()
