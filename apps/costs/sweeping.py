"""What all sweeps of `drumlin cost` share: the axes that are asked for, fronts of work and precision, advice. A point is a dict as in cost.json
(docs/formats/cost.md); an error that is not known is None or absent."""

import math
import pathlib


class Failure(Exception):
    """Ends the command with this exit code and text."""
    code = 74


class InputError(Failure):
    code = 2


class NotConverged(Failure):
    code = 3


class ProgramFailed(Failure):
    """A program that has said itself why it failed."""

    def __init__(self, code):
        super().__init__("")
        self.code = code


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


class Points:
    """The points of OUT, each done once: what an earlier call has finished is taken as it is."""

    def __init__(self, ask, options, shared, inputs):
        ask("claim", shared=shared, inputs=inputs)
        self.ask, self.folder = ask, pathlib.Path(options["output"]) / "points"

    def point(self, name, do):
        kept = self.ask("kept", name=name)
        if kept is None:
            self.ask("keep", name=name, point=do())
            kept = self.ask("kept", name=name)
        return kept
