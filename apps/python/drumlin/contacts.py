"""One contact problem: u = W r + q, Signorini's condition and Coulomb's law at each contact, two rows each, normal first."""

import dataclasses
import operator

import numpy as np
import scipy.sparse

from . import _drumlin


@dataclasses.dataclass(frozen=True)
class ContactSolution:
    """r: impulses, u: velocities, both (contacts, 2) with the normal component first. The report is of r, by the project's one residual."""

    r: np.ndarray
    u: np.ndarray
    converged: bool
    status: str
    residual: float
    residual_max: float
    sweeps: int
    seconds: float
    discs: bool
    asymmetry: float


def _arrays(W, q, mu):
    W = scipy.sparse.coo_matrix(W)
    q = np.asarray(q, float).reshape(-1)
    if W.shape != (q.size, q.size):
        raise _input_error(f"W: {W.shape[0]} rows and {W.shape[1]} columns (allowed: as many as q has numbers, {q.size})")
    mu = np.asarray(mu, float)
    if mu.ndim == 0:
        mu = np.full(q.size // 2, float(mu))
    return W.row.astype(np.int32), W.col.astype(np.int32), W.data.astype(float), q, mu.reshape(-1)


def _input_error(text):
    from .errors import InputError
    return InputError(text)


MOST_TOLERANCE, MOST_THREADS = 10, 256  # as `drumlin solve-contacts` takes them


def _checked_limits(tolerance, max_seconds, threads):
    """As the command refuses them; comparisons are false for NaN."""
    if not 0 < tolerance <= MOST_TOLERANCE:
        raise _input_error(f"tolerance: is {tolerance} (allowed: above 0 to {MOST_TOLERANCE})")
    if not max_seconds > 0:
        raise _input_error(f"max_seconds: is {max_seconds} (allowed: above 0)")
    if not 1 <= operator.index(threads) <= MOST_THREADS:
        raise _input_error(f"threads: is {threads} (allowed: 1 to {MOST_THREADS})")


def solve_contacts(W, q, mu, tolerance=1e-8, solver="accelerated", max_seconds=60.0, threads=1):
    """Solves a problem with W a scipy matrix or array, q of length 2 n, mu a number or one per contact.

    What misses the tolerance does not raise: `converged` and `status` say so, and the residual is that of what is returned.
    """
    _checked_limits(tolerance, max_seconds, threads)
    found = _drumlin.solve_contacts(*_arrays(W, q, mu), tolerance, max_seconds, solver, threads)
    return ContactSolution(**{name: value.reshape(-1, 2) if name in "ru" else value for name, value in found.items()})


def contact_residual(W, q, mu, r):
    """The residual of any impulses r, by whatever they were found: 0 where they solve the problem."""
    return _drumlin.contact_residual(*_arrays(W, q, mu), np.asarray(r, float).reshape(-1))


def contact_solvers():
    """The names that solve_contacts takes."""
    return _drumlin.contact_solvers()
