"""The library of laws as an emulator of mu at given I, and the law of the grains that a posterior leaves."""

import types

import numpy as np

from ..errors import InputError
from . import emulator

GRAINS = ("friction", "restitution", "spread", "rolling_resistance")
USUAL = {"restitution": 0.1, "spread": 0.2, "rolling_resistance": 0.0}  # of the library's main axis
DRAWN = 200  # laws, each of another sample
BAND = (0.05, 0.5, 0.95)


def _library():
    from ..library.table import library  # pylint: disable=import-outside-toplevel  # loads scikit-learn and the table
    return library()


def points():
    """How many the library has."""
    return len(_library().columns["mu"])


def _require_inside(name, low, high):
    least, most = _library().range(name)
    if not least - 1e-9 <= low <= high <= most + 1e-9:
        raise InputError(f"library: {name}: from {low:g} to {high:g} (allowed: from {least:g} to {most:g}, the ends of the library of laws)")


class LibraryEmulator:
    """mu at some I, of grains in the units of their ranges, as an Emulator; what is not asked for is as the settings of the scene say."""

    def __init__(self, scene, ranges):
        one = scene.measured[0]
        if len(scene.measured) != 1 or one.quantity != "mu" or one.z is None:
            raise InputError(f"{scene.name}: measured: the library knows mu at given I (allowed: one entry with quantity mu, and I)")
        _require_inside("I", min(one.z), max(one.z))
        self.names, self.inertial = scene.names(), np.array(one.z)
        self.free = [name for name, prior in ranges.items() if not isinstance(prior, str)]
        self.ends = np.array([ranges[name] for name in self.free], float)
        self.fixed = {name: value for name, value in (USUAL | scene.settings).items() if name not in self.free}
        for name in GRAINS:
            _require_inside(name, *(ranges[name] if name in self.free else [self.fixed.get(name, np.nan)] * 2))
        self.processes = [types.SimpleNamespace(rest=np.zeros(0)) for _ in self.names]
        self.middle = 0.0
        mean, covariance = _library().normal("mu", self._grains(self.ends.mean(axis=1)), self.inertial)
        self.middle = mean[0] - np.log(self.predict(np.full((1, len(self.free)), 0.5))[0][0, 0])
        deviation = np.sqrt(np.diag(covariance))
        self.correlation = (1 - emulator.SHRINKAGE) * covariance / np.outer(deviation, deviation) + emulator.SHRINKAGE * np.eye(len(deviation))
        self.factor = np.linalg.cholesky(self.correlation)

    def _grains(self, values):
        return self.fixed | {name: value for name, value in zip(self.free, values) if name in GRAINS}

    def predict(self, unit):
        """(means, standard deviations, spreads), each (points, I); what differs from run to run is in the process."""
        from ..library.table import coordinates  # pylint: disable=import-outside-toplevel
        count, of = len(self.inertial), _library()
        grains = self._grains((self.ends[:, 0] + unit * (self.ends[:, 1] - self.ends[:, 0])).T)
        repeated = {name: np.repeat(np.broadcast_to(np.asarray(value, float), len(unit)), count) for name, value in grains.items()}
        mean, deviation = of.processes["mu"].predict(coordinates(repeated, np.tile(self.inertial, len(unit))), return_std=True)
        mu = np.exp(mean + self.middle)
        return mu.reshape(-1, count), (mu * deviation).reshape(-1, count), np.zeros((len(unit), count))


def law_of(asked, given, samples):
    """{I, mu, low, high}: the law of grains of the posterior with its 90 % band. given: by the names of the library, what is not unknown, or None where nothing
    is known of it. None where the library does not know such grains."""
    if given is None:
        return None
    given = USUAL | given
    names = list(asked.priors)
    chosen = samples[:: max(1, len(samples) // DRAWN)][:DRAWN]
    grains = [given | {name: float(value) for name, value in zip(names, row) if name in GRAINS} for row in chosen]
    try:
        for name in GRAINS:
            values = [one.get(name, np.nan) for one in grains]
            _require_inside(name, min(values), max(values))
    except InputError:
        return None
    inertial, random = np.geomspace(*_library().range("I"), 13), np.random.default_rng(6)
    drawn = [np.exp(random.multivariate_normal(*_library().normal("mu", one, inertial), method="eigh")) for one in grains]
    low, middle, high = np.quantile(drawn, BAND, axis=0)
    return {"I": inertial.tolist(), "mu": middle.tolist(), "low": low.tolist(), "high": high.tolist()}
