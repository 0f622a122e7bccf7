"""What a change of the engine does: two builds of `drumlin` on the same scenes, in turn, on one thread and on two.

usage: python3 tests/benchmarks/two_builds.py OLD_BUILD NEW_BUILD RECORD.json --flow FOLDER [DISCS...]   (30000, 100000, 1000000 unless told)
FOLDER: where `sweeps_over_size.py --keep FOLDER DISCS...` has left its runs. 100 steps of each flow, twice (300 of the smaller ones, five times), and 10 steps
of a million deposited discs, once, to a residual of 1e-2. Seconds are processor seconds, of the solver its share of wall time. An idle machine: the load stands in the record.
"""

import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from machine import machine  # noqa: E402
from ranks import scene  # noqa: E402

SIZES = (30000, 100000, 1000000)
DEPOSITED, DEPOSITED_STEPS = 1000000, 10


def steps_and_calls(discs):
    if discs >= DEPOSITED:
        return DEPOSITED_STEPS, 1
    return (100, 2) if discs >= 30000 else (300, 5)


def called(build, scene_file, threads, folder):
    subprocess.run([build / "drumlin", "run", scene_file, "--threads", str(threads), "-o", folder], check=True, capture_output=True)
    run = json.loads((folder / "run.json").read_text(encoding="utf-8"))
    cost, sweeps = run["cost"], run["cost"]["sweeps_mean"] * run["steps"]
    found = {"sweeps_per_step": cost["sweeps_mean"], "cpu_seconds": run["cpu_seconds"], "wall_seconds": run["wall_seconds"], "solver_seconds": cost["solver_seconds"], "detection_seconds": cost["detection_seconds"],
             "solver_ns_per_contact_and_sweep": 1e9 * cost["solver_seconds"] / (sweeps * cost["contacts_mean"])}
    return found, run["revision"]


def main():
    given = sys.argv[1:]
    flows = pathlib.Path(given.pop(given.index("--flow") + 1)).resolve()
    given.remove("--flow")
    sizes = [int(word) for word in given[3:]] or SIZES
    builds, record = {"old": pathlib.Path(given[0]).resolve(), "new": pathlib.Path(given[1]).resolve()}, pathlib.Path(given[2])
    load, cases, revisions = os.getloadavg()[0], [], {}
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for discs in sizes:
            flowing = discs < DEPOSITED
            steps, calls = steps_and_calls(discs)
            scene_file = flows / str(discs) / "in-turn.toml" if flowing else folder / "scene.toml"
            text = (flows / str(discs) / "flowing.toml").read_text(encoding="utf-8") if flowing else scene(discs, steps, True)
            scene_file.write_text(re.sub(r"duration_s = [\d.]+", f"duration_s = {steps * 1e-3:g}", text), encoding="utf-8")
            case = {"discs": discs, "flowing": flowing, "steps": steps, "calls": []}
            for call in range(calls):
                for threads in (1, 2):
                    for which, build in builds.items():
                        found, revisions[which] = called(build, scene_file, threads, folder / f"{discs}-{call}-{threads}-{which}")
                        case["calls"].append({"build": which, "threads": threads, **found})
                        print(discs, which, f"{threads} threads:", {key: round(value, 2) for key, value in found.items()}, flush=True)

            def ratio(what, threads, case=case):
                best = [min(c[what] for c in case["calls"] if c["build"] == which and c["threads"] == threads) for which in ("old", "new")]
                return best[0] / best[1]

            for what in ("solver_seconds", "detection_seconds", "wall_seconds"):
                case[f"old_over_new_in_{what.removesuffix('_seconds')}"] = {str(threads): ratio(what, threads) for threads in (1, 2)}
            print({key: value for key, value in case.items() if key.startswith("old_over_new")})
            cases.append(case)
    content = {"format": "drumlin-two-builds-1", "command": "python3 tests/benchmarks/two_builds.py OLD_BUILD NEW_BUILD RECORD.json --flow FOLDER [DISCS...]", "revisions": revisions,
               **machine(), "load_before": load, "load_after": os.getloadavg()[0], "cases": cases}
    record.write_text(json.dumps(content, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
