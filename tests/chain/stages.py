"""Stages that end early and open a wall: what run.json, walls.csv and the snapshots say, an interruption in between, and a crushed packing.

usage: stages.py DRUMLIN FOLDER_OF_THIS_TEST
"""

import csv
import math
import signal

import h5py

from command import given, read_json, require, results_of_run
from interruption import stopped

GRAVITY, DENSITY = 9.81, 2700


def loads(run):
    with open(run / "walls.csv", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def weight_of(run):
    """Of all grains, N per metre of depth."""
    with h5py.File(run / "snapshots" / "000001.h5") as snapshot:
        radii = snapshot["grains/radius"][:] * snapshot["scales/length_m"][()]
    return math.pi * float((radii**2).sum()) * DENSITY * GRAVITY


def stages_end_as_they_say(run):
    report = read_json(run / "run.json")
    ends = report["stages"]
    require([end["ended_by"] for end in ends] == ["at rest", "its time", "its time"], f"{ends}")
    fill, settle, out = (end["step"] for end in ends)
    require(fill < 5 / 5e-4 and settle == fill + 600 and out == settle + 600, f"steps at the ends: {ends}")
    require(report["steps"] == report["steps_planned"] == out, "steps in all")
    with h5py.File(sorted((run / "snapshots").iterdir())[-1]) as last, h5py.File(run / "snapshots" / "000001.h5") as first:
        require(list(last["walls/open"]) == [1, 0] and list(first["walls/open"]) == [0, 0], "the gate opens")
    return settle * 5e-4


def gate_carries_the_weight(run, opened):
    """At rest the floor of a box carries the weight, less what its sides take by friction; the box all of it after the fall."""
    weight = weight_of(run)
    rows = loads(run)
    before = [row for row in rows if opened - 0.15 < float(row["time_s"]) < opened]
    carried = -sum(float(row["force_z_n_m"]) for row in before) / len({row["time_s"] for row in before})
    require(abs(carried - weight) < 0.01 * weight, f"gate and box carry {carried} N/m of {weight} N/m")
    require(not [row for row in rows if row["wall"] == "gate" and float(row["time_s"]) > opened + 0.1], "lines of an opened gate")


def main():
    with given() as (drumlin, folder, there):
        scene = folder / "tiny-gate.toml"
        drumlin("run", scene, "-o", there / "whole")
        gate_carries_the_weight(there / "whole", stages_end_as_they_say(there / "whole"))
        overrides = ["--set", "output.checkpoint_every_s=0.05", "--threads", "2"]
        stopped(drumlin.executable, scene, there / "again", signal.SIGINT, 130, overrides)
        drumlin("run", scene, "-o", there / "again", "--resume", *overrides)
        require(results_of_run(there / "again") == results_of_run(there / "whole"), "interrupted: other bytes")
        drumlin("plot", there / "whole", "-o", there / "plots")
        lid = ["--set", "walls.0={name=\"gate\", shape=\"segment\", from_mm=[-11.9, 62], to_mm=[11.9, 62]}", "--set", "stages=[{name=\"press\", "
               "duration_s=0.2, time_step_s=5e-4, motions=[{wall=\"gate\", kind=\"translation\", velocity_mm_s=[0, -580]}]}]"]
        drumlin("run", scene, "-o", there / "pressed", *lid, code=3)
        require(read_json(there / "pressed" / "run.json")["status"] == "crushed", "status of a crushed packing")


if __name__ == "__main__":
    main()
