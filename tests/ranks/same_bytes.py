"""Runs of drumlin-run on 1 to 4 ranks with 1 or 2 threads leave the same bytes; a killed rank ends the job, and its run
goes on with another number of ranks; what ranks do not know is refused.

usage: same_bytes.py DRUMLIN_RUN DRUMLIN MPIRUN [--large]
  --large  nothing but a packing so large that a coarse grid corrects its impulses: a minute
"""

import json
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import time

GRAINS = """format = "drumlin-scene-1"
title = "Ranks"
reduced = true
[grains]
density_kg_m3 = 2700
[grains.generated]
count = {count}
diameter_min_mm = 3.0
diameter_max_mm = 3.6
region = {region}
[effects.gravity]
"""
STAGES = """[[stages]]
name = "settle"
duration_s = {settle}
time_step_s = 1e-3
[[stages]]
name = "moving"
duration_s = {moving}
time_step_s = 1e-3
snapshots = 3
motions = [{motion}]
[solver]
tolerance = 1e-2
max_sweeps = 500
[output]
velocity_window_s = 3e-3
checkpoint_every_s = 0.02
"""
DRUM = GRAINS.format(count=350, region='{ shape = "circle", radius_mm = 50 }') + """
[[walls]]
name = "drum"
shape = "container"
radius_mm = 50
[effects.friction]
grain_grain = 0.4
grain_wall = 0.9
[effects.restitution]
grain_grain = 0.46
grain_wall = 0.46
[effects.spin]
""" + STAGES.format(settle=0.12, moving=0.06, motion='{ wall = "drum", kind = "rotation", speed_rpm = 15 }')
# Discs that lie from the beginning, and then roll on and strike each other.
DEPOSITED = DRUM.replace('region = {', 'placement = "deposited"\nregion = {').replace("duration_s = 0.12", "duration_s = 0.02").replace(
    "speed_rpm = 15", "speed_rpm = 60").replace("duration_s = 0.06", "duration_s = 0.15")
BOX_SHAPE = """shape = "polyline"
x_mm = [0, 0, 120, 120]
z_mm = [60, 0, 0, 60]
"""
BOX = GRAINS.format(count=300, region='{ shape = "rectangle", min_mm = [0, 0], max_mm = [120, 60] }') + """
[[walls]]
name = "box"
""" + BOX_SHAPE + """[effects.friction]
grain_grain = 0.5
grain_wall = 0.5
""" + STAGES.format(settle=0.08, moving=0.04,
                    motion='{ wall = "box", kind = "oscillation", amplitude_mm = [1, 0], frequency_hz = 20 }, '
                    '{ wall = "box", kind = "translation", velocity_mm_s = [0, 50] }, { wall = "box", kind = "belt", speed_mm_s = 200 }')


def require(condition, message):
    if not condition:
        sys.exit(message)


class Ranks:
    def __init__(self, program, mpirun):
        self.program, self.mpirun = program, mpirun

    def words(self, ranks, *words):
        return [self.mpirun, "-n", str(ranks), self.program, *map(str, words)]

    def __call__(self, ranks, *words, code=0):
        result = subprocess.run(self.words(ranks, *words), capture_output=True, text=True, timeout=1200, check=False)
        require(result.returncode == code, f"{words} on {ranks} ranks: exit code {result.returncode} instead of {code}\n"
                                           f"{result.stdout}{result.stderr}")
        return result.stderr


def results(run):
    """What must not depend on ranks, threads or interruptions."""
    files = [run / "log.csv", *sorted((run / "snapshots").iterdir())]
    return {str(file.relative_to(run)): file.read_bytes() for file in files}


def require_same(right, run, what):
    own = results(run)
    require(own.keys() == right.keys(), f"{what}: other files: {sorted(own)}")
    differing = [name for name in right if own[name] != right[name]]
    require(not differing, f"{what}: other bytes in {', '.join(differing)}")


def same_on_all(run_on, folder, name, text, ways=((1, 1), (1, 2), (2, 1), (2, 2), (3, 1), (4, 1))):
    scene = folder / f"{name}.toml"
    scene.write_text(text, encoding="utf-8")
    right = None
    for ranks, threads in ways:
        run = folder / f"{name}-{ranks}x{threads}"
        run_on(ranks, scene, "-o", run, "--threads", threads)
        if right is None:
            right = results(run)
            require(len(right) == 4, f"{name}: not three snapshots and a log")
        require_same(right, run, f"{name}, {ranks} ranks x {threads} threads")
        report = json.loads((run / "run.json").read_text(encoding="utf-8"))
        shares = report["ranks"]
        require(len(shares) == ranks and report["status"] == "finished", f"{run}: not as run.json should say")
        grains = sum(share["grains_mean"] for share in shares)
        require(abs(grains - report["grains"]) < 1e-6 * grains, f"{run}: {grains} grains on the ranks together")
        require(ranks == 1 or all(share["halo_rounds_per_sweep"] <= 12 for share in shares),
                f"{run}: more rounds per sweep than colours, their start and their residual")
    return scene, right


