"""What past strain adds to the amount of the stress: its dilatancy, the lag of its axes, creep (docs/theory/dilatancy.md)."""

import dataclasses
import itertools
import math

import numpy as np
import scipy.optimize
from drumlin import _drumlin
from drumlin.errors import InputError

from .paths import Paths, half_width, rms, without_each

FLOW = 1e-2  # I, above which mu grows faster and faster with ln I
RATIOS = (0.02, 0.035, 0.05, 0.07, 0.1)  # of |D|/|W|, below which creep counts
C_NU, C_PSI, C_SEEN = (2, 3, 4, 6, 8), (8, 12, 16, 24, 32), (2, 4, 6, 8, 12, 16, 24, 32)


def knots_beside(paths, knots, ratio):
    """Knots of mu(I) beside a creep: the first, which says from where on I is remembered, those above the I that the paths have where creep begins, in the
    mean of its logarithm, and in the flow octaves down from their largest I."""
    first, last, turning = knots[0], max(knots[0], paths.I.max()), paths.spin_share > 0
    begins = ratio * np.exp(np.mean(paths.ln_I[turning] + np.log(paths.spin_share[turning]))) if turning.any() else 0
    kept = [I for I in knots if I <= first or begins <= I <= min(FLOW, last) / 1.5]  # noqa: E741
    octaves = range(-max(0, math.floor(math.log2(last / FLOW))), 1)
    return kept + [last * 2.0**octave for octave in octaves if last * 2.0**octave > kept[-1]]


class Memory:
    """What is added to mu(I) at the ends of paths. `axes`: the law of the axes; `ends`: of the I that are remembered."""

    def __init__(self, paths, axes, ends):
        self.paths, self.ends = paths, np.log(ends)
        self.lag = paths.of(lambda bed: bed.lag(axes.c, axes.chi, axes.I_low, axes.I_high))

    def felt(self, c_nu, c_psi):
        """The dilatancy over the swelling: what relaxes with c_psi to c_nu (ln I - L), L with c_nu to ln I, is the difference of two means."""
        late, early = (self.paths.of(lambda bed: bed.carried_ln_I(c, *self.ends)) for c in (c_psi, c_nu))  # pylint: disable=cell-var-from-loop
        return c_nu * c_psi / (c_psi - c_nu) * (late - early)

    def crept(self, ratio):
        """What creep takes off per slope."""
        with np.errstate(divide="ignore"):
            return np.minimum(0, -np.log(ratio * self.paths.spin_share))

    def added(self, law):
        creep = law["creep"]["slope"] * self.crept(law["creep"]["ratio"]) if "creep" in law else 0
        return law["swelling"] * self.felt(law["c_nu"], law["c_psi"]) - law["lag"] * self.lag + creep


class Trial:
    """Least squares of the amount of all paths: the first value of a table straight in ln I and its growth from knot to knot, none below its least, and a
    dilatancy's coefficient, lag and slope of creep."""

    def __init__(self, memory, knots, ratio, dilatancy):
        paths, ln_knots = memory.paths, np.log(knots)
        growths = np.clip((paths.ln_I[:, None] - ln_knots[:-1]) / np.diff(ln_knots), 0, 1)
        self.knots, self.ratio, self.sector = knots, ratio, paths.sector
        self.rows = np.column_stack([np.ones(len(growths)), growths, dilatancy, -memory.lag, memory.crept(ratio)])
        self.values, self.least = np.abs(paths.stress), np.array(_drumlin.least_growths(knots) + [-np.inf, -np.inf, 0])
        self.more = self._solution()[-3:]
        self.rms = rms(self.rows @ self._solution() - self.values)

    def _solution(self, kept=slice(None)):
        return scipy.optimize.lsq_linear(self.rows[kept], self.values[kept], (self.least, np.inf), method="bvls").x

    @property
    def is_determined(self):
        """All but a creep that no path has."""
        return np.linalg.matrix_rank(self.rows.T @ self.rows) == self.rows.shape[1] - (not self.rows[:, -1].any())

    def intervals(self):
        """Of the three, over the sectors of the drum."""
        return [half_width(values) for values in np.transpose([self._solution(rest)[-3:] for rest in without_each(self.sector)])]


