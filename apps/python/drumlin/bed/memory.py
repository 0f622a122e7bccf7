"""The memory of the stress's axes: its coefficients by least squares along the paths, and what the runs cannot tell of them."""

import dataclasses
import itertools
import math
import typing

import numpy as np
import scipy.optimize
from drumlin import _drumlin
from drumlin.errors import InputError

from .paths import BED, SECTOR_DEG, Paths, half_width, rms, student_99, without_each

SOFT = 0.05  # of s/p, beyond which a misfit counts less than its square
LEAST, MOST = np.array([math.log(0.3), 0, -np.inf]), np.array([math.log(100), 2, np.inf])  # of ln c, m, chi
NAMES = ("c", "m", "chi")


class Axes(typing.NamedTuple):
    """v.grad A + 2 i W A = 2 c |D| (e^(i chi(I)) n - A), s/p = mu(I) (n + m A)/rho; chi in rad below I_low, atan(1/c) above I_high; rho is |n + m A|, carried
    with c_rho or at once (None)."""

    c: float
    m: float
    chi: float
    c_rho: float | None = None
    I_low: float = 1e-3
    I_high: float = 1e-2


FIRST_GUESS = Axes(6, 1, 0.5)


@dataclasses.dataclass
class Fit:
    """Coefficients that make the mean bounded square `cost` least; intervals and correlations (of c and m, c and chi, m and chi) by leaving out sectors of
    the drum, one step from the minimum, and from the spread of what each run gives alone. NaN of what is held or was not found."""

    law: Axes
    free: np.ndarray
    converged: bool
    paths: int
    rms: float
    cost: float
    cost_without: np.ndarray
    ci99_sectors: np.ndarray
    correlation: list
    ci99_runs: np.ndarray = dataclasses.field(default_factory=lambda: np.full(3, np.nan))


def _numbers(law):
    return np.array([math.log(law.c), law.m, law.chi])


def _law(x, held):
    return held._replace(c=math.exp(x[0]), m=float(x[1]), chi=float(x[2]))


def _misfit(paths, x, held):
    return paths.stress - paths.amount * paths.axes(_law(x, held))


def _minimum(paths, start, free):
    """(ln c, m, chi; whether it was found) of the least sum of bounded squares."""
    x = _numbers(start)

    def placed(moved):
        at = x.copy()
        at[free] = moved
        return at

    def roots(moved):
        r = _misfit(paths, placed(moved), start)
        return (r * np.sqrt(2 / (1 + np.sqrt(1 + np.abs(r / SOFT) ** 2)))).view(float)

    found = scipy.optimize.least_squares(roots, x[free], bounds=(LEAST[free], MOST[free]), ftol=None, gtol=None, xtol=1e-10)
    return placed(found.x), found.success


def _reported(x):
    return np.array([math.exp(x[0]), x[1], x[2]])


def fit(paths, start, free=(True, False, True)):
    """The law from `start`, of which what is not free is held."""
    free = np.array(free)
    x, converged = _minimum(paths, start, free)
    r = _misfit(paths, x, start)
    step = 1e-4 * np.eye(3)[free]
    slopes = np.array([(_misfit(paths, x - h, start) - _misfit(paths, x + h, start)) / 2e-4 for h in step])
    weighted = slopes.conj() / np.sqrt(1 + np.abs(r / SOFT) ** 2)
    squares = 2 * SOFT**2 * (np.sqrt(1 + np.abs(r / SOFT) ** 2) - 1)
    without, costs = [], []
    for rest in without_each(paths.sector):
        moved = x.copy()
        moved[free] += np.linalg.lstsq((weighted[:, rest] @ slopes[:, rest].T).real, (weighted[:, rest] @ r[rest]).real, rcond=None)[0]
        without.append(_reported(moved))
        costs.append(np.mean(squares[rest]))
    without = np.transpose(without)
    told = free & (len(costs) > 2)
    with np.errstate(invalid="ignore"):
        together = np.corrcoef(without) if len(costs) > 2 else np.full((3, 3), np.nan)
    return Fit(_law(x, start), free, bool(converged), r.size, rms(r), np.mean(squares), np.array(costs),
               np.array([half_width(one) if known else math.nan for one, known in zip(without, told)]),
               [together[j, k] if free[j] and free[k] else math.nan for j, k in itertools.combinations(range(3), 2)])


