"""A snapshot as other programs take it: SI, in space. Of discs the plane is that of x and y, with y up, and forces are per metre of depth."""

import dataclasses
import math

import h5py
import numpy as np

from ..figures.result_files import number_of, text_of

SPHERES = "drumlin-spheres-1"


@dataclasses.dataclass
class Instant:
    """`place`, `velocity`, `omega` (or None) of each grain and `normal`, `force` (on i) of each contact are rows of three; `j` < 0: a wall. `period`: 0 where
    the domain is open."""

    step: int
    time: float
    spheres: bool
    place: np.ndarray
    velocity: np.ndarray
    omega: np.ndarray
    radius: np.ndarray
    mass: np.ndarray
    period: np.ndarray
    tilt: np.ndarray  # xy, xz, yz
    i: np.ndarray
    j: np.ndarray
    normal: np.ndarray
    force: np.ndarray

    @property
    def force_name(self):
        return "force_N" if self.spheres else "force_N_m"

    def across(self):
        """From the centre of i to that of j's nearest image, or to the wall (rows of three)."""
        reach = self.radius[self.i] + np.where(self.j >= 0, self.radius[np.maximum(self.j, 0)], 0.0)
        return -self.normal * reach[:, None]

    def box(self):
        """(lower corner, lengths): the period where there is one, else around all grains; of discs as thick as the largest."""
        low, high = ((self.place - self.radius[:, None]).min(axis=0), (self.place + self.radius[:, None]).max(axis=0))
        lengths = np.where(self.period > 0, self.period, high - low)
        return np.where(self.period > 0, np.floor(low / np.where(self.period > 0, self.period, 1)) * self.period, low), lengths


def instant_of(path):
    with h5py.File(path) as stored:
        spheres = text_of(stored["format"]) == SPHERES
        length, second, density = (number_of(stored["scales/" + name]) for name in ("length_m", "time_s", "density_kg_m3"))
        grains = {name: values[:] for name, values in stored["grains"].items()}
        contacts = {name: values[:] for name, values in stored["contacts"].items()} if "contacts" in stored else {"i": np.zeros(0, int), "j": np.zeros(0, int)}
        numbers = {name: number_of(stored[name]) for name in ("step", "time", "time_step", "period_x", "period_y", "period_z", "tilt_xy", "tilt_xz", "tilt_yz")
                   if name in stored}
    zeros = np.zeros(len(grains["x"]))

    def vectors(of, prefix, names, count):
        return np.array([of[prefix + name].astype(float) if name and prefix + name in of else np.zeros(count) for name in names]).T.reshape(count, 3)

    axes = ("x", "y", "z") if spheres else ("x", "z", None)
    count = len(contacts["i"])
    normal = vectors(contacts, "normal_", axes, count)
    if spheres:
        force = vectors(contacts, "force_", axes, count)
        omega = vectors(grains, "omega_", axes, len(zeros)) if "omega_x" in grains else None
    else:
        push, drag = (contacts.get(name, np.zeros(count))[:, None] / numbers["time_step"] for name in ("impulse_n", "impulse_t"))
        force = push * normal + drag * np.column_stack([normal[:, 1], -normal[:, 0], np.zeros(count)])
        omega = np.column_stack([zeros, zeros, -grains["spin"]]) if "spin" in grains else None
    radius = grains["radius"]
    solid = 4 / 3 * math.pi * radius**3 if spheres else math.pi * radius**2
    dimension = 3 if spheres else 2
    return Instant(
        step=int(numbers["step"]), time=numbers["time"] * second, spheres=spheres, place=vectors(grains, "", axes, len(zeros)) * length,
        velocity=vectors(grains, "v_", axes, len(zeros)) * length / second, omega=None if omega is None else omega / second, radius=radius * length,
        mass=grains.get("mass", solid) * density * length**dimension,
        period=length * np.array([numbers.get("period_" + axis, 0.0) if axis else 0.0 for axis in axes]),
        tilt=length * np.array([numbers.get("tilt_" + axes_, 0.0) for axes_ in ("xy", "xz", "yz")]), i=contacts["i"].astype(int), j=contacts["j"].astype(int),
        normal=normal, force=force * density * length ** (dimension + 1) / second**2)
