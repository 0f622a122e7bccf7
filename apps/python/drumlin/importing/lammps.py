"""Text dumps of LAMMPS and of programs that write its format."""

import dataclasses

import numpy as np

from .frame import Column, Frame, TextFrames
from .text import Columns, CutOff

SAME = 1e-6  # relative: of the digits that a user writes


@dataclasses.dataclass
class Units:
    """What one unit of the dump is in SI."""

    length_unit_m: float = 1.0
    time_unit_s: float = 1.0
    mass_unit_kg: float = 1.0


STYLES = {"si": Units(), "cgs": Units(1e-2, 1.0, 1e-3), "micro": Units(1e-6, 1e-6, 1e-15), "nano": Units(1e-9, 1e-9, 1e-21)}


@dataclasses.dataclass
class Meaning:
    """Where a column goes, what one of its units is in SI, what is added to it; `scaled`: by the box."""

    name: str
    quantity: str = "number"
    factor: float = 1.0
    offset: float = 0.0
    scaled: bool = False


class Box:
    """Lower and upper bound along x, y, z; where it is tilted, those around it."""

    def __init__(self, text, item):
        self.bounds, self.tilted, self.periodic_x = [], False, item.split()[-3] == "pp"
        for _ in range(3):
            words = text.line_below("BOX BOUNDS").split()
            if not 2 <= len(words) <= 4:
                text.refuse("BOX BOUNDS", f"holds {len(words)} numbers", "2 to 4")
            # Of two numbers, of three where it is tilted along an axis, of four where it lies anyhow.
            numbers = [text.number_from(word, "BOX BOUNDS") for word in words] if len(words) < 4 else [0.0, 0.0, 1.0]
            self.tilted |= numbers[2:] not in ([], [0.0])
            if not numbers[0] <= numbers[1]:
                text.refuse("BOX BOUNDS", "are not in their order", "lower, then upper")
            self.bounds.append(numbers[:2])


class Dump(TextFrames):
    """Frames of the style custom or local: `rows_item` is above the rows, `words` says what the columns are called, `weighs`: whether the unit of mass
    matters."""

    def __init__(self, files, source, rows_item, words, weighs):
        super().__init__(files)
        self.source, self.rows_item, self.words, self.weighs = source, rows_item, words, weighs

    def meaning(self, name, box, units):
        """Of a column in a frame; None for one that tells nothing."""
        raise NotImplementedError

    def frames_of(self, text):
        style = None
        while (item := text.next_line()) is not None:
            self.first_line, told, box = text.number, {}, None

            def tell(key, value_below):
                if key in told:
                    text.refuse(key, "appears a second time in this frame", "once in each frame")
                told[key] = value_below(key)

            while not item.startswith(self.rows_item):
                if item == "ITEM: TIMESTEP":
                    tell("TIMESTEP", text.whole_number_below)
                elif item == "ITEM: TIME":
                    tell("TIME", lambda key: text.number_from(text.line_below(key), key))
                elif item == "ITEM: UNITS":
                    style = text.line_below("UNITS")
                    if style != "lj" and style not in STYLES:
                        text.refuse("UNITS", f'is "{style}"', "si, cgs, micro, nano, lj")
                elif item.startswith("ITEM: NUMBER OF "):
                    tell("NUMBER OF ...", text.whole_number_below)
                elif item.startswith("ITEM: BOX BOUNDS"):
                    tell("BOX BOUNDS", lambda _, head=item: Box(text, head))
                else:
                    text.refuse("", f'"{item[:60]}" is not expected here', f"ITEM: TIMESTEP, NUMBER OF ..., BOX BOUNDS, {self.rows_item[6:]}")
                item = text.line_below("")
            for key in ("TIMESTEP", "NUMBER OF ..."):
                if key not in told:
                    text.refuse(self.rows_item, f"comes before ITEM: {key}")
            yield self._frame(text, item, told, style)

    def _frame(self, text, item, told, style):
        units, box = self._units(text, style), told.get("BOX BOUNDS")
        if "TIME" not in told and "step_s" not in self.source:
            text.refuse("TIMESTEP", "counts steps whose length is not known", "ITEM: TIME in each frame, or lammps.step_s in the description")
        time = told["TIME"] * units.time_unit_s if "TIME" in told else told["TIMESTEP"] * self.source["step_s"]
        frame = Frame(text.path, None, self.first_line, {}, item[len(self.rows_item):].strip(),
                      self.words | ({"time": "TIME"} if "TIME" in told else {}), time)
        if box and box.periodic_x and not box.tilted:
            frame.period_m = (box.bounds[0][1] - box.bounds[0][0]) * units.length_unit_m
        self._read_rows(text, int(told["NUMBER OF ..."]), box, units, frame)
        return frame

    def _units(self, text, style):
        """Of the description and of the file, which must not contradict each other."""
        units = dataclasses.asdict(STYLES.get(style, Units()))
        for key, own in units.items():
            given = self.source.get(key)
            if given is None and style == "lj" and (key != "mass_unit_kg" or self.weighs):
                text.refuse("UNITS", 'is "lj", which has no dimensions', f"lammps.{key} in the description")
            if given is not None and style in STYLES and abs(given / own - 1) > SAME:
                text.refuse("UNITS", f'is "{style}", a unit of {own:g}; lammps.{key} is {given:g}',
                            "a description without the key, or with the same unit")
            units[key] = own if given is None else given
        return Units(**units)

    def _read_rows(self, text, count, box, units, frame):
        """What the named columns give; of those that give the same the first, but of a radius and a diameter both."""
        names, found = frame.all_names.split(), {}
        for k, name in enumerate(names):
            meaning = self.meaning(name, box, units)
            if meaning and meaning.name == "radius" and any(other.name == "radius" for other in found.values()):
                meaning.name = "second radius"
            if not meaning or any(meaning.name == other.name for other in found.values()):
                self.unused.add(name)
                continue
            if meaning.scaled and not box:
                text.refuse(name, "is scaled by a box that this frame does not give", "ITEM: BOX BOUNDS before it")
            if meaning.scaled and box.tilted:
                text.refuse(name, "is scaled by a tilted box", "coordinates that are not")
            found[k] = meaning
            frame.words[meaning.name] = name
        rows = text.so_many_rows(Columns(names, list(found), " ", comments=False), count,
                                 lambda left, most: text.refuse("", f"ends after {most - left} rows of a frame", f"{most} rows", CutOff))
        # The last number of a line without an end may lack digits.
        if text.unended and self.count:
            text.refuse("", "ends within a line", kind=CutOff)
        frame.lines, numbers = rows
        for values, meaning in zip(numbers, found.values()):
            frame.columns[meaning.name] = Column(values * meaning.factor + meaning.offset, meaning.quantity)
        if second := frame.columns.pop("second radius", None):
            radius = frame.columns["radius"].values
            frame.require(np.abs(radius - second.values) <= SAME * np.abs(radius), "radius, diameter",
                          lambda row: f"say that the radius is {radius[row]:g} m and {second.values[row]:g} m", "one of them, or a diameter of two radii")


