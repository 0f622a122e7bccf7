"""The length over which flow spreads, read off maps: nonlocal fluidity with a threshold (docs/theory/rheology.md), and whether the runs ask for either."""

import dataclasses
import math

import numpy as np
from drumlin.errors import InputError

from .paths import BED, SECTOR_DEG, half_width, rms, without_each

THRESHOLD_STEP, BIN = 0.002, 0.02  # of the mu_s that are tried, of the table of lengths
SPACING, REACH, LEAST_NODES = 4, 6, 40  # d between points; d about each of nodes that ln g is fitted over, and their least number
SURFACE_MARGIN, WALL_MARGIN = 3, 4  # d


def points_of(bed, x, z):
    """(mu, I, lap g/g per d^2, sector about the drum's axis), each (points,), of nodes in the packing with enough of them around: g = 2|D|/mu, mu = |s|/p;
    lap g/g = lap ln g + |grad ln g|^2 of a quadratic through ln g."""
    nodes = bed.nodes
    rate, p = np.abs(nodes["rate"]), nodes["p"]
    with np.errstate(all="ignore"):
        mu, inertial = np.abs(nodes["stress"]) / p, 2 * rate / np.sqrt(p)
        ln_g = np.log(np.where((rate > 0) & (mu > 0) & (p > 0), 2 * rate / mu, np.nan))
    points, (every_x, every_z) = [], (max(1, round(SPACING / (at[1] - at[0]))) for at in (x, z))
    for column in range(0, x.size, every_x):
        for row in range(0, z.size, every_z):
            depth = bed.axis - z[row]
            if (not np.isfinite(ln_g[row, column]) or z[row] > min(0, nodes["surface"][column]) - SURFACE_MARGIN
                    or math.hypot(x[column], depth) > bed.radius - WALL_MARGIN):
                continue
            rows, columns = np.flatnonzero(np.abs(z - z[row]) < REACH), np.flatnonzero(np.abs(x - x[column]) < REACH)
            dz, dx = (at.ravel() for at in np.meshgrid(z[rows] - z[row], x[columns] - x[column], indexing="ij"))
            y = ln_g[np.ix_(rows, columns)].ravel()
            near = (np.hypot(dx, dz) < REACH) & np.isfinite(y)
            if near.sum() < LEAST_NODES:
                continue
            dx, dz = dx[near], dz[near]
            _, x_1, z_1, xx, _, zz = np.linalg.lstsq(np.column_stack([np.ones(dx.size), dx, dz, dx * dx, dx * dz, dz * dz]), y[near], rcond=None)[0]
            sector = math.floor(math.degrees(math.atan2(x[column], depth)) / SECTOR_DEG)
            points.append((mu[row, column], inertial[row, column], 2 * (xx + zz) + x_1**2 + z_1**2, sector))
    return np.transpose(points) if points else np.empty((4, 0))


def _amplitude(missing, curvature):
    """A and the rms that it leaves of mu at a threshold; `missing`: max(mu_loc, mu_s) - mu."""
    square = curvature @ curvature
    squared = max(0.0, missing @ curvature / square) if square > 0 else 0.0
    return math.sqrt(squared), rms(missing - squared * curvature)


def _best(mu, curvature, local):
    """(A, mu_s) that leave least of mu."""
    thresholds = np.arange(local.min(), local.max() + 1e-12, THRESHOLD_STEP)
    trials = [_amplitude(np.maximum(local, mu_s) - mu, curvature) for mu_s in thresholds]
    best = int(np.argmin([left for _, left in trials]))
    return np.array([trials[best][0], thresholds[best]])


@dataclasses.dataclass
class Spreading:
    """amplitude and mu_s with half widths over the sectors of the drum (None: of too few), and the record's other numbers."""

    amplitude: float
    mu_s: float
    amplitude_ci99: float | None
    mu_s_ci99: float | None
    record: dict

    @property
    def is_told(self):
        """Whether the amplitude lies outside its own interval of nought: what is not told is no part of a law."""
        return self.amplitude_ci99 is not None and self.amplitude > self.amplitude_ci99

    @property
    def law(self):
        return {key: value for key, value in vars(self).items() if key != "record" and value is not None}

    def untold(self):
        """What the runs cannot tell, as sentences."""
        of, said = self.record, []
        if of["rms_bed"] > 0.95 * of["rms_local_bed"]:
            said.append(f"a threshold: |s|/p that follows I in the bed leaves {of['rms_local_bed']:.4f} (rms), the best threshold {of['rms_bed']:.4f}: the "
                        "runs do not require one")
        if not self.is_told:
            said.append(f"a length: A = {self.amplitude:.2f} is not distinguished from 0, and the law is left without one")
        return said + ["what stops flow: a threshold asks lap g/g to fall in a line as |s|/p rises to mu_s; their correlation in the bed is "
                       f"{of['correlation_bed']:+.2f}"]


def spreading_of(points, amount):
    """mu = max(mu_loc(I), mu_s) - A^2 lap g/g by least squares over all points; `amount`: mu_loc."""
    mu, inertial, curvature, sector = points
    bed = inertial < BED
    if bed.sum() < 50:
        raise InputError(f"--nonlocal: {bed.sum()} points with I < {BED:g} (needed: 50): how flow decays shows in a bed; take runs of a larger drum")
    local = amount(inertial)
    A, mu_s = _best(mu, curvature, local)
    half = [None, None]
    if np.unique(sector).size > 2:
        half = [half_width(values) for values in np.transpose([_best(mu[rest], curvature[rest], local[rest]) for rest in without_each(sector)])]
    left = np.maximum(local, mu_s) - A**2 * curvature - mu
    given = []
    for threshold in BIN * np.arange(9, 15):
        missing = np.maximum(local, threshold) - mu
        at = _amplitude(missing, curvature)[0]
        given.append({"mu_s": threshold, "amplitude": at, "rms_bed": rms((missing - at**2 * curvature)[bed])})
    lengths = []
    for low in BIN * np.arange(round(1 / BIN)):
        there = (mu >= low) & (mu < low + BIN)
        if there.sum() >= 5:
            mean = np.mean(curvature[there])
            lengths.append({"mu": [low, low + BIN], "points": int(there.sum()), "I": np.exp(np.mean(np.log(inertial[there]))), "curvature": mean,
                            "xi": 1 / math.sqrt(mean) if mean > 0 else math.nan})
    return Spreading(A, mu_s, *half, {
        "points": mu.size, "rms": rms(left), "rms_bed": rms(left[bed]), "rms_local": rms(local - mu), "rms_local_bed": rms((local - mu)[bed]),
        "correlation_bed": np.corrcoef(mu[bed], curvature[bed])[0, 1], "given_mu_s": given, "lengths": lengths})
