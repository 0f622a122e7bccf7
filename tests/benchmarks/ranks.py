"""What discs cost on ranks: a settling drum on 1 and 2 ranks of one thread each, and in one process, twice each, in turns.

usage: python3 tests/benchmarks/ranks.py BUILD RECORD.json [--lying] [DISCS...]   (7183 and 30000 unless told; the 6 rpm drum at the same fill)
--lying: discs are deposited from the beginning, 20 steps, one call each: large drums, and machines that others use. What counts then is the work of the
rank that has most: processor seconds less those in which it waited.

Wall time means something on an idle machine only: the load before and after stands in the record. Snapshots of 1 and 2 ranks are compared.
"""

import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from drums import drum, solved_to, stage  # noqa: E402

STEPS = {7183: 1000, 30000: 200}
CALLS = 2


def scene(discs, steps, lying=False):
    """The 6 rpm drum with other grains, as far as it settles."""
    start, solver = drum(discs)
    if lying:
        start = re.sub(r'(region = .*"circle".*)', r'\1\nplacement = "deposited"', start)
    return start + stage("settle", f"duration_s = {steps * 1e-3:g}") + solved_to("1e-2", solver) + "\n[output]\nvelocity_window_s = 0\ncheckpoint_every_s = 100\n"


def timed(words, folder):
    environment = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMP_NUM_THREADS": "1"}
    subprocess.run([*map(str, words), "-o", str(folder)], check=True, env=environment, capture_output=True)
    run = json.loads((folder / "run.json").read_text(encoding="utf-8"))
    found = {"wall_seconds_per_step": run["wall_seconds"] / run["steps"], "sweeps_per_step": run["cost"]["sweeps_mean"], "contacts_mean": run["cost"]["contacts_mean"]}
    if "ranks" in run:
        found["ranks"] = [{name: rank[name] for name in ("step_seconds", "waiting_seconds", "contacts_mean", "halo_bytes_per_sweep", "peak_memory_mb")} for rank in run["ranks"]]
    else:
        found["peak_memory_mb"] = run["peak_memory_mb"]
    return found, run


def main():
    lying, given = "--lying" in sys.argv, [word for word in sys.argv[1:] if word != "--lying"]
    build, record, sizes = pathlib.Path(given[0]).resolve(), pathlib.Path(given[1]), [int(word) for word in given[2:]] or list(STEPS)
    ways = {"one process": [build / "drumlin", "run"], "1 rank": ["mpirun", "-n", "1", build / "drumlin-run"], "2 ranks": ["mpirun", "-n", "2", build / "drumlin-run"]}
    cases = []
    load = os.getloadavg()[0]
    for discs in sizes:
        steps = 20 if lying else STEPS.get(discs, 300)
        case = {"discs": discs, "steps": steps, "lying": lying, "tolerance": 1e-2, "calls": {name: [] for name in ways}}
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            (folder / "scene.toml").write_text(scene(discs, steps, lying), encoding="utf-8")
            for call in range(1 if lying else CALLS):
                for number, (way, words) in enumerate(ways.items()):
                    found, run = timed([*words, folder / "scene.toml", "--threads", "1"], folder / f"{call}-{number}")
                    case["calls"][way].append(found)
                    print(f"{discs} discs, {way}: {1e3 * found['wall_seconds_per_step']:.2f} ms per step", flush=True)
            same = [next((folder / f"0-{number}" / "snapshots").iterdir()).read_bytes() for number in (1, 2)]
            assert same[0] == same[1], "1 and 2 ranks differ"
            case["revision"] = run["revision"]

        def best(way):
            return min(call["wall_seconds_per_step"] for call in case["calls"][way])

        def work(way):
            return min(max(rank["step_seconds"] - rank["waiting_seconds"] for rank in call["ranks"]) for call in case["calls"][way])

        case["work_of_two_ranks_over_one"] = work("1 rank") / work("2 ranks")
        case["two_ranks_over_one"] = best("1 rank") / best("2 ranks")
        case["one_rank_over_one_process"] = best("1 rank") / best("one process")
        cases.append(case)
    content = {"format": "drumlin-ranks-cost-1", "command": "python3 tests/benchmarks/ranks.py BUILD RECORD.json", "processors": os.cpu_count(),
               "load_before": load, "load_after": os.getloadavg()[0], "cases": cases}
    record.write_text(json.dumps(content, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
