"""`drumlin infer` once its options are read: makes the runs that are missing, infers, and writes infer.json, samples.csv and figures.

usage: command.py GIVEN
  GIVEN  JSON: the options of the command by their long names (apps/commands/infer.cpp), and the sum of what was requested
"""

import json
import pathlib
import sys

import numpy as np

from drumlin import _drumlin
from drumlin.commands import draw
from drumlin.errors import NotConvergedError
from drumlin.figures import whole_file
from drumlin.inference import answer, design, emulator, laws, posterior, question, tables


class Table:
    """Runs that others made, or another model, as rows of a table (docs/formats/infer.md); or the library of laws."""

    runs, quantities, reduced = (), (), False

    def __init__(self, asked, scene):
        self.asked, self.scene = asked, scene

    def missing(self):
        return []

    def emulator(self, of_unit):
        """(Emulator, rows that count)"""
        if self.scene.kind == "library":
            return laws.LibraryEmulator(self.scene, self.asked.ranges()), laws.points()
        points, values, errors = tables.read(self.scene, self.asked.ranges())
        return emulator.Emulator(of_unit(points), values, errors, self.scene.names()), len(points)

    def grains(self):
        """What is known of them beside the unknowns, as laws.law_of takes it; None of a table."""
        return laws.USUAL | self.scene.settings if self.scene.kind == "library" else None

    def used(self, count):
        return {self.scene.kind: self.scene.scene, "runs": count}


class Design:
    """The runs of one scene of a question."""

    def __init__(self, asked, scene, store):
        self.asked, self.scene, self.quantities = asked, scene, [one.quantity for one in scene.measured]
        self.family = design.family(scene.scene, scene.settings, asked.ranges(), store)
        self.runs = design.plan(self.family, asked.runs)

    @property
    def reduced(self):
        return self.family.reduced

    def missing(self):
        return [run for run in self.runs if run.status() in design.UNFINISHED]

    def seconds(self):
        """Processor time of a run: the mean of those that are there; NaN without any."""
        there = [run.cpu_seconds() for run in self.runs if run.status()]
        return float(np.mean(there)) if there else np.nan

    def emulator(self, of_unit):
        """(Emulator, runs that count)"""
        points, values, errors = [], [], []
        for run in self.runs:
            found = question.simulated(self.scene, run.folder) if run.status() == "finished" else None
            if found is not None:
                points.append(run.point)
                values.append(found[0])
                errors.append(found[1])
        if len(points) < emulator.LEAST_RUNS:
            raise NotConvergedError(f"{self.scene.name}: {len(points)} of {len(self.runs)} runs have finished (allowed: {emulator.LEAST_RUNS} or more)")
        return emulator.Emulator(of_unit(np.array(points)), np.array(values), np.array(errors), self.scene.names()), len(points)


    def grains(self):
        """What the scene says of them."""
        return self.family.grains()

    def used(self, count):
        """What infer.json says of them."""
        return {"folder": str(self.family.folder), "runs": count, "failed": len(self.runs) - count,
                "cpu_seconds": float(sum(run.cpu_seconds() for run in self.runs if run.status()))}


def designs_of(asked, store):
    return [Design(asked, scene, store) if scene.kind == "scene" else Table(asked, scene) for scene in asked.scenes]


def make(designs, folder, executor, say, progress=None, price_only=False):
    """Makes the runs that are missing; says before what they cost, by the first of each scene."""
    count = sum(len(each.missing()) for each in designs)
    if count:
        say(f"{count} runs to make of {sum(len(each.runs) for each in designs)}")
    first = [(each.missing()[0], each.quantities) for each in designs if each.missing() and len(each.missing()) == len(each.runs)]
    if first:
        design.make_all(first, folder, executor, progress)
    if count:
        parts = [(len(each.missing()), each.seconds(), each.scene.name) for each in designs if each.missing()]
        total = sum(number * seconds for number, seconds, _ in parts)
        text = "; ".join(f"{name}: {number} runs x {seconds:.2g} s" for number, seconds, name in parts)
        say(f"cost: {total:.0f} s of a processor, without the measurements ({text})")
    if not price_only:
        every = [(run, each.quantities) for each in designs for run in each.missing()]
        design.make_all(every, folder, executor, progress)


def inferred(asked, designs):
    """(Posterior, samples, content of infer.json)"""
    of = posterior.Posterior(asked.priors, [])
    used = []
    for each in designs:
        emulated, count = each.emulator(of.unit)
        values, errors = each.scene.values()
        of.data.append(posterior.Datum(emulated, values, errors, each.scene.realisations))
        used.append({"scene": each.scene.name} | each.used(count))
    samples, _ = of.sample()
    content = answer.answer(of, samples, asked.scenes, laws.law_of(asked, next(filter(None, (each.grains() for each in designs)), None), samples))
    head = {"format": "drumlin-infer-1", "reduced": any(each.reduced for each in designs), "title": asked.title, "equal": asked.equal}
    return samples, head | content | {"designs": used}


def samples_text(names, samples):
    lines = ["# drumlin-samples-1", *(f"# column {name} = 1: of the posterior" for name in names), ",".join(names)]
    return "\n".join([*lines, *(",".join(f"{value:.8g}" for value in row) for row in samples)]) + "\n"


def write(folder, names, samples, content):
    """infer.json, samples.csv and figures."""
    whole_file.write_text(folder / "samples.csv", samples_text(names, samples))
    whole_file.write_text(folder / "infer.json", json.dumps(content, indent=2, ensure_ascii=False) + "\n")
    draw("figures/infer_figures.py", folder)


def say(text):
    print(text, flush=True)


def main(words):
    given = json.loads(words)
    asked, output = question.read_question(given["question"]), pathlib.Path(given["output"])
    store = pathlib.Path(given["designs"] or output.parent / "designs")
    designs = designs_of(asked, store)
    if given["price-only"]:
        make(designs, store, given["executor"], say, price_only=True)
        return
    growing = _drumlin.GrowingOutput(given["output"], "infer", given["resume"], given["overwrite"], [given["question"]],
                                     FILES, given["sum"])
    growing.forget("*")
    growing.save()
    make(designs, store, given["executor"], say)
    samples, content = inferred(asked, designs)
    write(output, list(asked.priors), samples, content | {"provenance": _drumlin.provenance()})
    for name in [name for name in FILES if (output / name).exists()]:
        growing.list(name)
    growing.finish()
    for line in content["words"]:
        say(line)
    say(f"results: {output / 'infer.json'}, {output / 'corner.png'}")


FILES = ["infer.json", "samples.csv", "corner.png", "data.png", "law.png"]

if __name__ == "__main__":
    main(*sys.argv[1:])