def impacts_near_each_other(run_on, folder):
    """Impacts of a drum that lies and rolls are few: ranks send the pairs near them, and not all."""
    same_on_all(run_on, folder, "deposited", DEPOSITED, ((1, 1), (2, 1), (4, 1)))
    report = json.loads((folder / "deposited-2x1" / "run.json").read_text(encoding="utf-8"))
    shares, contacts = report["ranks"], report["cost"]["contacts_mean"]
    sent = sum(share["impact_pairs_sent_mean"] for share in shares)
    require(shares[0]["impacts_gathered"] > 0, "no impacts in the drum that rolls")
    require(0 < sent < 0.8 * contacts, f"{sent} pairs of {contacts} sent for impacts")


def coarse_corrections(run_on, drumlin, folder):
    """So many contacts that a coarse grid corrects their impulses: sweeps stay about those of one process."""
    text = re.sub(r"count = \d+", "count = 52000", DEPOSITED)
    for old, new in (("radius_mm = 50", "radius_mm = 605"), ("tolerance = 1e-2", "tolerance = 3e-3"), ("velocity_window_s = 3e-3", "velocity_window_s = 0"),
                     ("duration_s = 0.02", "duration_s = 0.002"), ("duration_s = 0.15", "duration_s = 0.003"), ("speed_rpm = 60", "speed_rpm = 0.05")):
        text = text.replace(old, new)
    scene, _ = same_on_all(run_on, folder, "large", text, ((1, 1), (2, 1), (3, 2)))
    reports = [json.loads((folder / f"large-{way}" / "run.json").read_text(encoding="utf-8")) for way in ("1x1", "3x2")]
    for report in reports:
        require(all(share["coarse_corrections"] > 0 for share in report["ranks"]), "no coarse correction of a large packing")
    subprocess.run([drumlin, "run", scene, "-o", folder / "large-one", "--threads", "1"], check=True, capture_output=True)
    one = json.loads((folder / "large-one" / "run.json").read_text(encoding="utf-8"))["cost"]["sweeps_mean"]
    own = reports[0]["cost"]["sweeps_mean"]
    require(own < 1.5 * one, f"{own} sweeps a step on ranks, {one} in one process")


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


def going_on_elsewhere(run_on, folder, scene, right):
    """A rank is killed once there is a checkpoint of four: the job ends with a message, one rank goes on, is told to
    stop, and three finish."""
    run = folder / "killed"
    with subprocess.Popen(run_on.words(4, scene, "-o", run), stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True) as job:
        while not (run / "checkpoint.h5").exists():
            require(job.poll() is None, "the job ended before its first checkpoint")
            time.sleep(0.005)
        os.kill(ranks_of(job)[-1], signal.SIGKILL)
        _, said = job.communicate(timeout=300)
    require(job.returncode != 0 and "signal 9" in said, f"a killed rank: exit code {job.returncode}, said\n{said}")
    with subprocess.Popen(run_on.words(1, scene, "-o", run, "--resume"), stdout=subprocess.DEVNULL,
                          stderr=subprocess.PIPE, text=True) as job:
        before = (run / "checkpoint.h5").stat().st_mtime_ns
        while job.poll() is None and (run / "checkpoint.h5").stat().st_mtime_ns == before:
            time.sleep(0.005)
        if job.poll() is None:
            job.send_signal(signal.SIGTERM)
        job.communicate(timeout=300)
    run_on(3, scene, "-o", run, "--resume")
    require_same(right, run, "killed on 4 ranks, gone on with 1, finished by 3")


def refusals(run_on, folder):
    scene = folder / "periodic.toml"
    scene.write_text(BOX.replace("[effects.gravity]", "[periodic_x]\nx_min_mm = 0\nx_max_mm = 120\n[effects.gravity]")
                     .replace(BOX_SHAPE, 'shape = "segment"\nfrom_mm = [0, 0]\nto_mm = [120, 0]\n'), encoding="utf-8")
    said = run_on(2, scene, "-o", folder / "periodic", code=2)
    require("periodic_x: not on ranks: deal.II 9.4 knows no ghosts across periodic sides" in said
            and str(scene) in said and not (folder / "periodic").exists(), f"periodic_x on ranks:\n{said}")
    scene.write_text(DRUM + "energy_ledger = true\n", encoding="utf-8")
    said = run_on(2, scene, "-o", folder / "ledger", code=2)
    require("output.energy_ledger" in said and said.count("not on ranks") == 1, f"a ledger on ranks, said once:\n{said}")


