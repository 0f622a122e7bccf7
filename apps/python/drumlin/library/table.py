"""The law of given grains by the library of laws (docs/formats/laws.md): Gaussian processes over the points of data/laws/laws.csv."""

import functools
import math
import pathlib
import warnings

import numpy as np

from ..errors import InputError, IoError
from ..figures.result_files import read_table
from ..laws import Law

GRAINS = ("friction", "restitution", "spread", "rolling_resistance")
ALLOWED = {"friction": (0, 100), "restitution": (0, 1), "spread": (0, 1), "rolling_resistance": (0, 100)}
FITTED = {"mu": "ln", "nu": "", "k": ""}  # quantities with a process of their own; ln: over their logarithm
NORMAL_99 = 2.5758
START_LENGTHS = (2, 1, 0.6, 2, 2, 0.5)  # of the coordinates; half of each is the least
ORDERED = 0.1  # spread up to which sheared discs order: those of +-5 % do, those of +-20 % do not
DRAWS = 16
KNOTS = 13


def table_file():
    """That of the source tree, or the one installed beside this package."""
    here = pathlib.Path(__file__).resolve().parent
    for file in (here / "laws.csv", *(above / "data/laws/laws.csv" for above in here.parents[3:4])):
        if file.is_file():
            return file
    raise IoError(f"{here / 'laws.csv'}: is missing: the table of the library of laws")


def coordinates(grains, I):  # noqa: E741
    """What the processes see of grains, arrays of one length, at I."""
    return np.column_stack([np.log(grains["friction"] + 0.05), grains["restitution"], grains["spread"], np.log(grains["rolling_resistance"] + 0.03), np.log(I),
                            np.exp(-((np.asarray(grains["spread"]) / ORDERED) ** 2))])


class Library:
    """The table and its processes. `columns`: points of 400 discs at full accuracy, alike in length."""

    def __init__(self, file=None, left_out=None):
        file = table_file() if file is None else file
        self.header, columns = read_table(file, "drumlin-laws-1")[1:]
        kept = (columns["half_accuracy"] == 0) & (columns["grains"] == columns["grains"].min())
        if left_out is not None:
            kept &= ~np.all([columns[name] == left_out[name] for name in GRAINS], axis=0)
        self.columns = {name: column[kept] for name, column in columns.items()}

    @functools.cached_property
    def processes(self):
        return {name: self._process(name) for name in FITTED}

    def kernel(self, name):
        """A sum of what friction does over I to all grains and what each of the rest adds; with the scales that the table's head holds, else some to begin
        a fit with."""
        from sklearn.gaussian_process import kernels

        def part(amplitude, *seen):
            lengths, bounds = np.full(6, 1e5), [(9e4, 1.1e5)] * 6  # a length that tells nothing apart
            for coordinate in seen:
                lengths[coordinate], bounds[coordinate] = START_LENGTHS[coordinate], (0.5 * START_LENGTHS[coordinate], 30)
            return kernels.ConstantKernel(amplitude, (1e-8, 1e2)) * kernels.RBF(lengths, bounds)
        kernel = part(0.1, 0, 4) + part(0.01, 0, 1, 4) + part(0.01, 0, 2, 4) + part(0.01, 0, 3, 4) + part(0.01, 0, 4, 5) + kernels.WhiteKernel(1e-5, (1e-12, 1e-2))
        scales = self.header.get("process_" + name)
        return kernel.clone_with_theta(np.log([float(scale) for scale in scales.split()])) if scales else kernel

    def _process(self, name, fit=False):
        try:
            from sklearn.gaussian_process import GaussianProcessRegressor
        except ImportError as missing:
            raise IoError("the library of laws needs scikit-learn (Debian: python3-sklearn)") from missing
        value, half = self.columns[name], self.columns[name + "_ci99"]
        known = np.isfinite(value) & np.isfinite(half)
        value, deviation = value[known], half[known] / NORMAL_99
        if FITTED[name]:
            value, deviation = np.log(value), deviation / value
        process = GaussianProcessRegressor(self.kernel(name), alpha=deviation**2, optimizer="fmin_l_bfgs_b" if fit else None)
        self._middle = getattr(self, "_middle", {}) | {name: value.mean()}
        return process.fit(self.points()[known], value - value.mean())

    def points(self):
        return coordinates(self.columns, self.columns["I"])

    def fitted_scales(self, name):
        """Those of the kernel that make the table most likely."""
        with warnings.catch_warnings(action="ignore"):  # of scales at their bounds
            return np.exp(self._process(name, fit=True).kernel_.theta)

    def normal(self, name, grains, I):  # noqa: E741
        """Mean and covariance of a quantity (of its logarithm, for mu) at I, the scatter of a point beside the process left out."""
        I = np.asarray(I, float)  # noqa: E741
        process = self.processes[name]
        mean, covariance = process.predict(coordinates({key: np.full(I.shape, float(grains[key])) for key in GRAINS}, I), return_cov=True)
        return mean + self._middle[name], covariance

    def range(self, name):
        return float(self.columns[name].min()), float(self.columns[name].max())


