"""Gaussian processes in place of a scene's runs: one for each number that was measured, with the chance that runs of the same grains leave."""

import dataclasses
import warnings

import numpy as np
import scipy.linalg

from ..errors import InputError

LEAST_RUNS = 8  # that have a number
SHRINKAGE = 0.1  # of the correlations of what one run's numbers have in common, towards none


def _processes():
    try:
        import sklearn.exceptions  # pylint: disable=import-outside-toplevel  # of those who infer
        import sklearn.gaussian_process  # pylint: disable=import-outside-toplevel
    except ModuleNotFoundError as missing:
        raise InputError("infer needs scikit-learn, which is not installed: the package python3-sklearn") from missing
    return sklearn.gaussian_process, sklearn.exceptions.ConvergenceWarning


@dataclasses.dataclass
class Process:
    """One number of a scene over the unknowns in [0, 1]. `spread`: standard deviation from run to run of the same grains beyond the runs' own intervals."""

    fitted: object
    middle: float
    scale: float
    spread: float
    inflation: float  # of standard deviations, so that the runs left out lie where they should
    rest: np.ndarray  # of each run left out, over its standard deviation; NaN where it has no number
    inverse_factor: np.ndarray  # of the Cholesky factor of the runs' covariance

    def predict(self, points):
        """(mean, standard deviation of the mean); without the checks of scikit-learn's predict, which take ten times as long for a few points."""
        smooth = self.fitted.kernel_.k1
        common = smooth(points, self.fitted.X_train_)
        variance = smooth.diag(points) - np.sum((common @ self.inverse_factor.T) ** 2, axis=-1)
        return self.middle + self.scale * (common @ self.fitted.alpha_), self.scale * np.sqrt(np.clip(variance, 0, None))


def fit(points, values, errors, name=""):
    """A Process through runs at `points` with their values and standard errors (NaN: not known, taken as the spread alone)."""
    process, unsettled = _processes()
    kernels = process.kernels
    there = np.isfinite(values)
    if there.sum() < LEAST_RUNS:
        raise InputError(f"{name}: only {there.sum()} of {len(values)} runs have this number (allowed: {LEAST_RUNS} or more; more runs, or another quantity)")
    middle, scale = values[there].mean(), values[there].std() or 1.0
    noise = np.nan_to_num(errors[there] / scale) ** 2
    kernel = (kernels.ConstantKernel(1.0, (1e-2, 1e3)) * kernels.RBF(np.ones(points.shape[1]), (0.1, 30.0)) +
              kernels.WhiteKernel(0.05, (1e-6, 1.0)))
    fitted = process.GaussianProcessRegressor(kernel, alpha=noise + 1e-9, n_restarts_optimizer=2, random_state=0)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", unsettled)  # at an end of a range: as good as flat, or without spread
        fitted.fit(points[there], (values[there] - middle) / scale)
    spread = scale * np.sqrt(fitted.kernel_.k2.noise_level)
    inverse_factor = scipy.linalg.solve_triangular(fitted.L_, np.eye(len(fitted.L_)), lower=True)
    rest = np.full(len(values), np.nan)
    rest[there] = fitted.alpha_ / np.sqrt(np.sum(inverse_factor**2, axis=0))  # closed form of leaving one out
    return Process(fitted, middle, scale, spread, max(1.0, np.sqrt(np.nanmean(rest**2))), rest, inverse_factor)


class Emulator:
    """All numbers of one scene. What one run's numbers have in common is a correlation of their errors."""

    def __init__(self, points, values, errors, names):
        self.names = names
        self.processes = [fit(points, values[:, k], errors[:, k], name) for k, name in enumerate(names)]
        self.correlation = _correlation(np.array([process.rest for process in self.processes]))
        self.factor = np.linalg.cholesky(self.correlation)
        self.inverse_factor = np.linalg.inv(self.factor)

    def predict(self, points):
        """(means, standard deviations of the means), each (points, numbers)"""
        both = [process.predict(points) for process in self.processes]
        return tuple(np.stack([one[part] for one in both], axis=-1) for part in (0, 1))

    def deviations(self, own, errors, realisations):
        """Of what is measured from what the emulator says: its own deviation, the spread of so many runs, and the measurement's standard errors."""
        spread, inflation = (np.array([getattr(process, name) for process in self.processes]) for name in ("spread", "inflation"))
        return np.sqrt(errors**2 + inflation**2 * (own**2 + spread**2 / realisations))


def _correlation(rest):
    known = np.isfinite(rest).all(axis=0)
    if len(rest) == 1 or known.sum() < LEAST_RUNS:
        return np.eye(len(rest))
    return (1 - SHRINKAGE) * np.corrcoef(rest[:, known]) + SHRINKAGE * np.eye(len(rest))
