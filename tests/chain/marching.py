"""A march in time from rest and from a flow; interrupted and killed it goes on to the same bytes; what fails says so.

usage: marching.py DRUMLIN FOLDER_OF_THIS_TEST
"""

import csv
import signal
import sys

from command import given, read_json, require, started, wait_until

TIME = ["--set", "time.step_s=0.05", "--set", "time.steps=6", "--set", "time.every=2", "--set", "time.ramp_s=0.1"]

def series(run):
    with open(run / "series.csv", newline="", encoding="utf-8") as stream:
        require(stream.readline() == "# drumlin-flow-series-1\n", "series.csv does not begin with its format")
        return list(csv.DictReader(stream))


def results(run):
    """What must not depend on how often a march was stopped."""
    return {name: (run / name).read_bytes() for name in ("series.csv", "state.h5", "profiles.csv", "maps.h5")}


def stopped(command, run, stop, code):
    """Starts a march and stops it by a signal once it has kept a state."""
    process = started(*command, "-o", run)
    wait_until((run / "checkpoint.h5").exists, f"{run.name}: a kept state", process)
    process.send_signal(stop)
    require(process.wait(timeout=600) == code, f"{run.name}: exit code {process.returncode} instead of {code}")
    require(not (run / "flow.json").exists(), f"{run.name}: finished although it was stopped")


def main():
    with given() as (drumlin, here, folder):
        data = here.parents[1] / "data"
        law = data / "rheology" / "paper.toml"
        march = ["flow", here / "tiny-drum-flow.toml", "--rheology", law, *TIME]
        whole = folder / "whole"
        drumlin(*march, "-o", whole)
        rows = series(whole)
        require([row["step"] for row in rows] == list("123456"), "not one line per step")
        require([round(float(row["rotation_rpm"]), 6) for row in rows] == [7.5, 15, 15, 15, 15, 15], "the drum does not speed up as asked")
        flow = read_json(whole / "flow.json")
        require(flow["start"] == "transient run from rest" and flow["time"]["steps"] == 6, "flow.json does not tell of the march")
        require(flow["sensitivity"] is None and flow["mesh_change_missing"], "a march says nothing of meshes and settings")
        require(not (whole / "checkpoint.h5").exists() and (whole / "series.png").exists(), "a kept state or no figure is left")
        drumlin(*march, "-o", whole, "--resume")

        command = [sys.argv[1], *map(str, march)]
        broken = folder / "broken"
        stopped(command, broken, signal.SIGINT, 130)
        drumlin("flow", here / "tiny-drum-flow.toml", "--rheology", law, *TIME, "--set", "time.ramp_s=0.2", "-o", broken,
                "--resume", code=2)  # another scene
        drumlin(*march, "-o", broken, "--resume")
        require(results(broken) == results(whole), "interrupted and resumed, the march left other bytes")

        on = folder / "on"
        drumlin(*march, "--from", whole, "-o", on, "--set", "drum.rotation_rpm=12", "--set", "time.steps=2")
        require([float(row["rotation_rpm"]) for row in series(on)] == [13.5, 12], "the speed does not go from that of the start")

        failed = folder / "failed"
        _, said = drumlin(*march, "-o", failed, "--set", "solver.max_iterations=1", code=3)
        require("step 1, 0.05 s" in said and not (failed / "flow.json").exists(), f"not said which step failed: {said}")
        drumlin(*march, "-o", folder / "none", "--set", "time.ramp_s=1", code=2)  # longer than the march
        drumlin("flow", data / "scenes" / "incline-flow.toml", "--rheology", law, *TIME, "-o", folder / "none", code=2)
        require(not (folder / "none").exists(), "what was refused left a folder")
    print("march: from rest, from a flow, interrupted, failed")


if __name__ == "__main__":
    main()
