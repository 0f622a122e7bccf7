"""What discs cost on ranks: 100 steps of a flow on one process with one thread and two, and on 1 and 2 ranks of one thread, in turn.

usage: python3 tests/benchmarks/ranks.py BUILD RECORD.json FOLDER DISCS...
FOLDER: the flows that `sweeps_over_size.py --keep FOLDER` has left for each of these sizes. All calls must write the same snapshot.
Wall time means something on an idle machine only: the load before and after stands in the record.
"""

import os
import pathlib
import re
import sys
import tempfile

from records import called, content_of, machine, write

STEPS, CALLS = 100, 3


def timed(words, folder):
    called(*words, "-o", folder)
    run = content_of(folder / "run.json")
    ranks = run.get("ranks", [{"waiting_seconds": 0, "peak_memory_mb": run["peak_memory_mb"]}])
    return {"wall_seconds_per_step": run["wall_seconds"] / STEPS,
            **{f"{phase}_seconds_per_step": run["cost"][f"{phase}_seconds"] / STEPS for phase in ("detection", "setup", "solver", "projection")},
            "waiting_seconds_per_step": [rank["waiting_seconds"] / STEPS for rank in ranks],
            "peak_memory_mb": [rank["peak_memory_mb"] for rank in ranks]}, run


def main():
    build, record, flows, sizes = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3]).resolve(), sys.argv[4:]
    one, ranks = [build / "drumlin", "run", "--threads"], [build / "drumlin-run", "--threads", "1"]
    ways = {"one process": [*one, "1"], "two threads": [*one, "2"], "1 rank": ["mpirun", "-n", "1", *ranks], "2 ranks": ["mpirun", "-n", "2", *ranks]}
    cases, load = [], os.getloadavg()[0]
    for discs in sizes:
        text = re.sub(r"duration_s = [\d.]+", f"duration_s = {STEPS * 1e-3:g}", (flows / discs / "flowing.toml").read_text(encoding="utf-8"))
        scene = flows / discs / "on-ranks.toml"
        scene.write_text(text, encoding="utf-8")
        calls = {name: [] for name in ways}
        with tempfile.TemporaryDirectory() as name:
            snapshots = set()
            for call in range(CALLS):
                for way, words in ways.items():
                    folder = pathlib.Path(name) / f"{way} {call}"
                    found, run = timed([*words, scene], folder)
                    calls[way].append(found)
                    snapshots.add(next((folder / "snapshots").iterdir()).read_bytes())
                    print(f"{discs} discs, {way}: {1e3 * found['wall_seconds_per_step']:.2f} ms per step", flush=True)
        assert len(snapshots) == 1, "not the same snapshots"
        best = {way: min(call["wall_seconds_per_step"] for call in made) for way, made in calls.items()}
        cases.append({"discs": int(discs), "steps": STEPS, "tolerance": 1e-2, "revision": run["revision"], "sweeps_per_step": run["cost"]["sweeps_mean"],
                      "contacts_mean": run["cost"]["contacts_mean"], "one_rank_over_one_process": best["1 rank"] / best["one process"],
                      "two_ranks_over_one": best["1 rank"] / best["2 ranks"], "two_threads_over_one": best["one process"] / best["two threads"], "calls": calls})
    content = {"format": "drumlin-ranks-cost-2", "command": "python3 tests/benchmarks/ranks.py BUILD RECORD.json FOLDER DISCS...", **machine(),
               "load_before": load, "load_after": os.getloadavg()[0], "cases": cases}
    write(record, content)


if __name__ == "__main__":
    main()
