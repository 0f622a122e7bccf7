"""Import of the files of another program as snapshots: {name of a dataset: numbers}, as docs/formats/snapshot.md has them."""

import dataclasses
import math

import numpy as np

from ..errors import InputError
from . import contacts, grains
from .frame import LARGEST, Scales
from .frames import SOURCES, format_of_files
from .view import in_axes_of_description

OTHER_UNIT = 2.0
SAME_TIME = 1e-9  # relative: times of a table of few digits are compared as they are printed


def no_contacts(axes):
    """The datasets of a snapshot without any."""
    forces = ["impulse_n", "impulse_t"] if axes == "xz" else ["force_" + axis for axis in axes]
    kinds = {"i": "i4", "j": "i4"} | {"normal_" + axis: "f4" for axis in axes} | {name: "f8" for name in forces}
    return {f"contacts/{name}": np.zeros(0, kind) for name, kind in kinds.items()}


@dataclasses.dataclass
class Report:
    """What was imported. `kind`: the table of the description that tells of the files; `grains`: of the last snapshot, `contacts`: of all; `left_out`:
    snapshots that were not taken over, and why; `unused_period_m`: of a file that is periodic along x where the description has neither that nor a drum."""

    kind: str
    snapshots: int = 0
    grains: int = 0
    contacts: int = 0
    with_spin: bool = False
    with_contacts: bool = False
    first_time_s: float = 0.0
    last_time_s: float = 0.0
    scales: Scales = None
    unused_columns: list = dataclasses.field(default_factory=list)
    unused_period_m: float = None
    left_out: list = dataclasses.field(default_factory=list)


class ContactFrames:
    """The frame of contacts that belongs to a time. Frames without a time belong one to one; an instant that frames with times do not name has none."""

    def __init__(self, frames, source):
        self.frames, self.timed = (in_axes_of_description(frame, source) for frame in frames), False
        self.waiting = next(self.frames, None)

    def at(self, time, of_grains, scales):
        frame = self.waiting
        if frame is None:
            if not self.timed:
                of_grains.refuse("contacts", "there is no frame of contacts for this snapshot", "one for each")
            return None
        self.timed = frame.time is not None
        if self.timed:
            own, tolerance = frame.time_in(scales), SAME_TIME * max(1.0, abs(time))
            if own < time - tolerance:
                frame.refuse(frame.word("time"), "there is no snapshot of grains at this time")
            if own > time + tolerance:
                return None
        self.waiting = next(self.frames, None)
        while self.timed and self.waiting and self.waiting.repeats(frame):
            self.waiting = next(self.frames, None)
        return frame

    def pass_by(self, without_grains):
        """Without grains there are none; a frame that says so belongs to no snapshot."""
        if self.waiting and not len(self.waiting.lines) and self.waiting.time in (None, without_grains.time):
            self.waiting = next(self.frames, None)


def _check_units(frame, bodies, before, bodies_before):
    """Grains that are all larger or smaller than in the snapshot before are told in another unit."""
    if not {"radius"} <= frame.columns.keys() & before.columns.keys():
        return
    now, last = (float(np.mean(of.columns["radius"].values[rows])) for of, rows in ((frame, bodies.grains), (before, bodies_before.grains)))
    if not 1 / OTHER_UNIT < now / last < OTHER_UNIT:
        frame.refuse(frame.word("radius"), f"the mean is {now:.4g}, in the snapshot before {last:.4g}", "one unit in all of them")


def _check_sequence(frame, bodies, before, bodies_before, scales, may_change):
    """What of the times and grains must fit from one snapshot to the next."""
    time, last = frame.time_in(scales), before.time_in(scales)
    if not time > last:
        frame.refuse(frame.word("time"), f"{time * scales.time_s:.9g} s does not go on from {last * scales.time_s:.9g} s", "times that ascend")
    if may_change or np.array_equal(bodies.ids, bodies_before.ids):
        return
    lost = len(bodies.ids) <= len(bodies_before.ids)
    from_, in_ = (bodies_before.ids, bodies.ids) if lost else (bodies.ids, bodies_before.ids)
    frame.refuse("id", f"grain {np.setdiff1d(from_, in_)[0]} {'is gone' if lost else 'was not there before'}",
                 "the same grains in every snapshot, or grains.may_change = true")


def _checked_time(frame, scales):
    if frame.time is None:
        frame.refuse(frame.word("time"), "the time is not known", "a column time_s or time, or csv.interval_s")
    time = frame.time_in(scales)
    if not abs(time) <= LARGEST:
        frame.refuse(frame.word("time"), f"is {time:.3g} sqrt(d/g)", f"up to {LARGEST:g} of it")
    return time