class Grains(Dump):
    """Dumps of the style custom. The axes of the plane, the one across it, and the component of the angular velocity that turns in it: with x to the right
    and y up it points at the onlooker and anticlockwise is positive; with z up it points away."""

    def __init__(self, files, source):
        upright = source["plane"] == "xz"
        self.axes, self.clockwise = {"x": "x", "z" if upright else "y": "z", "y" if upright else "z": "third"}, 1 if upright else -1
        up, across = list(self.axes)[1:]
        self.spin, self.v_z = "omega" + across, "v" + up
        super().__init__(files, source, "ITEM: ATOMS",
                         {"time": "TIMESTEP", "z": up, "v_x": "vx", "v_z": self.v_z, "radius": "radius or diameter"}, weighs=False)

    def meaning(self, name, box, units):
        metre, second = units.length_unit_m, units.time_unit_s
        if name == "id" or (name == "type" and self.source["wall_types"]):
            return Meaning(name)
        if name in ("radius", "diameter"):
            return Meaning("radius", "length", metre if name == "radius" else metre / 2)
        if name == self.spin:
            return Meaning("spin_clockwise", "rate", self.clockwise / second)
        if name in ("vx", self.v_z):
            return Meaning("v_x" if name == "vx" else "v_z", "velocity", metre / second)
        target, letters = self.axes.get(name[:1]), name[1:]
        if not target or letters not in ("", "u", "s", "su"):
            return None
        if letters in ("", "u"):
            return Meaning(target, "length", metre)
        low, high = box.bounds["xyz".index(name[0])] if box else (0.0, 0.0)
        return Meaning(target, "length", (high - low) * metre, low * metre, True)


class Contacts(Dump):
    """Dumps of the style local."""

    def __init__(self, files, source):
        super().__init__(files, source, "ITEM: ENTRIES", {"time": "TIMESTEP"} | dict(zip(("i", "j", "f_x", "f_z"), self.names_in(source))), weighs=True)

    @staticmethod
    def names_in(source):
        return source["contact_ids"] + source["contact_forces"]

    def meaning(self, name, box, units):
        names = self.names_in(self.source)
        if name not in names:
            return None
        sign = 1 if self.source["force_on"] == "first" else -1
        force = sign * units.mass_unit_kg * units.length_unit_m / (units.time_unit_s * units.time_unit_s) / self.source["depth_m"]
        place = names.index(name)
        return Meaning(("i", "j", "f_x", "f_z")[place], *(("force", force) if place > 1 else ()))
