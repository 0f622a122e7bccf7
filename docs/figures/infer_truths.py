"""Coverage of `drumlin infer` on synthetic truths: makes the designs and the truths of data/limits/infer.toml, infers each truth, and judges.

usage: infer_truths.py runs|judge LIMITS WORK [-o RECORD.json] [--processes N]
  LIMITS  data/limits/infer.toml; its scenes lie in data/infer
  WORK    folder for designs, truths and answers; the same call again goes on
"""

import argparse
import concurrent.futures
import itertools
import pathlib
import tomllib

import numpy as np

from drumlin.infer import design

BIASED_SEED = 1000  # seeds of the truths that are measured several times begin here, those of the 40 at 500, designs at 1


def quantities_of(scene):
    return [(one["quantity"], tuple(one["z"]) if "z" in one else None) for one in scene["measured"]]


def truths(limits):
    """(truths, unknowns)"""
    ranges = np.array(list(limits["unknowns"].values()))
    return np.random.default_rng(limits["seed"]).uniform(ranges[:, 0], ranges[:, 1], (limits["truths"], len(ranges)))


def families(limits, scenes, work):
    """{scene's name: (family, quantities)}"""
    return {scene["name"]: (design.family(scenes / scene["scene"], scene.get("settings", {}), limits["unknowns"], work / "designs"), quantities_of(scene))
            for question in limits["questions"] for scene in question["scenes"]}


def planned_truths(limits, of, name, work):
    """{(number, realisation): run} of a scene; realisation 0 is that of the 40."""
    found = {}
    for number, point in enumerate(truths(limits)):
        folder = work / "truths" / f"{number:02}" / name
        found[number, 0] = design.Planned(of, point, folder, of.changes(point, 500 + number))
        for again in range(limits["biased"]["realisations"] if number < limits["biased"]["truths"] and name.startswith("drum") else 0):
            folder = work / "truths" / f"{number:02}" / f"{name}-{again + 1}"
            found[number, again + 1] = design.Planned(of, point, folder, of.changes(point, BIASED_SEED + 100 * number + again))
    return found


def make_runs(limits, scenes, work, processes):
    runs = []
    for name, (of, _) in families(limits, scenes, work).items():
        runs += design.plan(of, limits["design_runs"]) + list(planned_truths(limits, of, name, work).values())
    runs.sort(key=lambda run: run.folder.name[-2] == "-" and run.folder.name.startswith("drum"))  # those of the biased truths last
    for run in runs:
        run.folder.parent.mkdir(parents=True, exist_ok=True)
    done = itertools.count(1)
    with concurrent.futures.ThreadPoolExecutor(processes) as executor:
        design.make_all(runs, executor, lambda _: print(f"{next(done)} of {len(runs)}", flush=True))


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("step", choices=["runs", "judge"])
    parser.add_argument("limits", type=pathlib.Path)
    parser.add_argument("work", type=pathlib.Path)
    parser.add_argument("-o", "--output", type=pathlib.Path)
    parser.add_argument("--processes", type=int, default=2)
    given = parser.parse_args()
    limits = tomllib.loads(given.limits.read_text(encoding="utf-8"))
    scenes = given.limits.parent.parent / "infer"
    if given.step == "runs":
        make_runs(limits, scenes, given.work, given.processes)


if __name__ == "__main__":
    main()
