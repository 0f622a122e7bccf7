"""What two sides of a pair are compared by, over time: the definitions of data/limits/pair.toml. Units d, sqrt(d/g), rho0 g d.

A measure takes the means of two sides (Mean) and gives a number at each time, or one; of the halves of an ensemble it is the noise floor.
"""

import itertools
import math

import numpy as np
import scipy.stats

FLOWS = 1e-3  # inertial number from which material counts as flowing
AT_REST = 1e-2  # share of the greatest kinetic energy
STEADY = (0.1, 0.5)  # of the fill's area discharged
RUN_OUTS = (1, 3, 5)  # d of height
DENSE = 0.75  # of nu_bulk, which the kernel leaves nowhere in a column on an upright wall
MOST_HALVINGS = 35


class Mean:
    """The mean of some runs of a side: fields where at least half of them have material, heights above `floor` (over x) with 0 where there is nothing."""

    def __init__(self, frames, floor, runs=None):
        runs = list(range(len(frames.runs))) if runs is None else runs
        self.frames, self.floor = frames, floor
        self.h = np.nan_to_num(frames.height[runs] - floor).clip(0).mean(axis=0)
        self.mass_height = np.nan_to_num(frames.mass_height[runs]).mean(axis=0)
        there = np.isfinite(frames.fields["v_x"][runs]).sum(axis=0) >= max(1, len(runs) / 2)
        self.fields = {name: np.where(there, _mean(values[runs]), np.nan) for name, values in frames.fields.items()}
        self.scalars = {name: _mean(values[runs]) for name, values in frames.scalars.items()}
        self.loads = {name: _mean(values[runs]) for name, values in frames.loads.items()}
        self.dense = (np.nan_to_num(self.fields["nu"]) > DENSE * float(frames.header["nu_bulk"])).any(axis=1)  # over times and x

    def flowing(self):
        return np.nan_to_num(self.fields["I"]) > FLOWS


def _mean(values):
    """Over the runs that have a value."""
    known = np.isfinite(values)
    return np.divide(np.where(known, values, 0).sum(axis=0), known.sum(axis=0), out=np.full(values.shape[1:], np.nan), where=known.any(axis=0))


def floor_height(*sides):
    """Over x: the lowest node at which nu of any side is ever half of nu_bulk; NaN where it never is."""
    there = np.any([(frames.fields["nu"] >= float(frames.header["nu_bulk"]) / 2).any(axis=(0, 1)) for frames in sides], axis=0)
    return np.where(there.any(axis=0), sides[0].z[there.argmax(axis=0)], np.nan)


