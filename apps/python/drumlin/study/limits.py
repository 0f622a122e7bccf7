"""Flows of several speeds judged by limits that a file states before they are solved (docs/formats/comparison-study.md), each against all runs of its
speed that calibrated nothing, with the noise floor, run against run, in each cell."""

import itertools
import math
import pathlib

import numpy as np
import scipy.interpolate

from ..figures import result_files
from .fits import mean, pooled_speeds
from .runs import read_toml, refused, require_one_study, same_speed
from .sides import number, pair, require_one_drum

FIELDS = (("flowing", "static", "all"), ("relative", "rms"))
# What may be judged where: zones and measures.
PLACES = {"centre": FIELDS, "map": FIELDS, "wall": (("",), ("rms",)), "scalar": (("",), ("difference", "relative", "inside_interval")),
          "cost": (("",), ("value",))}


def _positive(value):
    return isinstance(value, (int, float)) and value > 0


def read_limits(path, places=None, keys=None):
    """A file of limits (drumlin-limits-1); InputError, all faults at once, where it holds others than docs/formats/comparison-study.md lists, or
    `places` and more `keys`, {name: (words, test)}; beside these a limit may go without an aim."""
    places, keys = places or PLACES, keys or {}
    content = read_toml(path, "drumlin-limits-1")
    starts = [line for line, text in enumerate(pathlib.Path(path).read_text(encoding="utf-8").splitlines(), 1) if text.strip().startswith("[[limits]]")]
    problems = [(str(path), key, "is not known here", "format, floor_factor, limits") for key in set(content) - {"format", "floor_factor", "limits"}]
    for i, (start, limit) in enumerate(zip(starts, content.get("limits", []))):
        zones, measures = places.get(limit.get("where"), ((), ()))
        allowed = {"quantity": ("a name", lambda value: isinstance(value, str) and value != ""), "where": (", ".join(places), places.__contains__),
                   "zone": (", ".join(zones) or "none", zones.__contains__), "measure": (", ".join(measures), measures.__contains__),
                   "must": ("above 0", _positive), "aim": ("above 0", _positive), "must_worst": ("above 0", _positive)} | keys
        needed = ("quantity", "where", "measure", "must", *(keys or ["aim"]))
        for key, value in (dict.fromkeys(needed) | {"zone": ""} | limit).items():
            words, holds = allowed.get(key, (", ".join(allowed), lambda _: False))
            if not holds(value):
                problems.append((f"{path}:{start}", f"limits.{i}.{key}", "is missing" if value is None else f"is {value!r}", words))
    if problems or not starts:
        raise refused(problems or [(str(path), "limits", "is missing", "one table or more")])
    return content


def traction_ratios(header, x, z, fields):
    """Shear over normal traction on circles about the drum's axis, 5, 7, 9 and 11 d inside the wall (mean of the four), at -45, -40 ... 45 deg from below
    the axis, positive downslope: shape (19,); NaN where a map (nodes x, z; fields by name) does not reach."""
    axis, radius = float(header["axis_depth"]), float(header["drum_radius"])
    angle, r = np.radians(np.arange(-45, 46, 5))[:, None], radius - np.array([5.0, 7, 9, 11])
    s, c = np.sin(angle), np.cos(angle)
    xx, zz, xz = (scipy.interpolate.RegularGridInterpolator((z, x), fields[name], bounds_error=False)((axis - r * c, r * s))
                  for name in ("sigma_xx", "sigma_zz", "sigma_xz"))
    # Outward normal (s, -c), tangent (c, s); sigma_xz is minus the entry of the pressure tensor.
    on_x, on_z = xx * s + xz * c, -xz * s - zz * c
    return np.mean((c * on_x + s * on_z) / (s * on_x - c * on_z), axis=1)


def _traction_of(run):
    if not run.maps_file.exists():
        return np.full(19, math.nan)
    return traction_ratios(*result_files.read_maps(run.maps_file, ("sigma_xx", "sigma_zz", "sigma_xz"))[:4])


def _error(comparison, traction, limit):
    """(error of the second side against the first, whether it leaves places of the zone undefined); that of a scalar keeps its sign."""
    relative = limit["measure"] == "relative"
    if limit["where"] in ("centre", "map"):
        part = comparison if limit["where"] == "centre" else comparison["maps"] or {"errors": {}}
        zone = (part["errors"].get(limit["quantity"]) or {}).get(limit["zone"], {})
        return number(zone.get("rel_l2" if relative else "rms")), limit["where"] == "centre" and zone.get("undefined", 0) > 0
    if limit["where"] == "wall":
        return np.sqrt(np.mean(traction**2)), False
    sides = comparison["scalars"].get(limit["quantity"], {})
    particles, continuum = number(sides.get("particles")), number(sides.get("continuum"))
    return (continuum - particles) / (abs(particles) if relative else 1), False


def _errors(speed, limit, by, pairs, tractions):
    """(error of the flow, mean over its runs; the same between two of these, mean over pairs: the noise floor; whether the flow leaves places undefined).
    Of a scalar the mean of the signed differences, without its sign; of inside_interval that over the half width of the pooled interval."""
    flow, runs = speed
    if limit["where"] == "cost":
        return flow.cpu_seconds if flow.start.startswith("cold") == (limit["quantity"] == "seconds_cold") else math.nan, math.nan, False

    def error(first, second):
        return _error(pair(pairs, first, second, by), tractions and tractions[second.folder] - tractions[first.folder], limit)

    found = [error(run, flow) for run in runs]
    value, undefined = abs(mean([value for value, _ in found])), any(undefined for _, undefined in found)
    if limit["measure"] == "inside_interval":
        scalars = [run.scalars[limit["quantity"]] for run in runs if limit["quantity"] in run.scalars]
        return np.divide(value, pooled_speeds([scalars])[0].half), math.nan, undefined
    return value, mean([abs(error(*two)[0]) for two in itertools.combinations(runs, 2)]), undefined


