"""Snapshots in tables: a frame per file, per time where there is a column of time, and per heading where the source has one."""

import numpy as np

from .frame import Column, Frame, TextFrames
from .text import Columns, CutOff, shown

SUFFIXES = {"number": "", "time": "_s", "length": "_m", "velocity": "_m_s", "rate": "_rad_s", "force": "_N_m"}
GRAINS = {"time": "time", "id": "number", "x": "length", "z": "length", "v_x": "velocity", "v_z": "velocity", "radius": "length",
          "spin_clockwise": "rate", "spin_anticlockwise": "rate"}
CONTACTS = {"time": "time", "i": "number", "j": "number", "normal_x": "number", "normal_z": "number",
            "f_n": "force", "f_t": "force", "f_x": "force", "f_z": "force"}


class Tables(TextFrames):
    """Of grains or contacts, `known` their columns."""

    def __init__(self, files, source, known):
        super().__init__(files)
        self.known, self.interval_s = known, source.get("interval_s")
        self.names, self.heading = (source["columns"], source["heading"]) if known is GRAINS else ([], [])

    def frames_of(self, text):
        between = "spaced" if self.names else ","
        if not self.names:
            line = text.next_line(comments=True)
            if line is None:
                text.refuse("", "holds no line of column names", "docs/formats/import.md")
        names = self.names or Columns([], [], between, True).fields(line)
        meaning = self._meaning(text, names)
        columns = Columns([name or f"column {k + 1} without a name" for k, name in enumerate(names)], list(meaning), between, comments=True)
        self.unused |= {name for k, name in enumerate(columns.names) if k not in meaning}
        return (self._below_headings if self.heading else self._of_rows)(text, columns, list(meaning.values()))

    def _meaning(self, text, names):
        """{place: (name, whether in SI)} of the columns that are known."""
        found = {}
        for k, name in enumerate(names):
            if ";" in name or "\t" in name:
                text.refuse("", f'the name "{name}" holds a semicolon or a tab', "commas between names and numbers, points before decimals")
            for word, quantity in self.known.items():
                if name in (word, word + SUFFIXES[quantity]):
                    if any(word == other for other, _ in found.values()):
                        text.refuse(name, "appears twice", "one column for each quantity")
                    found[k] = word, name != word
        return found

    def _frame(self, text, first_line, columns, meaning, rows):
        """Of rows that TextFile joined."""
        lines, numbers = rows
        frame = Frame(text.path, lines, first_line, {}, ", ".join(columns.names), {name: name + SUFFIXES[q] for name, q in self.known.items()})
        for (name, in_si), values, k in zip(meaning, numbers, columns.used):
            frame.words[name] = columns.names[k]
            if name != "time":
                frame.columns[name] = Column(values, self.known[name], in_si)
            elif len(values):
                frame.time, frame.time_in_si = float(values[0]), in_si
        if frame.time is None and self.interval_s is not None:
            frame.time = self.count * self.interval_s
        return frame

    def _of_rows(self, text, columns, meaning):
        time = next((k for k, (name, _) in enumerate(meaning) if name == "time"), None)
        parts = []
        while rows := text.rows(columns):
            lines, numbers = rows
            begins = [] if time is None else np.flatnonzero(np.diff(numbers[:, time])) + 1
            for piece in zip(np.split(lines, begins), np.split(numbers, begins)):
                if time is not None and parts and piece[1][0, time] != parts[0][1][0, time]:
                    yield self._frame(text, int(parts[0][0][0]), columns, meaning, text.joined(parts, columns))
                    parts = []
                parts.append(piece)
        yield self._frame(text, int(parts[0][0][0]) if parts else max(1, text.number), columns, meaning, text.joined(parts, columns))

    def _below_headings(self, text, columns, meaning):
        while (line := text.next_line(comments=True)) is not None:
            first_line, fields = text.number, columns.fields(line)
            if len(fields) < len(self.heading):
                text.refuse("", f"holds {len(fields)} fields", f"at least {len(self.heading)}, the names of csv.heading")
            head = {name: text.number_from(field, name) for name, field in zip(self.heading, fields) if name in ("count", "time", "time_s")}
            count = head["count"]
            if count != np.floor(count) or not 0 <= count < 1e15:
                text.refuse("count", f"is {shown(count)}", "a whole number >= 0")
            rows = text.so_many_rows(columns, int(count), lambda left, _: text.refuse("", "ends within a snapshot", f"{left} rows more", CutOff))
            # The last number of a line without an end may lack digits.
            if text.unended and self.count:
                text.refuse("", "ends within a line")
            frame = self._frame(text, first_line, columns, meaning, rows)
            for name in head.keys() & {"time", "time_s"}:
                frame.time, frame.time_in_si, frame.words["time"] = head[name], name == "time_s", name
            yield frame
