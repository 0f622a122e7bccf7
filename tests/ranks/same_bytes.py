"""Runs of drumlin-run on 1 to 4 ranks with 1 or 2 threads leave the bytes of one process; a killed rank ends the job, and
its run goes on with another number of ranks or in one process.

usage: same_bytes.py DRUMLIN_RUN DRUMLIN MPIRUN [--large]
  --large  nothing but a packing so large that a coarse grid corrects its impulses: a minute
"""

import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time

START = """format = "drumlin-scene-1"
title = "Ranks"
reduced = true
[grains]
density_kg_m3 = 2700
[grains.generated]
count = {count}
diameter_min_mm = 3.0
diameter_max_mm = 3.6
placement = "deposited"
region = {{ shape = "circle", radius_mm = {radius} }}
[effects.gravity]
[[walls]]
name = "drum"
shape = "container"
radius_mm = {radius}
[effects.friction]
grain_grain = 0.4
grain_wall = 0.9
[effects.restitution]
grain_grain = 0.46
grain_wall = 0.46
[effects.spin]
"""
STAGES = """[[stages]]
name = "at rest"
duration_s = {rest}
time_step_s = 1e-3
[[stages]]
name = "moving"
duration_s = {moving}
time_step_s = 1e-3
snapshots = 3
motions = [{{ wall = "drum", kind = "rotation", speed_rpm = {rpm} }}]
[solver]
tolerance = {tolerance}
max_sweeps = 500
[output]
checkpoint_every_s = 0.01
"""


def drum(count, rest=0.01, moving=0.05, rpm=60, tolerance=1e-2, more="", output="velocity_window_s = 3e-3\n"):
    """Discs that lie from the beginning, and then roll on and strike each other, at the fill of 350 in a drum of 100 mm."""
    radius = 50 * (count / 350) ** 0.5
    return START.format(count=count, radius=f"{radius:.1f}") + more + STAGES.format(rest=rest, moving=moving, rpm=rpm, tolerance=tolerance) + output


# So many contacts that four ranks have some strips of them each; so many that they are swept in waves; so many that a coarse grid corrects them.
SHARED = drum(5600)
WAVES = drum(17000, rest=0.002, moving=0.003, rpm=0.05, output="velocity_window_s = 0\n")
CORRECTED = drum(52000, rest=0.002, moving=0.003, rpm=0.05, tolerance=3e-3, output="velocity_window_s = 0\n")
# What else a scene can say is done by all ranks.
EVERYTHING = drum(350, output="energy_ledger = true\nwalls_every_s = 0.01\n", more="""[effects.rolling_resistance]
grain_grain = 0.1
grain_wall = 0.1
[effects.cohesion]
grain_grain = 1e-4
grain_wall = 0
[effects.drag]
rate_per_s = 1
""")


def require(condition, message):
    if not condition:
        sys.exit(message)


def called(command, code=0):
    """What a command says that ends with this code."""
    result = subprocess.run(list(map(str, command)), capture_output=True, text=True, timeout=1200, check=False)
    require(result.returncode == code, f"{command}: exit code {result.returncode} instead of {code}\n{result.stdout}{result.stderr}")
    return result.stdout + result.stderr


class Ranks:
    def __init__(self, program, mpirun):
        self.program, self.mpirun = program, mpirun

    def words(self, ranks, *words):
        return [self.mpirun, "-n", str(ranks), self.program, *map(str, words)]

    def __call__(self, ranks, *words, code=0):
        return called(self.words(ranks, *words), code)


def results(run):
    """What must not depend on ranks, threads or interruptions."""
    files = [file for file in (*sorted(run.glob("*.csv")), *sorted((run / "snapshots").iterdir())) if file.name != "grains.csv"]
    return {str(file.relative_to(run)): file.read_bytes() for file in files}


def require_same(right, run, what):
    own = results(run)
    require(own.keys() == right.keys(), f"{what}: other files: {sorted(own)}")
    differing = [name for name in right if own[name] != right[name]]
    require(not differing, f"{what}: other bytes in {', '.join(differing)}")


