"""Measured runs and flows as a study reads them from their folders, and which of them belong together."""

import dataclasses
import json
import math
import pathlib
import tomllib

import numpy as np

from ..errors import InputError
from ..figures import result_files
from .fits import Scalar, pooled_speeds

# Settings of a measurement that must be the same in all runs; the others are results (the angle of the frame, say).
SETTINGS = ("slope_isoline_nu", "slope_half_width_asked", "surface_nu", "position", "slice_width_asked", "layer_thickness", "velocity_window",
            "surface_speed_depth", "linear_share", "decay_window_below_H", "bulk_margin", "mu_fit_I", "mu_fit_surface_margin", "mu_fit_wall_margin")
FLOW_NUMERICS = ("surface_cell", "surface_zone", "levels", "regularisation_shear_rate", "regularisation_pressure", "entrainment_length", "slice_width",
                 "layer_thickness")
# Keys that earlier programs did not know: a scene that names such a value says the same as one without the key.
LATER_DEFAULTS = {"grains.generated.placement": "apart"}


class Profile:
    """Layers of a run from the wall up: `z` and `columns`, each of shape (layers,), in d, sqrt(d/g) and rho0 g d, NaN where nothing was measured;
    `header`: what the file says of itself, as texts."""

    def __init__(self, header, columns):
        self.header, self.columns, self.z = header, columns, columns["z"]

    def number(self, key):
        """A number of the header, NaN where it has none."""
        return float(self.header.get(key, "nan"))

    def at(self, name):
        """(value, half width of the 99 % interval), each of shape (layers,); NaN where there is no such column."""
        none = np.full(self.z.shape, math.nan)
        return self.columns.get(name, none), self.columns.get(name + "_ci99", none)

    @property
    def wall(self):
        """z of the drum's wall, d."""
        return float(self.header.get("wall_z", self.z[0]))


@dataclasses.dataclass
class Run:
    """What `drumlin measure` left of a run, or `drumlin flow` of a flow (`start`: what it started from; `fitted_on`: runs of its law; `law`)."""

    name: str
    folder: str
    rotation_rpm: float
    profile: Profile
    scalars: dict  # name: Scalar
    identity: dict  # what must be the same in all runs (flows) of a study
    numerics: dict  # what may differ, but is worth a word
    warnings: list = dataclasses.field(default_factory=list)  # why it counts less than a steady whole turn
    cpu_seconds: float = math.nan
    start: str = ""
    fitted_on: list = dataclasses.field(default_factory=list)
    law: dict = dataclasses.field(default_factory=dict)
    line: tuple = (math.nan, math.nan)  # lowest and highest z of the straight line through v_x

    @property
    def reduced(self):
        """Whether it is a demo."""
        return self.profile.header["reduced"] == "true"

    @property
    def maps_file(self):
        """Path of its maps.h5."""
        folder = pathlib.Path(self.folder)
        return (folder if self.start else folder / "measured") / "maps.h5"


@dataclasses.dataclass
class Speed:
    """Runs at one speed of rotation, with their pooled scalars."""

    rotation_rpm: float
    runs: list
    scalars: dict


def words(value):
    """A text as it stands, any other value as in JSON."""
    return value if isinstance(value, str) else json.dumps(value, ensure_ascii=False)


def refused(problems):
    """InputError from (file, key, what, allowed), in the words of the commands."""
    lines = [": ".join(part for part in (file, key, what) if part) + (f" (allowed: {allowed})" if allowed else "") for file, key, what, allowed in problems]
    error = InputError("\n".join(lines))
    error.problems = [{"file": file, "line": 0, "key": key, "what": what, "allowed": allowed} for file, key, what, allowed in problems]
    return error


def read_toml(path, form=None):
    """A TOML file; InputError where it is none or not there, or its format is not `form`."""
    try:
        content = tomllib.loads(pathlib.Path(path).read_text(encoding="utf-8"))
    except (ValueError, FileNotFoundError, IsADirectoryError) as error:
        raise InputError(f"{path}: {getattr(error, 'strerror', None) or error}") from error
    if form is not None and content.get("format") != form:
        raise refused([(f"{path}:1", "format", "is missing or not known here", f'"{form}"')])
    return content


def _number(value):
    return np.float64(math.nan if value is None else value)


def scalars_of(content):
    """Top-level numbers of measured.json or flow.json: plain ones, {"value", "ci99"}, and null."""
    found = {}
    for name, entry in content.items():
        if isinstance(entry, dict) and "value" in entry:
            found[name] = Scalar(_number(entry["value"]), _number(entry["ci99"]) if "ci99" in entry else None)
        elif entry is None or (isinstance(entry, (int, float)) and not isinstance(entry, bool)):
            found[name] = Scalar(_number(entry))
    return found


def _flat(name, table):
    """The keys of a scene's table by their dotted names, without those that say no more than their absence; an empty table stands for itself."""
    kept = {}
    for key, value in table.items():
        own = f"{name}.{key}"
        if isinstance(value, dict):
            kept |= _flat(own, value)
        elif value != [] and LATER_DEFAULTS.get(own) != value:
            kept[own] = value
    return kept or {name: {}}


def _scene(path):
    """(identity, numerics) of a run's scene; a run from elsewhere has none."""
    if not path.exists():
        return {}, {}
    scene, identity, numerics = read_toml(path), {}, {}
    for part in ("grains", "effects"):
        if part in scene:
            identity |= _flat(part, scene[part])
    if "tolerance" in scene.get("solver", {}):
        numerics["solver.tolerance"] = scene["solver"]["tolerance"]
    if "time_step_s" in (scene.get("stages") or [{}])[-1]:
        numerics["time_step_s"] = scene["stages"][-1]["time_step_s"]
    return identity, numerics


