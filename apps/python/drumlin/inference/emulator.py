"""Gaussian processes in place of a scene's runs: one for each number that was measured, with the chance that runs of the same grains leave."""

import dataclasses

import numpy as np
import scipy.linalg
import scipy.optimize

from ..errors import InputError
from .posterior import require_emcee

LEAST_RUNS = 8  # that have a number
SHRINKAGE = 0.1  # of the correlations of what one run's numbers have in common, towards none
WALKERS, STEPS, KEPT = 24, 200, 8  # of the chains of a process's parameters, of which the ends of some are kept
# Priors of the logarithms of those parameters, for unknowns in [0, 1] and values over their deviation: middle and deviation.
VARIANCE, LENGTH, SPREAD = (np.log(2), 1.5), (0.0, 1.0), (np.log(0.1), 2.0)


def _processes():
    try:
        import sklearn.gaussian_process  # pylint: disable=import-outside-toplevel  # of those who infer
    except ModuleNotFoundError as missing:
        raise InputError("infer needs scikit-learn, which is not installed: the package python3-sklearn") from missing
    return sklearn.gaussian_process


@dataclasses.dataclass
class Process:
    """One number of a scene over the unknowns in [0, 1], or its logarithm: an average over probable parameters of a Gaussian process, the first index."""

    points: np.ndarray
    middle: float
    scale: float
    logarithm: bool
    parameters: np.ndarray  # logarithms: variance, lengths, variance from run to run of the same grains beyond the runs' own intervals
    weights: np.ndarray
    inverse_factors: np.ndarray  # of the Cholesky factors of the runs' covariances
    rest: np.ndarray  # of each run left out, over its standard deviation; NaN where it has no number

    def predict(self, points):
        """(mean, standard deviation of the mean, spread from run to run)"""
        variance, lengths, noise = np.exp(self.parameters[:, :1]), np.exp(self.parameters[:, 1:-1]), np.exp(self.parameters[:, -1:])
        common = variance[..., None] * np.exp(-0.5 * np.tensordot(lengths**-2, (points[:, None] - self.points) ** 2, (1, 2)))
        mean = self.middle + self.scale * (common @ self.weights[..., None])[..., 0]
        own = self.scale**2 * np.clip(variance - np.sum((common @ self.inverse_factors.transpose(0, 2, 1)) ** 2, axis=-1), 0, None)
        spread = self.scale**2 * noise * np.ones_like(mean)
        if self.logarithm:
            mean = np.exp(mean + (own + spread) / 2)
            own, spread = mean**2 * np.expm1(own), mean**2 * np.expm1(spread)
        return mean.mean(axis=0), np.sqrt(own.mean(axis=0) + mean.var(axis=0)), np.sqrt(spread.mean(axis=0))


def _log_prior(theta):
    """(logarithm up to a constant, its gradient)"""
    middle, deviation = np.array([VARIANCE, *[LENGTH] * (len(theta) - 2), SPREAD]).T
    off = (theta - middle) / deviation
    return -0.5 * off @ off, -off / deviation


def _most_probable(objective, start, bounds):
    """As an optimizer of scikit-learn."""
    def posterior(theta):
        (value, slope), (prior, prior_slope) = objective(theta), _log_prior(theta)
        return value - prior, slope - prior_slope
    found = scipy.optimize.minimize(posterior, start, jac=True, bounds=bounds, method="L-BFGS-B")
    return found.x, found.fun


def _regression(points, values, errors, logarithm):
    """(log density of the values at the most probable parameters, scikit-learn's process, middle, scale)"""
    errors, jacobian = (errors / values, -np.log(values).sum()) if logarithm else (errors, 0.0)
    values = np.log(values) if logarithm else values
    middle, scale = values.mean(), values.std() or 1.0
    process, wide = _processes(), (1e-8, 1e8)
    kernels = process.kernels
    kernel = kernels.ConstantKernel(2.0, wide) * kernels.RBF(np.ones(points.shape[1]), wide) + kernels.WhiteKernel(0.1, wide)
    fitted = process.GaussianProcessRegressor(kernel, alpha=np.nan_to_num(errors / scale) ** 2 + 1e-9, optimizer=_most_probable)
    fitted.fit(points, (values - middle) / scale)
    return fitted.log_marginal_likelihood_value_ - len(values) * np.log(scale) + jacobian, fitted, middle, scale


def _probable_parameters(fitted):
    """A few draws of the parameters' posterior: runs of a design leave lengths and spread open, and the best of them is surer than they are."""
    emcee, random = require_emcee(), np.random.RandomState(1)  # pylint: disable=no-member
    best = fitted.kernel_.theta
    sampler = emcee.EnsembleSampler(WALKERS, len(best), lambda theta: fitted.log_marginal_likelihood(theta, clone_kernel=False) + _log_prior(theta)[0])
    start = best + 0.3 * random.standard_normal((WALKERS, len(best)))
    return sampler.run_mcmc(emcee.State(start, random_state=random.get_state()), STEPS).coords[:KEPT]


def fit(points, values, errors, name=""):
    """A Process through runs at `points` with their values and standard errors (NaN: not known, taken as the spread alone); of logarithms where all values
    are positive and these are the more probable: then the spread grows with the number."""
    there = np.isfinite(values)
    if there.sum() < LEAST_RUNS:
        raise InputError(f"{name}: only {there.sum()} of {len(values)} runs have this number (allowed: {LEAST_RUNS} or more; more runs, or another quantity)")
    of = points[there], values[there], errors[there]
    forms = (False, True) if (of[1] > 0).all() else (False,)
    (_, fitted, middle, scale), logarithm = max(((_regression(*of, form), form) for form in forms), key=lambda found: found[0][0])
    parameters = _probable_parameters(fitted)
    each = [_processes().GaussianProcessRegressor(fitted.kernel_.clone_with_theta(theta), alpha=fitted.alpha, optimizer=None)
            .fit(fitted.X_train_, fitted.y_train_) for theta in parameters]
    inverse_factors = np.array([scipy.linalg.solve_triangular(one.L_, np.eye(len(one.L_)), lower=True) for one in each])
    weights, rest = np.array([one.alpha_ for one in each]), np.full(len(values), np.nan)
    rest[there] = np.mean(weights / np.sqrt(np.sum(inverse_factors**2, axis=1)), axis=0)  # closed form of leaving one out
    return Process(of[0], middle, scale, logarithm, parameters, weights, inverse_factors, rest)


class Emulator:
    """All numbers of one scene. What one run's numbers have in common is a correlation of their errors."""

    def __init__(self, points, values, errors, names):
        self.names = names
        self.processes = [fit(points, values[:, k], errors[:, k], name) for k, name in enumerate(names)]
        self.correlation = _correlation(np.array([process.rest for process in self.processes]))
        self.factor = np.linalg.cholesky(self.correlation)

    def predict(self, points):
        """(means, standard deviations of the means, spreads from run to run), each (points, numbers)"""
        each = [process.predict(points) for process in self.processes]
        return tuple(np.stack(part, axis=-1) for part in zip(*each))


def _correlation(rest):
    known = np.isfinite(rest).all(axis=0)
    if len(rest) == 1 or known.sum() < LEAST_RUNS:
        return np.eye(len(rest))
    return (1 - SHRINKAGE) * np.corrcoef(rest[:, known]) + SHRINKAGE * np.eye(len(rest))
