"""Many jobs on executors, and a scene with many settings."""

import concurrent.futures
import functools
import os
import pathlib
import signal

import drumlin
import pytest
from drumlin.sweeping import executors
from drumlin.sweeping.executors import workers_of
from drumlin.sweeping.report import Report
from drumlin.sweeping.sweep import settings_of

# --- jobs: module-level functions, which pickle can write


def square(number):
    if number == 3:
        raise ValueError("three")
    return number**2


def dies_once(folder):
    """Ends its worker without a word the first time."""
    trace = pathlib.Path(folder) / "died"
    if not trace.exists():
        trace.touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return "alive"


def dies(_):
    os.kill(os.getpid(), signal.SIGKILL)


# --- executors


@pytest.mark.parametrize("executor", [None, "local:2", concurrent.futures.ThreadPoolExecutor(2), concurrent.futures.ProcessPoolExecutor(2)])
def test_outcomes_come_in_the_order_of_the_jobs_failed_ones_too(tmp_path, executor):
    ended = []
    outcomes = drumlin.run_all([functools.partial(square, n) for n in range(6)], tmp_path, executor, ended=lambda number, outcome: ended.append(number))
    assert [outcome.value for outcome in outcomes] == [0, 1, 4, None, 16, 25]
    assert [type(outcome.error) for outcome in outcomes] == [type(None)] * 3 + [ValueError] + [type(None)] * 2
    assert sorted(ended) == list(range(6)) and list(tmp_path.iterdir()) == []


def test_a_broken_pool_is_made_anew_once(tmp_path):
    pool = concurrent.futures.ProcessPoolExecutor(1)
    outcomes = drumlin.run_all([functools.partial(dies_once, tmp_path), *(functools.partial(square, n) for n in (1, 2))], tmp_path, pool)
    assert [outcome.value for outcome in outcomes] == ["alive", 1, 4]
    outcomes = drumlin.run_all([functools.partial(dies, 0)], tmp_path, concurrent.futures.ProcessPoolExecutor(1))
    assert isinstance(outcomes[0].error, concurrent.futures.BrokenExecutor)


@pytest.mark.parametrize("text", ["local:0", "local:-1", "local:two", "dask", "slurm"])
def test_an_executor_that_there_is_not_is_refused(tmp_path, text):
    with pytest.raises(drumlin.InputError, match=f"executor: '{text}' is none .allowed: local"):
        drumlin.run_all([functools.partial(square, 1)], tmp_path, text)


class Counting(concurrent.futures.ThreadPoolExecutor):
    submitted = 0

    def submit(self, *words):  # pylint: disable=arguments-differ
        self.submitted += 1
        return super().submit(*words)


def test_a_thousand_jobs_are_submitted_once_each_and_reported_seldom(tmp_path, monkeypatch):
    drawn = []
    monkeypatch.setattr("drumlin.sweeping.report.draw", lambda script, *words: drawn.append(script))
    monkeypatch.setattr("drumlin.sweeping.report.FIRST_S", 1e9)
    report = Report(tmp_path, "", False, [{"seed": n} for n in range(1000)])
    with Counting(2) as pool:
        outcomes = drumlin.run_all([functools.partial(dict, n=drumlin.study.Scalar(n)) for n in range(1000)], tmp_path, pool, ended=report.ended)
    report.renew("finished")
    assert pool.submitted == 1000 and [outcome.value["n"].value for outcome in outcomes] == list(range(1000))
    assert len(drawn) == 3  # the page at the beginning; figure and page at the end


def test_no_jobs_are_no_work(tmp_path):
    assert drumlin.run_all([], tmp_path) == []


# --- sweeps


def test_a_sweep_runs_every_combination_of_a_dict_and_goes_on(box, tmp_path, capfd):
    box["stages"][0]["duration_s"] = 0.01
    values = {"effects.friction.grain_grain": [0.2, 0.4], "solver.tolerance": [1e-3]}
    runs = drumlin.sweep(box, values, tmp_path / "sweep", "local:2", progress=True)
    assert [run.changes["effects.friction.grain_grain"] for run in runs] == [0.2, 0.4]
    assert [run.folder["scene.toml"]["effects"]["friction"]["grain_grain"] for run in runs] == [0.2, 0.4]
    assert f"results: {tmp_path}/sweep" in capfd.readouterr().err
    written = [(run.folder.path / "run.json").stat().st_mtime_ns for run in runs]
    again = drumlin.sweep(box, settings_of(values), tmp_path / "sweep", progress=False, report=False)
    assert [(run.folder.path / "run.json").stat().st_mtime_ns for run in again] == written