def _row(speeds, limit, by, factor, pairs, tractions):
    found = [_errors(speed, limit, by, pairs, tractions) for speed in speeds]
    value, floor, undefined = np.array(found, float).reshape(-1, 3).T
    of_others, undefined = np.isnan(floor) & np.isfinite(floor).any(), undefined > 0
    floor = np.where(of_others, np.nanmean(floor) if of_others.any() else math.nan, floor)
    known, is_share = undefined | ~np.isnan(value), limit["measure"] == "inside_interval"

    def allowed(wanted):  # a limit below so many noise floors is judged against that
        return np.fmax(1.0 if is_share else wanted, factor * floor)

    def each(wanted):
        return ~undefined & (value <= allowed(wanted))

    def outcome(wanted):
        """At each speed, in the mean, or for a share of the speeds."""
        if is_share:
            holds = each(1)[known].sum() >= wanted * known.sum() - 1e-9
        elif "must_worst" in limit:
            holds = each(limit["must_worst"])[known].all() and value[known].sum() <= allowed(wanted)[known].sum()
        else:
            holds = each(wanted)[known].all()
        return "not_measured" if not known.any() else "met" if holds else "missed"

    worst = limit.get("must_worst", limit["must"])
    columns = {"rotation_rpm": [flow.rotation_rpm for flow, _ in speeds], "value": value.tolist(), "floor": floor.tolist(),
               "floor_of_other_speeds": of_others.tolist(), "limit": allowed(worst).tolist(), "met": np.where(known, each(worst), None).tolist()}
    cells = [dict(zip(columns, cell)) | ({"undefined": True} if one else {}) for one, *cell in zip(undefined, *columns.values())]
    numbers = {key: float(limit[key]) for key in ("must", "aim", "must_worst") if key in limit}
    return {"registered_by": by} | {key: limit.get(key, "") for key in ("quantity", "where", "zone", "measure")} | numbers | {
        "cells": cells, "must_outcome": outcome(limit["must"]), "aim_outcome": outcome(limit["aim"])}


@np.errstate(all="ignore")
def judged_limits(limits, runs, flows, pairs):
    """The key limits of study.json. limits: the content of a file drumlin-limits-1; pairs: as in compared_speeds(), by both registrations, the runs of a
    speed against one another as well. Runs that the law was fitted on judge only where their speed has no other."""
    fitted_on, speeds = set(flows[0].fitted_on), []
    for flow in sorted(flows, key=lambda flow: flow.rotation_rpm):
        here = [run for run in runs if same_speed(run.rotation_rpm, flow.rotation_rpm)]
        judges = [run for run in here if run.name not in fitted_on] or here
        if judges:
            speeds.append((flow, judges))
    judges = [run.name for _, runs in speeds for run in runs]
    walls = any(limit["where"] == "wall" for limit in limits["limits"])
    tractions = {run.folder: _traction_of(run) for flow, judging in speeds for run in [flow, *judging]} if walls else None
    return {"speeds_rpm": [flow.rotation_rpm for flow, _ in speeds],
            "judged_by": [name for name in judges if name not in fitted_on],
            "judged_by_calibrating_runs": [name for name in judges if name in fitted_on],
            "rows": [_row(speeds, limit, by, limits.get("floor_factor", 1.5), pairs, tractions)
                     for by in ("axis", "surface") for limit in limits["limits"]]}


def score(limits, runs, flow, pairs):
    """One flow judged by limits, against the runs at its speed that calibrated nothing: the content of score.json (docs/formats/score.md) but format, name
    and origins. Arguments as of judged_limits(); a limit of the mean over speeds holds for the one."""
    if problems := require_one_drum(runs[0], [flow]):
        raise refused(problems)
    require_one_study(runs)
    each = [{key: value for key, value in limit.items() if key != "must_worst"} for limit in limits["limits"]]
    judged, rows = judged_limits(limits | {"limits": each}, runs, [flow], pairs), []
    if not judged["rows"] or not judged["rows"][0]["cells"]:
        raise refused([(flow.name, "rotation", f"no run turns at {flow.rotation_rpm:.4g} rpm", "runs at the speed of what is scored")])
    for row in judged["rows"]:
        cell, name = row["cells"][0], ("registered_by", "quantity", "zone", "where", "measure")
        rows.append({key: row[key] for key in name} | {"error": cell["value"], "limit": cell["limit"], "must": row["must"], "aim": row["aim"],
                                                       "noise_floor": cell["floor"], "met": cell["met"]})
    by_axis = [row["met"] for row in rows if row["registered_by"] == "axis"]
    counts = {"met": by_axis.count(True), "missed": by_axis.count(False), "not_measured": by_axis.count(None)}
    return {"rotation_rpm": flow.rotation_rpm, "against": judged["judged_by"] or judged["judged_by_calibrating_runs"],
            "calibrated_on_them": not judged["judged_by"], "verdict": counts, "rows": rows}