class Import:
    """The snapshots of a description with all its defaults, to be iterated over; `report` is whole at their end. `files`: of grains and of contacts."""

    def __init__(self, description, files):
        kind = next(kind for kind in SOURCES if kind in description)
        self.description = description
        self.source = description[kind] | {"dimensions": description.get("dimensions", 2)}
        found = format_of_files(kind, files["grains"], "grains")
        self.report = Report(found.name)
        self.frames = found.grains(files["grains"], self.source)
        self.contact_frames = format_of_files(kind, files["contacts"], "contacts").contacts(files["contacts"], self.source) if files["contacts"] else None

    def _leave_out(self, where, why):
        self.report.left_out.append(f"{where}: {why}")

    def _wanted_frames(self, matching):
        """(frame, bodies) of the frames that become snapshots, with the scales of the first in the report."""
        before = bodies_before = None
        for frame in (in_axes_of_description(frame, self.source) for frame in self.frames):
            where = f"{frame.file}:{frame.first_line}"
            if matching and not matching.waiting and self.contact_frames.cut_off:
                self._leave_out(where, "its contacts are cut off")
                return
            if not before and not len(frame.lines):
                self._leave_out(where, "has no grains yet")
                if matching:
                    matching.pass_by(frame)
                continue
            bodies = grains.Bodies(frame, self.source.get("wall_types"))
            if before and len(bodies.grains) == len(bodies_before.grains) and frame.repeats(before, bodies.grains, bodies_before.grains):
                self._leave_out(where, "is the snapshot before once more")
                continue
            if not before:
                self.report.scales = grains.scales_for(self.description, frame, bodies)
            _checked_time(frame, self.report.scales)
            if before:
                _check_units(frame, bodies, before, bodies_before)
                _check_sequence(frame, bodies, before, bodies_before, self.report.scales, self.description["grains"]["may_change"])
            before, bodies_before = frame, bodies
            yield frame, bodies

    def _snapshot(self, frame, bodies, first_time, matching):
        """Without its velocities."""
        description, scales, drum = self.description, self.report.scales, self.description.get("drum")
        s = grains.still_parts(description, scales) | {"time": frame.time_in(scales)}
        if "wall/spin" in s:
            turned_before = math.copysign(2 * math.pi * drum["turns_before"], drum["speed_rpm"]) if drum else 0.0
            s["wall/angle"] = turned_before + s["wall/spin"] * (s["time"] - first_time)
        grains.add_grains(s, frame, bodies, scales)
        if not drum and "periodic_x" not in description and scales.axes == "xz":
            self.report.unused_period_m = frame.period_m
        if matching:
            s |= no_contacts(scales.axes)
            of_time = matching.at(s["time"], frame, scales)
            if of_time:
                contacts.add_contacts(s, of_time, frame, bodies, scales)
        return s

    def __iter__(self):
        report, matching = self.report, ContactFrames(self.contact_frames, self.source) if self.contact_frames else None
        moved, before, first_time = self.description["grains"]["velocities"] == "displacements", None, None
        for frame, bodies in self._wanted_frames(matching):
            first_time = frame.time_in(report.scales) if first_time is None else first_time
            s = self._snapshot(frame, bodies, first_time, matching)
            if not moved:
                grains.add_velocities(s, frame, bodies, report.scales)
            elif before:
                grains.add_displacements(s, before, report.scales.axes)
            before, has_velocities = s, not moved or bool(before)
            if not has_velocities:
                self._leave_out(f"{frame.file}:{frame.first_line}", "has no snapshot before, and so no velocities")
                continue
            report.snapshots += 1
            s["step"] = report.snapshots
            report.grains, report.with_spin = len(s["grains/x"]), bool({"grains/spin", "grains/omega_y"} & s.keys())
            report.contacts += len(s.get("contacts/i", ()))
            report.last_time_s = s["time"] * report.scales.time_s
            if report.snapshots == 1:
                report.first_time_s = report.last_time_s
            yield s
        self._end(matching)

    def _end(self, matching):
        if not self.report.snapshots:
            raise InputError("the files hold no snapshot")
        for source in filter(None, (self.frames, self.contact_frames)):
            if source.cut_off:
                self._leave_out(source.cut_off, "is cut off")
            self.report.unused_columns += sorted(source.unused)
        if matching and matching.waiting and not self.frames.cut_off:
            matching.waiting.refuse("contacts", "there is no snapshot of grains for these")
        self.report.with_contacts = matching is not None
