"""What callers do wrong raises; nothing of it ends the interpreter."""

import copy
import os
import pickle
import subprocess
import sys
import threading

import drumlin
import numpy as np
import pytest
import scipy.sparse
from drumlin import _drumlin
from test_contacts import Q, W

LONG = "problems/drum-300-mu-0.95-flow.h5"


def in_threads(*works):
    threads = [threading.Thread(target=work) for work in works]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()


def test_threads_share_a_simulation_step_by_step(box, tmp_path):
    alone, shared = drumlin.Simulation(box), drumlin.Simulation(box)
    alone.run(steps=200)
    seen = []

    def look():
        while shared.steps < 200:
            seen.append((len(shared.contacts), shared.kinetic_energy, shared.mass.sum(), shared.scales["time_s"], shared.stage))
        shared.save_snapshot(tmp_path / "s.h5")

    in_threads(look, look, *[lambda: [shared.step() for _ in range(50)]] * 4)
    assert shared.steps == 200 and (shared.z == alone.z).all() and (shared.contacts == alone.contacts).all()
    assert seen and (drumlin.read(tmp_path / "s.h5").z == alone.z).all()


def test_threads_meet_the_end_of_a_scene(box):
    simulation, refused = drumlin.Simulation(box, {"stages.0.duration_s": 0.03}), []

    def step():
        try:
            while True:
                simulation.step()
        except drumlin.InputError as error:
            refused.append(str(error))

    in_threads(step, step, step)
    assert simulation.steps == 30 and len(refused) == 3 and "finished" in refused[0]


@pytest.mark.parametrize("work", ["drumlin.Simulation({scene!r}).run()",
                                  "drumlin.solve_contacts(p.W, p.q, p.mu, tolerance=1e-300, max_seconds=600)",
                                  "[drumlin.calibrate(I, 0.35 + 0.02 * np.log(I), nu=0.8, draws=10000) for _ in range(1000)]"])
def test_the_interpreter_ends_while_a_daemon_computes(work, box, data):
    work = work.format(scene=box | {"stages": [{"name": "fall", "duration_s": 1000, "time_step_s": 1e-3}]})
    program = f"""import sys, threading, time
sys.path.insert(0, {os.environ["DRUMLIN_PACKAGE"]!r})
import drumlin, numpy as np
p, I = drumlin.read({str(data / LONG)!r}), np.logspace(-3, -1, 60)
threading.Thread(target=lambda: {work}, daemon=True).start()
time.sleep(0.1)
"""
    result = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=600, check=False)
    assert (result.returncode, result.stdout, result.stderr) == (0, "", "")


def test_an_argument_of_another_type_is_not_printed(box):
    simulation, many = drumlin.Simulation(box), np.full(60, 0.31415)
    for work in (lambda: drumlin.calibrate(many, many, nu=0.8, form=many), lambda: simulation.set_wall(many),
                 lambda: drumlin.Simulation(box, threads=many), lambda: _drumlin.law(many)):
        with pytest.raises(TypeError, match="argument types are supported") as refused:
            work()
        assert "3141" not in str(refused.value)


@pytest.mark.parametrize("cls", [drumlin.Simulation, drumlin.Law, drumlin.laws.CalibratedLaw])
def test_an_object_without_its_beginning_has_no_content(cls):
    empty = cls.__new__(cls)
    for name in ("x", "contacts", "steps", "mass", "nu", "words", "form", "range"):
        with pytest.raises(AttributeError):
            getattr(empty, name)
    for work in ("step", "run", "mu", "band"):
        with pytest.raises((AttributeError, TypeError)):
            getattr(empty, work)(*([1.0] if work in ("mu", "band") else []))


@pytest.mark.parametrize("cls", [_drumlin.SteppedScene, _drumlin.Law, _drumlin.Calibration])
def test_compiled_classes_are_not_made_by_their_names(cls):
    class Under(cls):
        def __new__(cls):
            return super().__new__(cls)

    for make in (cls, lambda: cls.__new__(cls), lambda: object.__new__(cls), Under):
        with pytest.raises(TypeError):
            make()