def same_on_all(run_on, drumlin, folder, name, text, ways):
    scene = folder / f"{name}.toml"
    scene.write_text(text, encoding="utf-8")
    called([drumlin, "run", scene, "-o", folder / name, "--threads", 1])
    right = results(folder / name)
    require(len(right) >= 4, f"{name}: not three snapshots and a log")
    for ranks, threads in ways:
        run = folder / f"{name}-{ranks}x{threads}"
        run_on(ranks, scene, "-o", run, "--threads", threads)
        require_same(right, run, f"{name}, {ranks} ranks x {threads} threads")
        report = json.loads((run / "run.json").read_text(encoding="utf-8"))
        require(len(report["ranks"]) == ranks and report["status"] == "finished", f"{run}: not as run.json should say")
        require(all(rank["waiting_seconds"] > 0 for rank in report["ranks"]), f"{run}: a rank that waited for nobody")
    return scene, right


def ranks_of(mpirun):
    """The processes that an mpirun has started, which are ours."""
    ranks = []
    for folder in pathlib.Path("/proc").glob("[0-9]*"):
        try:
            name, _, rest = (folder / "stat").read_text(encoding="utf-8").rpartition(")")
        except OSError:  # it has ended since
            continue
        if int(rest.split()[1]) == mpirun.pid and "drumlin-run" in name:
            ranks.append(int(folder.name))
    return ranks


def until_checkpoint(job, run):
    while not (run / "checkpoint.h5").exists():
        require(job.poll() is None, "the job ended before its first checkpoint")
        time.sleep(0.005)


def newest_checkpoint(run):
    """When checkpoint.h5 was written; None while there is the previous one alone, the next not yet in place."""
    try:
        return (run / "checkpoint.h5").stat().st_mtime_ns
    except FileNotFoundError:
        return None


def going_on_elsewhere(run_on, drumlin, folder, scene, right):
    """A rank is killed once there is a checkpoint of four: the job ends with a message, one process goes on and is told to stop,
    three ranks finish."""
    run = folder / "killed"
    with subprocess.Popen(run_on.words(4, scene, "-o", run), stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True) as job:
        until_checkpoint(job, run)
        os.kill(ranks_of(job)[-1], signal.SIGKILL)
        _, said = job.communicate(timeout=300)
    require(job.returncode != 0 and "signal 9" in said, f"a killed rank: exit code {job.returncode}, said\n{said}")
    with subprocess.Popen([drumlin, "run", scene, "-o", run, "--resume"], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True) as job:
        before = newest_checkpoint(run)
        while job.poll() is None and newest_checkpoint(run) in (before, None):
            time.sleep(0.005)
        if job.poll() is None:
            job.send_signal(signal.SIGTERM)
        job.communicate(timeout=300)
    run_on(3, scene, "-o", run, "--resume")
    require_same(right, run, "killed on 4 ranks, gone on with in one process, finished by 3")


def failing(run_on, folder):
    """A run that must not go on: its log holds every step, and its run.json tells how it ended."""
    scene = folder / "failing.toml"
    scene.write_text(drum(300).replace("max_sweeps = 500", "max_sweeps = 20\nstop_when_unconverged = true"), encoding="utf-8")
    for ranks in (1, 2):
        run = folder / f"failing-{ranks}"
        said = run_on(ranks, scene, "-o", run, code=3)
        report = json.loads((run / "run.json").read_text(encoding="utf-8"))
        steps = len((run / "log.csv").read_text(encoding="utf-8").splitlines()) - 1
        require(f"step {steps}: " in said and report["steps"] == steps > 0, f"a run that fails on {ranks} ranks, after {steps} steps:\n{said}")
        require(report["status"] == "not converged", f"{run}: run.json says {report['status']}")


