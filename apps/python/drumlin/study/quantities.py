"""Numbers of one run that the paper speaks of and that follow from its profile and scalars (docs/formats/study.md lists them)."""

import math

import numpy as np

from .fits import ABSENT, Scalar, fit_line

SURFACE_MARGIN, BULK_MARGIN, WALL_MARGIN = 2, 4, 3  # d; those of the measurement
LOGARITHMIC_FROM = 1e-4  # I; below it mu falls faster
NOTHING = Scalar(math.nan, math.nan)


def _mean_between(z, low, high, value, ci99):
    """Mean over the layers low <= z <= high where it is known, three or more; half width: that of the layers, as if they moved together."""
    inside = (z >= low) & (z <= high) & np.isfinite(value)
    return Scalar(np.mean(value[inside]), np.mean(ci99[inside])) if np.sum(inside) >= 3 else NOTHING


def _difference(a, b):
    return Scalar(a.value - b.value, math.hypot(a.half, b.half))


def _times(factor, a):
    return Scalar(factor * a.value, factor * a.half)


def _tangent(angle_deg):
    tangent = math.tan(math.radians(angle_deg.value))
    return Scalar(tangent, (1 + tangent**2) * math.radians(angle_deg.half))


def _over_root(a, b):
    """a/sqrt(b) with independent relative errors."""
    value = a.value * np.power(b.value, -0.5)
    return Scalar(value, abs(value) * math.hypot(a.half / a.value, 0.5 * b.half / b.value))


def _shear_rate_change(run):
    """Mean shear rate of the upper half of the straight line through v_x minus that of the lower, over their mean."""
    bottom, top = run.line
    top = min(top, -SURFACE_MARGIN)
    middle, z, rate = (bottom + top) / 2, run.profile.z, run.profile.at("shear_rate")
    upper, lower = _mean_between(z, middle, top, *rate), _mean_between(z, bottom, middle, *rate)
    return _times(2 / (upper.value + lower.value), _difference(upper, lower))


def _friction_slope_below(profile, H):
    """Slope of mu over ln I in the layers that creep: below the flowing layer, off the wall, sign of the shear rate known, I < 1e-4."""
    (rate, rate_ci99), (inertial, I_ci99), (mu, mu_ci99) = (profile.at(name) for name in ("shear_rate", "I", "mu"))
    wall = profile.number("wall_z")
    creeps = (profile.z < -H) & (np.isnan(wall) | (profile.z > wall + WALL_MARGIN)) & (rate > np.where(np.isfinite(rate_ci99), rate_ci99, 0))
    creeps &= inertial < LOGARITHMIC_FROM
    inertial = inertial[creeps]
    fit = fit_line(np.log(inertial), mu[creeps], I_ci99[creeps] / inertial, mu_ci99[creeps])
    return fit.coefficients[1] if fit.points >= 4 else NOTHING


@np.errstate(all="ignore")
def with_derived(run):
    """The scalars of a run and, where they lack them, those that follow. Products take their factors for independent; a missing column leaves NaN."""
    scalars, profile = run.scalars, run.profile

    def known(name):
        return scalars.get(name, ABSENT)

    z, H, Q, theta = profile.z, known("H"), known("Q"), known("theta_deg")
    wall, rotation, weight = profile.number("wall_z"), profile.number("rotation"), math.cos(math.radians(theta.value))
    nu, (v_z, v_z_ci99) = profile.at("nu"), profile.at("v_z")
    (sigma, _), kinetic = profile.at("sigma_zz"), profile.at("sigma_zz_kinetic")
    along, across = (_mean_between(z, -H.value, -SURFACE_MARGIN, *column) for column in (profile.at("v_x"), (abs(v_z), v_z_ci99)))
    below, rate, beside = _friction_slope_below(profile, H.value), known("shear_rate"), known("sigma_xz_over_weight_static")
    derived = {
        "mu_eff": _tangent(theta),
        "mu_eff_com": _tangent(known("theta_com_deg")),
        "H_over_sqrt_Q": _over_root(H, Q),
        "Q_over_expected": _times(1 / known("Q_expected").value, Q),
        "nu_flowing_drop": _difference(_mean_between(z, wall + BULK_MARGIN, -H.value, *nu), _mean_between(z, -H.value, -BULK_MARGIN, *nu)),
        "v_z_share": _times(1 / along.value, across),
        "kinetic_share": _mean_between(z, -H.value, -SURFACE_MARGIN, kinetic[0] / sigma, kinetic[1] / sigma),
        "shear_rate_change": _shear_rate_change(run),
        "mu_b_below": below,
        "mu_b_excess": _difference(below, known("mu_b")),
        "shear_stress_departure": Scalar(beside.value - 1, beside.half),
        "shear_rate_laboratory": Scalar(rate.value + rotation, rate.half),
        "coriolis_share": _times(2 * rotation / weight, known("surface_speed")),
        "centrifugal_share": Scalar(rotation**2 * profile.number("drum_radius") / weight),
    }
    return scalars | {name: Scalar(one.value, one.ci99 if math.isfinite(one.half) else None) for name, one in derived.items() if name not in scalars}
