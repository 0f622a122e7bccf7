"""How results depend on the speed of rotation, by way of the flow rate Q, and whether the curves of several speeds over I are one."""

import math

import numpy as np
import scipy.special

from .fits import ABSENT, NORMAL_99, Scalar, fit_line, fit_log_friction, fit_power, mean, pooled_speeds
from .quantities import SURFACE_MARGIN, WALL_MARGIN

I_MIN, I_MAX = 1e-4, 1e-1  # layers that speak of mu(I), as in `drumlin calibrate`
POINTS_PER_DECADE = 4


def _column(groups, name):
    """(value, half width) of a pooled scalar, each of shape (speeds,)."""
    found = [group.scalars.get(name, ABSENT) for group in groups]
    return np.array([one.value for one in found], float), np.array([one.half for one in found], float)


def _points(groups, x, y):
    (x, x_ci99), (y, y_ci99) = _column(groups, x), _column(groups, y)
    return x, y, x_ci99, y_ci99


def _law(formula, names, fit):
    return {"formula": formula, "coefficients": dict(zip(names, fit.coefficients)), "reduced_chi2": fit.reduced_chi2, "rms": fit.rms, "points": fit.points}


def _shear_rate_laws(groups, slope, c0):
    """Rajchenbach's scaling without and with an offset; Phi = atan(c0) of the friction law, whose interval is carried into c."""
    theta, rate, theta_ci99, rate_ci99 = _points(groups, slope, "shear_rate")
    theta, theta_ci99 = np.radians(theta), np.radians(theta_ci99)

    def fitted(angle, offset):
        x = np.sqrt((np.sin(theta) - np.sin(angle)) / np.cos(angle))  # NaN for a slope below Phi
        return fit_line(x, rate, theta_ci99 * np.cos(theta) / (2 * x * np.cos(angle)), rate_ci99, offset)

    Phi, Phi_ci99 = math.atan(c0.value), c0.half / (1 + c0.value**2)
    scaling = fitted(Phi, False)
    c = scaling.coefficients[0]
    if math.isfinite(Phi_ci99):
        high, low = (fitted(angle, False).coefficients[0].value for angle in (Phi + Phi_ci99, Phi - Phi_ci99))
        c = Scalar(c.value, math.hypot(c.half, (high - low) / 2))
    scaling = scaling._replace(coefficients=[c, Scalar(math.degrees(Phi), math.degrees(Phi_ci99))])
    formula = "c sqrt(sin(theta) - sin(Phi)) / sqrt(cos(Phi)), Phi = atan(c0)"
    return {"shear_rate": _law("shear_rate = " + formula, ["c", "Phi_deg"], scaling),
            "shear_rate_with_offset": _law("shear_rate = g0 + " + formula, ["g0", "c"], fitted(Phi, True))}


@np.errstate(all="ignore")
def speed_laws(groups):
    """{name: law} through one point a speed; names ending in _com take the angle of the centre of mass for the slope. A law whose quantities were not
    measured holds NaN."""
    Q, H, Q_ci99, H_ci99 = _points(groups, "Q", "H")
    laws = {"flowing_layer_depth": _law("H = c sqrt(Q)", ["c"], fit_line(np.sqrt(Q), H, Q_ci99 / (2 * np.sqrt(Q)), H_ci99, False)),
            "flowing_layer_depth_power": _law("H = c Q^p", ["c", "p"], fit_power(Q, H, Q_ci99, H_ci99))}
    for suffix in ("", "_com"):
        friction = _law("tan(theta) = c0 + c1 Q", ["c0", "c1"], fit_line(*_points(groups, "Q", "mu_eff" + suffix)))
        slope = "theta_com_deg" if suffix else "theta_deg"
        with_slope = {"effective_friction": friction} | _shear_rate_laws(groups, slope, friction["coefficients"]["c0"])
        laws |= {name + suffix: law for name, law in with_slope.items()}
    laws["shear_rate_power"] = _law("shear_rate = c Q^p", ["c", "p"], fit_power(*_points(groups, "Q", "shear_rate")))
    return laws


def speed_trend(name, groups):
    """mean: over the speeds, each alike; its half width is the larger of what their intervals give and Student's t of their spread. trend: the slope of
    the line over Q times the range of Q, over the mean. reduced_chi2: about a constant."""
    Q, value, Q_ci99, ci99 = _points(groups, "Q", name)
    known = np.isfinite(value)
    middle = Scalar(math.nan)
    if known.any():
        constant = fit_line(np.ones(known.sum()), value[known], offset=False).coefficients[0]
        combined = np.sqrt(np.sum(ci99[known] ** 2)) / known.sum()
        middle = Scalar(constant.value, np.fmax(combined, constant.half) if np.isfinite(combined) else None)
    both = known & np.isfinite(Q)
    gain = (np.ptp(Q[both]) if both.any() else math.nan) / middle.value
    slope = fit_line(Q, value, Q_ci99, ci99).coefficients[1]
    return {"mean": middle, "trend": Scalar(slope.value * gain, abs(slope.half * gain) if math.isfinite(slope.half) else None),
            "reduced_chi2": fit_line(np.ones(value.size), value, math.nan, ci99, False).reduced_chi2}


def friction_points(profile):
    """(I, mu, standard error of I, of mu), shape (layers,), of the layers of a profile that speak about the law."""
    (inertial, I_ci99), (mu, mu_ci99) = profile.at("I"), profile.at("mu")
    factor = float(profile.header.get("interval_factor", 2.576))
    used = (profile.z <= -SURFACE_MARGIN) & (profile.z >= profile.wall + WALL_MARGIN) & (inertial >= I_MIN) & (inertial <= I_MAX) & np.isfinite(mu)
    return np.array([inertial, mu, I_ci99 / factor, mu_ci99 / factor])[:, used]