def test_copies_are_whole(box, data):
    simulation, law, I = drumlin.Simulation(box), drumlin.Law(data / "rheology/paper.toml"), np.logspace(-3, -1, 60)  # noqa: E741
    fitted = drumlin.calibrate(I, 0.35 + 0.02 * np.log(I), nu=0.81, draws=20)
    for work in (copy.copy, copy.deepcopy, lambda whole: pickle.loads(pickle.dumps(whole))):
        other = work(simulation)
        other.step()
        assert (simulation.steps, other.steps) == (0, 1) and work(law).text == law.text
        assert work(fitted).band(0.01) == fitted.band(0.01)
    with pytest.raises(TypeError, match="pickle"):
        pickle.dumps(simulation._scene)


def test_a_simulation_that_is_begun_again_keeps_what_was_seen_of_it(box):
    simulation = drumlin.Simulation(box)
    x = simulation.x
    before = x.copy()
    for _ in range(20):
        simulation.__init__(box)
    simulation.run(steps=5)
    assert (x == before).all() and simulation.steps == 5
    with pytest.raises(drumlin.InputError):
        simulation.__init__({"title": "none"})
    with pytest.raises(drumlin.InputError, match="threads: 1000000"):
        drumlin.Simulation(box, threads=10**6)


def changed(matrix, **members):
    matrix = matrix.copy()
    for name, values in members.items():
        setattr(matrix, name, values)
    return matrix


BROKEN_POINTERS = ([0, 10**8, 3, 4, 10], [0, -5, 3, 4, 10], [5, 4, 3, 2, 1], [0] + [10**9] * 4, [0, 3, 5], [])


@pytest.mark.parametrize("matrix", [
    *[changed(kind(W), indptr=np.array(bad, np.int32)) for kind in (scipy.sparse.csr_matrix, scipy.sparse.csc_matrix) for bad in BROKEN_POINTERS],
    *[changed(kind(W), indices=kind(W).indices.astype(np.int64) + add) for kind in (scipy.sparse.csr_matrix, scipy.sparse.csc_matrix)
      for add in (10**8, -10**8, 2**32)],
    *[changed(scipy.sparse.coo_matrix(W), **{name: scipy.sparse.coo_matrix(W).row.astype(np.int64) + add}) for name in ("row", "col")
      for add in (10**8, -10**8, 2**32)],
    *[changed(scipy.sparse.coo_matrix(W), **{name: np.zeros(count, np.int32)}) for name in ("row", "col", "data") for count in (0, 1, 3)],
    changed(scipy.sparse.csr_matrix(W), indices=np.zeros(2, np.int32)), changed(scipy.sparse.csr_matrix(W), data=np.zeros(2)),
    changed(scipy.sparse.bsr_matrix(W, blocksize=(2, 2)), indptr=np.array([0, 10**8, 4])),
    changed(scipy.sparse.bsr_matrix(W, blocksize=(2, 2)), indices=np.array([0, 7, 0, 7]))])
def test_indices_outside_of_a_matrix_are_refused(matrix):
    for work in (lambda: drumlin.solve_contacts(matrix, Q, 0.3), lambda: drumlin.contact_residual(matrix, Q, 0.3, Q)):
        with pytest.raises(drumlin.InputError, match="^W: "):
            work()


def test_short_arrays_are_refused_by_the_compiled_part_too():
    entries = scipy.sparse.coo_matrix(W)
    for rows, columns in ((entries.row[:1], entries.col), (entries.row, entries.col[:0])):
        with pytest.raises(drumlin.InputError, match="not as many"):
            _drumlin.contact_residual(rows, columns, np.ones(entries.nnz), Q, np.array([0.3, 0.3]), Q)
    with pytest.raises(drumlin.InputError, match="outside the matrix"):
        _drumlin.contact_residual(entries.row + 4, entries.col, entries.data, Q, np.array([0.3, 0.3]), Q)


