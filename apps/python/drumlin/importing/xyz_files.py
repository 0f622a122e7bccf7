"""Extended XYZ, text of ASE and OVITO: for each instant the number of grains, a line of key=value, and a row per grain, whose columns are its Properties."""

import re

import numpy as np

from .array_names import grain_columns, known_names
from .frame import Cell, Frame, FramesInUnits
from .text import Columns, CutOff

ENTRY = re.compile(r"""([^\s="']+)\s*=\s*(?:"([^"]*)"|'([^']*)'|\{([^}]*)\}|\[([^\]]*)\]|(\S+))""")
FLAGS = {"T": True, "F": False, "TRUE": True, "FALSE": False, "1": True, "0": False}


def _entries(line):
    """{key in small letters: value}"""
    return {key.lower(): "".join(values) for key, *values in ENTRY.findall(line)}


class Grains(FramesInUnits):
    """The times are Time, else Step or Timestep times step_s, else interval_s apart. A Lattice without pbc is periodic along all of its edges."""

    def frames_of(self, text):
        while (line := text.next_line()) is not None:
            self.first_line = text.number
            count = text.number_from(line, "number of grains")
            if count != int(count) or not 0 <= count < 1e15:
                text.refuse("number of grains", f"is {line}", "a whole number >= 0")
            yield self._frame(text, int(count), _entries(text.line_below("Properties")))

    def _frame(self, text, count, head):
        places, columns = self._columns(text, head.get("properties", ""))
        time, step = (next((text.number_from(head[key], key) for key in keys if key in head), None) for keys in (["time"], ["step", "timestep"]))
        time, cell = self.time_of(text.refuse, "Time or Step", time, step), self._cell(text, head)
        lines, numbers = text.so_many_rows(columns, count, lambda left, most: text.refuse(
            "", f"ends after {most - left} rows of a frame", f"{most} rows", CutOff))
        # The last number of a line without an end may lack digits.
        if text.unended and self.count:
            text.refuse("", "ends within a line", kind=CutOff)
        read = dict(zip(columns.used, numbers))
        self.unused |= {name for name, at in places.items() if at[0] not in read}
        arrays = {name: np.column_stack([read[k] for k in at]) for name, at in places.items() if at[0] in read}
        _, found = grain_columns(arrays.pop("pos"), arrays, self, text.refuse)
        return Frame(text.path, lines, self.first_line, found, ", ".join(places), {}, time, cell=cell, in_file_axes=True)

    def _columns(self, text, properties):
        """({name: places of its columns}, Columns, of which those that matter are read)"""
        words = properties.split(":")
        if len(words) % 3 or not all(width.isdecimal() and int(width) > 0 for width in words[2::3]):
            text.refuse("Properties", f'is "{properties}"', "name:type:number of columns:name:...")
        places, names = {}, []
        for name, width in zip(words[::3], map(int, words[2::3])):
            if name in places:
                text.refuse("Properties", f"names {name} twice", "each once")
            places[name] = range(len(names), len(names) + width)
            names += [name if width == 1 else f"{name}[{k + 1}]" for k in range(width)]
        if "pos" not in places:
            text.refuse("Properties", "names no pos", "pos:R:3")
        used = ["pos", *known_names(places, self.source).values()]
        return places, Columns(names, sorted(k for name in used for k in places[name]), " ", comments=False)

    def _cell(self, text, head):
        if "lattice" not in head:
            return None
        periodic = [FLAGS.get(word.upper()) for word in re.split(r"[\s,]+", head.get("pbc", "T T T").strip())]
        if len(periodic) != 3 or None in periodic:
            text.refuse("pbc", f'is "{head["pbc"]}"', "three of T and F")
        lattice = [text.number_from(word, "Lattice") for word in re.split(r"[\s,]+", head["lattice"].strip())]
        if len(lattice) != 9:
            text.refuse("Lattice", f"holds {len(lattice)} numbers", "9, three of each edge")
        return Cell.of_rows(self.units.length_unit_m * np.reshape(lattice, (3, 3)), periodic, lambda *what: text.refuse("Lattice", *what))
