"""What the share of an overlap that a step takes off (`solver.projection_share`) does to a flow: one turn of the 6 rpm drum for each.

usage: python3 tests/benchmarks/projection_share.py BUILD RUN RECORD.json
RUN: a whole run of data/scenes/drum-6rpm.toml, from the end of which each turn starts. The first second does not count; means over the nine others stand with
the half-width of their 95 % interval, from the scatter of one-second means. One thread each, one after the other.
"""

import json
import os
import pathlib
import statistics
import sys
import tempfile

from drums import drum, rotation, solved_to, stage, started_from
from records import called, content_of, machine, steps_of, write

# Tolerance and share: the scene's; rougher, with the usual share and with larger ones.
CASES = ((3e-3, 0.2), (5.5e-3, 0.2), (5.5e-3, 0.6), (5.5e-3, 1))
SECONDS, LEFT_OUT = 10, 1
STEPS_OF_A_SECOND = 1000
STUDENT = 2.31  # 95 %, nine means


def scene(run, tolerance, share):
    start, solver = drum(7183)
    solver = solved_to(f"{tolerance:g}", solver).rstrip() + f"\nprojection_share = {share:g}\n"
    return started_from(run, start) + stage("turn", f"duration_s = {SECONDS}", rotation(6)) + solver + "\n[output]\nvelocity_window_s = 0\n"


def mean_and_interval(values):
    means = [statistics.mean(values[at : at + STEPS_OF_A_SECOND]) for at in range(0, len(values), STEPS_OF_A_SECOND)]
    return {"mean": statistics.mean(means), "half_width_95": STUDENT * statistics.stdev(means) / len(means) ** 0.5}


def main():
    build, run, record = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve(), pathlib.Path(sys.argv[3])
    load, cases, report = os.getloadavg()[0], [], {}
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for tolerance, share in CASES:
            file, where = folder / "scene.toml", folder / f"{tolerance:g}-{share:g}"
            file.write_text(scene(run, tolerance, share), encoding="utf-8")
            called(build / "drumlin", "run", file, "-o", where, "--threads", 1)
            report = content_of(where / "run.json")
            rows = steps_of(where)[LEFT_OUT * STEPS_OF_A_SECOND :]
            case = {"tolerance": tolerance, "projection_share": share, "cpu_seconds": report["cpu_seconds"], "sweeps_mean": report["cost"]["sweeps_mean"],
                    "overlap_max": max(float(row["overlap_max"]) for row in rows)}
            case |= {key: mean_and_interval([float(row[key]) for row in rows]) for key in ("overlap_mean", "kinetic_energy", "contacts")}
            print(json.dumps(case), flush=True)
            cases.append(case)
    content = {"format": "drumlin-projection-share-1", "command": "python3 tests/benchmarks/projection_share.py BUILD RUN RECORD.json", "revision": report["revision"], **machine(),
               "load_before": load, "load_after": os.getloadavg()[0], "cases": cases}
    write(record, content)


if __name__ == "__main__":
    main()
