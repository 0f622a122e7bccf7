"""Text dumps of LAMMPS and of programs that write its format."""

import dataclasses

import numpy as np

from .frame import SAME, Cell, Column, Frame, TextFrames
from .text import Columns, CutOff
from .units import Units, axes_of_files, force_unit

MORE = " of a second set"

STYLES = {"si": Units(), "cgs": Units(1e-2, 1.0, 1e-3), "micro": Units(1e-6, 1e-6, 1e-15), "nano": Units(1e-9, 1e-9, 1e-21)}


@dataclasses.dataclass
class Meaning:
    """Where a column goes, what one of its units is in SI, and the axis of the box that scales it."""

    name: str
    quantity: str = "number"
    factor: float = 1.0
    scaled: int = None


class Box:
    """Lower corner, edges as columns, in units of the dump, and along which of them it is periodic."""

    def __init__(self, text, item):
        bounds, tilts = [], []
        self.periodic = tuple(word == "pp" for word in item.split()[-3:])
        for axis in range(3):
            words = text.line_below("BOX BOUNDS").split()
            if not 2 <= len(words) <= 4:
                text.refuse("BOX BOUNDS", f"holds {len(words)} numbers", "2 to 4")
            # Of two numbers, of three where it is tilted along an axis, of four where it lies anyhow.
            if len(words) == 4:
                text.refuse("BOX BOUNDS", "are those of a box that lies anyhow", "a box that LAMMPS calls orthogonal or triclinic")
            numbers = [text.number_from(word, "BOX BOUNDS") for word in words]
            if not numbers[0] <= numbers[1]:
                text.refuse("BOX BOUNDS", "are not in their order", "lower, then upper")
            bounds.append(numbers[:2])
            tilts.append(numbers[2] if len(words) == 3 else 0.0)
        xy, xz, yz = tilts
        low, high = np.array(bounds).T
        # Those of a tilted box are those of the box around it (LAMMPS, Howto triclinic).
        low = low - [min(0.0, xy, xz, xy + xz), min(0.0, yz), 0.0]
        high = high - [max(0.0, xy, xz, xy + xz), max(0.0, yz), 0.0]
        self.low, self.edges = low, np.diag(high - low) + [[0, xy, xz], [0, 0, yz], [0, 0, 0]]

    def cell(self, metre):
        return Cell(self.edges * metre, self.periodic)


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
                      self.words | ({"time": "TIME"} if "TIME" in told else {}), time, in_file_axes=True)
        frame.cell = box.cell(units.length_unit_m) if box else None
        self._read_rows(text, int(told["NUMBER OF ..."]), box, units, frame)
        return frame

    @staticmethod
    def _put_into_box(text, box, scaled, frame, metre):
        """Scaled coordinates as lengths: an axis needs those of the edges that lie across it."""
        lengths = {}
        for axis in scaled:
            needed = [edge for edge in range(3) if box.edges[axis, edge] != 0 or edge == axis]
            for edge in needed:
                if edge not in scaled:
                    text.refuse(f"{'xyz'[axis]}s", "is scaled by a tilted box", f"{'xyz'[edge]}s beside it")
            lengths[axis] = metre * (box.low[axis] + sum(box.edges[axis, edge] * scaled[edge].values for edge in needed))
        for axis, values in lengths.items():
            scaled[axis].values = values

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
            if meaning.scaled is not None and not box:
                text.refuse(name, "is scaled by a box that this frame does not give", "ITEM: BOX BOUNDS before it")
            found[k] = meaning
            frame.words[meaning.name] = name
        rows = text.so_many_rows(Columns(names, list(found), " ", comments=False), count,
                                 lambda left, most: text.refuse("", f"ends after {most - left} rows of a frame", f"{most} rows", CutOff))
        # The last number of a line without an end may lack digits.
        if text.unended and self.count:
            text.refuse("", "ends within a line", kind=CutOff)
        frame.lines, numbers = rows
        for values, meaning in zip(numbers, found.values()):
            frame.columns[meaning.name] = Column(values * meaning.factor, meaning.quantity)
        self._put_into_box(text, box, {meaning.scaled: frame.columns[meaning.name] for meaning in found.values() if meaning.scaled is not None}, frame,
                           units.length_unit_m)
        if second := frame.columns.pop("second radius", None):
            radius = frame.columns["radius"].values
            frame.require(np.abs(radius - second.values) <= SAME * np.abs(radius), "radius, diameter",
                          lambda row: f"say that the radius is {radius[row]:g} m and {second.values[row]:g} m", "one of them, or a diameter of two radii")


class Grains(Dump):
    """Dumps of the style custom."""

    def __init__(self, files, source):
        super().__init__(files, source, "ITEM: ATOMS",
                         {"time": "TIMESTEP", "v_x": "vx", "v_y": "vy", "v_z": "vz", "radius": "radius or diameter"}, weighs=False)

    def meaning(self, name, box, units):
        metre, second = units.length_unit_m, units.time_unit_s
        if name == "id" or (name == "type" and self.source["wall_types"]):
            return Meaning(name)
        if name in ("radius", "diameter"):
            return Meaning("radius", "length", metre if name == "radius" else metre / 2)
        if name in ("omegax", "omegay", "omegaz"):
            return Meaning("omega_" + name[-1], "rate", 1 / second)
        if name in ("vx", "vy", "vz"):
            return Meaning("v_" + name[-1], "velocity", metre / second)
        axis, letters = name[:1], name[1:]
        if not axis or axis not in "xyz" or letters not in ("", "u", "s", "su"):
            return None
        return Meaning(axis, "length", metre) if letters in ("", "u") else Meaning(axis, "length", 1.0, "xyz".index(axis))


class Contacts(Dump):
    """Dumps of the style local. Forces of a second set of columns, as the tangential part of LAMMPS, are added to those of the first. Without names of
    columns they are those of `drumlin export`, with normals."""

    def __init__(self, files, source):
        axes = axes_of_files(source)
        ids, forces = source["contact_ids"] or ["i", "j"], source["contact_forces"] or ["f" + axis for axis in axes]
        targets = ["i", "j"] + ["f_" + axis for axis in axes] + [f"f_{axis}{MORE}" for axis in axes]
        words = dict(zip(targets, ids + forces))
        if not source["contact_forces"]:
            words |= {"normal_" + axis: "n" + axis for axis in axes}
        self.targets = {name: target for target, name in words.items()}
        super().__init__(files, source, "ITEM: ENTRIES", {"time": "TIMESTEP"} | words, weighs=True)

    def meaning(self, name, box, units):
        target = self.targets.get(name)
        if not target:
            return None
        return Meaning(target, "force", force_unit(self.source, units)) if target[0] == "f" else Meaning(target)

    def _read_rows(self, text, count, box, units, frame):
        super()._read_rows(text, count, box, units, frame)
        for name in [name for name in frame.columns if name.endswith(MORE)]:
            frame.columns[name.removesuffix(MORE)].values += frame.columns.pop(name).values
