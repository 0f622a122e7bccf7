"""A run that is interrupted, terminated or killed goes on to the same bytes; what does not fit is refused.

usage: interruption.py DRUMLIN FOLDER_OF_THIS_TEST
"""

import resource
import shutil
import signal
import subprocess
import time
from random import Random

from command import bytes_below, given, read_json, require, results_of_run, started, wait_until

OVERRIDES = ["--set", "output.checkpoint_every_s=0.05", "--set", "stages.1.turns=0.2", "--set", "stages.2.turns=0.2",
             "--set", "output.energy_ledger=true"]


def stopped(executable, scene, run, stop, code, overrides=OVERRIDES):
    """Starts a run and stops it by a signal once it has left a checkpoint and a snapshot; one that was done before is begun again."""
    for _ in range(20):
        shutil.rmtree(run, ignore_errors=True)
        process = started(executable, "run", scene, "-o", run, *overrides)
        wait_until(lambda: process.poll() is not None or (run / "checkpoint.h5").exists() and list((run / "snapshots").glob("*.h5")), f"{run.name}: checkpoint and snapshot")
        process.send_signal(stop)
        if process.wait(timeout=600) != 0:
            break
    require(process.returncode == code, f"{run.name}: exit code {process.returncode} instead of {code}")


def killed_again_and_again(executable, scene, run, expected):
    """Kills a run and what resumes it at random moments, files half written among them; it ends with the same bytes."""
    random, kills = Random(7), 0
    words = []
    while True:
        process = started(executable, "run", scene, "-o", run, *words, *OVERRIDES)
        words = ["--resume"]
        try:
            # Later and later, so that a slow machine gets there too.
            code = process.wait(timeout=random.uniform(0.01, 0.05) * 1.15 ** kills)
            require(code == 0, f"killed {kills} times, then resumed: exit code {code}")
            break
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()
            kills += 1
    require(results_of_run(run) == expected, f"killed {kills} times: the run left other bytes than the whole one")
    print(f"killed {kills} times, the same bytes")


def stopped_within_a_step(executable, scene, run):
    """A signal that comes while a long step is solved: that step ends, a checkpoint is left, no other step begins."""
    words = ["--set", "solver.tolerance=1e-15", "--set", "solver.penetration_tolerance=1e-15", "--set", "solver.max_sweeps=20000"]
    process = started(executable, "run", scene, "-o", run, *OVERRIDES, *words)
    wait_until((run / "run.json").exists, "long steps: run.json", process)
    time.sleep(0.5)
    process.terminate()
    require(process.wait(timeout=1200) == 143, f"long steps: exit code {process.returncode} instead of 143")
    report = read_json(run / "run.json")
    steps = [line.split(",")[0] for line in (run / "log.csv").read_text(encoding="utf-8").splitlines()[1:]]
    require(report["status"] == "interrupted" and (run / "checkpoint.h5").exists(), "long steps: no checkpoint")
    require(report["steps"] == len(steps) and steps[-1] == str(len(steps)), "long steps: log and report disagree")


def damage(file):
    content = bytearray(file.read_bytes())
    content[len(content) // 2] ^= 4
    file.write_bytes(content)


def full_disk(executable, drumlin, scene, kept, run, expected):
    """Files that may not grow beyond a few bytes stand for a full disk: exit code 74, what stood there stays, and the run
    goes on when there is room again."""
    for room in (200, 3000, 20000):
        shutil.rmtree(run, ignore_errors=True)
        shutil.copytree(kept, run)
        before = bytes_below(run)

        def limit(size=room):
            resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))
        result = subprocess.run([executable, "run", scene, "-o", run, "--resume", *OVERRIDES], preexec_fn=limit,
                                capture_output=True, text=True, timeout=1200, check=False)
        require(result.returncode == 74, f"{room} bytes of room: exit code {result.returncode} instead of 74\n{result.stderr}")
        after = bytes_below(run)
        require(after["checkpoint.h5"] == before["checkpoint.h5"], f"{room} bytes of room: the checkpoint was touched")
        for name, content in before.items():
            # A snapshot that the kill cut short is no snapshot: its unfinished file may go.
            if name.startswith("snapshots/") and name.endswith(".h5"):
                require(after.get(name) == content, f"{room} bytes of room: {name} was touched")
        drumlin("run", scene, "-o", run, "--resume", *OVERRIDES)
        require(results_of_run(run) == expected, f"{room} bytes of room: the resumed run left other bytes than the whole one")


def main():
    with given() as (drumlin, tests, work):
        executable, scene = drumlin.executable, tests / "tiny-drum.toml"
        whole = work / "whole"
        drumlin("run", scene, "-o", whole, *OVERRIDES)
        expected = results_of_run(whole)

        for stop, code, status in ((signal.SIGINT, 130, "interrupted"), (signal.SIGTERM, 143, "interrupted"),
                                   (signal.SIGKILL, -signal.SIGKILL, "running")):
            run = work / stop.name
            stopped(executable, scene, run, stop, code)
            require(read_json(run / "run.json")["status"] == status, f"{stop.name}: run.json does not say {status}")
            shutil.copytree(run, work / (stop.name + "-kept"))
            drumlin("run", scene, "-o", run, "--resume", "--threads", "2", *OVERRIDES)
            require(results_of_run(run) == expected, f"{stop.name}: the resumed run left other bytes than the whole one")
            require(read_json(run / "run.json")["status"] == "finished", f"{stop.name}: not finished")

        killed_again_and_again(executable, scene, work / "often", expected)
        stopped_within_a_step(executable, scene, work / "long")
        full_disk(executable, drumlin, scene, work / "SIGKILL-kept", work / "full", expected)

        before = bytes_below(whole)
        drumlin("run", scene, "-o", whole, "--resume", *OVERRIDES)
        require(bytes_below(whole) == before, "resuming a finished run changed it")

        kept = work / "SIGINT-kept"
        _, error = drumlin("run", scene, "-o", kept, "--resume", code=2)
        require("scene" in error, "another scene: the message does not say so")
        log = (kept / "log.csv").read_bytes()
        (kept / "log.csv").write_bytes(log[:100])
        _, error = drumlin("run", scene, "-o", kept, "--resume", *OVERRIDES, code=2)
        require("log.csv" in error, "short log: the message does not name it")
        (kept / "log.csv").unlink()
        drumlin("run", scene, "-o", kept, "--resume", *OVERRIDES, code=2)
        (kept / "log.csv").write_bytes(log)
        one_damaged = work / "one-damaged"
        shutil.copytree(kept, one_damaged)
        damage(one_damaged / "checkpoint.h5")
        if (one_damaged / "checkpoint-previous.h5").exists():
            _, error = drumlin("run", scene, "-o", one_damaged, "--resume", *OVERRIDES)
            require("checkpoint.h5" in error and "goes on from checkpoint-previous.h5" in error, f"another checkpoint without a word: {error}")
            require(results_of_run(one_damaged) == expected, "from the checkpoint before, the run left other bytes than the whole one")
        for name in ("checkpoint.h5", "checkpoint-previous.h5"):
            if (kept / name).exists():
                damage(kept / name)
        _, error = drumlin("run", scene, "-o", kept, "--resume", *OVERRIDES, code=2)
        require("checkpoint.h5" in error and "damaged" in error, "damaged checkpoints: the message does not say so")
        require((kept / "log.csv").read_bytes() == log, "a refused resumption touched the log")


if __name__ == "__main__":
    main()
