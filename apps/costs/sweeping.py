"""What all sweeps of `drumlin cost` share: the axes that are asked for, fronts of work and precision, advice. A point is a dict as in cost.json
(docs/formats/cost.md); an error that is not known is None or absent."""

import contextlib
import importlib
import json
import math
import os
import pathlib
import subprocess

import isolated
import whole_file
from drumlin import _drumlin
from drumlin.commands import program
from drumlin.errors import InputError

POINT, SWEEP = "drumlin-cost-point-1", "drumlin-cost-sweep-1"
RESULTS = ["sweep.json", "cost.json", "start.h5", "work_precision.png", "statistics.png", "prices.png", "effects.png", "points/*.json", "points/*.h5",
           "points/*/scene.toml"]
GRACE_S = 10  # for a program that is told to end


def say(text):
    print(text, flush=True)


def ended(words, ranks=1, time_limit_s=None, output=None):
    """(exit code, what it printed) of a program of ours, the first of `words`, on so many MPI processes. The exit code is None where its time was over.
    output: as of subprocess; None shows it."""
    started = (["mpirun", "-n", str(ranks)] if ranks > 1 else []) + [program(words[0]), *words[1:]]
    root = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
    with subprocess.Popen(started, stdin=subprocess.DEVNULL, stdout=output, stderr=subprocess.STDOUT if output == subprocess.PIPE else None,
                          env=os.environ | root, text=True, errors="surrogateescape") as process:
        try:
            said, _ = process.communicate(timeout=time_limit_s)
            return process.returncode, said
        except subprocess.TimeoutExpired:
            return None, ""
        finally:  # KeyboardInterrupt, too
            process.terminate()
            with contextlib.suppress(subprocess.TimeoutExpired):
                process.wait(GRACE_S)
            process.kill()


def axes_of(words, allowed):
    """{name: values as words} of words such as "tolerance=1e-2:1e-3"; no values stand for standard ones, no words for all of `allowed`."""
    axes = {}
    for word in words:
        name, *values = word.split("=")
        if len(values) > 1 or name not in allowed:
            raise InputError(f"--sweep: '{name}' is nothing that this scene can be swept over (allowed: {', '.join(allowed)})")
        if name in axes:
            raise InputError(f"--sweep: {name} is named twice")
        axes[name] = values[0].split(":") if values else []
    return axes or {name: [] for name in allowed}


def numbers_of(name, words, standard):
    """The values of an axis as numbers above 0."""
    def number(word):
        try:
            value = float(word)
        except ValueError:
            value = math.nan
        if not (0 < value < math.inf and word.isascii() and word == word.strip() and "_" not in word):
            raise InputError(f"--sweep {name}: '{word}' is no value (allowed: number > 0)")
        return value

    return [number(word) for word in words] or standard


def names_of(name, words, standard):
    """The values of an axis as names, each of them one of `standard`."""
    for word in words:
        if word not in standard:
            raise InputError(f"--sweep {name}: '{word}' is no {name} (allowed: {', '.join(standard)})")
    return words or standard


def without_repeats(values):
    return list(dict.fromkeys(values))


def plain(number):
    """The fewest digits that read back to the same number, 1 for 1.0."""
    return repr(number).removesuffix(".0")


def number_or_none(value):
    return value if math.isfinite(value) else None


def known(point, quantity):
    """Whether the point has a time and an error of the quantity."""
    return point["cpu_seconds"] is not None and point["errors"].get(quantity) is not None


def mark_fronts(points, quantities):
    """Gives each point "pareto": the quantities in which no other has at most its seconds and error, and less of one of them."""
    def beats(one, other, quantity):
        theirs, ours = ((point["cpu_seconds"], point["errors"][quantity]) for point in (one, other))
        return theirs != ours and theirs[0] <= ours[0] and theirs[1] <= ours[1]

    for point in points:
        point["pareto"] = [quantity for quantity in quantities if known(point, quantity)
                           and not any(known(other, quantity) and beats(other, point, quantity) for other in points)]


