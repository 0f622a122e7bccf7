"""Files of MercuryDPM: .data with grains, in the plane (8 numbers a line) or in space (14), .fstat with contacts."""

import numpy as np

from .frame import Column, Frame, FramesInUnits
from .text import Columns, CutOff, shown
from .units import axes_of_files, force_unit

# Numbers of a line by those of its heading; "" tells nothing. In the plane the file has the spin clockwise.
PLANE = ["x", "y", "v_x", "v_y", "radius", "", "omega_z", "type"]
SPACE = ["x", "y", "z", "v_x", "v_y", "v_z", "radius", "", "", "", "omega_x", "omega_y", "omega_z", "type"]
QUANTITIES = {"x": "length", "y": "length", "z": "length", "radius": "length", "v_x": "velocity", "v_y": "velocity", "v_z": "velocity",
              "omega_x": "rate", "omega_y": "rate", "omega_z": "rate", "type": "number"}
CONTACT = ["time", "i", "j", "x", "y", "z", "overlap", "spring", "f_n", "f_t", "n_x", "n_y", "n_z", "t_x", "t_y", "t_z"]


class Data(FramesInUnits):
    """.data: a heading of number, time and corners of the domain above the grains of each instant, whose ids are their places."""

    def frames_of(self, text):
        while (line := text.next_line()) is not None:
            self.first_line = text.number
            head = [text.number_from(word, "heading") for word in line.split()]
            if len(head) not in (6, 8):
                text.refuse("heading", f"holds {len(head)} numbers", "6 in the plane, 8 in space: number of grains, time, corners of the domain")
            if not (head[0] == np.floor(head[0]) and 0 <= head[0] < 1e15):
                text.refuse("number of grains", f"is {shown(head[0])}", "a whole number >= 0")
            names = PLANE if len(head) == 6 else SPACE
            yield self._frame(text, names, head)

    def _frame(self, text, names, head):
        used = [k for k, name in enumerate(names) if name and (name != "type" or self.source["wall_types"])]
        columns = Columns([name or f"number {k + 1}" for k, name in enumerate(names)], used, "spaced", comments=False)
        lines, numbers = text.so_many_rows(columns, int(head[0]), lambda left, most: text.refuse(
            "", f"ends after {most - left} grains of a frame", f"{most}, as its heading says", CutOff))
        if text.unended and self.count:
            text.refuse("", "ends within a line", kind=CutOff)
        frame = Frame(text.path, lines, self.first_line, {}, ", ".join(filter(None, names)), {}, head[1] * self.units.time_unit_s, in_file_axes=True)
        for k, values in zip(used, numbers):
            sign = -1 if names is PLANE and names[k] == "omega_z" else 1
            frame.columns[names[k]] = Column(sign * self.units.of(QUANTITIES[names[k]]) * values, QUANTITIES[names[k]])
        return frame


class Contacts(FramesInUnits):
    """.fstat: three lines with # above the contacts of each instant. A contact of two grains that move is told from both sides, one with a wall or a fixed
    grain from one; at a wall normal and tangent point into it (BaseInteraction::writeToFStat). Images of grains across a period have ids beyond those of
    .data (contacts.py finds the grains)."""

    def __init__(self, files, source):
        super().__init__(files, source)
        self.axes = axes_of_files(source)
        self.force = force_unit(source | {"force_on": "first"}, self.units)

    def frames_of(self, text):
        columns = Columns(CONTACT, [k for k, name in enumerate(CONTACT) if k in (1, 2, 6) or k >= 8], "spaced", comments=False)
        while (line := text.next_line()) is not None:
            self.first_line = text.number
            time = self._heading(text, line)
            parts = []
            while most := text.lines_before("#"):
                part = text.rows(columns, most)
                if part is None:
                    break
                parts.append(part)
            if text.unended and self.count:
                text.refuse("", "ends within a line", kind=CutOff)
            yield self._frame(text, time, *text.joined(parts, columns))

    def _heading(self, text, line):
        words = line.split()
        if words[:1] != ["#"] or len(words) < 3:
            text.refuse("", f'"{line[:60]}" is no heading', "three lines with #: time; corners of the domain; radii")
        time = text.number_from(words[1], "time")
        for _ in range(2):
            below = text.line_below("heading")
            if not below.startswith("#"):
                text.refuse("heading", f'"{below[:60]}" has no #', "three lines with #")
        return time * self.units.time_unit_s

    def _frame(self, text, time, lines, numbers):
        i, j, overlap, f_n, f_t = numbers[:5]
        normal, tangent = np.array(numbers[5:8]), np.array(numbers[8:11])
        turned = np.where(j < 0, -1.0, 1.0)
        force = turned * self.force * (f_n * normal + f_t * tangent)
        # From the other side a second time: i and j beyond each other's place.
        most = 1 + max(i.max(initial=0), j.max(initial=0))
        again = (i > j) & (j >= 0) & np.isin(i * most + j, (j * most + i)[(i < j)])
        kept = ~again
        frame = Frame(text.path, lines[kept], self.first_line, {}, ", ".join(CONTACT), {}, time, in_file_axes=True)
        frame.columns = {"i": Column(i[kept], "number"), "j": Column(j[kept], "number"), "overlap": Column(self.units.of("length") * overlap[kept], "length")}
        for k, axis in enumerate("xyz"):
            if axis in self.axes:
                frame.columns["normal_" + axis] = Column((turned * normal[k])[kept], "number")
                frame.columns["f_" + axis] = Column(force[k][kept], "force")
        return frame
