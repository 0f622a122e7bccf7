"""Means of runs and straight lines through points, with 99 % intervals (docs/theory/statistics.md). A half width that is NaN is not known."""

import math
import typing

import numpy as np
import scipy.special

NORMAL_99 = 2.5758293035489  # half width of a 99 % interval per standard error that is known


class Scalar(typing.NamedTuple):
    """A number and the half width of its 99 % interval; NaN for what was not measured, None where there is no interval."""

    value: float
    ci99: float | None = None

    @property
    def half(self):
        """The half width, NaN where there is none."""
        return math.nan if self.ci99 is None else self.ci99


ABSENT = Scalar(math.nan)


class Fit(typing.NamedTuple):
    """Coefficients of a law with their intervals; reduced_chi2 is NaN where no point has an interval, rms that of y about the law, unweighted."""

    coefficients: list
    reduced_chi2: float
    rms: float
    points: int


def mean(values):
    """sum x/n; NaN without values."""
    return sum(values) / len(values) if values else math.nan


def told_quantile_99(reduced_chi2, freedom):
    """Half width per standard error that was told, where `freedom` degrees of freedom of scatter give reduced_chi2 in units of what was told: the larger
    of the normal quantile and Student's t times sqrt(reduced_chi2), the longer of both as in Wiksten, Ruecker & Schwarzer, Stat. Med. 35 (2016) 2503."""
    if freedom < 1:
        return NORMAL_99
    return float(np.fmax(NORMAL_99, scipy.special.stdtrit(freedom, 0.995) * np.sqrt(reduced_chi2)))


def pooled_speeds(speeds):
    """The mean of a quantity at each of several speeds: speeds holds a list of Scalars, one a run, for each speed.

    Half width: sqrt(sum ci99^2)/n or, where larger, Student's t times the standard error by which the runs lie about the means of their speeds. The ratio
    of spread to intervals is taken for one at all speeds, so that their degrees of freedom add up. One run keeps its interval. NaN values are left out; a
    speed with a run that has no interval gets none."""
    pools, chi2, freedom = [], 0.0, 0
    for runs in speeds:
        known = [run for run in runs if math.isfinite(run.value)]
        value, count = mean([run.value for run in known]), len(known)
        told = math.sqrt(sum(run.half**2 for run in known)) / count if count else math.nan
        if math.isfinite(told) and count > 1:
            chi2 += sum(((run.value - value) * NORMAL_99 / run.half) ** 2 for run in known if run.half > 0)
            freedom += count - 1
        pools.append((value, told, count))
    widening = told_quantile_99(chi2 / freedom if freedom else math.nan, freedom) / NORMAL_99
    return [Scalar(value, told * (widening if count > 1 else 1) if math.isfinite(told) else None) for value, told, count in pools]


def straight_line(x, y, variance, offset=True):
    """((intercept, its variance), (slope, its variance), chi^2, degrees of freedom) of the line of least squares with weights 1/variance, through the
    origin without an offset; None where no two x differ (none differs from 0). The variances of the coefficients are those that follow from `variance`."""
    weight = 1 / variance
    middle_x, middle_y = (np.sum(weight * v) / np.sum(weight) if offset and v.size else 0.0 for v in (x, y))
    square = np.sum(weight * (x - middle_x) ** 2)
    if not square > 0:
        return None
    slope = np.sum(weight * (x - middle_x) * (y - middle_y)) / square
    intercept = middle_y - slope * middle_x
    of_intercept = 1 / np.sum(weight) + middle_x**2 / square if offset else 0.0
    chi2 = np.sum(weight * (y - intercept - slope * x) ** 2)
    return (intercept, of_intercept), (slope, 1 / square), chi2, x.size - (2 if offset else 1)


