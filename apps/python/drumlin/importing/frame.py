"""The numbers of one instant as another program wrote them, with the place of each row."""

import dataclasses
import typing

import numpy as np

from .text import CutOff, InputError, TextFile, refusal
from .units import units_of

# Largest place, speed, force or time in units of d, sqrt(d/g) and rho0 g d: beyond, a unit is wrong or the other program has lost its grains.
LARGEST = 1e9
SAME = 1e-6  # relative: of the digits that a user writes


@dataclasses.dataclass
class Scales:
    """What one unit is in SI: d, sqrt(d/g), rho0."""

    length_m: float
    time_s: float
    density_kg_m3: float
    axes: typing.ClassVar = "xz"

    def unit_of(self, quantity):
        """Of a "number", "time", "length", "velocity", "rate" or "force" (of discs per metre of depth)."""
        velocity = self.length_m / self.time_s
        return {"number": 1.0, "time": self.time_s, "length": self.length_m, "velocity": velocity, "rate": 1 / self.time_s,
                "force": self.density_kg_m3 * velocity * velocity * self.length_m ** (len(self.axes) - 1)}[quantity]


class SphereScales(Scales):
    """Of spheres, whose forces are not per metre."""

    axes: typing.ClassVar = "xyz"


SI = Scales(1.0, 1.0, 1.0)


@dataclasses.dataclass
class Cell:
    """The box of a frame, m: columns of `edges` are its edges along the axes of the file, `periodic` along which it repeats."""

    edges: np.ndarray
    periodic: tuple

    @classmethod
    def of_rows(cls, rows, periodic, refuse):
        """Of edges as rows, which mean nothing along an axis without a period. Refused: a box that lies anyhow, or has no size."""
        edges = np.where(np.reshape(periodic, (3, 1)), rows, 0.0).T
        lies_anyhow = np.any(np.abs(np.tril(edges, -1)) > SAME * np.abs(edges).max())
        if not np.isfinite(edges).all() or lies_anyhow or not np.all(np.diag(edges)[list(periodic)] > 0):
            refuse(f"has the edges {edges.T.tolist()}", "the first along x, the second in the plane of x and y, periods > 0")
        return cls(edges, tuple(periodic))


@dataclasses.dataclass
class Column:
    """Numbers of a quantity, in SI or dimensionless already."""

    values: np.ndarray
    quantity: str
    in_si: bool = True


@dataclasses.dataclass
class Frame:
    """Columns by the names of docs/formats/import.md without their units: id, x, y, z, v_x, v_y, v_z, radius, spin_clockwise, spin_anticlockwise, omega_x,
    omega_y, omega_z, type, third of grains; i, j, normal_x, normal_y, normal_z, f_n, f_t, f_x, f_y, f_z of contacts. `lines`: of each row, `first_line`:
    where the instant begins; `words`: what the file calls its columns, also those that it lacks; `cell`: where the file has one; `in_file_axes`: the axes
    are those of the file (view.py), not of the description."""

    file: str
    lines: np.ndarray
    first_line: int
    columns: dict
    all_names: str
    words: dict
    time: float = None
    time_in_si: bool = True
    cell: Cell = None
    in_file_axes: bool = False

    @property
    def period_m(self):
        """Along x, of a box that is periodic along x and not tilted; else None."""
        cell = self.cell
        upright = cell and not np.any(cell.edges - np.diag(np.diag(cell.edges)))
        return float(cell.edges[0, 0]) if upright and cell.periodic[0] else None

    def word(self, name):
        return self.words.get(name, name)

    def values(self, name, scales):
        """Dimensionless; refused where they are missing or beyond LARGEST."""
        if name not in self.columns:
            raise refusal(self.file, self.first_line, self.word(name), f"no such column among {self.all_names}", "docs/formats/import.md")
        column = self.columns[name]
        values = column.values / scales.unit_of(column.quantity) if column.in_si else column.values
        self.require(np.isfinite(values), self.word(name), lambda row: f"is {column.values[row]}", "finite numbers")
        if column.quantity != "number":
            self.require(np.abs(values) <= LARGEST, self.word(name),
                         lambda row: f"is {values[row]:.3g} of the unit made of d, sqrt(d/g) and rho0", f"up to {LARGEST:g} of it")
        return values

    def time_in(self, scales):
        return self.time / scales.time_s if self.time_in_si else self.time

    def repeats(self, other, rows=slice(None), of_other=slice(None)):
        """Whether the numbers of both are the same, but for their places in files."""
        return (self.time == other.time and self.columns.keys() == other.columns.keys()
                and all(np.array_equal(column.values[rows], other.columns[name].values[of_other]) for name, column in self.columns.items()))

    def refuse(self, key, what, allowed="", row=None):
        """Names the line of a row, or the first of the instant."""
        raise refusal(self.file, self.first_line if row is None or row >= len(self.lines) else self.lines[row], key, what, allowed)

    def require(self, good, key, what, allowed="", rows=None):
        """Refuses the first of `rows` (of all) that is not good; `what` says of a place in `good` what is wrong."""
        if not np.all(good):
            first = int(np.argmin(good))
            self.refuse(key, what(first) if callable(what) else what, allowed, first if rows is None else rows[first])


