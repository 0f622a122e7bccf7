"""The posterior of the unknowns: prior, likelihood by emulators, samples, and whether anything in the ranges explains the data."""

import dataclasses
import re

import numpy as np
import scipy.stats

from ..errors import InputError, NotConvergedError

WALKERS, FIRST_STEPS, MOST_STEPS = 128, 250, 8000
LONG_ENOUGH = 20  # correlation times that the chains have to last
DRAWN = 4096  # points of the prior from which the chains start
REPLICATES = 400  # data sets drawn from the posterior, against which the misfit is judged
MISFIT = 0.01  # share of them that contradict themselves as much: below it the data are called a misfit


def require_emcee():
    """The package, which is loaded where it is needed."""
    try:
        import emcee  # pylint: disable=import-outside-toplevel  # of those who infer
    except ModuleNotFoundError as missing:
        raise InputError("infer needs emcee, which is not installed: the package python3-emcee") from missing
    return emcee


@dataclasses.dataclass
class Datum:
    """What was measured of one scene, and its emulator."""

    emulator: object
    values: np.ndarray
    errors: np.ndarray
    realisations: int = 1
    _inverse_factors: dict = dataclasses.field(default_factory=dict, repr=False)  # by the numbers left out

    def at(self, points):
        """(means, deviations of what is measured from them) at each point."""
        means, own, spread = self.emulator.predict(points)
        return means, np.sqrt(self.errors**2 + own**2 + spread**2 / self.realisations)

    def entries(self):
        """[(name, numbers)] of what was measured at once: a profile is one entry."""
        names = [re.sub(r"\((z|I)=[^()]*\)$", "", name) for name in self.emulator.names]
        return [(name, [k for k, other in enumerate(names) if other == name]) for name in dict.fromkeys(names)]

    def squares(self, means, deviations, values=None, without=()):
        """Sum of squares of what the values are off, in independent units; without some of the numbers, as if each had an offset that is free."""
        kept = [k for k in range(len(self.values)) if k not in without]
        key = tuple(without)
        if key not in self._inverse_factors:
            self._inverse_factors[key] = np.linalg.inv(np.linalg.cholesky(self.emulator.correlation[np.ix_(kept, kept)]))
        off = ((self.values if values is None else values) - means) / deviations
        return np.sum((off[..., kept] @ self._inverse_factors[key].T) ** 2, axis=-1)

    def log_likelihood(self, points):
        means, deviations = self.at(points)
        return -0.5 * self.squares(means, deviations) - np.log(deviations).sum(axis=-1)

    def drawn(self, points, random):
        """Data sets that grains at these points would give."""
        means, deviations = self.at(points)
        return means + deviations * (random.standard_normal(means.shape) @ self.emulator.factor.T)