def add_run_intervals(paths_of_runs, found):
    """ci99_runs, with two runs at least."""
    if len(paths_of_runs) < 2 or not all(paths.sector.size for paths in paths_of_runs):
        return
    alone = [_minimum(paths, found.law, found.free) for paths in paths_of_runs]
    if all(settled for _, settled in alone):
        values = np.array([_reported(x) for x, _ in alone])
        half = student_99(len(alone)) / math.sqrt(len(alone)) * np.std(values, axis=0, ddof=1)
        found.ci99_runs = np.where(found.free, half, np.nan)


def _turned_deg(a, b=1j):
    """Angles from the axes of b, unless told those of simple shear, to those of a."""
    return np.degrees(np.angle(a * np.conj(b))) / 2


def score(name, paths, law):
    """What is left of a run's s/p and of its axes, in the bed and in the flow; without memory: by mu(I) n."""
    predicted, coaxial = paths.amount * paths.axes(law), paths.amount * paths.axis
    zones = {}
    for zone, there in (("bed", paths.in_bed), ("flow", ~paths.in_bed)):
        off, axes_off, coaxial_off, coaxial_axes_off = (rms(values[there]) for values in (
            paths.stress - predicted, _turned_deg(paths.stress, predicted), paths.stress - coaxial, _turned_deg(paths.stress, coaxial)))
        zones[zone] = {"paths": int(there.sum()), "rms": off, "axes_deg": axes_off, "rms_without_memory": coaxial_off,
                       "axes_deg_without_memory": coaxial_axes_off}
    return {"run": name} | zones


def axes_on_arcs(paths, law, drum_radius):
    """Axes along arcs about the drum's axis, means over 5 deg with three paths at least."""
    arcs, predicted, bins = [], paths.amount * paths.axes(law), np.rint(np.degrees(paths.angle) / 5)
    for middle in np.array([0.87, 0.75, 0.63]) * drum_radius:
        near = np.abs(paths.radius - middle) <= 2
        groups = [near & (bins == one) for one in np.unique(bins[near]) if np.sum(near & (bins == one)) >= 3]

        def means(values):
            return [values[group].mean() for group in groups]  # pylint: disable=cell-var-from-loop

        arcs.append({"radius": [middle - 2, middle + 2], "angle_deg": [5 * one for one in means(bins)]}
                    | {key: [_turned_deg(one) for one in means(values)]
                       for key, values in (("stress_deg", paths.stress), ("law_deg", predicted), ("strain_rate_deg", paths.axis))}
                    | {"amount": means(np.abs(paths.stress)), "law_amount": means(np.abs(predicted))})
    return arcs


def dilation(blocks):
    """mu along the strain rate and div v/(2|D|) upstream and downstream by half decades of I; slope: 1 would be Taylor's stress-dilatancy."""
    shares = []
    for low in np.power(10, 0.5 * np.arange(-11, -2)):
        there = (blocks["I"] >= low) & (blocks["I"] < low * math.sqrt(10))
        halves = {name: {"points": int(half.sum())} | {key: np.mean(blocks[key][half]) if half.any() else math.nan for key in ("mu", "dilatancy")}
                  for name, half in (("upstream", there & (blocks["x"] < 0)), ("downstream", there & (blocks["x"] > 0)))}
        (up, down) = halves.values()
        if up["points"] or down["points"]:
            with np.errstate(all="ignore"):
                shares.append({"I": [low, low * math.sqrt(10)]} | halves | {"slope": np.divide(up["mu"] - down["mu"], up["dilatancy"] - down["dilatancy"])})
    return shares


def require_bed(paths):
    bed, sectors = int(paths.in_bed.sum()), np.unique(paths.sector[paths.in_bed]).size
    if bed < 100 or sectors < 5:
        raise InputError(f"--memory: too little bed: {bed} paths end where I < {BED:g}, in {sectors} sectors of {SECTOR_DEG:g} deg (needed: 100 in 5); the "
                         "axes of the stress remember in the bed alone, so take runs of a larger drum")


def told_apart(at_once, carried):
    """Whether the cost with a carried rho lies further off than its 99 % interval over the sectors."""
    differences = carried.cost_without - at_once.cost_without
    return bool(differences.size > 2 and carried.cost - at_once.cost > half_width(differences))