def halvings(runs):
    """The ways to part so many runs into two halves of one size, [(first, second)]; of an odd number one run is left out in turn."""
    found = []
    for left_out in ([None] if runs % 2 == 0 else range(runs)):
        kept = [run for run in range(runs) if run != left_out]
        for first in itertools.combinations(kept, len(kept) // 2):
            if kept and kept[0] in first:
                found.append((list(first), [run for run in kept if run not in first]))
    return found[::max(1, math.ceil(len(found) / MOST_HALVINGS))] if runs > 1 else []


def noise_floor(measure, halves):
    """Root mean square of a measure over pairs of halves; NaN of one run."""
    values = [measure(*two) for two in halves]
    return np.sqrt(np.mean(np.square(values), axis=0)) if values else math.nan


def height_error(of):
    """Root mean square over x of the difference of heights, over H0, where a side is dense; `of`: h or mass_height."""
    def measure(first, second):
        a, b = getattr(first, of), getattr(second, of)
        there = first.dense | second.dense
        return np.sqrt(_over(np.where(there, (b - a) ** 2, 0).sum(axis=-1), there.sum(axis=-1))) / fill_height(first)
    return measure


def fill_height(side):
    """Of the material at the origin: what has left through a slot later lies deeper."""
    there = side.fields["nu"][0] >= float(side.frames.header["nu_bulk"]) / 2
    return np.max((side.h[0] + side.floor - side.frames.z[there.argmax(axis=0)])[there.any(axis=0)])


def field_error(names, zone, pooled, there=None):
    """Norm of the difference over that of the first side, at each time or over all times; zone: flowing or all; `there`: masks more."""
    def measure(first, second):
        a, b = (np.array([side.fields[name] for name in names]) for side in (first, second))
        known = np.isfinite(a).all(axis=0) & np.isfinite(b).all(axis=0)
        known &= first.flowing() if zone == "flowing" else True
        known &= True if there is None else there
        over = None if pooled else (0, 2, 3)
        return np.sqrt(_over(np.where(known, (b - a) ** 2, 0).sum(axis=over), np.where(known, a**2, 0).sum(axis=over)))
    return measure


def load_error(name, component, weight):
    def measure(first, second):
        return np.abs(second.loads[name] - first.loads[name])[:, component] / weight
    return measure


def across(load):
    """The component, 0 or 1, in which a load (T, 2) is the greater over time."""
    return int(np.argmax(np.nansum(load**2, axis=0)))


def run_out(side, least):
    """How far the material reaches along x with a height above `least`, less that at the origin, over the width of the fill at that height."""
    above = side.h > least
    reach = np.where(above.any(axis=-1), side.frames.x[above.shape[1] - 1 - above[:, ::-1].argmax(axis=-1)], np.nan)
    width = reach[0] - side.frames.x[above[0].argmax()]
    return _over(reach - reach[0], width)


def stopped(times, energy):
    """The first time from which the kinetic energy stays below a share of its greatest; NaN where the last frame still moves."""
    moving = np.flatnonzero(~(energy < AT_REST * np.nanmax(energy)))
    if not len(moving):
        return times[0]
    return times[moving[-1] + 1] if moving[-1] + 1 < len(times) else math.nan


def steady_part(side):
    """(begin, end) of the discharge's steady part; NaN where so much never left."""
    share = side.scalars["discharged"] / side.scalars["area"][0]
    return tuple(np.interp(limit, share, side.frames.times, left=math.nan, right=math.nan) if np.nanmax(share) > 0 else math.nan for limit in STEADY)


def rate(side):
    begin, end = steady_part(side)
    return (STEADY[1] - STEADY[0]) * side.scalars["area"][0] / (end - begin)


def in_steady_part(side, name):
    """A field's mean over the frames of the steady part, NaN where there are none."""
    begin, end = steady_part(side)
    chosen = (side.frames.times >= begin) & (side.frames.times <= end)
    return _mean(side.fields[name][chosen])


def profile_error(take):
    """Relative difference of what `take(side)` gives, an array."""
    def measure(first, second):
        a, b = take(first), take(second)
        known = np.isfinite(a) & np.isfinite(b)
        return np.sqrt(_over(np.sum((b - a)[known] ** 2), np.sum(a[known] ** 2)))
    return measure


def slope_deg(x, h, chosen):
    """Of the line through heights, from +x anticlockwise; NaN of fewer than three."""
    return math.degrees(math.atan(np.polyfit(x[chosen], h[chosen], 1)[0])) if chosen.sum() > 2 else math.nan


def surface_slopes(frames, run):
    """At each time, of the middle half of the surface."""
    def one(h):
        at = np.flatnonzero(np.isfinite(h))
        quarter = len(at) // 4
        return slope_deg(frames.x, h, np.isin(np.arange(len(h)), at[quarter:len(at) - quarter]))
    return np.array([one(h) for h in frames.height[run]])


def repose_angle(side):
    """Beyond the bend, where the floor stops falling, in the last frame: of the heap's front between 0.2 and 0.8 of its height, positive downwards."""
    x, h, floor = side.frames.x, side.h[-1], side.floor
    beyond = np.arange(len(x)) >= np.flatnonzero(floor <= np.nanmin(floor) + 0.5)[0]
    top = np.where(beyond, h, -1).argmax()
    return -slope_deg(x, h, beyond & (np.arange(len(x)) >= top) & (h > 0.2 * h[top]) & (h < 0.8 * h[top]))


def interval(values):
    """(mean, half width of the 99 % interval) over the first axis; NaN of one run."""
    count = len(values)
    if count < 2:
        return values[0], np.full(values.shape[1:], np.nan)
    return values.mean(axis=0), scipy.stats.t.ppf(0.995, count - 1) * values.std(axis=0, ddof=1) / math.sqrt(count)


def _over(a, b):
    a, b = np.broadcast_arrays(a, b)
    return np.divide(a, b, out=np.full(b.shape, np.nan), where=b > 0)
