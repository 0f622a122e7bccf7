"""Text of Yade: export.text and export.textExt of yade.export, a file per instant."""

from .frame import Column, Frame, FramesInUnits
from .text import Columns

QUANTITIES = {"id": "number", "x": "length", "y": "length", "z": "length", "r": "length", "v_x": "velocity", "v_y": "velocity", "v_z": "velocity",
              "omega_x": "rate", "omega_y": "rate", "omega_z": "rate"}


class Text(FramesInUnits):
    """`#format x_y_z_r...` above a row per sphere. Names behind attrs_ are those of `columns` of the description. Files are interval_s apart."""

    def frames_of(self, text):
        line = text.next_line()
        words = (line or "").split()
        if words[:1] != ["#format"] or len(words) != 2 or not words[1].startswith("x_y_z_r"):
            text.refuse("", "has no heading", "#format x_y_z_r..., as yade.export.text and textExt write it")
        self.first_line = text.number
        names = [*"xyzr", *[word for word in words[1].split("_")[4:] if word != "attrs"]]
        if words[1].endswith("_attrs"):
            names += self.source["columns"]
        used = [k for k, name in enumerate(names) if name in QUANTITIES]
        self.unused |= set(names) - QUANTITIES.keys()
        columns = Columns(names, used, "spaced" if len(names) == 4 else " ", comments=True)
        parts = []
        while rows := text.rows(columns):
            parts.append(rows)
        lines, numbers = text.joined(parts, columns)
        frame = Frame(text.path, lines, self.first_line, {}, ", ".join(names), {"radius": "r"}, in_file_axes=True)
        frame.time = self.time_of(text.refuse)
        for k, values in zip(used, numbers):
            frame.columns["radius" if names[k] == "r" else names[k]] = Column(values * self.units.of(QUANTITIES[names[k]]), QUANTITIES[names[k]])
        yield frame
