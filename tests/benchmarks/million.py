"""A million discs: deposited, settled, turned and measured, beside smaller drums of the same fill.

usage: python3 tests/benchmarks/million.py BUILD RECORD.json [--threads N] [--ranks N] [--keep FOLDER] [DISCS...]   (7183, 100000, 1000000 unless told)

Each drum starts from deposited discs (grains.generated.placement), lies for 100 steps of 1e-3 s, is brought to the Froude number of the 6 rpm drum within
200 steps (a quarter of a swing, so that its speed does not jump), and turns with it for 100 steps, to a residual of 1e-2 with the bounds on penetration and
sinking that scenes have. The speed of its rim grows as the fourth root of the number of discs. What it took to place the discs, to take the steps of each
stage and to measure ten snapshots is told: counts depend on no machine, seconds and memory are of this one.
--ranks: the run, and nothing else, goes on so many ranks of one thread each; its memory is the sum of their peaks.
"""

import argparse
import math
import os
import pathlib
import re
import statistics
import subprocess
import tempfile
import time

from drums import drum, rotation, solved_to, speed_rpm, stage
from records import content_of, machine, steps_of, write

SIZES = (7183, 100000, 1000000)
SETTLE, START, TURN = 0.1, 0.2, 0.1  # seconds, in steps of 1e-3


def scene(discs):
    start, solver = drum(discs)
    start = re.sub(r'(region = .*"circle".*)', r'\1\nplacement = "deposited"', start)
    rpm, frequency = speed_rpm(discs), 1 / (4 * START)
    amplitude = 6 * rpm / (2 * math.pi * frequency)  # degrees
    swing = f'{{ wall = "drum", kind = "rocking", amplitude_deg = {amplitude:.6f}, frequency_hz = {frequency}, phase_deg = -90 }}'
    stages = (stage("settle", f"duration_s = {SETTLE}", snapshots=0) + stage("start", f"duration_s = {START}", swing, snapshots=0)
              + stage("turn", f"duration_s = {TURN}", rotation(f"{rpm:.6f}"), snapshots=10))
    return start + stages + solved_to("1e-2", solver) + "\n[output]\nvelocity_window_s = 6e-3\ncheckpoint_every_s = 0.1\n"


def taken(command):
    """Wall and processor seconds of a command and its peak memory."""
    begin = time.monotonic()
    child = subprocess.Popen(command, stdout=subprocess.DEVNULL)
    _, status, used = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    if child.returncode:
        raise SystemExit(f"{command} ended with {child.returncode}")
    return {"wall_seconds": time.monotonic() - begin, "cpu_seconds": used.ru_utime + used.ru_stime, "peak_memory_mb": used.ru_maxrss / 1024}


def told(rows):
    """Of the steps of one stage."""
    sweeps = sorted(int(row["sweeps"]) for row in rows)
    return {
        "steps": len(sweeps),
        "sweeps_mean": statistics.mean(sweeps),
        "sweeps_median": statistics.median(sweeps),
        "sweeps_largest": sweeps[-1],
        "steps_missed": sum(row["converged"] == "0" for row in rows),
        "contacts_at_end": int(rows[-1]["contacts"]),
        "overlap_mean_at_end": float(rows[-1]["overlap_mean"]),
        "sinking_largest": max(float(row["sinking"]) for row in rows),
    }


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("record", type=pathlib.Path)
    parser.add_argument("discs", type=int, nargs="*", default=list(SIZES))
    parser.add_argument("--threads", type=int, default=os.cpu_count())
    parser.add_argument("--ranks", type=int, default=0)
    parser.add_argument("--keep", type=pathlib.Path, help="folder in which the runs stay")
    given = parser.parse_intermixed_args()
    program, cases, run = given.build.resolve() / "drumlin", [], {}
    with tempfile.TemporaryDirectory() as name:
        folder = given.keep or pathlib.Path(name)
        folder.mkdir(parents=True, exist_ok=True)
        for discs in given.discs:
            file, where = folder / f"drum-{discs}.toml", folder / f"drum-{discs}"
            file.write_text(scene(discs), encoding="utf-8")
            case = {"discs": discs, "placing": taken([program, "scene", "check", file])}
            shared = ["--ranks", str(given.ranks), "--threads", str(given.ranks)] if given.ranks else ["--threads", str(given.threads)]
            case["run"] = taken([program, "run", file, "-o", where, *shared])
            run = content_of(where / "run.json")
            if given.ranks:
                case["ranks"] = run["ranks"]
                case["run"]["peak_memory_mb"] = sum(rank["peak_memory_mb"] for rank in run["ranks"])
            rows = steps_of(where)
            case["stages"] = {stage: told([row for row in rows if row["stage"] == stage]) for stage in ("settle", "start", "turn")}
            case["cost"] = run["cost"]
            sweeps = sum(int(row["sweeps"]) for row in rows)
            case["ns_per_disc_and_sweep"] = 1e9 * run["cost"]["solver_seconds"] / (discs * sweeps)
            case["memory_per_disc_kb"] = case["run"]["peak_memory_mb"] * 1024 / discs
            case["measure"] = taken([program, "measure", where])
            print(f"{discs} discs: {sweeps} sweeps in {len(rows)} steps, {case['run']['wall_seconds']:.0f} s", flush=True)
            cases.append(case)
    whole = {"format": "drumlin-million-1", "revision": run["revision"], "command": "python3 tests/benchmarks/million.py BUILD RECORD.json" + (f" --ranks {given.ranks}" if given.ranks else ""),
             **machine(), **({"ranks": given.ranks} if given.ranks else {"threads": given.threads}), "tolerance": 1e-2, "time_step_s": 1e-3, "cases": cases}
    write(given.record, whole)


if __name__ == "__main__":
    main()
