"""Contact problems on scipy matrices."""

import json

import drumlin
import numpy as np
import pytest
import scipy.sparse

# A disc of mass 1 in a corner: floor and wall, normal first.
W = np.array([[1.0, 0, 0, 1], [0, 3, -1, 2], [0, -1, 1, 0], [1, 2, 0, 3]])
Q = np.array([-1, 0.5, -0.5, -1])


@pytest.mark.parametrize("solver", ["accelerated", "nlgs", "nncg", "reference"])
def test_the_solution_obeys_signorini_and_coulomb(solver):
    assert solver in drumlin.contact_solvers()
    found = drumlin.solve_contacts(scipy.sparse.csr_matrix(W), Q, [0.3, 0.3], tolerance=1e-12, solver=solver)
    assert found.converged and found.status == "converged" and found.residual <= 1e-12
    r, u = found.r, found.u
    assert (r.reshape(-1) @ W + Q == pytest.approx(u.reshape(-1), abs=1e-12))
    assert (r[:, 0] >= 0).all() and (u[:, 0] >= -1e-11).all() and np.abs(r[:, 0] * u[:, 0]).max() < 1e-11
    assert (np.abs(r[:, 1]) <= 0.3 * r[:, 0] + 1e-12).all()
    assert drumlin.contact_residual(W, Q, 0.3, r) == pytest.approx(found.residual, abs=1e-14)
    assert drumlin.contact_residual(W, Q, 0.3, 0 * r) > 0.1


def test_a_problem_of_a_file_is_solved_as_the_command_solves_it(data):
    file = data / "problems/drum-300-mu-0.4-flow.h5"
    problem = drumlin.read(file)
    found = drumlin.solve_contacts(problem.W, problem.q, problem.mu, tolerance=1e-4)
    assert found.converged and found.discs
    said = json.loads(drumlin.command("solve-contacts", file, "--tolerance", 1e-4, "--json"))
    assert said["sweeps"] == found.sweeps and said["residual"] == found.residual and said["discs"] == found.discs


def test_what_is_no_problem_is_refused():
    for matrix, text in [(W[:3], "W: 3 rows"), (W + np.triu(W), "not symmetric"), (-W, "no symmetric positive definite diagonal block"),
                         (np.where(W == 3, np.nan, W), "W/x: a number is not finite")]:
        with pytest.raises(drumlin.InputError, match=text):
            drumlin.solve_contacts(matrix, Q, 0.3)
    with pytest.raises(drumlin.InputError, match="friction -0.1"):
        drumlin.solve_contacts(W, Q, [-0.1, 0.3])
    with pytest.raises(drumlin.InputError, match="q: not of length 6"):
        drumlin.solve_contacts(W, Q, [0.3, 0.3, 0.3])
    with pytest.raises(drumlin.InputError, match="none"):
        drumlin.solve_contacts(W, Q, 0.3, solver="none")
    for words, text in [({"tolerance": -1}, "tolerance: is -1"), ({"tolerance": np.nan}, "tolerance: is nan"), ({"tolerance": 11}, "tolerance: is 11"),
                        ({"max_seconds": np.nan}, "max_seconds"), ({"threads": 0}, "threads: is 0"), ({"threads": 257}, "threads: is 257")]:
        with pytest.raises(drumlin.InputError, match=text):
            drumlin.solve_contacts(W, Q, 0.3, **words)


def test_a_missed_tolerance_is_reported_not_raised(data):
    problem = drumlin.read(data / "problems/drum-300-mu-0.95-flow.h5")
    found = drumlin.solve_contacts(problem.W, problem.q, problem.mu, tolerance=1e-15, max_seconds=0.05)
    assert not found.converged and found.status == "out of time" and found.residual > 0
