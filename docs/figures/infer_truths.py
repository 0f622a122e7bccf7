"""Coverage of `drumlin infer` on synthetic truths: makes the designs and the truths of data/limits/infer.toml, infers each truth, and judges.

usage: infer_truths.py runs|judge LIMITS WORK [-o RECORD.json] [--executor local:2] [--processes N]
  LIMITS  data/limits/infer.toml; its scenes lie in data/infer
  WORK    folder of designs and truths; the same call again goes on
"""

import argparse
import concurrent.futures
import functools
import json
import pathlib
import time
import tomllib

import numpy as np

from drumlin import _drumlin
from drumlin.inference import answer, command, design, posterior, question

SEED, REPEATED_SEED = 500, 1000  # designs have seeds from 1 on
FASTER = "drum-30: theta_deg"


def truths(limits):
    """(truths, unknowns)"""
    ranges = np.array(list(limits["unknowns"].values()))
    return np.random.default_rng(limits["seed"]).uniform(ranges[:, 0], ranges[:, 1], (limits["truths"], len(ranges)))


def questions(limits, folder):
    """{name: Question}, whose measured numbers are still to be filled in."""
    def one(scene):
        measured = [question.Measured(each["quantity"], tuple(each["z"]) if "z" in each else None, np.zeros(0), np.zeros(0)) for each in scene["measured"]]
        return question.Scene(scene["name"], str(folder / scene["scene"]), scene.get("settings", {}), 1, measured)
    priors = {name: question.Prior(*ends) for name, ends in limits["unknowns"].items()}
    return {asked["name"]: question.Question(asked["name"], limits["design_runs"], priors, {}, [one(scene) for scene in asked["scenes"]])
            for asked in limits["questions"]}


def run_of_truth(limits, each, work, number, again=0):
    """The run of a truth in one scene; `again`: from 1 on with other seeds."""
    name, seed = each.scene.name, SEED + number if not again else REPEATED_SEED + 100 * number + again - 1
    folder, point = work / "truths" / f"{number:02}" / (name if not again else f"{name}-{again}"), truths(limits)[number]
    return design.Planned(each.family, point, folder, each.family.changes(point, seed))


def make_runs(limits, designs, work, executor):
    runs = [(run, each.quantities) for each in designs for run in each.runs]
    runs += [(run_of_truth(limits, each, work, number), each.quantities) for each in designs for number in range(limits["truths"])]
    biased = limits["biased"]
    runs += [(run_of_truth(limits, each, work, number, again + 1), each.quantities) for each in designs if each.scene.name.startswith("drum")
             for number in range(biased["truths"]) for again in range(biased["realisations"])]
    for run, _ in runs:
        run.folder.parent.mkdir(parents=True, exist_ok=True)
    design.make_all(runs, work, executor, True)


class Judge:
    """A question with its emulators, asked for one truth after the other."""

    def __init__(self, designs):
        self.designs = designs
        self.of = posterior.Posterior(designs[0].asked.priors, [])
        self.emulators = [each.emulator(self.of.unit)[0] for each in designs]

    def ask(self, data, realisations=1, bias=None):
        """Posterior and samples for [(values, standard errors)] of the scenes; bias: degrees by names of numbers."""
        self.of.data = [posterior.Datum(emulator, values + [(bias or {}).get(name, 0) for name in emulator.names], np.nan_to_num(errors), realisations)
                        for emulator, (values, errors) in zip(self.emulators, data)]
        return self.of.sample()

    def share_of_misfit(self, samples):
        return self.of.misfit(samples)["share"]


def mean_of(each, runs):
    """(values, standard errors) of the mean of several runs."""
    found = [question.simulated(each.scene, run.folder) for run in runs]
    return np.mean([values for values, _ in found], axis=0), np.sqrt(np.sum([np.nan_to_num(errors) ** 2 for _, errors in found], axis=0)) / len(found)


