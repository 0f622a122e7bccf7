"""Paths of the material through the maps of several runs, and errors of what is fitted to them."""

import math

import numpy as np
import scipy.special

BED = 1e-3  # I, below which a path ends in the bed
SECTOR_DEG = 15  # about the drum's axis: what is left out for an interval


class Paths:
    """Arrays (paths,) of all beds one after the other: angle, radius, axis, ln_I, spin_share, stress, p, sector, I and unweighed_I, without the
    beds' own weight, and amount, mu(unweighed_I) at their ends."""

    def __init__(self, beds, amount, kept=slice(None)):
        self.beds, self.kept = beds, kept
        each = [bed.paths for bed in beds]
        for name in each[0]:
            setattr(self, name, np.concatenate([paths[name] for paths in each])[kept])
        self.I = np.exp(self.ln_I)  # noqa: E741
        self.unweighed_I = self.I * np.sqrt(1 + beds[0].own_weight / self.p)
        self.amount = amount(self.unweighed_I)
        self.sector = np.rint(np.degrees(self.angle) / SECTOR_DEG)
        self.in_bed = self.I < BED

    def of(self, value):
        """value(bed), an entry for each path of it."""
        return np.concatenate([value(bed) for bed in self.beds])[self.kept]

    def axes(self, law):
        """(n + m A)/rho, the stress over p and amount."""
        return self.of(lambda bed: bed.axes(*law))


def rms(values):
    return np.sqrt(np.mean(np.abs(values) ** 2)) if np.size(values) else math.nan


def without_each(groups):
    """Masks of what is left where one group each is left out, in their order."""
    return [groups != group for group in np.unique(groups)]


def half_width(without):
    """Half width of the 99 % interval of an estimate from its values with one part left out each: the jackknife with the correlation of neighbours where it
    is positive, times Student's t; NaN of one value."""
    count, off = len(without), without - np.mean(without)
    return student_99(count) * np.sqrt((count - 1) / count * (off @ off + 2 * max(0, off[:-1] @ off[1:])))


def student_99(count):
    """Half width of a 99 % interval per standard error of `count` values; NaN of one."""
    return scipy.special.stdtrit(count - 1, 0.995) if count > 1 else math.nan