class Posterior:
    """Of unknowns with their priors, from the data of some scenes. Points are in the units of the priors."""

    def __init__(self, priors, data):
        self.names, self.priors, self.data = list(priors), list(priors.values()), data
        self.low, self.high = (np.array([getattr(prior, end) for prior in self.priors], float) for end in ("low", "high"))

    def unit(self, points):
        """Of points within the ranges: as emulators take them."""
        return (points - self.low) / (self.high - self.low)

    def log_density(self, points):
        """Up to a constant; -inf outside the ranges."""
        inside = ((points >= self.low) & (points <= self.high)).all(axis=-1)
        density = np.full(len(points), -np.inf)
        if inside.any():
            chosen = points[inside]
            density[inside] = sum(prior.log_density(column) for prior, column in zip(self.priors, chosen.T))
            density[inside] += sum(datum.log_likelihood(self.unit(chosen)) for datum in self.data)
        return density

    def of_prior(self, count):
        """Points that fill the prior."""
        shares = scipy.stats.qmc.Sobol(len(self.names), scramble=True, seed=2).random_base2(int(np.log2(count)))
        return np.stack([prior.quantile(column) for prior, column in zip(self.priors, shares.T)], axis=-1)

    def sample(self, progress=lambda done: None):
        """(samples, log densities), a few thousand. NotConvergedError where the chains have not forgotten their start after 8000 steps."""
        emcee, random = require_emcee(), np.random.RandomState(3)  # pylint: disable=no-member
        prior = self.of_prior(DRAWN)
        density = self.log_density(prior) - sum(one.log_density(column) for one, column in zip(self.priors, prior.T))
        weights = np.exp(density - density.max())
        start = prior[random.choice(len(prior), WALKERS, p=weights / weights.sum())]
        start = np.clip(start + 1e-3 * (self.high - self.low) * random.standard_normal(start.shape), self.low, self.high)
        sampler = emcee.EnsembleSampler(WALKERS, len(self.names), self.log_density, vectorize=True,
                                        moves=[(emcee.moves.DEMove(), 0.8), (emcee.moves.StretchMove(), 0.2)])
        state, steps, time = emcee.State(start, random_state=random.get_state()), 0, np.inf
        while not steps >= LONG_ENOUGH * time:
            if steps >= MOST_STEPS:
                raise NotConvergedError(f"the chains still remember their start after {steps} steps (correlation time {time:.0f})")
            count = max(FIRST_STEPS, steps)
            for _ in sampler.sample(state, iterations=count, skip_initial_state_check=True):
                pass
            state, steps = sampler.get_last_sample(), steps + count
            time = float(np.max(sampler.get_autocorr_time(tol=0)))
            progress(steps)
        forgotten, apart = int(5 * time), max(1, int(time / 2))
        return (sampler.get_chain(discard=forgotten, thin=apart, flat=True), sampler.get_log_prob(discard=forgotten, thin=apart, flat=True))

    def misfit(self, samples):
        """{chi_square, data, without, share}: sum of squares of the best point, the same without an entry of the data, and the share of data sets drawn from
        the posterior that contradict themselves as badly: an entry with a free offset makes them as much more likely."""
        random = np.random.default_rng(4)
        chosen = samples[random.choice(len(samples), REPLICATES)]
        tried = np.concatenate([chosen, self.of_prior(1024)])
        drawn = [datum.drawn(self.unit(chosen), random) for datum in self.data]
        there = [datum.at(self.unit(tried)) for datum in self.data]
        conflict, best, without = self._conflict(there, [datum.values for datum in self.data])
        replicated = [self._conflict(there, [values[number] for values in drawn])[0] for number in range(REPLICATES)]
        count = sum(len(datum.values) for datum in self.data)
        return {"chi_square": best, "data": count, "without": without, "share": float(np.mean(np.array(replicated) >= conflict))}

    def _conflict(self, there, values):
        """(greatest contradiction of one entry to the others, sum of squares of the most likely point, {entry: the same without it}). Twice the gain in log
        likelihood by a free offset of the entry is as chi square of its numbers; of all entries in normal deviations."""
        parts = [datum.squares(*at, of) for datum, at, of in zip(self.data, there, values)]
        level, squares = 2 * sum(np.log(deviations).sum(axis=-1) for _, deviations in there), sum(parts)
        likely = int((level + squares).argmin())
        greatest, without = -np.inf, {}
        for datum, at, of, part in zip(self.data, there, values, parts):
            for name, numbers in datum.entries():
                freed = squares - part + datum.squares(*at, of, numbers)
                likely_then = int((level + freed).argmin())
                gain = (level + squares)[likely] - (level + freed)[likely_then]
                greatest = max(greatest, scipy.stats.norm.isf(scipy.stats.chi2.sf(gain, len(numbers))))
                without[name] = float(freed[likely_then])
        return greatest, float(squares[likely]), without

    def predicted(self, samples):
        """For each scene (means, standard deviations) of what the posterior expects to be measured."""
        random = np.random.default_rng(5)
        chosen = samples[random.choice(len(samples), 1000)]
        drawn = [datum.drawn(self.unit(chosen), random) for datum in self.data]
        return [(values.mean(axis=0), values.std(axis=0)) for values in drawn]


def share_above(log_densities, density):
    """Share of the samples whose density is higher: the least region of highest density that holds a point of that density."""
    return float(np.mean(log_densities > density))