def fit_line(x, y, x_ci99=math.nan, y_ci99=math.nan, offset=True):
    """y = c0 + c1 x, or y = c x without an offset; arrays of shape (points,).

    Weights 1/(s_y^2 + (y' s_x)^2), s = ci99/2.576 ("effective variance": Orear, Am. J. Phys. 50 (1982) 912). Half width of a coefficient: the larger of
    2.576 standard errors by the points' intervals and Student's t times those by the scatter. Points without numbers are left out, and where some have an
    interval those without, which would count as exact. NaN with fewer points than coefficients; with as many the scatter says nothing."""
    x, y, x_ci99, y_ci99 = np.broadcast_arrays(*(np.asarray(v, float) for v in (x, y, x_ci99, y_ci99)))
    used = np.isfinite(x) & np.isfinite(y)
    told = bool((y_ci99[used] > 0).any())
    if told:
        used &= y_ci99 > 0
    x, y, x_ci99, y_ci99 = x[used], y[used], x_ci99[used], y_ci99[used]
    none = Fit([Scalar(math.nan, math.nan)] * (2 if offset else 1), math.nan, math.nan, x.size)
    if x.size < len(none.coefficients):
        return none
    errors_x, errors_y = (np.where(np.isfinite(v), v / NORMAL_99, 0) ** 2 for v in (x_ci99, y_ci99))
    line = straight_line(x, y, np.ones(x.size), offset)
    for _ in range(20):  # the weights depend on the slope, weakly
        if line is None:
            return none
        variance = errors_y + (line[1][0] if told else 0) ** 2 * errors_x
        line = straight_line(x, y, np.where(variance > 0, variance, 1), offset)
    *coefficients, chi2, freedom = line
    scatter = chi2 / freedom if freedom > 0 else math.nan
    if told:
        factor = told_quantile_99(scatter, freedom)
    else:
        factor = scipy.special.stdtrit(freedom, 0.995) * math.sqrt(scatter) if freedom > 0 else math.nan
    rms = np.sqrt(np.mean((y - line[0][0] - line[1][0] * x) ** 2))
    found = [Scalar(value, factor * np.sqrt(variance)) for value, variance in coefficients]
    return Fit(found if offset else found[1:], scatter if told else math.nan, rms, x.size)


def fit_power(x, y, x_ci99=math.nan, y_ci99=math.nan):
    """y = c x^p by the line through the logarithms (c, p; rms of ln y). Points that are not above 0 are left out."""
    x, y, x_ci99, y_ci99 = np.broadcast_arrays(*(np.asarray(v, float) for v in (x, y, x_ci99, y_ci99)))
    used = (x > 0) & (y > 0)
    x, y, x_ci99, y_ci99 = x[used], y[used], x_ci99[used], y_ci99[used]
    fit = fit_line(np.log(x), np.log(y), x_ci99 / x, y_ci99 / y)
    scale, power = fit.coefficients
    return fit._replace(coefficients=[Scalar(np.exp(scale.value), scale.half * np.exp(scale.value)), power])


class LogFriction(typing.NamedTuple):
    """mu = a + b ln I through points: rms of mu, Birge ratio (root of the reduced chi^2 without scatter beyond the errors; NaN where no error is known),
    number and range of the points."""

    a: Scalar
    b: Scalar
    rms: float
    birge_ratio: float
    points: int
    I_min: float
    I_max: float

    def rms_of(self, inertial, mu):
        return np.sqrt(np.mean((mu - self.a.value - self.b.value * np.log(inertial)) ** 2))


def fit_log_friction(inertial, mu, I_error, mu_error):
    """mu = a + b ln I as `drumlin measure` fits mu_a and mu_b; arrays of shape (points,), three or more with different I, standard errors (NaN: not known)."""
    from .. import _drumlin  # pylint: disable=import-outside-toplevel  # the study of other things reads files alone

    a, b, a_ci99, b_ci99, *further = _drumlin.fit_log_friction([inertial, mu, I_error, mu_error])
    return LogFriction(Scalar(a, a_ci99), Scalar(b, b_ci99), *further)