def grain_lost(run_on, folder):
    """Grains fall off a floor without sides: the run says so, its log holds every step before, and its run.json tells how it ended."""
    scene = folder / "no-sides.toml"
    scene.write_text(BOX.replace(BOX_SHAPE, 'shape = "segment"\nfrom_mm = [0, 0]\nto_mm = [120, 0]\n').replace(
        "duration_s = 0.08", "duration_s = 2"), encoding="utf-8")
    for ranks in (1, 2):
        run = folder / f"no-sides-{ranks}"
        said = run_on(ranks, scene, "-o", run, code=3)
        report = json.loads((run / "run.json").read_text(encoding="utf-8"))
        steps = len((run / "log.csv").read_text(encoding="utf-8").splitlines()) - 1
        require(f"step {steps + 1}: grain " in said and said.count("is lost") == 1, f"a lost grain on {ranks} ranks, after {steps} steps:\n{said}")
        require(report["status"] == "grain lost" and report["steps"] == steps > 20 and report["grains"] == 300,
                f"a lost grain on {ranks} ranks: {report['status']}, {report['steps']} steps, {steps} of them in the log")


def unseen_by_one(run_on, folder, scene):
    """Where a rank does not see the scene, it says so, and all end."""
    there, elsewhere = folder / "there", folder / "elsewhere"
    there.mkdir(), elsewhere.mkdir()
    (there / "scene.toml").write_bytes(scene.read_bytes())
    command = [run_on.mpirun, "-n", "1", "-wdir", str(there), run_on.program, "scene.toml", "-o", "run", ":",
               "-n", "1", "-wdir", str(elsewhere), run_on.program, "scene.toml", "-o", "run"]
    result = subprocess.run(command, capture_output=True, text=True, timeout=1200, check=False)
    require(result.returncode == 2 and "rank 1: scene.toml" in result.stderr and not (there / "run").exists(),
            f"a scene that one rank does not see: exit code {result.returncode}\n{result.stdout}{result.stderr}")


def other_on_one(run_on, folder, scene):
    """A rank that was given something else than rank 0 is named before anything is computed, exit code 2; nothing is written."""
    there, elsewhere = folder / "theirs", folder / "ours"
    there.mkdir(), elsewhere.mkdir()
    text = scene.read_text(encoding="utf-8")
    (there / "scene.toml").write_text(text, encoding="utf-8")
    (there / "box.toml").write_text(BOX, encoding="utf-8")
    law = pathlib.Path(__file__).parents[2] / "data" / "rheology" / "paper.toml"
    flow = (pathlib.Path(__file__).parents[1] / "chain" / "tiny-drum-flow.toml").read_text(encoding="utf-8")
    for place, words in ((there, flow), (elsewhere, flow.replace("reduced = true", "reduced = false"))):
        (place / "flow.toml").write_text(words, encoding="utf-8")
        (place / "law.toml").write_bytes(law.read_bytes())
    solver = [str(pathlib.Path(run_on.program).with_name("drumlin-flow")), "flow.toml", "--rheology", "law.toml", "-o", "out"]
    run = [run_on.program, "scene.toml", "-o", "out"]
    words, content = "rank 1: words of the call are", "are not those of rank 0"
    cases = [(run, [run_on.program, "box.toml", "-o", "out"], there, words), (run, [*run, "--set", "seed=7"], there, words),
             (run, [*run, "--no-such-option"], there, words), (run, [*run, "--version"], there, words),
             (run, [run_on.program, "scene.toml", "-o", "other"], there, words)]
    for changed in (BOX, text.replace("reduced = true", "reduced = true\nseed = 7"), text.replace("duration_s = 0", "duration_s = 1")):
        require(changed != text, f"nothing to change in\n{text}")
        cases.append((run, run, changed, content))
    cases.append((solver, solver, elsewhere, content))
    for first, second, where, said in cases:
        if isinstance(where, str):
            (elsewhere / "scene.toml").write_text(where, encoding="utf-8")
            where = elsewhere
        command = [run_on.mpirun, "-n", "1", "-wdir", str(there), *first, ":", "-n", "1", "-wdir", str(where), *second]
        result = subprocess.run(command, capture_output=True, text=True, timeout=1200, check=False)
        require(result.returncode == 2 and said in result.stderr, f"{second} on rank 1: exit code {result.returncode}\n{result.stdout}{result.stderr}")
        require(not (there / "out").exists() and not (where / "out").exists(), f"{second} on rank 1: results were begun")


