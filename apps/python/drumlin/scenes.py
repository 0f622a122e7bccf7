"""Scenes as files, texts or dicts, and their simulation step by step."""

import json
import os
import pathlib
import tempfile

import numpy as np

from . import _drumlin
from .errors import InputError
from .figures.result_files import contact_forces
from .inputs import file_name, real
from .progress import Progress


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


def toml_of(scene: dict) -> str:
    """The text of a scene that is a dict, a key a line.

    >>> print(drumlin.toml_of({"title": "Box", "seed": 2}))
    """
    return "".join(f"{_toml_key(key)} = {_toml_value(value, key)}\n" for key, value in scene.items())


def overrides_of(changes):
    """{"solver.tolerance": 1e-3} as the words after --set of a command; words stay as they are."""
    if isinstance(changes, dict):
        return [f"{key}={_toml_value(value, key)}" for key, value in changes.items()]
    return list(changes)


def _text_and_name(scene, default_format="drumlin-scene-1"):
    """(text, name) of a scene: None and the path of a file, which a shipped name stands for, or a text that a dict stands for."""
    if isinstance(scene, dict):
        return toml_of({"format": default_format} | scene), "scene"
    if isinstance(scene, str) and "\n" in scene:
        return scene, "scene"
    return None, file_name(shipped_file(scene))


def shipped_file(name, kind="scene"):
    """The file of a shipped scene, or of a law with kind="law", by its name, as the commands find it; any other path stands for itself."""
    if not isinstance(name, str) or os.path.dirname(name) or os.path.isfile(name):
        return name
    from .commands import command  # pylint: disable=import-outside-toplevel  # it needs this module

    return command("scene", "file", name, **({"law": True} if kind == "law" else {})).removesuffix("\n")


def resolved(scene, changes=()) -> str:
    """The text of a scene (a path, the name of a shipped one, a text, a dict) with all its defaults, checked.

    >>> print(drumlin.resolved("drum-smoke"))
    """
    return _drumlin.resolved_scene(*_text_and_name(scene), overrides_of(changes))