def _profile_and_speed(path, settings):
    _, header, columns = result_files.read_table(path, "drumlin-profiles-1")
    profile = Profile(header, columns)
    return profile, profile.number("rotation") / settings["scales"]["time_s"] * 30 / math.pi


def _json(path):
    return json.loads(path.read_text(encoding="utf-8"))


def _name_of(folder):
    return folder.resolve().name


def _unsteady(measured):
    steadiness = measured.get("steadiness") or {}
    if "steady" not in steadiness:
        return ["its measurement does not say whether it is steady"]
    return [] if steadiness["steady"] else [words(reason) for reason in steadiness.get("reasons", [])] or ["not steady"]


def read_run(folder):
    """A measured run, from RUN/measured (docs/formats/measured.md), run.json and scene.toml."""
    folder = pathlib.Path(folder)
    measured = _json(folder / "measured" / "measured.json")
    settings = measured["settings"]
    profile, rpm = _profile_and_speed(folder / "measured" / "profiles.csv", settings)
    identity, numerics = _scene(folder / "scene.toml")
    identity |= {key: profile.header[key] for key in ("reduced", "drum_radius", "diameter_m")}
    identity |= {"settings." + key: settings[key] for key in SETTINGS if key in settings}
    run = _json(folder / "run.json") if (folder / "run.json").exists() else {}
    line = tuple(_number(measured.get("fits", {}).get(key)) for key in ("fit_bottom", "fit_top"))
    return Run(_name_of(folder), str(folder), rpm, profile, scalars_of(measured), identity, numerics, _unsteady(measured), _number(run.get("cpu_seconds")),
               line=line)


def read_flow(folder):
    """A flow, from flow.json, flow_scene.toml and profiles.csv (docs/formats/flow.md); a scalar's interval is what the law's draws leave open."""
    folder = pathlib.Path(folder)
    flow = _json(folder / "flow.json")
    if flow.get("geometry", "drum") != "drum":
        raise refused([(str(folder / "flow.json"), "geometry", f"is {words(flow['geometry'])}", '"drum"')])
    settings = flow["settings"]
    profile, rpm = _profile_and_speed(folder / "profiles.csv", settings)
    scalars = scalars_of(flow)
    for name, width in ((flow.get("law_band") or {}).get("scalars") or {}).items():
        width = width.get("ci99") if isinstance(width, dict) else width
        if name in scalars and width is not None:
            scalars[name] = Scalar(scalars[name].value, width)
    law = dict(settings.get("law", {}))
    fitted_on = [words(name) for name in law.pop("fitted_on", [])]
    effects = [" ".join([name, *(f"{key} = {json.dumps(value)}" for key, value in keys.items())])
               for name, keys in read_toml(folder / "flow_scene.toml").get("effects", {}).items()]
    identity = {"law": words(law), "effects": ", ".join(effects) or "nothing"}
    numerics = {key: settings[key] for key in FLOW_NUMERICS if key in settings}
    return Run(_name_of(folder), str(folder), rpm, profile, scalars, identity, numerics, [], _number(flow.get("cpu_seconds")),
               words(flow.get("start", "not said")), fitted_on, law)


def same_speed(a, b):
    """Whether two speeds of rotation count as one: to 0.5 %."""
    return abs(a - b) <= 0.005 * abs(a)


def _same(key, ours, theirs):
    """Numbers of headers and settings to 1e-3: the mean diameter in one file is that of the scene, in another that of the discs drawn."""
    if key.startswith(("grains", "effects")):
        return ours == theirs
    try:
        return abs(float(ours) - float(theirs)) <= 1e-3 * abs(float(ours))
    except (TypeError, ValueError):
        return ours == theirs


def require_one_study(runs):
    """InputError, every difference at once, unless the runs show the same drum, grains and definitions; also when one is named twice, stands still, or
    there is none."""
    if not runs:
        raise InputError("a study needs at least one run")
    problems, names = [], [run.name for run in runs]
    for i, run in enumerate(runs):
        if run.name in names[:i]:
            problems.append((run.name, "", "appears twice in this study", "each run once"))
        if not run.rotation_rpm > 0:
            problems.append((run.name, "rotation", "the drum stands still", "a drum that turns"))
    keys = sorted({key for run in runs for key in run.identity})
    for run in runs:
        for key in keys:
            ours, theirs = (one.identity.get(key, "nothing") for one in (run, runs[0]))
            if not _same(key, ours, theirs):
                problems.append((run.name, key, f"{words(ours)}, but {words(theirs)} in {runs[0].name}", "the same in all runs of a study"))
    if problems:
        raise refused(problems)


def other_numerics(runs):
    """A warning for each setting in which a run differs from the first."""
    first = runs[0]
    return [f"{run.name}: {key} = {words(value)}, other than in {first.name}" for run in runs for key, value in run.numerics.items()
            if first.numerics.get(key) != value]


def speed_groups(runs):
    """The runs by speed (same_speed), slow to fast; every scalar that one of them has is pooled."""
    groups = []
    for run in runs:
        group = next((group for group in groups if same_speed(run.rotation_rpm, group.rotation_rpm)), None)
        if group is None:
            groups.append(group := Speed(run.rotation_rpm, [], {}))
        group.runs.append(run)
    groups.sort(key=lambda group: group.rotation_rpm)
    for name in dict.fromkeys(name for group in groups for run in group.runs for name in run.scalars):
        pools = pooled_speeds([[run.scalars[name] for run in group.runs if name in run.scalars] for group in groups])
        for group, pool in zip(groups, pools):
            if any(name in run.scalars for run in group.runs):
                group.scalars[name] = pool
    return groups
