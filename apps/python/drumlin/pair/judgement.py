"""The limits of data/limits/pair.toml, each on the pair that it judges."""

import functools
import math
import re

import numpy as np

from ..study.limits import read_limits
from . import measures
from .geometry import at, normal_stress
from .measures import Mean

PLACES = {"height": (("",), ("rms",)), "field": (("flowing", "all"), ("relative",)), "load": (("",), ("difference",)), "slot": (("",), ("relative",)),
          "wall": (("",), ("relative",)), "scalar": (("",), ("relative", "difference", "inside_interval")), "run": (("",), ("value",))}
TIMES = re.compile(r"all|moving|pooled|steady|end|>= ([0-9.]+)")
KEYS = {"case": ("a name", lambda value: isinstance(value, str)), "times": ("all, moving, pooled, steady, end, >= a number",
                                                                            lambda value: isinstance(value, str) and TIMES.fullmatch(value))}


def read_pair_limits(path):
    """A file of limits of pairs; InputError, all faults at once, where it holds others than docs/formats/pair.md lists."""
    return read_limits(path, PLACES, KEYS)


class Pair:
    """Both sides on one grid: means, halves of the particles' ensemble, single runs. walls: of the scene; record: what is known of the continuum's run."""

    def __init__(self, particles, continuum, walls, record):
        self.sides, self.walls, self.record = (particles, continuum), walls, record
        self.floor = measures.floor_height(particles, continuum)
        self.particles, self.continuum = Mean(particles, self.floor), Mean(continuum, self.floor)
        self.halves = [tuple(Mean(particles, self.floor, half) for half in two) for two in measures.halvings(len(particles.runs))]
        self.weight = float(particles.header["nu_bulk"]) * self.particles.scalars["area"][0]
        self.loads = {name: measures.across(load) for name, load in self.particles.loads.items() if name in self.continuum.loads}

    @functools.cached_property
    def each_run(self):
        return [Mean(self.sides[0], self.floor, [run]) for run in range(len(self.sides[0].runs))]


def judged(limits, case, pair):
    """The rows of pair.json: each limit of the case, and of any."""
    return [_row(limit, limits.get("floor_factor", 1.0), pair) for limit in limits["limits"] if limit["case"] in (case, "any")]


def outcome_row(limit, factor, values, floors, times=None):
    """A limit with its values at the times that count, each with its noise floor (NaN: none): the worst of them is told."""
    values, floors = np.atleast_1d(values).astype(float), np.broadcast_to(np.atleast_1d(floors), np.shape(np.atleast_1d(values)))
    known, shares = np.isfinite(values), limit["measure"] == "inside_interval"

    def allowed(wanted):
        return np.full(values.shape, wanted) if shares else np.fmax(wanted, factor * floors)

    def outcome(wanted):
        if wanted is None or not known.any():
            return None if wanted is None else "not_measured"
        return "met" if np.all((values >= allowed(wanted) if shares else np.abs(values) <= allowed(wanted))[known]) else "missed"

    row = {key: limit.get(key) for key in ("case", "quantity", "where", "zone", "measure", "times", "must", "aim")}
    row |= {"value": math.nan, "floor": math.nan, "limit": math.nan, "time": math.nan}
    if known.any():
        worst = np.flatnonzero(known)[0] if shares else np.nanargmax(np.abs(values) / allowed(limit["must"]))
        row |= {"value": values[worst], "floor": floors[worst], "limit": allowed(limit["must"])[worst],
                "time": times[worst] if times is not None and len(times) == len(values) else math.nan}
    return row | {"must_outcome": outcome(limit["must"]), "aim_outcome": outcome(limit.get("aim"))}


def _row(limit, factor, pair):
    values, floors = _OF[limit["where"]](limit, pair)
    times = pair.particles.frames.times
    if np.ndim(values) and len(values) == len(times):
        chosen = times_chosen(limit["times"], pair)
        values, floors, times = values[chosen], floors[chosen] if np.ndim(floors) else floors, times[chosen]
    return outcome_row(limit, factor, values, floors, times)


def times_chosen(words, pair):
    times = pair.particles.frames.times
    if words == "moving":
        stop = measures.stopped(times, pair.particles.scalars["kinetic_energy"])
        return times <= (times[-1] if math.isnan(stop) else stop)
    if words == "end":
        return times == times[-1]
    if since := re.fullmatch(r">= ([0-9.]+)", words):
        return times >= float(since[1]) * math.sqrt(measures.fill_height(pair.particles)) - 1e-6
    return np.ones(len(times), bool)


def _beside(measure, pair):
    return measure(pair.particles, pair.continuum), measures.noise_floor(measure, pair.halves)


def _height(_, pair):
    return _beside(measures.height_error("h"), pair)


def _field(limit, pair):
    names = ("v_x", "v_z") if limit["quantity"] == "v" else (limit["quantity"],)
    return _beside(measures.field_error(names, limit["zone"], limit["times"] == "pooled"), pair)


def _load(limit, pair):
    name = limit["quantity"]
    return _beside(measures.load_error(name, pair.loads[name], pair.weight), pair) if name in pair.loads else (math.nan, math.nan)


