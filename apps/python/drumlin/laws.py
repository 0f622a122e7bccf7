"""Laws mu(I): files evaluated over arrays, and calibration from arrays."""

import os
import pathlib

import numpy as np

from . import _drumlin
from .errors import InputError, IoError
from .figures import whole_file
from .scenes import shipped_file
from .inputs import file_name, real, require_file
from .progress import Progress


class Law:
    """A law of a file rheology.toml, of the name of a shipped one, or of its text, as a flow computes with it. All its numbers are dimensionless.

    >>> drumlin.Law("drum-6rpm").mu([1e-3, 1e-2])
    """

    def __init__(self, source):
        if isinstance(source, str) and "\n" in source:
            text, name = source, "law"
        else:
            text, name = _text_of_file(source), str(source)
        self._law = _drumlin.law(text, name)
        self.text = text

    def __reduce__(self):
        return Law, (self.text,)

    def __repr__(self):
        return f"<law: {self.words}>"

    def mu(self, I):  # noqa: E741
        """mu at I, a number or an array of any shape; of that shape."""
        return self._law.mu(real("I", I))

    def slope(self, I):  # noqa: E741
        """I dmu/dI at I, of its shape."""
        return self._law.slope(real("I", I))

    @property
    def nu(self) -> float:
        """Volume fraction of the bulk."""
        return self._law.nu

    @property
    def words(self) -> str:
        """mu(I) as a formula, a text."""
        return self._law.words

    def write(self, path) -> None:
        """Writes the file rheology.toml that `drumlin flow --rheology` reads."""
        whole_file.write_text(os.fsdecode(file_name(path)), self.text)


def _text_of_file(path):
    file = pathlib.Path(os.fsdecode(file_name(shipped_file(path, "law"))))
    require_file(file)
    try:
        return file.read_text(encoding="utf-8")
    except OSError as error:
        raise IoError(f"{path}: {error.strerror}") from error


class CalibratedLaw(Law):
    """A law that was fitted to points, with what is known of it.

    >>> law = drumlin.calibrate(I, mu, nu=0.8)
    >>> law.coefficients, law.band(1e-2)
    """

    def __init__(self, *points, drawn=None):
        self._found = _drumlin.calibrate(*points, drawn)
        self._points = points
        super().__init__(self._found.text)

    def __reduce__(self):
        return CalibratedLaw, self._points

    def band(self, I, share=0.99):  # noqa: E741
        """(low, high) of mu at I, each of its shape: between them lie so much of the laws of other draws of the points."""
        return self._found.band(real("I", I), share)

    @property
    def form(self) -> str:
        """Of the law: log, log-linear, jop or table."""
        return self._found.form

    @property
    def coefficients(self) -> list[float]:
        """Of the form: a and b of mu = a + b ln I, mu_s, mu_2 - mu_s and I_0 of Jop's, values at the knots of a table; a list."""
        return self._found.coefficients

    @property
    def rms_misfit(self) -> float:
        """Root mean square of what the law leaves of the points."""
        return self._found.rms_misfit

    @property
    def scatter(self) -> float:
        """What of it their errors do not explain."""
        return self._found.scatter

    @property
    def points(self) -> int:
        """Their number."""
        return self._found.points

    @property
    def range(self) -> tuple[float, float]:
        """(I_min, I_max) of the points."""
        return self._found.range

    @property
    def ill_posed(self) -> list[tuple[float, float]]:
        """Ranges of I in which the equations of flow are ill-posed in simple shear, [(from, to), ...]."""
        return self._found.ill_posed


def _checked_errors(what, errors):
    wrong = np.flatnonzero(~(np.isfinite(errors) & (errors > 0)))
    if wrong.size:
        place = int(wrong[0])
        raise InputError(f"{what}: is {errors[place]} at point {place} (allowed: finite and above 0; None where it is not known)")


def calibrate(I, mu, I_error=None, mu_error=None, *, nu, form="auto", draws=200, names=None, progress: bool | None = None) -> CalibratedLaw:  # noqa: E741
    """Fits mu(I) robustly to points, as `drumlin calibrate` does to measured layers.

    I, mu: arrays of one run, or lists of arrays, one of each run, whose scatter tells the band. Errors are standard errors; without them
    points count alike. nu: volume fraction of the bulk, which the law's file holds. form: "log", "log-linear", "jop", "table", "auto". draws: bootstrap
    samples; a band of 99 % needs 199. All numbers are dimensionless. progress: shown or not; None: on a terminal alone.

    >>> law = drumlin.calibrate(profile.I, profile.mu, nu=0.8, form="log")
    """
    if np.ndim(I[0]) == 0:
        I, mu = [I], [mu]  # noqa: E741
        I_error, mu_error = [I_error], [mu_error]
    unknown = [None] * len(I)
    runs = []
    for columns in zip(I, mu, unknown if I_error is None else I_error, unknown if mu_error is None else mu_error, strict=True):
        length = np.size(columns[0])
        runs.append([np.full(length, np.nan) if column is None else real("I, mu or an error", column).reshape(-1) for column in columns])
        for what, given, errors in zip(("I_error", "mu_error"), columns[2:], runs[-1][2:]):
            if given is not None:
                _checked_errors(what, errors)
    names = [f"run {k + 1}" for k in range(len(runs))] if names is None else list(names)
    if len(names) != len(runs):
        raise InputError(f"names: are {len(names)} of {len(runs)} runs (allowed: one for each)")
    with Progress("calibrate", shown=progress) as bar:
        return CalibratedLaw(runs, names, float(nu), form, int(draws), drawn=bar.to if bar.shown else None)
