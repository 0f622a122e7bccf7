"""Scenes as files, texts or dicts, and their simulation step by step."""

import json
import operator
import os

import numpy as np

from . import _drumlin
from .errors import InputError
from .inputs import file_name


def _toml_value(value, key):
    if isinstance(value, (np.generic, np.ndarray)):
        value = value.tolist()
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (int, float)):
        return repr(value)
    if isinstance(value, (str, os.PathLike)):
        return json.dumps(os.fspath(value), ensure_ascii=False).replace("\x7f", "\\u007F")
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{_toml_key(name)} = {_toml_value(entry, f'{key}.{name}')}" for name, entry in value.items()) + " }"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(_toml_value(entry, f"{key}.{number}") for number, entry in enumerate(value)) + "]"
    raise InputError(f"{key}: {type(value).__name__} has no place in a scene (allowed: numbers, texts, truth values, lists, dicts)")


def _toml_key(name):
    if not isinstance(name, str):
        raise InputError(f"{name!r}: is no key (allowed: a text)")
    return name if name.isascii() and name.replace("_", "a").replace("-", "a").isalnum() else json.dumps(name)


def toml_of(scene):
    """The text of a scene that is a dict, a key a line."""
    return "".join(f"{_toml_key(key)} = {_toml_value(value, key)}\n" for key, value in scene.items())


def overrides_of(changes):
    """{"solver.tolerance": 1e-3} as the words after --set of a command; words stay as they are."""
    if isinstance(changes, dict):
        return [f"{key}={_toml_value(value, key)}" for key, value in changes.items()]
    return list(changes)


def _text_and_name(scene, default_format="drumlin-scene-1"):
    """(text, name) of a scene: None and the path of a file, or a text that a dict stands for."""
    if isinstance(scene, dict):
        return toml_of({"format": default_format} | scene), "scene"
    if isinstance(scene, str) and "\n" in scene:
        return scene, "scene"
    return None, file_name(scene)


def resolved(scene, changes=()):
    """The text of a scene (a path, a text, a dict) with all its defaults, checked."""
    return _drumlin.resolved_scene(*_text_and_name(scene), overrides_of(changes))


class Simulation:
    """A scene of grains in time, step by step.

    scene: a path, a text of TOML or a dict with the same keys (`drumlin scene keys` lists them); changes: {"solver.tolerance": 1e-3}.
    Results do not depend on the number of threads.

    x, z, v_x, v_z, spin, radius are read-only views of what the simulation computes with: they change with each step, copy what you keep.
    Of a scene with outlets or sources they are copies, for there the arrays move. Units: d, sqrt(d/g), rho0 d^2; `scales` says what these are.

    Threads may share a simulation: each call waits for the step that is at work.
    """

    def __init__(self, scene, changes=(), threads=1):
        self._scene = _drumlin.stepped_scene(*_text_and_name(scene), overrides_of(changes), threads)

    def __repr__(self):
        return f"<simulation: {len(self.x)} grains, step {self.steps} of {self.steps_planned}, t = {self.time:.6g} sqrt(d/g)>"

    def step(self):
        """One step; returns its report."""
        return self._scene.step()

    def save_snapshot(self, path):
        self._scene.save_snapshot(file_name(path))

    @property
    def forces(self):
        """(n, 2) array: the force of each of `contacts` on its grain i, along x and z."""
        contacts = self.contacts
        n_x, n_z = contacts["normal_x"].astype(float), contacts["normal_z"].astype(float)
        normal, tangential = contacts["impulse_n"] / self.time_step, contacts["impulse_t"] / self.time_step
        return np.column_stack([normal * n_x + tangential * n_z, normal * n_z - tangential * n_x])

    def run(self, stepped=None, steps=None):
        """Steps to the end of the scene, or so many steps. `stepped(simulation, report)` is called after each; False from it ends the run.
        Ctrl-C ends it after the step at hand, and the simulation can go on from there. Returns the number of steps done."""
        done = 0
        while not self.finished and (steps is None or done < steps):
            report = self.step()
            done += 1
            if stepped is not None and stepped(self, report) is False:
                break
        return done


for _name in ("x", "z", "v_x", "v_z", "spin", "radius", "mass", "id", "contacts", "walls", "wall_of_shape", "scales", "finished", "steps",
              "steps_planned", "time", "time_step", "stage", "kinetic_energy"):
    setattr(Simulation, _name, property(operator.attrgetter("_scene." + _name)))
