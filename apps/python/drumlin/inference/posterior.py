"""The posterior of the unknowns: prior, likelihood by emulators, samples, and whether anything in the ranges explains the data."""

import dataclasses

import numpy as np
import scipy.stats

from ..errors import InputError, NotConvergedError

WALKERS, FIRST_STEPS, MOST_STEPS = 128, 250, 8000
LONG_ENOUGH = 20  # correlation times that the chains have to last
DRAWN = 4096  # points of the prior from which the chains start
REPLICATES = 400  # data sets drawn from the posterior, against which the misfit is judged
MISFIT = 0.01  # share of them that fit as badly: below it the data are called a misfit


def _emcee():
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

    def at(self, points):
        """(means, deviations of what is measured from them) at each point."""
        means, own = self.emulator.predict(points)
        return means, self.emulator.deviations(own, self.errors, self.realisations)

    def rest(self, means, deviations, values=None):
        """Of the values from the means, in independent units."""
        scaled = ((self.values if values is None else values) - means) / deviations
        return scaled @ self.emulator.inverse_factor.T

    def log_likelihood(self, points):
        means, deviations = self.at(points)
        return -0.5 * np.sum(self.rest(means, deviations) ** 2, axis=-1) - np.log(deviations).sum(axis=-1)

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
        emcee, random = _emcee(), np.random.RandomState(3)  # pylint: disable=no-member
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
        """{chi_square, data, share}: sum of squares of the best point, and the share of data sets drawn from the posterior whose best point fits as badly."""
        random = np.random.default_rng(4)
        chosen = samples[random.choice(len(samples), REPLICATES)]
        tried = np.concatenate([chosen, self.of_prior(1024)])
        drawn = [datum.drawn(self.unit(chosen), random) for datum in self.data]
        there = [datum.at(self.unit(tried)) for datum in self.data]
        best = _squares([datum.rest(*at) for datum, at in zip(self.data, there)])
        replicated = [_squares([datum.rest(*at, values[number]) for datum, at, values in zip(self.data, there, drawn)]) for number in range(REPLICATES)]
        count = sum(len(datum.values) for datum in self.data)
        return {"chi_square": best, "data": count, "share": float(np.mean(np.array(replicated) >= best))}

    def predicted(self, samples):
        """For each scene (means, standard deviations) of what the posterior expects to be measured."""
        random = np.random.default_rng(5)
        chosen = samples[random.choice(len(samples), 1000)]
        drawn = [datum.drawn(self.unit(chosen), random) for datum in self.data]
        return [(values.mean(axis=0), values.std(axis=0)) for values in drawn]


def _squares(rests):
    """The least sum of squares over the points."""
    return float(np.min(sum(np.sum(rest**2, axis=-1) for rest in rests)))


def share_above(log_densities, density):
    """Share of the samples whose density is higher: the least region of highest density that holds a point of that density."""
    return float(np.mean(log_densities > density))