@dataclasses.dataclass
class Found:
    """free: all three coefficients, rho at once; bed_alone: over paths that end in the bed, with chi at every I; bounded: m at most 1; leads: ranges of I
    over which chi falls, with their cost; carried: [(a fit with c_rho, told apart from rho at once)], the first at once; law: what a flow can solve."""

    leads: list
    free: Fit
    bed_alone: Fit
    bounded: Fit
    carried: list
    law: Axes

    @property
    def lead(self):
        return min(self.leads, key=lambda trial: trial["cost"])


def axes_of(beds, amount):
    """The memory of the axes of the beds of several runs."""
    paths, of_runs = Paths(beds, amount), [Paths([bed], amount) for bed in beds]
    require_bed(paths)
    leads, start = [], FIRST_GUESS
    for low, high in itertools.product((1e-3, 3e-3, 1e-2, 3e-2), (1e-2, 3e-2, 1e-1)):
        if low < high:
            trial = fit(paths, start._replace(I_low=low, I_high=high))
            leads.append({"I_low": low, "I_high": high, "cost": trial.cost})
            start = trial.law
    best = min(leads, key=lambda trial: trial["cost"])
    free = fit(paths, FIRST_GUESS._replace(I_low=best["I_low"], I_high=best["I_high"]), (True, True, True))
    add_run_intervals(of_runs, free)
    bed_alone = fit(Paths(beds, amount, paths.in_bed), FIRST_GUESS._replace(I_low=1e6, I_high=1e7), (True, True, True))  # beyond every I
    add_run_intervals([Paths([bed], amount, run.in_bed) for bed, run in zip(beds, of_runs)], bed_alone)
    bounded = free
    if free.law.m > 1:
        bounded = fit(paths, free.law._replace(m=1))
        add_run_intervals(of_runs, bounded)
    carried = [(bounded, False)]
    for c_rho in (30, 100, 300, 1000):
        trial = fit(paths, bounded.law._replace(c_rho=c_rho))
        carried.append((trial, told_apart(bounded, trial)))
    return Found(leads, free, bed_alone, bounded, carried, min((trial for trial, _ in carried[1:]), key=lambda trial: trial.cost).law)


def untold(found, table, beds):
    """What the runs cannot tell, as sentences."""
    free, bounded, said = found.free, found.bounded, []
    if not (free.converged and bounded.converged):
        said.append("the fit did not settle: c, m and chi are not determined by these runs")
    for (one, other), correlation in zip(itertools.combinations(NAMES, 2), free.correlation):
        if abs(correlation) > 0.7:
            said.append(f"{one} and {other} move together (correlation {correlation:+.2f} over the sectors): their intervals are not independent")
    if free.law.m > 1:
        said.append(f"m: {free.law.m:.2f} +- {free.ci99_sectors[1]:.2f} fits best; a law whose stress does no negative work has m <= 1, which is held "
                    f"(cost {100 * (bounded.cost / free.cost - 1):+.1f} %)")
    alike = [f"{trial.law.c_rho:g} (cost {100 * (trial.cost / bounded.cost - 1):+.0f} %)" for trial, apart in found.carried[1:] if not apart]
    said.append(f"c_rho: not distinguished from rho at once with 99 %: {', '.join(alike)}; {found.law.c_rho:g} is taken" if alike else
                "c_rho: rho at once fits better than each value tried; the best of them is taken, since a flow needs one")
    alike = [f"{trial['I_low']:g} to {trial['I_high']:g}" for trial in found.leads if trial is not found.lead and trial["cost"] < 1.05 * found.lead["cost"]]
    if alike:
        said.append(f"chi(I): a fall over I = {', '.join(alike)} fits within 5 % of the best")
    said.append(f"|s|/p below I = {table.range[0]:.1e} and above {table.range[1]:.1e}: no point; the table goes on straight in ln I")
    if table.held:
        said.append(f"|s|/p: {table.held} of {len(table.knots) - 1} intervals of the table are as flat as a well-posed law can be; the points require less")
    if len(beds) < 2:
        said.append("one run alone: what differs from run to run is not known")
    if min(bed.share_from_displacements for bed in beds) < 0.3:
        said.append("maps without motion from displacements: the strain rate of the bed is that of velocities, with more noise; measure the runs anew")
    return said


def bed_line(runs):
    """a + b ln I through the amounts below BED, None of fewer than ten."""
    bed = np.hstack(runs)
    bed = bed[:, bed[0] < BED]
    return _drumlin.fitted([list(bed)], "log") if bed.shape[1] >= 10 else None
