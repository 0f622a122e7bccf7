"""H5MD, HDF5 of molecular dynamics (nongnu.org/h5md, version 1.1): one group of particles, whose elements are fixed or have steps of their own."""

import re

import h5py
import numpy as np

from .array_names import QUANTITIES, grain_columns, known_names
from .frame import SAME, Cell
from .hdf5_files import Hdf5Frames, text_of

# Symbols of the module units that make a length, a time or an angle: (in SI, powers of m and s).
SYMBOLS = {"m": (1.0, 1, 0), "Ang": (1e-10, 1, 0), "Angstrom": (1e-10, 1, 0), "s": (1.0, 0, 1), "Hz": (1.0, 0, -1), "rad": (1.0, 0, 0),
           "degree": (np.pi / 180, 0, 0)}
PREFIXES = {"": 0, "E": 18, "P": 15, "T": 12, "G": 9, "M": 6, "k": 3, "h": 2, "da": 1, "d": -1, "c": -2, "m": -3, "u": -6, "n": -9, "p": -12, "f": -15,
            "a": -18}
POWERS = {"length": (1, 0), "time": (0, 1), "velocity": (1, -1), "rate": (0, -1)}


def unit_in_si(text):
    """(in SI, (power of m, power of s)) of a unit as "nm ps-1" or "60 s"; None for another one."""
    value, powers = 1.0, [0, 0]
    for factor in text.split():
        if not (parts := re.fullmatch(r"([A-Za-z]+|\d+(?:\.\d+)?)([-+]?\d+)?", factor)):
            return None
        symbol, power = parts[1], int(parts[2] or 1)
        known = (float(symbol), 0, 0) if symbol[0].isdigit() else next(
            ((10.0 ** PREFIXES[symbol.removesuffix(name)] * size, *dimension) for name, (size, *dimension) in SYMBOLS.items()
             if symbol.endswith(name) and symbol.removesuffix(name) in PREFIXES), None)
        if not known:
            return None
        value, powers = value * known[0] ** power, [sum_ + power * own for sum_, own in zip(powers, known[1:])]
    return value, tuple(powers)


def _along(stored, count):
    """Steps or times of so many rows: an array of them, or an increment with an offset."""
    return stored[:] if stored.shape else stored.attrs.get("offset", 0) + stored[()] * np.arange(count)


class Element:
    """An element; `steps` of its rows, None of one that is fixed in time."""

    def __init__(self, stored):
        self.fixed = isinstance(stored, h5py.Dataset)
        self.values, self.time = (stored, None) if self.fixed else (stored["value"], stored.get("time"))
        self.steps = None if self.fixed else _along(stored["step"], len(self.values)).tolist()
        self.rows, self.ends_early = None, False  # rows by step, where these are not those of the positions

    def follow(self, steps):
        """The steps of the positions."""
        if not self.fixed and self.steps != steps:
            self.rows, self.ends_early = {step: row for row, step in enumerate(self.steps)}, self.steps == steps[:len(self.steps)]

    def belongs_to(self, step):
        """Whether there is a row, or would be if the element did not end too early, which at() refuses."""
        return self.rows is None or self.ends_early or step in self.rows

    def at(self, step, number):
        if self.fixed:
            return self.values[()]
        if self.rows is not None and step not in self.rows:
            raise ValueError(f"{self.values.name} ends after step {max(self.steps, default=0)}")
        return self.values[number if self.rows is None else self.rows[step]]


class Series:
    """The instants of the one group of particles that has positions: `numbers` are the rows of these for which all other elements have one."""

    def __init__(self, text, file, source):
        version = np.ravel(file["h5md"].attrs["version"]).tolist()
        groups = {name: group for name, group in file.get("particles", {}).items() if "position" in group}
        if version[:1] != [1]:
            text.refuse("h5md/version", f"is {version}", "1 and any minor one")
        if len(groups) != 1:
            text.refuse("particles", f"{len(groups)} groups hold positions{': ' if groups else ''}{', '.join(groups)}", "one")
        (group,) = groups.values()
        self.names = known_names(group, source)
        self.unused = group.keys() - {"position", "image", "box", *self.names.values()}
        self.elements = {name: Element(group[name]) for name in ("position", "image", *self.names.values()) if name in group}
        if "box" in group:
            self.boundary = [text_of(word) for word in np.ravel(group["box"].attrs["boundary"])]
        if "box/edges" in group:
            self.elements["edges"] = Element(group["box/edges"])
        self.places = self.elements["position"]
        if self.places.fixed:
            text.refuse("position", "is fixed in time", "steps and values")
        for one in self.elements.values():
            one.follow(self.places.steps)
        self.numbers = [k for k, step in enumerate(self.places.steps) if all(one.belongs_to(step) for one in self.elements.values())]
        if self.places.steps and not self.numbers:
            text.refuse(", ".join(self.elements), "have no step in common", "one or more")
        self.times = None if self.places.time is None else _along(self.places.time, len(self.places.steps))


class Grains(Hdf5Frames):
    """Times are those of the positions, else their steps times step_s, else interval_s apart. Units are those of the attributes `unit`, else of the
    description."""

    def series_of(self, text, file):
        return Series(text, file, self.source)

    def _unit(self, text, data, quantity):
        """Of a dataset, in units of the description."""
        told = text_of(data.attrs.get("unit", ""))
        if quantity == "number" or not told.strip():
            return 1.0
        value, powers = unit_in_si(told) or (1.0, None)
        if powers != POWERS[quantity]:
            text.refuse(data.name, f'has the unit "{told}"', f"one of a {quantity}, of {', '.join(SYMBOLS)} with prefixes and powers")
        given, keys = self.units.of(quantity), [key for key, power in zip(("length_unit_m", "time_unit_s"), powers) if power]
        if all(self.source.get(key) is not None for key in keys) and abs(given / value - 1) > SAME:
            text.refuse(data.name, f'has the unit "{told}", which {", ".join(keys)} of the description contradict', "one of both, or the same in both")
        return value / given

    def frame_of(self, text, series, number):
        step = series.places.steps[number]

        def values(name, quantity):
            one = series.elements[name]
            return np.asarray(one.at(step, number), float) * self._unit(text, one.values, quantity)

        rows, periodic, cell = np.zeros((3, 3)), [], None
        if "edges" in series.elements:
            edges = values("edges", "length")
            rows[:len(edges), :len(edges)] = edges if edges.ndim == 2 else np.diag(edges)
            periodic = [word == "periodic" for word in series.boundary]
            cell = Cell.of_rows(self.units.length_unit_m * rows, (periodic + 3 * [False])[:3], lambda *what: text.refuse("box/edges", *what))
        places = values("position", "length")
        if "image" in series.elements and any(periodic):
            width = places.shape[1]
            places += np.where(periodic, values("image", "number"), 0) @ rows[:width, :width]
        arrays = {name: values(name, QUANTITIES[what]) for what, name in series.names.items()}
        if "id" in series.names:
            # Places that are not taken have the fill value of the ids.
            ids = series.elements[series.names["id"]].values
            if ids.id.get_create_plist().fill_value_defined() == h5py.h5d.FILL_VALUE_USER_DEFINED:
                taken = arrays[series.names["id"]] != ids.fillvalue
                places, arrays = places[taken], {name: of[taken] for name, of in arrays.items()}
        time = None if series.times is None else series.times[number] * self._unit(text, series.places.time, "time")
        self.unused |= series.unused
        return *grain_columns(places, arrays, self, text.refuse), self.time_of(text.refuse, "position/step", time, step), cell