class Rows:
    """Places of the rows of a frame of a binary file, as messages name them."""

    def __init__(self, frame, count):
        self.frame, self.count = frame, count

    def __len__(self):
        return self.count

    def __getitem__(self, row):
        return f"{self.frame}, row {row + 1}"


def binary_frame(file, number, count, columns, **more):
    """A frame of a file that has no lines: the `number`-th of the file, from 0."""
    place = f"frame {number}"
    return Frame(file, Rows(place, count), place, columns, ", ".join(columns), {}, in_file_axes=True, **more)


class BinaryFile:
    """The file that a reader of binary frames has open; `number`: of the frame, for messages."""

    unended = False

    def __init__(self, path):
        self.path, self.number = path, 0

    def refuse(self, key, what, allowed="", kind=InputError):
        raise refusal(self.path, self.number, key, what, allowed, kind)


class TextFrames:
    """The frames of files, to be iterated over. `unused`: names of columns that told nothing; `cut_off`: where the last frame ends too early and was
    left out, as a killed program leaves it; else empty. A class of a format gives frames_of(text), and opens other files than text by its own `opened`."""

    opened = TextFile

    def __init__(self, files):
        self.files, self.unused, self.cut_off, self.count, self.first_line = files, set(), "", 0, None

    def frames_of(self, text):
        """The frames of an open file. `count`: how many there are so far, of all files."""
        raise NotImplementedError

    def __iter__(self):
        for number, file in enumerate(self.files, 1):
            text = self.opened(file)
            frames = self.frames_of(text)
            while True:
                try:
                    frame = next(frames, None)
                except InputError as error:
                    if not self.count or number < len(self.files) or not (isinstance(error, CutOff) or text.unended):
                        raise
                    self.cut_off = f"{file}:{self.first_line or text.number}"
                    return
                if frame is None:
                    break
                self.count += 1
                yield frame


class FramesInUnits(TextFrames):
    """Of files whose units and times the description tells where they do not."""

    def __init__(self, files, source):
        super().__init__(files)
        self.source, self.units = source, units_of(source)

    def time_of(self, refuse, told="", time=None, step=None):
        """s, of the file, else its step times step_s, else from frame to frame interval_s; `told`: where such files have it."""
        if time is not None:
            return float(time) * self.units.time_unit_s
        if step is not None and "step_s" in self.source:
            return float(step) * self.source["step_s"]
        if "interval_s" in self.source:
            return self.count * self.source["interval_s"]
        if step is not None:
            refuse(told, "counts steps whose length is not known", "files.step_s in the description")
        refuse("", "has no time", f"{told + ', or ' if told else ''}files.interval_s in the description")
