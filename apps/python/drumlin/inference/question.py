"""A question (docs/formats/infer.md): what is unknown, what was measured, and the scenes that measure it."""

import dataclasses
import functools
import math
import os
import pathlib

import numpy as np
import scipy.stats

from ..study.runs import read_toml, refused
from . import design, laws, observables

FORMAT = "drumlin-question-1"
KINDS = ("scene", "table", "library")


@dataclasses.dataclass
class Prior:
    """Uniform over the range, or normal or uniform in the logarithm within it."""

    low: float
    high: float
    mean: float = math.nan
    sd: float = math.nan
    log: bool = False

    @functools.cached_property
    def _law(self):
        if math.isfinite(self.sd):
            return scipy.stats.truncnorm((self.low - self.mean) / self.sd, (self.high - self.mean) / self.sd, self.mean, self.sd)
        return scipy.stats.loguniform(self.low, self.high) if self.log else scipy.stats.uniform(self.low, self.high - self.low)

    def log_density(self, values):
        return self._law.logpdf(values)

    def quantile(self, share):
        return self._law.ppf(share)


@dataclasses.dataclass
class Measured:
    """A measured quantity of a scene: one number, or one for each z of a profile or each I of a law; `sd`: their standard errors."""

    quantity: str
    z: tuple | None
    value: np.ndarray
    sd: np.ndarray

    @property
    def names(self):
        return [self.quantity] if self.z is None else [f"{self.quantity}({'I' if self.quantity == 'mu' else 'z'}={z:g})" for z in self.z]


@dataclasses.dataclass
class Scene:
    """What was measured, and by what (`kind`): a scene of grains with settings, the rows of a table of runs in which its columns have the settings, or the
    library of laws, for grains with the settings.
    `realisations`: of how many repetitions the measured numbers are the mean, for the chance that no interval of one run knows."""

    name: str
    scene: str
    settings: dict
    realisations: int
    measured: list
    kind: str = "scene"

    def names(self):
        return [f"{self.name}: {name}" for one in self.measured for name in one.names]

    def values(self):
        """(values, standard errors)"""
        return np.concatenate([one.value for one in self.measured]), np.concatenate([one.sd for one in self.measured])


@dataclasses.dataclass
class Question:
    """`priors` by the names of the free unknowns; `equal`: of those that equal another."""

    title: str
    runs: int
    priors: dict
    equal: dict
    scenes: list

    def ranges(self):
        """As design.family takes them."""
        return {name: (prior.low, prior.high) for name, prior in self.priors.items()} | self.equal


class Reader:
    """Values of a question's file with their faults, all of which are told at once."""

    def __init__(self, file):
        self.file, self.problems = file, []

    def fault(self, key, what, allowed):
        self.problems.append((str(self.file), key, what, allowed))

    def number(self, value, key, low=-math.inf, high=math.inf):
        if isinstance(value, bool) or not isinstance(value, (int, float)) or not low <= value <= high or not math.isfinite(value):
            allowed = "any finite number" if math.isinf(low) else f"at least {low:g}" if math.isinf(high) else f"from {low:g} to {high:g}"
            self.fault(key, f"is {value!r}", allowed)
            return math.nan
        return float(value)

    def known(self, table, key, names):
        if not isinstance(table, dict):
            self.fault(key, f"is {table!r}", "a table")
            return {}
        for name in table:
            if name not in names:
                self.fault(f"{key}.{name}".lstrip("."), "is not known here", ", ".join(names))
        return table


def _prior(reader, name, value):
    key = f"unknowns.{name}"
    table = {"range": value} if isinstance(value, list) else reader.known(value, key, ("range", "mean", "sd", "log"))
    ends = table.get("range")
    if not isinstance(ends, list) or len(ends) != 2:
        reader.fault(key, f"is {value!r}", "[low, high], { range = [low, high], mean, sd }, { range, log = true }, or the name of an unknown that it equals")
        return Prior(0, 1)
    low, high = (reader.number(end, f"{key}.range", 0 if name in design.KEYS else -math.inf) for end in ends)
    if not low < high or (table.get("log") and low <= 0):
        reader.fault(f"{key}.range", f"is [{low:g}, {high:g}]", "two numbers, the second greater; of a logarithm above 0")
    normal = {part: reader.number(table[part], f"{key}.{part}", *((1e-300,) if part == "sd" else ())) for part in ("mean", "sd") if part in table}
    if len(normal) == 1:
        reader.fault(key, "names one of mean and sd", "both or neither")
    return Prior(low, high, **normal, log=table.get("log") is True)