def row_of(judge, limits, work, number):
    """What becomes of one truth, and of its biased data."""
    truth, names = truths(limits)[number], list(limits["unknowns"])
    data = [question.simulated(each.scene, run_of_truth(limits, each, work, number).folder) for each in judge.designs]
    start = time.process_time()
    samples, densities = judge.ask(data)
    told = judge.share_of_misfit(samples)
    row = {"truth": dict(zip(names, truth)), "region": posterior.share_above(densities, judge.of.log_density(truth[None])[0]),
           "quantiles": dict(zip(names, (samples < truth).mean(axis=0))), "misfit": told, "seconds": time.process_time() - start,
           "widths": {name: one["width_over_prior"] for name, one in answer.unknowns(judge.of, samples).items()}}
    angles = [name for emulator in judge.emulators for name in emulator.names if name.endswith("theta_deg")]
    for label, biased in (("one", [FASTER]), ("both", angles)) if angles else ():
        row[f"misfit_biased_{label}"] = judge.share_of_misfit(judge.ask(data, bias=dict.fromkeys(biased, 2.0))[0])
    print(number, f"{row['region']:.2f}", {name: f"{share:.2f}" for name, share in row["quantiles"].items()}, f"{row['misfit']:.3f}", flush=True)
    return row


def judged(limits, designs, work, processes):
    """The rows of all truths of a question, and their judge."""
    judge = Judge(designs)
    with concurrent.futures.ProcessPoolExecutor(processes) as executor:
        return judge, list(executor.map(functools.partial(row_of, judge, limits, work), range(limits["truths"])))


def repeated(limits, judge, work):
    """[(share of misfit as they are, of biased data)] of truths that were measured several times."""
    of, found = limits["biased"], []
    for number in range(of["truths"]):
        data = [mean_of(each, [run_of_truth(limits, each, work, number, again + 1) for again in range(of["realisations"])]) for each in judge.designs]
        found.append([judge.share_of_misfit(judge.ask(data, of["realisations"], bias)[0]) for bias in (None, {FASTER: 2.0})])
    return found


def verdict(limits, rows, pairs):
    """Values beside the frozen limits."""
    level, share = limits["misfit_level"], limits["share"]
    joint = np.mean([row["region"] < share for row in rows])
    each = np.mean([abs(quantile - 0.5) < share / 2 for row in rows for quantile in row["quantiles"].values()])
    alarms = np.mean([row["misfit"] < level for row in rows])
    found = {"joint": (joint, limits["joint_must"][0] <= joint <= limits["joint_must"][1]),
             "each": (each, limits["each_must"][0] <= each <= limits["each_must"][1]),
             "false_alarm": (alarms, alarms <= limits["false_alarm_must"])}
    if pairs:
        plain, biased = (sum(pair[k] < level for pair in pairs) for k in (0, 1))
        found |= {"unbiased_told": (plain, plain <= limits["biased"]["unbiased_told_must"]), "biased_told": (biased, biased >= limits["biased"]["told_must"])}
        found |= {f"told_of_single_runs_{label}": (np.mean([row[f"misfit_biased_{label}"] < level for row in rows]), None) for label in ("one", "both")}
    found |= {f"width_of_{name}": (np.mean([row["widths"][name] for row in rows]), None) for name in limits["unknowns"]}
    return {name: {"value": float(value), "met": None if met is None else bool(met)} for name, (value, met) in found.items()}


def design_of(each):
    used = each.used(sum(run.status() == "finished" for run in each.runs))
    return {"scene": each.scene.name} | {name: value for name, value in used.items() if name != "folder"}


def call():
    """(words of the call, limits, {question: its designs})"""
    parser = argparse.ArgumentParser()
    parser.add_argument("step", choices=["runs", "judge"])
    parser.add_argument("limits", type=pathlib.Path)
    parser.add_argument("work", type=pathlib.Path)
    parser.add_argument("-o", "--output", type=pathlib.Path)
    parser.add_argument("--executor", default="local:2")
    parser.add_argument("--processes", type=int, default=1)
    given = parser.parse_args()
    limits = tomllib.loads(given.limits.read_text(encoding="utf-8"))
    asked = questions(limits, given.limits.parent.parent / "infer")
    designs = {name: command.designs_of(one, given.work / "designs") for name, one in asked.items()}
    return given, limits, designs


def main():
    given, limits, designs = call()
    if given.step == "runs":
        make_runs(limits, [each for those in designs.values() for each in those], given.work, given.executor)
        return
    record = {"format": "drumlin-infer-truths-1", "limits": "data/limits/infer.toml", "questions": {}, "provenance": _drumlin.provenance()}
    for name, those in designs.items():
        judge, rows = judged(limits, those, given.work, given.processes)
        pairs = repeated(limits, judge, given.work) if name == "drum" else []
        record["questions"][name] = {"verdict": verdict(limits, rows, pairs), "repeated": pairs, "truths": rows,
                                     "designs": [design_of(each) for each in those]}
        print(json.dumps(record["questions"][name]["verdict"], indent=1), flush=True)
    given.output.write_text(json.dumps(record, indent=1, default=float) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
