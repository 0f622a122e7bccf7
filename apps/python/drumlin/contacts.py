"""One contact problem: u = W r + q, Signorini's condition and Coulomb's law at each contact, two rows each, normal first."""

import dataclasses
import operator

import numpy as np
import scipy.sparse

from . import _drumlin
from .errors import InputError
from .inputs import real


@dataclasses.dataclass(frozen=True)
class ContactSolution:
    """r: impulses, u: velocities, both (contacts, 2) with the normal component first. The report is of r, by the project's one residual.

    >>> solution = drumlin.solve_contacts(W, q, mu=0.4)
    >>> solution.status, solution.residual, solution.r.shape
    """

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


def _entries(W):
    """Rows, columns and values of a matrix, whose indices scipy follows wherever they lead."""
    try:
        if hasattr(W, "check_format"):  # compressed
            W.check_format()
        if not scipy.sparse.isspmatrix_coo(W):
            W = scipy.sparse.coo_matrix(W)
        for index, size in zip((W.row, W.col), W.shape, strict=True):
            if index.shape != W.data.shape or (index.size and not (0 <= index.min() and index.max() < size)):
                raise InputError("W: an index lies outside the matrix, or is missing")
    except ValueError as error:
        raise InputError(f"W: {error}".replace("W: W: ", "W: ")) from None
    return W.row.astype(np.int32), W.col.astype(np.int32), real("W", W.data)


def _arrays(W, q, mu):
    rows, columns, values = _entries(W)
    q = real("q", q).reshape(-1)
    shape = np.shape(W)
    if shape != (q.size, q.size):
        raise InputError(f"W: {shape[0]} rows and {shape[1]} columns (allowed: as many as q has numbers, {q.size})")
    mu = real("mu", mu)
    if mu.ndim == 0:
        mu = np.full(q.size // 2, float(mu))
    return rows, columns, values, q, mu.reshape(-1)


MOST_TOLERANCE, MOST_THREADS = 10, 256  # as `drumlin solve-contacts` takes them


def _checked_limits(tolerance, max_seconds, threads):
    """As the command refuses them; comparisons are false for NaN."""
    if not 0 < tolerance <= MOST_TOLERANCE:
        raise InputError(f"tolerance: is {tolerance} (allowed: above 0 to {MOST_TOLERANCE})")
    if not max_seconds > 0:
        raise InputError(f"max_seconds: is {max_seconds} (allowed: above 0)")
    if not 1 <= operator.index(threads) <= MOST_THREADS:
        raise InputError(f"threads: is {threads} (allowed: 1 to {MOST_THREADS})")


def solve_contacts(W, q, mu, tolerance=1e-8, solver="accelerated", max_seconds=60.0, threads=1):
    """Solves a problem with W a scipy matrix or array, q of length 2 n, mu a number or one per contact.

    What misses the tolerance does not raise: `converged` and `status` say so, and the residual is that of what is returned.

    >>> solution = drumlin.solve_contacts(W, q, mu=0.4, tolerance=1e-6)
    """
    _checked_limits(tolerance, max_seconds, threads)
    found = _drumlin.solve_contacts(*_arrays(W, q, mu), tolerance, max_seconds, solver, threads)
    return ContactSolution(**{name: value.reshape(-1, 2) if name in "ru" else value for name, value in found.items()})


def contact_residual(W, q, mu, r):
    """The residual of any impulses r, by whatever they were found: 0 where they solve the problem.

    >>> drumlin.contact_residual(W, q, 0.4, solution.r)
    """
    return _drumlin.contact_residual(*_arrays(W, q, mu), real("r", r).reshape(-1))


def contact_solvers():
    """The names that solve_contacts takes.

    >>> drumlin.contact_solvers()
    """
    return _drumlin.contact_solvers()