def _slot(limit, pair):
    if pair.walls.slot() is None:
        return math.nan, math.nan
    (x0, x1), z = pair.walls.slot()
    x = pair.particles.frames.x

    def take(side):
        row = np.abs(side.frames.z - z - 2).argmin()
        return measures.in_steady_part(side, limit["quantity"])[row, (x >= x0) & (x <= x1)]
    return _beside(measures.profile_error(take), pair)


def _wall(limit, pair):
    particles = measures.in_steady_part(pair.particles, "sigma_zz")
    lines = pair.walls.inside(limit["quantity"], 2.0, lambda points: np.isfinite(at(pair.sides[0], particles, points)))

    def take(side):
        return normal_stress(side.frames, {name: measures.in_steady_part(side, name) for name in ("sigma_xx", "sigma_zz", "sigma_xz")}, lines)
    return _beside(measures.profile_error(take), pair) if lines else (math.nan, math.nan)


def _scalar(limit, pair):
    name = limit["quantity"]
    if name == "rate_offset":  # of several pairs (rate_offsets)
        return math.nan, math.nan
    if limit["measure"] == "inside_interval":
        taken = {"slope_deg": measures.surface_slopes}.get(name, lambda frames, run: frames.scalars[name][run])
        particles, continuum = pair.sides
        value, half = measures.interval(np.array([taken(particles, run) for run in range(len(particles.runs))]))
        inside, known = np.abs(taken(continuum, 0) - value) <= half, np.isfinite(half + value)
        return (inside[known].mean() if known.any() else math.nan), math.nan
    take = {"rate": measures.rate, "repose_deg": measures.repose_angle}[name]

    def measure(first, second):
        return abs(take(second) - take(first)) / (abs(take(first)) if limit["measure"] == "relative" else 1)
    return _beside(measure, pair)


def _run(limit, pair):
    if limit["quantity"] != "mass":
        return pair.record.get(limit["quantity"], math.nan), math.nan
    side = pair.continuum.scalars
    return np.abs(side["area"] + np.nan_to_num(side["discharged"]) - side["area"][0]) / side["area"][0], math.nan


_OF = {"height": _height, "field": _field, "load": _load, "slot": _slot, "wall": _wall, "scalar": _scalar, "run": _run}


def offset(widths, rates):
    """k of rate = C (width - k)^1.5, by least squares of rate^(2/3)."""
    slope, at_zero = np.polyfit(widths, np.power(rates, 2 / 3), 1)
    return -at_zero / slope


def rate_offsets(limits, contents):
    """Several contents of pair.json of one silo with other slots: the row rate_offset of each, and k of both sides."""
    widths = np.array([content["slot_width"] for content in contents])
    rates = {side: np.array([content["rate"][side] for content in contents]) for side in ("particles", "continuum")}
    k = {side: offset(widths, found) for side, found in rates.items()}
    mended = rates["continuum"] * ((widths - k["particles"]) / (widths - k["continuum"])) ** 1.5
    limit = next(limit for limit in limits["limits"] if limit["quantity"] == "rate_offset")
    factor = limits.get("floor_factor", 1.0)
    return {"k": k, "rows": [outcome_row(limit, factor, value, math.nan) for value in np.abs(mended / rates["particles"] - 1)]}


def against_heights(limits, case, frames, table):
    """The row of a case of published heights, from the continuum's frames and the rows of data/pair/heights.csv (read_rows) of one curve. A height between
    two frames is taken in between; lengths of the table are in the fill's height, x from the middle, here x = 0."""
    side = Mean(frames, measures.floor_height(frames))
    height = measures.fill_height(side)
    end, found = frames.times[-1] / math.sqrt(height), {}
    for row in table:
        time = end if row["time"] == "rest" else float(row["time"])
        if time <= end * (1 + 1e-6):
            after = np.array([np.interp(row["x"] * height, frames.x, h) for h in side.h])
            found.setdefault(time, []).append(np.interp(time * math.sqrt(height), frames.times, after) / height - row["h"])
    limit = next(limit for limit in limits["limits"] if limit["case"] == case and limit["where"] == "height")
    since = TIMES.fullmatch(limit["times"])[1]
    rms = {time: math.sqrt(np.mean(np.square(differences))) for time, differences in found.items()}
    chosen = [time for time in rms if time >= float(since or 0)]
    return outcome_row(limit, 1.0, [rms[time] for time in chosen], math.nan, chosen) | {"rms": rms}


def against_rates(limits, found, table, unit=30):
    """The row of each published slot (rows of data/pair/silo-rates.csv) among `found`, {half width: the continuum's frames}, by its greatest rate; `unit`:
    of the table's lengths, d. The narrowest is told, not judged."""
    limit = next(limit for limit in limits["limits"] if limit["case"] == "lagree-silo")
    rows, narrowest = [], min(row["half_width"] for row in table)
    for published in table:
        if frames := found.get(published["half_width"]):
            rate = np.nanmax(frames.scalars["discharge_rate"][0]) / unit**1.5
            row = outcome_row(limit, 1.0, rate / published["rate"] - 1, math.nan) | {"half_width": published["half_width"], "rate": rate}
            rows.append(row | {"must_outcome": None, "aim_outcome": None} if published["half_width"] == narrowest else row)
    return rows
