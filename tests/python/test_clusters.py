"""A sweep on a dask cluster of two workers: the bytes of a run here, also of one whose worker was killed; and on ranks of MPI."""

import os
import pathlib
import signal
import subprocess
import sys
import threading
import time

import drumlin
import pytest

distributed = pytest.importorskip("distributed", reason="python3-distributed is not installed")
PATIENCE_S = 120


def wait_until(is_so, what):
    end = time.monotonic() + PATIENCE_S
    while not is_so():
        assert time.monotonic() < end, f"not in time: {what}"
        time.sleep(0.02)


@pytest.fixture
def cluster(tmp_path):
    """(client, pids of two workers), each in a session of its own: with it dies what it has started, as with a machine."""
    environment = os.environ | {"PYTHONPATH": os.environ["DRUMLIN_PACKAGE"], "PYTHONDONTWRITEBYTECODE": "1"}
    file = tmp_path / "scheduler.json"

    def start(name, *words):
        with open(tmp_path / f"{name}.log", "w", encoding="utf-8") as log:
            return subprocess.Popen([sys.executable, "-m", f"distributed.cli.dask_{name.split('-')[0]}", *words, "--scheduler-file", file], cwd=tmp_path,
                                    stdout=log, stderr=log, env=environment, start_new_session=True)

    processes = [start("scheduler", "--host", "127.0.0.1", "--port", "0", "--no-dashboard")]
    processes += [start(f"worker-{k}", "--no-nanny", "--nthreads", "1", "--no-dashboard", "--death-timeout", "60") for k in range(2)]
    try:
        wait_until(file.exists, "the scheduler")
        with distributed.Client(scheduler_file=str(file)) as client:
            client.wait_for_workers(2, timeout=PATIENCE_S)
            yield client, [process.pid for process in processes[1:]]
    finally:
        for process in processes:  # one whose work was interrupted does not end by a request
            os.killpg(process.pid, signal.SIGKILL)
            process.wait(PATIENCE_S)


@pytest.fixture
def falling(box):
    box["stages"] = [{"name": "fall", "duration_s": 3, "time_step_s": 1e-3, "snapshots": 20}]
    return box | {"output": {"checkpoint_every_s": 0.2}}


def results(folder):
    """Bytes of all that is computed; other files hold times, too."""
    return {name: (folder.path / name).read_bytes() for name in folder.files if name.startswith("snapshots/") or name in ("log.csv", "scene.toml")}


def worker_of(run):
    """The worker whose child computes a run."""
    child = (run / ".lock").read_text(encoding="utf-8").split()[1].rstrip(",")
    return int(pathlib.Path(f"/proc/{child}/stat").read_text(encoding="utf-8").rsplit(")", 1)[1].split()[1])


@pytest.mark.parametrize("with_its_run", [False, True])
def test_a_run_whose_worker_is_killed_goes_on_elsewhere_with_the_same_bytes(falling, tmp_path, cluster, with_its_run):
    client, workers = cluster
    values, run = {"effects.friction.grain_grain": [0.2, 0.4]}, tmp_path / "there/000"
    here = drumlin.sweep(falling, values, tmp_path / "here", report=False)
    killed = []

    def kill():
        wait_until(lambda: (run / "checkpoint.h5").exists() and (run / "snapshots/000002.h5").exists(), "a checkpoint")
        before = (run / "snapshots/000001.h5").stat().st_mtime_ns
        killed.append((worker_of(run), before))
        (os.killpg if with_its_run else os.kill)(killed[0][0], signal.SIGKILL)

    thread = threading.Thread(target=kill)
    thread.start()
    there = drumlin.sweep(falling, values, tmp_path / "there", client, report=False)
    thread.join()
    assert [swept.error for swept in there] == [None, None]
    assert killed[0][0] in workers and (run / "snapshots/000001.h5").stat().st_mtime_ns == killed[0][1]
    assert len(results(here[0].folder)) == 22
    for one, other in zip(here, there):
        assert results(one.folder) == results(other.folder)


def test_a_failed_run_and_an_interruption_reach_the_cluster(falling, tmp_path, cluster, interrupt_when):
    client, _ = cluster
    misses = {"solver.max_sweeps": 1, "solver.check_every": 1, "solver.tolerance": 1e-12, "solver.stop_when_unconverged": True}
    long = {"stages.0.duration_s": 100}
    interrupt_when(*(tmp_path / f"SWEEP/{number:03}/log.csv" for number in range(3)))
    with pytest.raises(KeyboardInterrupt):
        drumlin.sweep(falling, [misses, long, long | {"seed": 2}], tmp_path / "SWEEP", client, report=False)
    assert [drumlin.read(tmp_path / f"SWEEP/{number:03}/run.json")["status"] for number in range(3)] == ["not converged", "interrupted", "interrupted"]
    runs = drumlin.sweep(falling, [misses, {}], tmp_path / "OTHER", client, report=False)
    assert isinstance(runs[0].error, drumlin.NotConvergedError) and runs[1].error is None


def test_ranks_of_mpi_compute_what_is_computed_here(falling, tmp_path):
    pytest.importorskip("mpi4py", reason="python3-mpi4py is not installed")
    here = drumlin.sweep(falling, {"seed": [1, 2]}, tmp_path / "here", report=False)
    scene = tmp_path / "here/sweep-scene.toml"
    words = ["sweep", scene, "--vary", "seed=1:2", "--executor", "mpi", "-o", tmp_path / "there"]
    with pytest.raises(drumlin.InputError, match="there is one rank"):
        drumlin.command(*words)
    done = subprocess.run(["mpirun", "--oversubscribe", "-n", "2", drumlin.program(), *words], capture_output=True, text=True, timeout=PATIENCE_S, check=False)
    assert done.returncode == 0 and "2 runs, 0 failed" in done.stdout, done.stderr
    for number, one in enumerate(here):
        assert results(one.folder) == results(drumlin.read(tmp_path / f"there/{number:03}"))