def advice(points, quantities, lines_of):
    """For each quantity the cheapest point whose relative error is at most 5, 2 and 1 %, its cost over that of the scene as it is, and what to write
    into the scene: `lines_of` the point. Then what the scene as it is wastes (a cheaper point is nowhere less exact) or lacks (its error exceeds 5 %).
    Empty if no point is the scene as it is."""
    scene = next((point for point in points if point["default"] and point["cpu_seconds"] is not None), None)
    if scene is None:
        return ""
    lines, pasted = ["the cheapest settings of this sweep, by the error that they leave:"], {}
    timed = [point for point in points if point["cpu_seconds"] is not None]

    def cheapest(candidates):
        return min(candidates, key=lambda point: point["cpu_seconds"], default=None)

    def said(error, best):
        if best is None:
            return f"{100 * error:g} %: none"
        cost = "the scene as it is" if best["default"] else f"{best['cpu_seconds'] / scene['cpu_seconds']:.2g} times the scene's"
        return f"{100 * error:g} %: {best['name']} ({cost})"

    for quantity in quantities:
        found = {error: cheapest(point for point in timed if known(point, quantity) and point["errors"][quantity] <= error) for error in (0.05, 0.02, 0.01)}
        pasted |= {best["name"]: best for best in found.values() if best and not best["default"]}
        lines.append(f"  {quantity}: " + "; ".join(said(error, best) for error, best in found.items()))
        if known(scene, quantity) and scene["errors"][quantity] > 0.05:
            lines.append(f"    the scene as it is leaves {100 * scene['errors'][quantity]:.2g} %")

    def as_exact(point):
        return all(known(point, quantity) == known(scene, quantity) and
                   not (known(point, quantity) and point["errors"][quantity] > scene["errors"][quantity]) for quantity in quantities)

    better = cheapest(point for point in timed if as_exact(point) and point["cpu_seconds"] < 0.9 * scene["cpu_seconds"])
    if better:
        lines.append(f"the scene as it is wastes time: {better['name']} is as exact in all of these at "
                     f"{better['cpu_seconds'] / scene['cpu_seconds']:.2g} of its cost")
        pasted[better["name"]] = better
    lines += [f"  {name}:  {lines_of(point)}" for name, point in sorted(pasted.items())]
    return "\n".join(lines) + "\n"


def json_of(file):
    return json.loads(pathlib.Path(file).read_text(encoding="utf-8"))


def write_json(file, content):
    whole_file.write_text(file, json.dumps(content, indent=2, ensure_ascii=False, allow_nan=False) + "\n")


def write_cost(folder, content, draw):
    """cost.json, after the figures that `draw`, a script, makes of it."""
    content = content | {"provenance": _drumlin.provenance()}
    isolated.load_matplotlib(pathlib.Path(isolated.__file__).parent)
    importlib.import_module(draw).draw_all(content, folder)
    write_json(folder / "cost.json", content)


class Points:
    """The points of COST, each done once: what an earlier call has finished is taken as it is. `shared`: what all of them have in common; points that
    share something else are refused."""

    def __init__(self, options, shared, inputs):
        folder = pathlib.Path(options["output"])
        self.output = _drumlin.GrowingOutput(options["output"], "cost", options["resume"], options["overwrite"], inputs, RESULTS)
        self.folder, shared, file = folder / "points", {"format": SWEEP} | shared, folder / "sweep.json"
        before = json_of(file) if file.exists() else shared
        for key, value in shared.items():
            if before.get(key) != value:
                raise InputError(f"{folder}: its points were made with another '{key}'; name another folder or give --overwrite")
        self.folder.mkdir(exist_ok=True)
        self.output.forget("*")  # what is written anew beside the points
        self.output.save()
        write_json(file, shared)

    def point(self, name, do):
        listed = f"points/{name}.json"
        file = self.folder / f"{name}.json"
        if listed not in self.output:
            write_json(file, {"format": POINT, "name": name} | do())
            self.output.list(listed)
            self.output.save()
        return json_of(file)

    def finish(self, content, draw):
        write_cost(self.folder.parent, content, draw)
        self.output.finish()
