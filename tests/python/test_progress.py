"""Long calls: what they show, and that Ctrl-C ends them and what they have started."""

import concurrent.futures
import os
import signal
import sys

import drumlin
import numpy as np
import pytest
from conftest import SOURCES

I = np.logspace(-3, -1, 60)  # noqa: E741


@pytest.mark.parametrize("tqdm", [True, False])
def test_a_long_call_shows_how_far_it_is_and_where_its_results_are(box, tmp_path, capfd, monkeypatch, tqdm):
    if tqdm:
        pytest.importorskip("tqdm")
    else:
        monkeypatch.setitem(sys.modules, "tqdm", None)
    box["stages"][0]["snapshots"] = 30
    drumlin.run(box, tmp_path / "RUN", progress=True)
    assert f"results: {tmp_path}/RUN\n" in capfd.readouterr().err
    drumlin.Simulation(box).run(steps=20, progress=True)
    assert ("steps: 100%" if tqdm else "steps: 100 %") in capfd.readouterr().err
    drumlin.calibrate(I, 0.35 + 0.02 * np.log(I), nu=0.8, draws=20, progress=True)
    assert "calibrate: " in capfd.readouterr().err


def test_nothing_is_shown_without_a_terminal(box, tmp_path, capfd):
    drumlin.run(box, tmp_path / "RUN")
    drumlin.sweep(box, {"solver.tolerance": [1e-3]}, tmp_path / "SWEEP", report=False)
    drumlin.Simulation(box).run(steps=20)
    drumlin.calibrate(I, 0.35 + 0.02 * np.log(I), nu=0.8, draws=20)
    assert capfd.readouterr().err == ""


def test_lines_of_progress_are_no_part_of_an_error(box, tmp_path):
    changes = {"solver.max_sweeps": 1, "solver.check_every": 1, "solver.tolerance": 1e-12, "solver.stop_when_unconverged": True}
    with pytest.raises(drumlin.NotConvergedError) as failed:
        drumlin.run(box, tmp_path / "RUN", changes, progress=True)
    assert "contact solver" in str(failed.value) and "%" not in str(failed.value)


@pytest.mark.parametrize("executor", [lambda: "local:2", lambda: concurrent.futures.ProcessPoolExecutor(2)], ids=["threads", "processes"])
def test_ctrl_c_ends_all_runs_of_a_sweep_and_the_same_call_goes_on(box, tmp_path, interrupt_when, executor):
    runs = [tmp_path / f"SWEEP/{number:03}" for number in range(3)]
    sweep = lambda: drumlin.sweep(box | {"stages": [{"name": "fall", "duration_s": 20, "time_step_s": 1e-3}]},  # noqa: E731
                                  {"effects.friction.grain_grain": [0.1, 0.2, 0.3]}, tmp_path / "SWEEP", executor(), report=False)

    interrupt_when(*(run / "log.csv" for run in runs[:2]))
    with pytest.raises(KeyboardInterrupt) as kept:  # with its traceback, as in a notebook
        sweep()
    assert kept and [drumlin.read(run)["run.json"]["status"] for run in runs[:2]] == ["interrupted"] * 2 and not runs[2].exists()
    assert [run.folder["run.json"]["status"] for run in sweep()] == ["finished"] * 3


def test_ctrl_c_ends_a_calibration_between_two_draws():
    done = []

    def drawn():
        done.append(1)
        if len(done) == 5:
            os.kill(os.getpid(), signal.SIGINT)

    with pytest.raises(KeyboardInterrupt):
        drumlin.CalibratedLaw([[I, 0.35 + 0.02 * np.log(I), np.full(60, np.nan), np.full(60, np.nan)]], ["a"], 0.8, "log", 10000, drawn=drawn)
    assert len(done) <= 6


def test_an_interrupted_run_is_whole_and_goes_on(tmp_path, interrupt_when):
    interrupt_when(tmp_path / "RUN/log.csv")
    scene, changes = SOURCES / "tests/chain/tiny-drum.toml", {"stages.1.turns": 2, "stages.2.turns": 0.02, "stages.2.snapshots": 4}
    with pytest.raises(KeyboardInterrupt, match="RUN: interrupted after step"):
        drumlin.run(scene, tmp_path / "RUN", changes)
    assert drumlin.read(tmp_path / "RUN")["run.json"]["status"] == "interrupted"
    assert drumlin.run(scene, tmp_path / "RUN", changes, resume=True)["run.json"]["status"] == "finished"
