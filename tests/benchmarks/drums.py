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


def solved_to(tolerance, solver):
    return re.sub(r"tolerance = \S+", f"tolerance = {tolerance}", solver, count=1)