def _unknowns(reader, table):
    if not table:
        reader.fault("unknowns", "names none", f"a table of {', '.join(design.KEYS)}, or of keys of the scenes")
    priors, equal = {}, {}
    for name, value in table.items():
        if name not in design.KEYS and "." not in name:
            reader.fault(f"unknowns.{name}", "is not known here", f"{', '.join(design.KEYS)}, or a dotted key of the scenes in quotes")
        elif isinstance(value, str):
            equal[name] = value
        else:
            priors[name] = _prior(reader, name, value)
    for name, other in equal.items():
        if other not in priors:
            reader.fault(f"unknowns.{name}", f"equals {other!r}", f"one that has a range: {', '.join(priors)}")
    return priors, equal


def _measured(reader, table, key):
    table = reader.known(table, key, ("quantity", "z", "I", "value", "interval", "confidence", "source"))
    z = table.get("z", table.get("I"))
    depths = None if z is None else tuple(reader.number(one, f"{key}.z") for one in (z if isinstance(z, list) else [z]))
    count = 1 if depths is None else len(depths)
    share = reader.number(table.get("confidence", 0.99), f"{key}.confidence", 0.01, 0.9999)
    columns = []
    for name, low in (("value", -math.inf), ("interval", 0.0)):
        given = table.get(name)
        given = given if isinstance(given, list) else [given] * (count if name == "interval" else 1)
        if len(given) != count:
            reader.fault(f"{key}.{name}", f"has {len(given)} numbers", f"{count}, one for each z" if depths else "one number; of a profile one for each z")
            given = [0.0] * count
        columns.append(np.array([reader.number(one, f"{key}.{name}", low) for one in given]))
    if not isinstance(table.get("quantity"), str):
        reader.fault(f"{key}.quantity", "is missing", "theta_deg, H, v_x, repose_deg, run_out, rate_grains_per_s, ... (docs/formats/infer.md)")
    return Measured(str(table.get("quantity")), depths, columns[0], columns[1] / scipy.stats.norm.ppf((1 + share) / 2))


def _scene(reader, table, key):
    table = reader.known(table, key, ("name", *KINDS, "settings", "realisations", "measured"))
    kinds = [kind for kind in KINDS if kind in table]
    scene = table[kinds[0]] if len(kinds) == 1 else None
    if kinds == ["library"]:
        scene, table = "library", table | {"settings": reader.known(scene, f"{key}.library", laws.GRAINS)}
    if not isinstance(scene, str):
        reader.fault(f"{key}.scene", "is missing or one of two", "one of scene (a file, or the name of a shipped scene), table (a file) and library (a table)")
        scene = ""
    beside = reader.file.parent / scene
    if kinds == ["table"] and not os.path.isfile(beside):
        reader.fault(f"{key}.table", f"is {scene!r}", "a file, from the question's folder")
    measured = [_measured(reader, one, f"{key}.measured.{number}") for number, one in enumerate(table.get("measured", []))]
    if not measured:
        reader.fault(f"{key}.measured", "is empty", "one or more measured quantities")
    repeats = reader.number(table.get("realisations", 1), f"{key}.realisations", 1)
    return Scene(str(table.get("name", pathlib.Path(scene).stem)), str(beside if beside.is_file() else scene), table.get("settings", {}),
                 int(repeats) if repeats == repeats else 1, measured, kinds[0] if kinds else "scene")


def read_question(path):
    """The question in a file; InputError with all its faults."""
    path = pathlib.Path(path)
    if not os.path.isfile(path):
        raise refused([(str(path), "", "is no file", "a question (docs/formats/infer.md)")])
    content, reader = read_toml(path, FORMAT), Reader(path)
    reader.known(content, "", ("format", "title", "runs", "unknowns", "scenes"))
    runs = reader.number(content.get("runs", 64), "runs", 4, 100000)
    priors, equal = _unknowns(reader, content.get("unknowns", {}))
    scenes = [_scene(reader, table, f"scenes.{number}") for number, table in enumerate(content.get("scenes", []))]
    names = [scene.name for scene in scenes]
    if not scenes:
        reader.fault("scenes", "is empty", "one or more scenes with what was measured of them")
    for number, name in enumerate(names):
        if name in names[:number]:
            reader.fault(f"scenes.{number}.name", f"is {name!r}, which appears twice", "another name for each scene")
    if reader.problems:
        raise refused(reader.problems)
    return Question(content.get("title", path.stem), int(runs), priors, equal, scenes)


def needed(scene):
    """[(quantity, z)] of a scene, as observables.read_all takes them."""
    return [(one.quantity, one.z) for one in scene.measured]


def simulated(scene, folder):
    """(values, standard errors) of a finished run in the order of Scene.values; None where it could not be measured."""
    found = observables.read_all(folder, needed(scene))
    return None if found is None else tuple(np.concatenate([found[key][part] for key in needed(scene)]) for part in (0, 1))
