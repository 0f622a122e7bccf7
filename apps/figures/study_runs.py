"""The measured runs of a study and its study.json, as the figures need them."""

import json
import math
import pathlib
import tomllib

import matplotlib.pyplot as plt

import script
import style
from style import half_width_of, shown_layers, value_of

# The paper's own marks, where its legends give them; colours from slow to fast.
MARKERS = {2: "o", 4: "*", 5: "s", 6: "^", 10: "D", 15: ">"}
SURFACE_MARGIN, WALL_MARGIN = 2, 3  # d: layers beyond belong to the surface or to the wall


class Run:
    """Profiles, narrow slices and scalars of one measured run; what was not measured is NaN or absent."""

    def __init__(self, folder, entry):
        self.folder = pathlib.Path(folder)
        measured = self.folder / "measured"
        self.name, self.rpm = entry["name"], entry["rotation_rpm"]
        self.header, self.columns = shown_layers(style.read_profiles(measured / "profiles.csv"))
        self.content = script.content_of(measured / "measured.json")
        self.scalars = entry["scalars"]
        slices = [shown_layers(style.read_profiles(file)) for file in (measured / "slices").glob("*.csv")]
        slices.sort(key=lambda one: float(one[0]["position"]))
        self.slices = {float(header["position"]): columns for header, columns in slices}
        self.z = self.columns["z"]
        self.wall = float(self.header.get("wall_z", "nan"))

    def scalar(self, name):
        return value_of(self.scalars.get(name))

    def half_width(self, name):
        return self.columns.get(name + "_ci99")

    def has(self, *names):
        return all(name in self.columns for name in names)

    def inside(self):
        """Layers below the surface and off the wall that shear forwards beyond their interval, from deep to shallow."""
        half = self.half_width("shear_rate")
        return self.off_ends() & (self.columns["shear_rate"] > (0 if half is None else half))

    def off_ends(self, surface_margin=SURFACE_MARGIN):
        """Which layers lie below the surface and off the wall."""
        return (self.wall + WALL_MARGIN <= self.z) & (self.z <= -surface_margin)


NOT_MEASURED = {"value": math.nan, "ci99": math.nan}


def with_nan(entry):
    """What was not measured is null in the file and NaN here, so that it can be drawn: not at all."""
    return {key: math.nan if value is None and key in ("value", "ci99") else value for key, value in entry.items()}


class Study:
    def __init__(self, file, folders, paper):
        with open(file, encoding="utf-8") as stream:
            self.content = json.load(stream, object_hook=with_nan)
        self.reduced = self.content["reduced"]
        self.runs = [Run(folder, entry) for folder, entry in zip(folders, self.content["runs"])]
        self.speeds = self.content["speeds"]
        self.is_papers = self.content["paper_table"] is not None
        self.table = read_toml(paper / "rotations.toml")["rotation"] if self.is_papers else []
        self.laws = {law["name"]: law for law in read_toml(paper / "laws.toml")["law"]} if self.is_papers else {}
        self.observables = read_toml(paper / "observables.toml")["observable"] if self.is_papers else []

    def first_runs(self):
        """One run of each speed, slow to fast."""
        by_name = {run.name: run for run in self.runs}
        return [by_name[speed["runs"][0]] for speed in self.speeds]

    def main_run(self):
        """The first run at the speed that most figures of the paper show, else in the middle of the speeds."""
        runs = self.first_runs()
        at_six = [run for run in runs if abs(run.rpm - 6) < 0.05]
        return at_six[0] if at_six else runs[len(runs) // 2]

    def speed_values(self, name):
        """Value and half width of a scalar over the speeds."""
        entries = [speed["scalars"].get(name) for speed in self.speeds]
        return [value_of(entry) for entry in entries], [half_width_of(entry) for entry in entries]

    def law(self, name, coefficient):
        return self.content["laws"][name]["coefficients"][coefficient]

    def mean(self, name):
        return self._over_all_speeds(name, "mean")

    def trend(self, name):
        return self._over_all_speeds(name, "trend")

    def _over_all_speeds(self, name, key):
        entry = self.content["over_all_speeds"].get(name, {}).get(key)
        return entry if isinstance(entry, dict) else NOT_MEASURED | {"value": value_of(entry)}

    def at_main_speed(self, name):
        """Pooled over the runs at the speed of the main run."""
        main = self.main_run().name
        speed = next(speed for speed in self.speeds if main in speed["runs"])
        entry = speed["scalars"].get(name)
        return entry if isinstance(entry, dict) else NOT_MEASURED | {"value": value_of(entry)}

    def paper_column(self, name):
        return [row[name] for row in self.table]

    def paper_value(self, name, rpm=None):
        """The paper's number, that of this speed before that of all; NaN where it has none."""
        found = [entry for entry in self.observables
                 if entry["name"] == name and entry.get("rotation_rpm") in (rpm, None)]
        found.sort(key=lambda entry: "rotation_rpm" not in entry)
        return found[0]["value"] if found else math.nan

    def paper_law(self, name, coefficient):
        return self.laws[name]["coefficients"][coefficient] if name in self.laws else math.nan


def read_toml(path):
    with open(path, "rb") as stream:
        return tomllib.load(stream)


def color_of(study, rpm):
    speeds = [speed["rotation_rpm"] for speed in study.speeds]
    place = speeds.index(min(speeds, key=lambda speed: abs(speed - rpm)))
    return plt.get_cmap("viridis")(0.9 * place / max(1, len(speeds) - 1))


def marker_of(rpm):
    near = [mark for speed, mark in MARKERS.items() if abs(speed - rpm) < 0.05 * speed]
    return near[0] if near else "o"


def label_of(run):
    return f"{run.rpm:.3g} rpm"


def shown(entry, digits=3):
    """A measurement in words."""
    value, half = value_of(entry), half_width_of(entry)
    if math.isnan(value):
        return "not measured"
    return f"{value:.{digits}g}" + (f" ± {half:.2g}" if math.isfinite(half) else "")