def seen(memory, best):
    """The same with the dilatancy that the particles show in place of the law's: no part of the law, its check; None where nothing dilates."""
    trials = []
    for c_psi in C_SEEN:
        trials.append((c_psi, Trial(memory, best.knots, best.ratio, memory.paths.of(lambda bed: bed.carried_dilatancy(c_psi)))))  # pylint: disable=W0640
        if not trials[-1][1].is_determined:
            return None
    c_psi, trial = min(trials, key=lambda one: one[1].rms)
    return {"coefficient": {"value": trial.more[0], "ci99_sectors": trial.intervals()[0]}, "c_psi": c_psi, "lag": trial.more[1], "rms": trial.rms}


@dataclasses.dataclass
class Found:
    """`law`: as [memory.amount]; `table`: mu(I) of steady simple shear; `ci99`: of swelling, lag, creep; scores of runs and of what was held out."""

    law: dict
    table: object
    ci99: list
    trials: list
    measured: dict | None
    scores: list
    predictions: list


def _score(name, memory, found):
    """rms of |s|/p with memory and by mu(I) alone, in the bed and in the flow."""
    paths, amount = memory.paths, np.abs(memory.paths.stress)
    law, table = found.law, found.table
    mu = _drumlin.memory_friction(table.knots, np.cumsum(table.coefficients), law["own_weight"], paths.I)
    left = amount - mu - memory.added(law), amount - paths.amount
    return {"run": name} | {zone: dict(zip(("rms", "rms_alone"), (rms(one[there]) for one in left)))
                            for zone, there in (("bed", paths.in_bed), ("flow", ~paths.in_bed))}


def amount_of(runs, held_out, axes, alone, own_weight):
    """`runs`, `held_out`: names and beds, with this own weight; `axes`: the law of the axes; `alone`: mu(I) without memory, whose knots are kept. Nothing of
    what is held out enters but the predictions."""
    paths = Paths([bed for _, bed in runs], alone.at)
    ends = np.array(knots_beside(paths, alone.knots, 0))[[0, -1]]
    memory, trials = Memory(paths, axes, ends), []
    felt = {(c_nu, c_psi): memory.felt(c_nu, c_psi) for c_nu, c_psi in itertools.product(C_NU, C_PSI) if c_nu < c_psi}
    for ratio in RATIOS:
        knots = knots_beside(paths, alone.knots, ratio)
        for rates, dilatancy in felt.items():
            trials.append((rates, Trial(memory, knots, ratio, dilatancy)))
            if not trials[-1][1].is_determined:
                raise InputError("--amount: the paths do not determine what the past adds to the amount of the stress")
    (c_nu, c_psi), best = min(trials, key=lambda one: one[1].rms)
    swelling, lag, creep = best.more
    if not (swelling > 0 and abs(lag) <= 1):
        raise InputError(f"--amount: the runs show a swelling of {swelling:.3g} and a lag of {lag:.3g} (allowed: a swelling above 0, a lag between -1 and 1): "
                         "the amount of their stress does not remember as the law says; leave --amount out")
    law = {"swelling": swelling, "c_nu": c_nu, "c_psi": c_psi, "lag": lag, "own_weight": own_weight}
    if creep > 0:
        law["creep"] = {"slope": creep, "ratio": best.ratio}
    fitted, others = ([(name, Memory(Paths([bed], alone.at), axes, ends)) for name, bed in group] for group in (runs, held_out))
    left = [[one.paths.I, np.abs(one.paths.stress) - one.added(law), 0 * one.paths.I, 0 * one.paths.I] for _, one in fitted]
    table = _drumlin.fitted(left, "table", best.knots, slope_besides=_drumlin.followed_slope(swelling, c_nu))
    found = Found(law, table, best.intervals(), [{"c_nu": rates[0], "c_psi": rates[1], "creep_ratio": trial.ratio, "rms": trial.rms} for rates, trial in trials],
                  seen(memory, best), [], [])
    found.scores, found.predictions = ([_score(name, one, found) for name, one in group] for group in (fitted, others))
    return found
