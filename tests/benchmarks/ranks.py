"""What discs cost on ranks: a settling drum on 1 and 2 ranks of one thread each, and in one process, twice each, in turns.

usage: python3 tests/benchmarks/ranks.py BUILD RECORD.json [--lying] [--flow FOLDER] [DISCS...]   (7183 and 30000 unless told; the 6 rpm drum at the same fill)
--flow: 100 steps of the flow that `sweeps_over_size.py --keep FOLDER` has left for each of these sizes, three calls each. Cases of other sizes or of other
kinds that the record holds already stay.
--lying: discs are deposited from the beginning, 20 steps, one call each: large drums, and machines that others use. What counts then is the work of the
rank that has most: processor seconds less those in which it waited.

`step_seconds` leaves out what a run does before its first step and between steps, the making of files.
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
from machine import machine  # noqa: E402

STEPS = {7183: 1000, 30000: 200}
CALLS = 2


def scene(discs, steps, lying=False):
    """The 6 rpm drum with other grains, as far as it settles."""
    start, solver = drum(discs)
    if lying:
        start = re.sub(r'(region = .*"circle".*)', r'\1\nplacement = "deposited"', start)
    return start + stage("settle", f"duration_s = {steps * 1e-3:g}") + solved_to("1e-2", solver) + "\n[output]\nvelocity_window_s = 0\ncheckpoint_every_s = 100\n"


FLOW_STEPS = 100


def kind(case):
    return case["discs"], case.get("lying", False), case.get("flowing", False)


def timed(words, folder):
    environment = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMP_NUM_THREADS": "1"}
    subprocess.run([*map(str, words), "-o", str(folder)], check=True, env=environment, capture_output=True)
    run = json.loads((folder / "run.json").read_text(encoding="utf-8"))
    phases = sum(run["cost"][f"{phase}_seconds"] for phase in ("detection", "setup", "solver", "projection"))
    found = {"wall_seconds_per_step": run["wall_seconds"] / run["steps"], "step_seconds": phases / run["steps"], "sweeps_per_step": run["cost"]["sweeps_mean"], "contacts_mean": run["cost"]["contacts_mean"]}
    if "ranks" in run:
        found["ranks"] = [{name: rank[name] for name in ("step_seconds", "waiting_seconds", "contacts_mean", "halo_bytes_per_sweep", "peak_memory_mb")} for rank in run["ranks"]]
    else:
        found["peak_memory_mb"] = run["peak_memory_mb"]
    return found, run


def main():
    given = sys.argv[1:]
    lying = "--lying" in given
    if lying:
        given.remove("--lying")
    flows = None
    if "--flow" in given:
        flows = pathlib.Path(given.pop(given.index("--flow") + 1)).resolve()
        given.remove("--flow")
    build, record, sizes = pathlib.Path(given[0]).resolve(), pathlib.Path(given[1]), [int(word) for word in given[2:]] or list(STEPS)
    ways = {"one process": [build / "drumlin", "run"], "1 rank": ["mpirun", "-n", "1", build / "drumlin-run"], "2 ranks": ["mpirun", "-n", "2", build / "drumlin-run"]}
    cases = json.loads(record.read_text(encoding="utf-8"))["cases"] if record.exists() else []
    load = os.getloadavg()[0]
    for discs in sizes:
        steps = FLOW_STEPS if flows else 20 if lying else STEPS.get(discs, 300)
        case = {"discs": discs, "steps": steps, "lying": lying, "flowing": flows is not None, "tolerance": 1e-2, "calls": {name: [] for name in ways}}
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            text, scene_file = "", folder / "scene.toml"
            if flows:
                text, scene_file = (flows / str(discs) / "flowing.toml").read_text(encoding="utf-8"), flows / str(discs) / "on-ranks.toml"
                text = re.sub(r"duration_s = [\d.]+", f"duration_s = {steps * 1e-3:g}", text)
            scene_file.write_text(text or scene(discs, steps, lying), encoding="utf-8")
            for call in range(1 if lying else 3 if flows else CALLS):
                for number, (way, words) in enumerate(ways.items()):
                    found, run = timed([*words, scene_file, "--threads", "1"], folder / f"{call}-{number}")
                    case["calls"][way].append(found)
                    print(f"{discs} discs, {way}: {1e3 * found['wall_seconds_per_step']:.2f} ms per step", flush=True)
            same = [next((folder / f"0-{number}" / "snapshots").iterdir()).read_bytes() for number in (1, 2)]
            assert same[0] == same[1], "1 and 2 ranks differ"
            case["revision"] = run["revision"]

        def best(way, what="wall_seconds_per_step", case=case):
            return min(call[what] for call in case["calls"][way])

        def work(way, case=case):
            return min(max(rank["step_seconds"] - rank["waiting_seconds"] for rank in call["ranks"]) for call in case["calls"][way])

        case["work_of_two_ranks_over_one"] = work("1 rank") / work("2 ranks")
        case["two_ranks_over_one"] = best("1 rank") / best("2 ranks")
        case["two_ranks_over_one_in_steps"] = best("1 rank", "step_seconds") / best("2 ranks", "step_seconds")
        case["one_rank_over_one_process"] = best("1 rank") / best("one process")
        cases = [*(other for other in cases if kind(other) != kind(case)), case]
    content = {"format": "drumlin-ranks-cost-1", "command": "python3 tests/benchmarks/ranks.py BUILD RECORD.json", **machine(),
               "load_before": load, "load_after": os.getloadavg()[0], "cases": cases}
    record.write_text(json.dumps(content, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