def curve(a, b, I_min, I_max):
    """a + b ln I at 41 points, evenly in ln I, as a flow evaluates it."""
    from .. import _drumlin  # pylint: disable=import-outside-toplevel  # the study of other things reads files alone

    return _drumlin.log_curve(a, b, I_min, I_max)


def friction_collapse(groups):
    """mu = a + b ln I through the layers of all runs and of each speed, and how far they lie about it; speeds with fewer than three layers are left out,
    None when all are. Layers move together, so that the intervals are lower bounds."""
    of_speeds = [(group.rotation_rpm, np.hstack([friction_points(run.profile) for run in group.runs])) for group in groups]
    of_speeds = [(rpm, points) for rpm, points in of_speeds if points.shape[1] >= 3]
    if not of_speeds:
        return None
    every = np.hstack([points for _, points in of_speeds])

    def described(fit):
        return {"a": fit.a, "b": fit.b, "rms": fit.rms, "birge_ratio": fit.birge_ratio, "layers": fit.points}

    common, own = fit_log_friction(*every), [fit_log_friction(*points) for _, points in of_speeds]
    squares = sum(fit.rms_of(*points[:2]) ** 2 * points.shape[1] for fit, (_, points) in zip(own, of_speeds))
    speeds = [{"rotation_rpm": rpm} | described(fit) | {"rms_about_common": common.rms_of(*points[:2])} for fit, (rpm, points) in zip(own, of_speeds)]
    return described(common) | {"curve": curve(common.a.value, common.b.value, common.I_min, common.I_max), "rms_own": np.sqrt(squares / every.shape[1]),
                                "mean_error": np.mean(every[3]), "speeds": speeds}


def inertial_curve(profile, column):
    """(I ascending, value, half width), each of shape (layers,): layers below z = -2 and more than 3 d from the wall, from the surface down as long as
    the shear rate exceeds its own interval, without those where I does not fall below all layers above. The interval of I counts through the slope."""
    (inertial, I_ci99), (rate, rate_ci99), (value, ci99) = (profile.at(name) for name in ("I", "shear_rate", column))
    known = [np.where(np.isfinite(v), v, 0) for v in (I_ci99, rate_ci99, ci99)]
    layers = []
    for l in np.flatnonzero(profile.z <= -SURFACE_MARGIN)[::-1]:
        if profile.z[l] < profile.wall + WALL_MARGIN or not rate[l] > known[1][l]:
            break
        if np.isfinite(value[l]) and not (layers and inertial[l] >= inertial[layers[-1]]):
            layers.append(l)
    layers = layers[::-1]
    inertial, value, ci99, I_ci99 = inertial[layers], value[layers], known[2][layers], known[0][layers]
    if inertial.size > 1:
        before, after = np.maximum(np.arange(inertial.size) - 1, 0), np.minimum(np.arange(inertial.size) + 1, inertial.size - 1)
        slope = (value[after] - value[before]) / np.log(inertial[after] / inertial[before])
        ci99 = np.hypot(ci99, slope * I_ci99 / inertial)
    return inertial, value, ci99


def _point_at(at, speeds):
    """The speeds at one I, interpolated in ln I; their mean is weighted by their intervals, spread is their standard deviation."""
    def read(inertial, values):
        return np.interp(math.log(at), np.log(inertial), values, math.nan, math.nan) if inertial.size else math.nan

    pooled = pooled_speeds([[Scalar(read(x, value), read(x, ci99)) for x, value, ci99 in curves] for curves in speeds])
    pooled = [one for one in pooled if math.isfinite(one.value) and one.half > 0]
    if len(pooled) < 2:
        return None
    value, variance = np.array([one.value for one in pooled]), np.array([(one.half / NORMAL_99) ** 2 for one in pooled])
    middle = np.sum(value / variance) / np.sum(1 / variance)
    return {"I": at, "mean": middle, "spread": np.std(value, ddof=1), "chi2": np.sum((value - middle) ** 2 / variance), "speeds": len(pooled)}


def collapse(column, groups):
    """Whether a column over I is one curve: at four I per decade those that two speeds or more reach. ratio = sqrt(sum chi2 / sum (speeds - 1)), limit: the
    99 % quantile of sqrt(chi^2/(n - 1)) for n speeds, as if all layers of a run moved together. NaN and None where nothing can be told."""
    speeds = [[inertial_curve(run.profile, column) for run in group.runs] for group in groups]
    steps = round(POINTS_PER_DECADE * math.log10(I_MAX / I_MIN))
    points = [_point_at(I_MIN * 10 ** (step / POINTS_PER_DECADE), speeds) for step in range(steps + 1)]
    points = [point for point in points if point is not None]
    if not points:
        return {"ratio": math.nan, "limit": math.nan, "collapse": None, "spread": math.nan, "range": math.nan, "points": []}
    most, means = max(point["speeds"] for point in points) - 1, [point["mean"] for point in points]
    ratio = math.sqrt(sum(point["chi2"] for point in points) / sum(point["speeds"] - 1 for point in points))
    limit = math.sqrt(scipy.special.chdtri(most, 0.01) / most)
    return {"ratio": ratio, "limit": limit, "collapse": ratio <= limit, "spread": math.sqrt(mean([point["spread"] ** 2 for point in points])),
            "range": max(means) - min(means), "points": points}