def other_on_one(run_on, folder):
    """A rank of the flow that was given something else than rank 0 is named before anything is computed, exit code 2; nothing is written."""
    there, elsewhere = folder / "theirs", folder / "ours"
    there.mkdir(), elsewhere.mkdir()
    law = pathlib.Path(__file__).parents[2] / "data" / "rheology" / "paper.toml"
    flow = (pathlib.Path(__file__).parents[1] / "chain" / "tiny-drum-flow.toml").read_text(encoding="utf-8")
    for place, words in ((there, flow), (elsewhere, flow.replace("reduced = true", "reduced = false"))):
        (place / "flow.toml").write_text(words, encoding="utf-8")
        (place / "law.toml").write_bytes(law.read_bytes())
    solver = [str(pathlib.Path(run_on.program).with_name("drumlin-flow")), "flow.toml", "--rheology", "law.toml", "-o", "out"]
    command = [run_on.mpirun, "-n", "1", "-wdir", str(there), *solver, ":", "-n", "1", "-wdir", str(elsewhere), *solver]
    require("are not those of rank 0" in called(command, 2), "another scene on rank 1")
    require(not (there / "out").exists() and not (elsewhere / "out").exists(), "another scene on rank 1: results were begun")


def started_by_drumlin(run_on, drumlin, folder, scene, right):
    """`drumlin run --ranks` leaves the bytes of mpirun's call, and ends as the job ends."""
    def start(*words, code=0):
        return called([drumlin, "run", *words], code)

    start(scene, "-o", folder / "started", "--ranks", 2)
    require_same(right, folder / "started", "drumlin run --ranks 2")
    said = start(scene, "-o", folder / "started", "--resume")
    require("already finished" in said, f"a finished run of ranks, resumed in one process, said\n{said}")
    said = start(scene, "-o", folder / "started", "--ranks", 2, code=2)
    require(str(folder / "started") in said, f"a folder that is taken, said\n{said}")
    said = run_on(1, scene, "-o", folder / "twice", "--ranks", 2, code=2)
    require("--ranks" in said and not (folder / "twice").exists(), f"--ranks on ranks, said\n{said}")
    start(folder / "started" / "scene.toml", "-o", folder / "started", "--extend", 0.02, "--ranks", 2)
    start(scene, "-o", folder / "longer")
    start(folder / "longer" / "scene.toml", "-o", folder / "longer", "--extend", 0.02)
    require_same(results(folder / "longer"), folder / "started", "prolonged on 2 ranks")
    run = folder / "told-to-end"
    with subprocess.Popen([drumlin, "run", scene, "-o", run, "--ranks", "2"], stdout=subprocess.DEVNULL,
                          stderr=subprocess.PIPE, text=True) as job:
        until_checkpoint(job, run)
        job.send_signal(signal.SIGTERM)
        _, said = job.communicate(timeout=300)
    require(job.returncode == 143, f"told to end: exit code {job.returncode} instead of 143, said\n{said}")
    start(scene, "-o", run, "--ranks", 3, "--resume")
    require_same(right, run, "told to end on 2 ranks, finished by 3")


def main():
    program, drumlin, mpirun, *large = sys.argv[1:]
    run_on = Ranks(program, mpirun)
    said = subprocess.run([program, "--help"], capture_output=True, text=True, check=False).stdout
    require("Usage: mpirun -n RANKS drumlin-run [OPTIONS] scene" in said and "--ranks" not in said, f"drumlin-run --help:\n{said}")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        if large:
            same_on_all(run_on, drumlin, folder, "corrected", CORRECTED, ((1, 2), (2, 1), (3, 2)))
            print("the same bytes on 1 to 3 ranks, corrected on a coarse grid")
            return
        scene, right = same_on_all(run_on, drumlin, folder, "drum", SHARED, ((1, 1), (1, 2), (2, 1), (2, 2), (3, 1), (4, 1)))
        going_on_elsewhere(run_on, drumlin, folder, scene, right)
        started_by_drumlin(run_on, drumlin, folder, scene, right)
        same_on_all(run_on, drumlin, folder, "waves", WAVES, ((2, 1), (3, 2)))
        same_on_all(run_on, drumlin, folder, "everything", EVERYTHING, ((2, 1),))
        failing(run_on, folder)
        other_on_one(run_on, folder)
    print("the same bytes on 1 to 4 ranks and in one process")


if __name__ == "__main__":
    main()
