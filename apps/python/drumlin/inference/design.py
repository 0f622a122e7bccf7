"""Runs that fill the space of the unknowns: chosen, kept for the next question, made by an executor, resumed."""

import dataclasses
import functools
import hashlib
import json
import pathlib
import tomllib

import numpy as np
import scipy.stats

from ..commands import run
from ..errors import NotConvergedError
from ..scenes import resolved
from ..sweeping.executors import run_all
from . import observables

# Keys of a scene that an unknown stands for. Runs that differ in these alone, and in their seed, are one family.
KEYS = {"friction": ("effects.friction.grain_grain",), "wall_friction": ("effects.friction.grain_wall",),
        "rolling_resistance": ("effects.rolling_resistance.grain_grain", "effects.rolling_resistance.grain_wall"),
        "restitution": ("effects.restitution.grain_grain", "effects.restitution.grain_wall")}


UNFINISHED = ("", "running", "interrupted")  # what run.json says of a run that goes on; one that failed is no data, and is not tried again
SIZES = ("grains.generated.diameter_min_mm", "grains.generated.diameter_max_mm")


def keys_of(unknown):
    """Keys of a scene that an unknown sets: its own, or itself where it is such a key."""
    return KEYS.get(unknown, (unknown,))


def flat(table, above=""):
    """{dotted key: value} of a scene; entries of its arrays by their numbers."""
    found = {}
    for key, value in (table.items() if isinstance(table, dict) else enumerate(table)):
        if isinstance(value, (dict, list)):
            found |= flat(value, f"{above}{key}.")
        else:
            found[f"{above}{key}"] = value
    return found


@dataclasses.dataclass
class Family:
    """Runs of one scene and its settings with other grains, in a folder of their own. `given`: the scene's own values of the keys of KEYS."""

    scene: str  # a file or the name of a shipped scene
    settings: dict
    unknowns: dict  # name: (low, high), or the name of another unknown that it equals
    folder: pathlib.Path
    given: dict
    sizes: tuple = ()  # least and greatest diameter of grains spread evenly, mm
    reduced: bool = False  # marked so

    def values(self, folder):
        """The unknowns of a run in this folder; None where it lies outside of the ranges or differs in a grain that is not asked for."""
        scene = flat(tomllib.loads((folder / "scene.toml").read_text(encoding="utf-8")))
        asked = {key: name for name in self.unknowns for key in keys_of(name)}
        if any(key not in asked and scene.get(key) != value for key, value in self.given.items()):
            return None
        found = {}
        for key, name in asked.items():
            value = scene.get(key)
            if value is None or not np.isclose(found.setdefault(name, value), value, rtol=1e-9):
                return None
        for name, prior in self.unknowns.items():
            if isinstance(prior, str) and not np.isclose(found[name], found[prior], rtol=1e-9):
                return None
            if not isinstance(prior, str) and not prior[0] * (1 - 1e-9) <= found[name] <= prior[1] * (1 + 1e-9):
                return None
        return np.array([found[name] for name, prior in self.unknowns.items() if not isinstance(prior, str)])

    def grains(self):
        """What the scene says of its grains, as the library of laws names it; the sizes as a spread about their mean, where they are spread evenly."""
        found = {"friction": self.given[KEYS["friction"][0]], "restitution": self.given[KEYS["restitution"][0]] or 0.0,
                 "rolling_resistance": self.given[KEYS["rolling_resistance"][0]] or 0.0}
        if self.sizes:
            found["spread"] = (self.sizes[1] - self.sizes[0]) / (self.sizes[1] + self.sizes[0])
        return {name: value for name, value in found.items() if value is not None}

    def changes(self, point, seed):
        """What a run at this point sets in the scene."""
        free = dict(zip((name for name, prior in self.unknowns.items() if not isinstance(prior, str)), point))
        values = {name: free[prior if isinstance(prior, str) else name] for name, prior in self.unknowns.items()}
        return self.settings | {"seed": int(seed)} | {key: float(value) for name, value in values.items() for key in keys_of(name)}

    def run_folder(self, point, seed):
        """Where the run at this point lies, by its scene."""
        text = resolved(self.scene, self.changes(point, seed))
        return self.folder / hashlib.sha256(text.encode()).hexdigest()[:12]


def family(scene, settings, unknowns, store):
    """The family of a scene in a folder of designs. InputError where the scene has no place for an unknown."""
    content = flat(tomllib.loads(resolved(scene, settings)))
    known = [key for name in {*KEYS, *unknowns} for key in keys_of(name)]
    same = {key: value for key, value in content.items() if key not in known and key not in ("title", "seed")}
    name = hashlib.sha256(json.dumps(same, sort_keys=True).encode()).hexdigest()[:12]
    return Family(str(scene), dict(settings), unknowns, pathlib.Path(store) / name, {key: content.get(key) for key in known},
                  tuple(content[key] for key in SIZES if key in content), content.get("reduced") is True)


@dataclasses.dataclass
class Planned:
    """A run of a design: at `point` of the free unknowns, in `folder`; `changes` is None where its folder says all."""

    family: Family
    point: np.ndarray
    folder: pathlib.Path
    changes: dict | None

    def status(self):
        """"" where there is nothing, else what its run.json says."""
        file = self.folder / "run.json"
        return json.loads(file.read_text(encoding="utf-8"))["status"] if file.exists() else ""

    def make(self, quantities=()):
        """Runs it, or goes on, and measures it. Whether it finished: one that does not converge is no data, and others go on."""
        if self.status() in UNFINISHED:
            scene = self.folder / "scene.toml"
            try:
                run(*([scene, self.folder] if scene.exists() else [self.family.scene, self.folder, self.changes]), resume=True)
            except NotConvergedError:
                pass
        if self.status() != "finished":
            return False
        observables.measure(self.folder, quantities)
        return True

    def cpu_seconds(self):
        return json.loads((self.folder / "run.json").read_text(encoding="utf-8")).get("cpu_seconds", 0.0)


def sobol(ranges, count):
    """Points that fill the ranges, (count, unknowns)."""
    low, high = np.transpose(ranges)
    sequence = scipy.stats.qmc.Sobol(len(low), scramble=True, seed=1)
    return low + (high - low) * sequence.random_base2(max(1, int(np.ceil(np.log2(count)))))[:count]


def plan(of, count):
    """`count` runs of a family: those that are there, and points of a Sobol sequence, those farthest from the others first."""
    ranges = np.array([prior for prior in of.unknowns.values() if not isinstance(prior, str)], float)
    there = []
    for folder in sorted(of.folder.glob("*/scene.toml")) if of.folder.exists() else []:
        point = of.values(folder.parent)
        if point is not None:
            there.append(Planned(of, point, folder.parent, None))
    fresh = []
    for number, point in enumerate(sobol(ranges, count)):
        folder = of.run_folder(point, number + 1)
        if not (folder / "scene.toml").exists():
            fresh.append(Planned(of, point, folder, of.changes(point, number + 1)))
    scale = ranges[:, 1] - ranges[:, 0]
    while fresh and len(there) < count:
        apart = [min((np.sum(((one.point - other.point) / scale) ** 2) for other in there), default=0.0) for one in fresh]
        there.append(fresh.pop(int(np.argmax(apart))))
    return there


def make_all(runs, folder, executor=None, progress=None):
    """Makes [(run, quantities)] by an executor as of sweeping.run_all; `folder`: any that its workers see. The first error that is no run's own fault is
    raised once the others have ended."""
    outcomes = run_all([functools.partial(run.make, quantities) for run, quantities in runs], folder, executor, progress)
    for outcome in outcomes:
        if outcome.error is not None:
            raise outcome.error
