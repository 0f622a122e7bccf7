"""Laws mu(I): files evaluated over arrays, and calibration from arrays."""

import os
import pathlib

import numpy as np

from . import _drumlin
from .errors import InputError, IoError
from .figures import whole_file
from .inputs import file_name, real


class Law:
    """A law of a file rheology.toml, or of its text: mu(I) and slope(I) = I dmu/dI over arrays, as a flow computes with it; `nu`, and the law in
    `words`."""

    def __init__(self, source):
        if isinstance(source, str) and "\n" in source:
            text, name = source, "law"
        else:
            text, name = _text_of_file(source), str(source)
        self._law = _drumlin.law(text, name)
        self.text = text

    def mu(self, I):  # noqa: E741
        return self._law.mu(real("I", I))

    def slope(self, I):  # noqa: E741
        return self._law.slope(real("I", I))

    @property
    def nu(self):
        return self._law.nu

    @property
    def words(self):
        return self._law.words

    def write(self, path):
        whole_file.write_text(os.fsdecode(file_name(path)), self.text)


def _text_of_file(path):
    try:
        return pathlib.Path(os.fsdecode(file_name(path))).read_text(encoding="utf-8")
    except OSError as error:
        raise IoError(f"{path}: {error.strerror}") from error


class CalibratedLaw(Law):
    """A law with what is known of it: `form`, `coefficients`, `rms_misfit`, `scatter` beyond the errors of the points, `range` of I,
    `ill_posed` ranges of I; band(I) is what lies between the laws of other draws of the points."""

    def __init__(self, found):
        super().__init__(found.text)
        self._found = found

    def __getattr__(self, name):
        if name in ("form", "coefficients", "rms_misfit", "scatter", "points", "range", "ill_posed"):
            return getattr(self._found, name)
        raise AttributeError(name)

    def band(self, I, share=0.99):  # noqa: E741
        """(low, high) of mu at I."""
        return self._found.band(real("I", I), share)


def _checked_errors(what, errors):
    wrong = np.flatnonzero(~(np.isfinite(errors) & (errors > 0)))
    if wrong.size:
        place = int(wrong[0])
        raise InputError(f"{what}: is {errors[place]} at point {place} (allowed: finite and above 0; None where it is not known)")


def calibrate(I, mu, I_error=None, mu_error=None, *, nu, form="auto", draws=200, names=None):  # noqa: E741
    """Fits mu(I) robustly to points, as `drumlin calibrate` does to measured layers.

    I, mu: arrays of one run, or lists of arrays, one of each run, whose scatter tells the band. Errors are standard errors; without them
    points count alike. nu: volume fraction of the bulk, which the law's file holds. form: "log", "log-linear", "table", "auto".
    """
    if np.ndim(I[0]) == 0:
        I, mu = [I], [mu]  # noqa: E741
        I_error, mu_error = [I_error], [mu_error]
    unknown = [None] * len(I)
    runs = []
    for columns in zip(I, mu, unknown if I_error is None else I_error, unknown if mu_error is None else mu_error, strict=True):
        length = np.size(columns[0])
        runs.append([np.full(length, np.nan) if column is None else real("I, mu or an error", column).reshape(-1) for column in columns])
        if columns[3] is not None:
            _checked_errors("mu_error", runs[-1][3])
    names = [f"run {k + 1}" for k in range(len(runs))] if names is None else list(names)
    if len(names) != len(runs):
        raise InputError(f"names: are {len(names)} of {len(runs)} runs (allowed: one for each)")
    return CalibratedLaw(_drumlin.calibrate(runs, names, float(nu), form, int(draws)))
