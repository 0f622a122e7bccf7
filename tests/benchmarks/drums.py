"""Drums of any number of discs at the fill of the shipped 6 rpm drum."""

import math
import pathlib
import re

SHIPPED = pathlib.Path(__file__).resolve().parents[2] / "data/scenes/drum-6rpm.toml"


def radius_mm(discs):
    return round(225 * math.sqrt(discs / 7183), 1)


def drum(discs):
    """The scene without its stages: what it says up to them, and its solver."""
    text = SHIPPED.read_text(encoding="utf-8")
    start, rest = text.split("[[stages]]", 1)[0], "[solver]" + text.split("[solver]", 1)[1].split("\n[output]", 1)[0]
    start = re.sub(r"count = \d+", f"count = {discs}", start)
    return re.sub(r"radius_mm = [\d.]+", f"radius_mm = {radius_mm(discs):.1f}", start), rest


def started_from(run, start, more=""):
    """The same with the grains of a run at its end; `more`: further keys of that table."""
    return re.sub(r"(?s)\[grains\.generated\].*?\n\n", f'[grains.from_run]\nrun = "{run}"\n{more}\n', start)


def solved_to(tolerance, solver):
    return re.sub(r"tolerance = \S+", f"tolerance = {tolerance}", solver, count=1)


def speed_rpm(discs):
    """At which the drum has the Froude number of the 6 rpm drum."""
    return 6 * (7183 / discs) ** 0.25


def stage(name, length, motion="", snapshots=1):
    """In steps of 1e-3 s; `length`: the key that says it."""
    lines = ["[[stages]]", f'name = "{name}"', length, "time_step_s = 1e-3", f"snapshots = {snapshots}" if snapshots else "", f"motions = [{motion}]" if motion else ""]
    return "\n".join(line for line in lines if line) + "\n\n"


def rotation(rpm):
    return f'{{ wall = "drum", kind = "rotation", speed_rpm = {rpm} }}'