def test_a_setting_that_the_scene_cannot_have_is_refused_before_anything_runs(box, tmp_path):
    with pytest.raises(drumlin.InputError, match="grain_grain"):
        drumlin.sweep(box, {"effects.friction.grain_grain": [0.2, -1]}, tmp_path / "sweep")
    assert not (tmp_path / "sweep").exists()


def test_a_run_that_fails_is_told_and_the_others_end(box, tmp_path):
    box["stages"][0]["duration_s"] = 0.1
    misses = {"solver.max_sweeps": 1, "solver.check_every": 1, "solver.tolerance": 1e-12, "solver.stop_when_unconverged": True}
    runs = drumlin.sweep(box, [misses, {}], tmp_path / "sweep", report=False)
    assert isinstance(runs[0].error, drumlin.NotConvergedError) and "contact solver" in str(runs[0].error)
    assert runs[1].error is None and runs[1].folder["run.json"]["status"] == "finished"


def test_a_manifest_that_is_late_is_waited_for(box, tmp_path, monkeypatch):
    box["stages"][0]["duration_s"] = 0.01
    monkeypatch.setattr(executors, "PATIENCE_S", 0.3)
    folder = drumlin.run(box, tmp_path / "RUN")
    assert folder.is_complete()
    file = folder.path / "log.csv"
    text = file.read_text()
    file.write_text(text[:-1])
    job = functools.partial(drumlin.Folder, folder.path)
    assert isinstance(drumlin.run_all([job], tmp_path)[0].error, drumlin.IoError)
    asked = []
    monkeypatch.setattr(executors.time, "sleep", lambda _: (asked.append(1), file.write_text(text)))
    assert drumlin.run_all([job], tmp_path)[0].error is None and asked == [1]


def test_an_executor_named_by_a_word():
    with workers_of("local:3") as pool:
        assert pool._max_workers == 3  # pylint: disable=protected-access


# --- the report


def width_of(folder):
    return {"width": (float(folder["run.json"]["grains"]), 0.5), "steps": folder["run.json"]["steps"]}


def test_the_report_holds_every_run_and_pools_seeds(box, tmp_path, monkeypatch):
    box["stages"][0]["duration_s"] = 0.01
    monkeypatch.setattr("drumlin.sweeping.report.FIRST_S", -1)  # renewed as each run ends
    drawn = []
    monkeypatch.setattr("drumlin.sweeping.report.draw", lambda script, *words: drawn.append(script))
    values = {"grains.generated.count": [10, 20], "seed": [1, 2], "solver.tolerance": [1e-3]}
    runs = drumlin.sweep(box, values, tmp_path / "SWEEP", "local:1", numbers=width_of)
    assert [run.numbers["width"][0] for run in runs] == [10, 10, 20, 20]
    content = drumlin.read(tmp_path / "SWEEP/sweep.json")
    assert content["state"] == "finished" and content["quantities"] == ["width", "steps"] and len(content["runs"]) == 4
    groups = [(group["changes"]["grains.generated.count"], group["runs"], group["numbers"]["width"]["value"]) for group in content["groups"]]
    assert groups == [(10, 2, 10), (20, 2, 20)] and content["groups"][0]["numbers"]["width"]["ci99"] == pytest.approx(0.5 / 2**0.5)
    assert drawn[:3] == ["pages/write_page.py", "figures/sweep_figures.py", "pages/write_page.py"] and len(drawn) >= 5


def no_number(folder):
    return {"title": folder["run.json"]["title"]}


def test_what_is_no_number_is_an_error_of_its_run(box, tmp_path):
    box["stages"][0]["duration_s"] = 0.01
    run, = drumlin.sweep(box, [{}], tmp_path / "SWEEP", numbers=no_number, report=False)
    assert isinstance(run.error, ValueError) and "could not convert" in str(run.error)


def test_the_page_shows_numbers_failures_and_what_still_runs(box, tmp_path):
    report = Report(tmp_path, "A <box>", False, [{"friction": 0.1}, {"friction": 0.2}, {"friction": 0.4}])
    report.ended(0, drumlin.Outcome({"theta_deg": drumlin.study.Scalar(20.0, 1.0), "H": drumlin.study.Scalar(3.0)}))
    report.ended(1, drumlin.Outcome(error=drumlin.NotConvergedError("step 3 <did not>")))
    assert report.renew("running") == ""
    page = (tmp_path / "index.html").read_text(encoding="utf-8")
    for text in ("1 of 3 runs have finished, 1 failed", "20 ± 1", "step 3 &lt;did not&gt;", "A &lt;box&gt;", 'http-equiv="refresh"', "data:image/png"):
        assert text in page
    report.renew("finished")
    assert "http-equiv" not in (tmp_path / "index.html").read_text(encoding="utf-8")