class Simulation:
    """A scene of grains in time, step by step, as its file or a caller between two steps says.

    scene: a path, the name of a shipped one (`drumlin scene list`), a text of TOML or a dict with the same keys (`drumlin scene keys`); changes: {"solver.tolerance": 1e-3}.
    Results do not depend on the number of threads.

    Numbers are in units of d, sqrt(d/g) and rho0 d^2 (`scales` says what these are), angles positive clockwise. Arrays of the grains are read-only views
    of what the simulation computes with: they change with each step, copy what you keep. Of a scene with outlets or sources they are copies, for there
    the arrays move.

    What set_velocity, set_friction, set_gravity and set_wall change holds from the next step on, as long as the same key of a stage would: friction and
    motions of walls to the end of the stage, gravity until another stage changes it. They refuse what a scene file could not say. save() and pickle
    keep it.

    Threads may share a simulation: each call waits for the step that is at work.

    >>> simulation = drumlin.Simulation("drum-smoke")
    >>> simulation.run(steps=100)
    >>> simulation.x, simulation.contacts.force
    """

    def __init__(self, scene, changes=(), threads: int = 1) -> None:
        self._scene, self._threads = _drumlin.stepped_scene(*_text_and_name(scene), overrides_of(changes), threads), threads

    def __repr__(self):
        return (f"<simulation: {len(self.x)} grains, step {self.steps} of {self.steps_planned}, t = {self.time:.6g} sqrt(d/g); "
                f"d = {1e3 * self.scales['length_m']:.4g} mm, sqrt(d/g) = {self.scales['time_s']:.4g} s>")

    @classmethod
    def load(cls, path, threads: int = 1) -> "Simulation":
        """Goes on from a file that save() wrote, bit for bit."""
        simulation = cls.__new__(cls)
        simulation._scene, simulation._threads = _drumlin.continued_scene(file_name(path), threads), threads
        return simulation

    def __reduce__(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "simulation.h5"
            self.save(file)
            return _loaded, (type(self), file.read_bytes(), self._threads)

    def step(self) -> dict:
        """One step; returns its report: contacts, impacts, converged, sweeps, residual, penetration and overlap_mean, overlap_max in d."""
        return self._scene.step()

    def save(self, path):
        """Writes all that the next steps depend on, what was set included, for load()."""
        self._scene.save(file_name(path))

    def save_snapshot(self, path):
        """Writes a snapshot (docs/formats/snapshot.md), which `drumlin.read` reads."""
        self._scene.save_snapshot(file_name(path))

    @property
    def contacts(self) -> np.recarray:
        """Loaded contacts of the last step, a record array with the names of a snapshot: grains i and j (below 0: wall shape -1 - j), unit normal
        (contacts, 2) from j to i, force_n and force_t on i along it and along (n_z, -n_x), force (contacts, 2) as a vector along x and z, rho0 g d^2."""
        found = contact_forces(self._scene.contacts, self.time_step)
        kinds = [(name, values.dtype, values.shape[1:]) for name, values in found.items()]
        contacts = np.empty(len(found["i"]), kinds).view(np.recarray)
        for name, values in found.items():
            contacts[name] = values
        return contacts

    @property
    def x(self) -> np.ndarray:
        """Positions of the centres along x, (grains,), d."""
        return self._scene.x

    @property
    def z(self) -> np.ndarray:
        """Positions of the centres along z, (grains,), d."""
        return self._scene.z

    @property
    def v_x(self) -> np.ndarray:
        """Velocities along x, (grains,), sqrt(g d)."""
        return self._scene.v_x

    @property
    def v_z(self) -> np.ndarray:
        """Velocities along z, (grains,), sqrt(g d)."""
        return self._scene.v_z

    @property
    def spin(self) -> np.ndarray:
        """Angular velocities, clockwise, (grains,), sqrt(g/d); empty in a scene without spin."""
        return self._scene.spin

    @property
    def radius(self) -> np.ndarray:
        """Radii, (grains,), d."""
        return self._scene.radius

    @property
    def mass(self) -> np.ndarray:
        """Masses, (grains,), rho0 d^2; a copy."""
        return self._scene.mass

    @property
    def id(self) -> np.ndarray:
        """Numbers of the grains, (grains,), that stay with them where grains come and go; else empty."""
        return self._scene.id

    @property
    def walls(self) -> list[str]:
        """Names of the walls, a list."""
        return self._scene.walls

    @property
    def wall_of_shape(self) -> list[int]:
        """For each wall shape the number of its wall, a list."""
        return self._scene.wall_of_shape

    @property
    def scales(self) -> dict[str, float]:
        """Units in SI, a dict: length_m (d), time_s, density_kg_m3 (rho0), velocity_m_s, stress_Pa (rho0 g d)."""
        return self._scene.scales

    @property
    def finished(self) -> bool:
        """Whether the scene is at its end."""
        return self._scene.finished

    @property
    def steps(self) -> int:
        """Number of steps done."""
        return self._scene.steps

    @property
    def steps_planned(self) -> int:
        """Number of steps of the scene, as far as known."""
        return self._scene.steps_planned

    @property
    def time(self) -> float:
        """Time since the start, sqrt(d/g)."""
        return self._scene.time

    @property
    def time_step(self) -> float:
        """Length of the last step, sqrt(d/g)."""
        return self._scene.time_step

    @property
    def stage(self) -> str:
        """Name of the stage of the last step."""
        return self._scene.stage

    @property
    def kinetic_energy(self) -> float:
        """Kinetic energy of all grains, of their spin too, rho0 g d^3."""
        return self._scene.kinetic_energy

    def set_velocity(self, grains, v_x=None, v_z=None, spin=None):
        """Gives grains other velocities. grains: an index, a slice or an array of indices or truth values; v_x, v_z in sqrt(g d), spin in sqrt(g/d): a
        number or one for each; None: as before."""
        now = [self.v_x, self.v_z, self.spin]
        for k, values in enumerate((v_x, v_z, spin)):
            if values is not None:
                now[k] = now[k].copy()
                now[k][grains] = real("velocity", values)
        self._scene.set_velocities(*now)

    def set_friction(self, grain_grain: float, grain_wall: float | None = None):
        """Coefficients of friction between grains and, where another, with walls, in a scene with effects.friction; for all materials."""
        self._scene.set_friction(grain_grain, grain_grain if grain_wall is None else grain_wall)

    def set_gravity(self, x: float = 0.0, z: float = -1.0):
        """Gravity along x and z, in units of g, in a scene with effects.gravity."""
        self._scene.set_gravity(x, z)

    def set_wall(self, name: str, velocity=(0.0, 0.0), spin: float = 0.0, center=(0.0, 0.0)):
        """Lets a wall go on from where it is with a velocity (v_x, v_z) in sqrt(g d), turning by spin, sqrt(g/d), about a point (x, z), d, which moves
        with it. Refused of a wall that a force moves, or that ends the stage when it has moved."""
        self._scene.set_wall(name, tuple(velocity), spin, tuple(center))

    def run(self, stepped=None, steps: int | None = None, progress: bool | None = None) -> int:
        """Steps to the end of the scene, or so many steps; returns the number of steps done.

        stepped(simulation, report) is called after each; False from it ends the run. Ctrl-C ends it after the step at hand, and the simulation can go
        on from there. progress: shown or not; None: on a terminal alone."""
        done = 0
        with Progress("steps", self.steps_planned - self.steps if steps is None else steps, progress) as bar:
            while not self.finished and (steps is None or done < steps):
                report = self.step()
                done += 1
                bar.to(done)
                if stepped is not None and stepped(self, report) is False:
                    break
        return done


def _loaded(cls, content, threads):
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "simulation.h5"
        file.write_bytes(content)
        return cls.load(file, threads)