def started_by_drumlin(run_on, drumlin, folder, scene, right):
    """`drumlin run --ranks` leaves the bytes of mpirun's call, and ends as the job ends."""
    def start(*words, code):
        result = subprocess.run([drumlin, "run", *map(str, words)], capture_output=True, text=True, timeout=1200, check=False)
        require(result.returncode == code, f"drumlin run {words}: exit code {result.returncode} instead of {code}\n"
                                           f"{result.stdout}{result.stderr}")
        return result.stdout + result.stderr

    start(scene, "-o", folder / "started", "--ranks", 2, code=0)
    require_same(right, folder / "started", "drumlin run --ranks 2")
    said = start(scene, "-o", folder / "started", "--resume", code=0)
    require("already finished" in said, f"a finished run of ranks, resumed in one process, said\n{said}")
    said = start(scene, "-o", folder / "started", "--ranks", 2, code=2)
    require(str(folder / "started") in said, f"a folder that is taken, said\n{said}")
    said = start(scene, "-o", folder / "longer", "--ranks", 2, "--extend", 1, code=2)
    require("--extend" in said and not (folder / "longer").exists(), f"--extend on ranks, said\n{said}")
    said = run_on(1, scene, "-o", folder / "twice", "--ranks", 2, code=2)
    require("--ranks" in said and not (folder / "twice").exists(), f"--ranks on ranks, said\n{said}")
    alone = folder / "alone"
    with subprocess.Popen([drumlin, "run", scene, "-o", alone], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as job:
        while not (alone / "checkpoint.h5").exists():
            require(job.poll() is None, "a run ended before its first checkpoint")
            time.sleep(0.005)
        job.send_signal(signal.SIGKILL)
    said = start(scene, "-o", alone, "--ranks", 2, "--resume", code=2)
    require("was begun in one process" in said, f"a run of one process, resumed on ranks, said\n{said}")
    run = folder / "told-to-end"
    with subprocess.Popen([drumlin, "run", scene, "-o", run, "--ranks", "2"], stdout=subprocess.DEVNULL,
                          stderr=subprocess.PIPE, text=True) as job:
        while not (run / "checkpoint.h5").exists():
            require(job.poll() is None, "the job ended before its first checkpoint")
            time.sleep(0.005)
        job.send_signal(signal.SIGTERM)
        _, said = job.communicate(timeout=300)
    require(job.returncode == 143, f"told to end: exit code {job.returncode} instead of 143, said\n{said}")
    start(scene, "-o", run, "--ranks", 3, "--resume", code=0)
    require_same(right, run, "told to end on 2 ranks, finished by 3")
    text = subprocess.run([run_on.program, "--help"], capture_output=True, text=True, check=False).stdout
    require("drumlin-run" in text and "drumlin run" not in text and "--ranks" not in text, f"drumlin-run --help:\n{text}")


def main():
    program, drumlin, mpirun, *large = sys.argv[1:]
    run_on = Ranks(program, mpirun)
    said = subprocess.run([program, "--help"], capture_output=True, text=True, check=False).stdout
    require("Usage: mpirun -n RANKS drumlin-run [OPTIONS] scene" in said, f"drumlin-run --help:\n{said}")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        if large:
            coarse_corrections(run_on, drumlin, folder)
            print("the same bytes on 1 to 3 ranks, corrected on a coarse grid")
            return
        scene, right = same_on_all(run_on, folder, "drum", DRUM)
        going_on_elsewhere(run_on, folder, scene, right)
        started_by_drumlin(run_on, drumlin, folder, scene, right)
        same_on_all(run_on, folder, "box", BOX, ((1, 1), (2, 1), (3, 2)))
        impacts_near_each_other(run_on, folder)
        same_on_all(run_on, folder, "box-frictionless", BOX.replace("[effects.friction]\ngrain_grain = 0.5\ngrain_wall = 0.5\n", ""),
                    ((1, 1), (3, 2)))
        same_on_all(run_on, folder, "box-dynamic", BOX.replace("[effects.friction]", "[effects.dynamic_friction]\ngrain_grain = 0.1\ngrain_wall = 0.1\n"
                    "speed_mm_s = 20\n[effects.friction]"), ((1, 1), (3, 2)))
        refusals(run_on, folder)
        grain_lost(run_on, folder)
        unseen_by_one(run_on, folder, scene)
        other_on_one(run_on, folder, scene)
        # The files are those of other runs.
        listed = subprocess.run([drumlin, "export", folder / "drum-4x1", "--vtu", "-o", folder / "grids"], capture_output=True,
                                text=True, check=False)
        require(listed.returncode == 0, f"drumlin export of a run on ranks:\n{listed.stdout}{listed.stderr}")
    print("the same bytes on 1 to 4 ranks")


if __name__ == "__main__":
    main()