def test_ctrl_c_is_that_of_the_main_thread(data, interrupt_when):
    problem, others = drumlin.read(data / LONG), []
    other = threading.Thread(target=lambda: others.append(
        drumlin.solve_contacts(problem.W, problem.q, problem.mu, tolerance=1e-300, max_seconds=2).status))
    other.start()
    interrupt_when(seconds=0.3)
    with pytest.raises(KeyboardInterrupt):
        drumlin.solve_contacts(problem.W, problem.q, problem.mu, tolerance=1e-300, max_seconds=600)
    other.join()
    assert others == ["out of time"]


def test_complex_numbers_are_refused():
    I, j = np.logspace(-3, -1, 60), 0.5j  # noqa: E741
    mu = 0.35 + 0.02 * np.log(I)
    law = drumlin.calibrate(I, mu, nu=0.81, draws=20)
    for work in (lambda: drumlin.solve_contacts(W + j, Q, 0.3), lambda: drumlin.solve_contacts(scipy.sparse.csr_matrix(W + j), Q, 0.3),
                 lambda: drumlin.solve_contacts(W, Q + j, 0.3), lambda: drumlin.solve_contacts(W, Q, 0.3 + j),
                 lambda: drumlin.contact_residual(W, Q, 0.3, Q + j), lambda: drumlin.calibrate(I, mu + j, nu=0.81),
                 lambda: drumlin.calibrate(I, mu, mu_error=mu + j, nu=0.81), lambda: law.mu(I + j), lambda: law.slope(j), lambda: law.band(I + j)):
        with pytest.raises(drumlin.InputError, match="complex"):
            work()


def test_numbers_that_no_machine_has_room_for_are_refused():
    I = np.logspace(-3, -1, 60)  # noqa: E741
    mu = 0.35 + 0.02 * np.log(I)
    for draws in (10**9, 10001, 19, -1):
        with pytest.raises(drumlin.InputError, match="draws: .*allowed: 20 to 10000"):
            drumlin.calibrate(I, mu, nu=0.81, draws=draws)
    law = drumlin.calibrate(I, mu, nu=0.81, draws=20)
    for share in (np.nan, -1, 2):
        with pytest.raises(drumlin.InputError, match="share"):
            law.band(I, share)


def test_a_nul_in_a_name_is_refused(box, data, tmp_path):
    simulation, law = drumlin.Simulation(box), drumlin.Law(data / "rheology/paper.toml")
    for kind, end in ((str, "a\0b"), (os.fsencode, b"a\0b")):
        name = kind(tmp_path / "x") + end
        for work in (drumlin.read, drumlin.Law, drumlin.Simulation, drumlin.resolved, simulation.save_snapshot, law.write):
            with pytest.raises(drumlin.InputError, match="NUL"):
                work(name)
    with pytest.raises(drumlin.InputError, match="NUL"):
        drumlin.command("scene", "check", "a\0b")
    assert not list(tmp_path.iterdir())


def test_names_that_are_no_utf8_are_names(box, tmp_path):
    folder = os.fsdecode(os.fsencode(tmp_path) + b"/caf\xe9")
    os.mkdir(folder)
    drumlin.Simulation(box).save_snapshot(folder + "/s.h5")
    assert len(drumlin.read(folder + "/s.h5").x) == 20
    with open(folder + "/scene.toml", "w", encoding="utf-8") as file:
        file.write(drumlin.toml_of({"format": "drumlin-scene-1"} | box))
    assert drumlin.Simulation(folder + "/scene.toml").step()["sweeps"] > 0
    with pytest.raises(drumlin.InputError, match="caf.*none.toml"):
        drumlin.Simulation(folder + "/none.toml")


