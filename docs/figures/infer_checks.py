"""What is known of `drumlin infer` beside the frozen truths: coverage on further truths, and how well a bias of one angle could be told at all.

usage: infer_checks.py runs|judge LIMITS WORK [-o RECORD.json] [--executor local:2] [--processes N]
  LIMITS, WORK  as of infer_truths.py, whose designs are used; runs lie in WORK/validation
"""

import concurrent.futures
import json
import types

import numpy as np
import scipy.stats

import infer_truths
from drumlin import _drumlin
from drumlin.inference import design, posterior, question

POINTS, SEEDS = 48, {"heap": 4, "drum": 2}  # further truths, and runs of each
GRID = 4096  # points of the prior
BIAS, FASTER = 2.0, "drum-30"
KNOWN_BETTER = [(1, 64), (6, 64), (6, 1024), (24, 64), (24, 256), (48, 256), (48, 1024)]  # runs that are averaged, runs of a design


def further(limits):
    ranges = np.array(list(limits["unknowns"].values()))
    return np.random.default_rng(1968).uniform(ranges[:, 0], ranges[:, 1], (POINTS, len(ranges)))


def run_of(limits, each, work, number, again):
    point, folder = further(limits)[number], work / "validation" / each.scene.name / f"{number:02}-{again}" / "run"
    return design.Planned(each.family, point, folder, each.family.changes(point, 5000 + 10 * number + again))


def weights_of(of, grid):
    """(shares of the points in the posterior, log densities); the prior is uniform."""
    density = of.log_density(grid)
    weights = np.exp(density - density.max())
    return weights / weights.sum(), density


def coverage(limits, judge, work, seeds):
    """Of further truths: shares within the joint region, and of single unknowns within their intervals."""
    share, inside, each_inside = limits["share"], [], []
    of, grid = judge.of, judge.of.of_prior(GRID)
    for number, truth in enumerate(further(limits)):
        for again in range(seeds):
            data = [question.simulated(each.scene, run_of(limits, each, work, number, again).folder) for each in judge.designs]
            of.data = [posterior.Datum(emulator, values, np.nan_to_num(errors)) for emulator, (values, errors) in zip(judge.emulators, data)]
            weights, density = weights_of(of, grid)
            inside.append(weights[density > of.log_density(truth[None])[0]].sum() < share)
            each_inside.append(np.abs(weights @ (grid < truth) - 0.5) < share / 2)
    return {"truths": POINTS, "data_sets": len(inside), "joint": float(np.mean(inside)), "each": float(np.mean(each_inside))}


def with_runs(emulator, factor):
    """An emulator that knows its means better."""
    def predict(points):
        means, own, spread = emulator.predict(points)
        return means, factor * own, spread
    return types.SimpleNamespace(names=emulator.names, correlation=emulator.correlation, factor=emulator.factor, predict=predict)


def power(limits, judge, realisations, runs):
    """How often a bias of the faster drum's angle is told by a test that knows which number to suspect, which no other exceeds: data drawn from the emulators,
    that angle against what the slower drum's data expect. A design's own deviation goes with the root of its runs."""
    of, designs, random = judge.of, judge.designs, np.random.default_rng(11)
    level, told, sd = limits["misfit_level"], [], []
    errors = [np.nanmedian([question.simulated(each.scene, run.folder)[1] for run in each.runs], axis=0) for each in designs]
    data = {each.scene.name: posterior.Datum(with_runs(emulator, np.sqrt(limits["design_runs"] / runs)), None, error / np.sqrt(realisations), realisations)
            for each, emulator, error in zip(designs, judge.emulators, errors)}
    angle = data.pop(FASTER)
    grid = of.of_prior(GRID)
    (means,), (deviations,) = (part.T for part in angle.at(of.unit(grid)))
    for truth in further(limits):
        unit = of.unit(truth[None])
        of.data = [posterior.Datum(one.emulator, one.drawn(unit, random)[0], one.errors, realisations) for one in data.values()]
        weights, _ = weights_of(of, grid)
        sd.append(np.sqrt(weights @ (deviations**2 + means**2) - (weights @ means) ** 2))
        below = weights @ scipy.stats.norm.cdf((angle.drawn(unit, random)[0, 0] + np.array([0, BIAS])[:, None] - means) / deviations).T
        told.append(2 * np.minimum(below, 1 - below) < level)
    plain, biased = np.mean(told, axis=0)
    return {"realisations": realisations, "design_runs": runs, "expected_sd_deg": float(np.median(sd)), "told": float(biased),
            "told_without_bias": float(plain)}


def main():
    given, limits, designs = infer_truths.call()
    if given.step == "runs":
        runs = [(run_of(limits, each, given.work, number, again), each.quantities) for name, those in designs.items() for each in those
                for number in range(POINTS) for again in range(SEEDS[name])]
        for run, _ in runs:
            run.folder.parent.mkdir(parents=True, exist_ok=True)
        design.make_all(runs, given.work, given.executor, True)
        return
    with concurrent.futures.ProcessPoolExecutor(given.processes) as executor:
        judges = dict(zip(designs, executor.map(infer_truths.Judge, designs.values())))
        covered = {name: executor.submit(coverage, limits, judge, given.work, SEEDS[name]) for name, judge in judges.items()}
        told = [executor.submit(power, limits, judges["drum"], *better) for better in KNOWN_BETTER]
    record = {"format": "drumlin-infer-checks-1", "limits": "data/limits/infer.toml", "bias_deg": BIAS, "provenance": _drumlin.provenance(),
              "coverage": {name: one.result() for name, one in covered.items()}, "power": [one.result() for one in told]}
    given.output.write_text(json.dumps(record, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