@functools.lru_cache(1)
def library():
    return Library()


class LibraryLaw(Law):
    """A law of the library. `I`, `low`, `high`: 99 % interval of mu at the knots; `nu_ci99`; `extrapolates`: what lies outside the table, in words.

    >>> drumlin.law(0.3).high - drumlin.law(0.3).low
    """

    def __init__(self, text, I, low, high, nu_ci99, extrapolates):  # noqa: E741
        super().__init__(text)
        self.I, self.low, self.high, self.nu_ci99, self.extrapolates = I, low, high, nu_ci99, extrapolates  # noqa: E741

    def __reduce__(self):
        return LibraryLaw, (self.text, self.I, self.low, self.high, self.nu_ci99, self.extrapolates)


def law(friction, restitution=0.1, spread=0.2, rolling_resistance=0.0, *, extrapolate=False) -> LibraryLaw:
    """mu(I) of such grains with its interval, from the library of laws (docs/formats/laws.md).

    friction, restitution, rolling_resistance: coefficients between grains. spread: sizes of the mean times 1 +- spread, evenly; of another
    distribution sqrt(3) times standard deviation over mean. Outside the table: refused, or with `extrapolate` a law that says so.

    >>> drumlin.law(friction=0.3, restitution=0.5).mu(1e-2)
    """
    grains = {"friction": friction, "restitution": restitution, "spread": spread, "rolling_resistance": rolling_resistance}
    of = library()
    outside = _outside(of, grains)
    if outside and not extrapolate:
        raise InputError(f"{'; '.join(outside)}: the table ends there (with --extrapolate, extrapolate=True in Python, the law goes on beyond it)")
    least, most = of.range("I")
    least = max(least, of.columns["I"][of.columns["seeds"] > 0].min())
    knots = np.geomspace(least if least > 5e-4 else 1e-3 * 2 / math.sqrt(math.pi), most, KNOTS)
    mean, covariance = of.normal("mu", grains, knots)
    deviation = np.sqrt(np.diag(covariance))
    shifts = np.random.default_rng(0).multivariate_normal(np.zeros(KNOTS), covariance, DRAWS, method="eigh")
    lines = [_growing(knots, np.exp(mean + shift), deviation) for shift in (np.zeros(KNOTS), *shifts)]
    nu, nu_covariance = of.normal("nu", grains, knots[:1])
    text = _text(of, grains, outside, knots, lines, float(nu[0]), NORMAL_99 * math.sqrt(nu_covariance[0, 0]))
    return LibraryLaw(text, knots, np.exp(mean - NORMAL_99 * deviation), np.exp(mean + NORMAL_99 * deviation),
                      NORMAL_99 * math.sqrt(nu_covariance[0, 0]), outside)


def _outside(of, grains):
    found = []
    for name, value in grains.items():
        low, high = ALLOWED[name]
        if not (isinstance(value, (int, float, np.number)) and low <= value <= high):
            raise InputError(f"{name}: is {value} (allowed: {low} to {high})")
        low, high = of.range(name)
        if not low - 1e-9 <= value <= high + 1e-9:
            found.append(f"{name} = {value:g} is outside {low:g} to {high:g}")
    return found


def _least_slope(mu):
    """Least I dmu/dI of a law that is well-posed in simple shear, as calibrate has it."""
    linear, square = 4 + mu * mu, 4 + mu * mu / 4
    return mu * (linear - np.sqrt(linear * linear - 4 * square * mu * mu)) / (2 * square)


def _growing(knots, mu, weight):
    """The nearest table, by least squares, that grows everywhere so fast that a flow with it is well-posed."""
    from sklearn.isotonic import IsotonicRegression
    steps = np.diff(np.log(knots))
    rise = np.concatenate([[0], np.cumsum(1.35 * _least_slope((mu[1:] + mu[:-1]) / 2) * steps)])
    return IsotonicRegression().fit_transform(np.log(knots), mu - rise, sample_weight=1 / weight**2) + rise


def _text(of, grains, outside, knots, lines, nu, nu_ci99):
    def numbers(values):
        return "[" + ", ".join(f"{value:.8g}" for value in values) + "]"
    head = "# Grains: " + ", ".join(f"{name} {value:g}" for name, value in grains.items()) + f". From the library of laws, runs at {of.header['revision']}.\n"
    if outside:
        head += f"# Extrapolates: {'; '.join(outside)}.\n"
    return (head + 'format = "drumlin-rheology-1"\n\n[mu]\nlaw = "table"\n'
            f"I = {numbers(knots)}\nmu = {numbers(lines[0])}\n\n[band]\ndraws = {numbers(np.concatenate(lines[1:]))}\n\n"
            f"[packing]\nnu = {nu:.6g}\nnu_ci99 = {nu_ci99:.3g}\n\n[fitted_on]\nruns = [\"library\"]\n")
