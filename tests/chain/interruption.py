"""A run that is interrupted, terminated or killed goes on to the same bytes; what does not fit is refused.

usage: interruption.py DRUMLIN FOLDER_OF_THIS_TEST
"""

import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time

from command import Drumlin, bytes_below, read_json, require

OVERRIDES = ["--set", "output.checkpoint_every_s=0.05", "--set", "stages.1.turns=0.2", "--set", "stages.2.turns=0.2"]


def results(run):
    """What must not depend on how often a run was stopped: all but timings and the private checkpoint."""
    return {name: content for name, content in bytes_below(run).items() if name not in ("run.json", "checkpoint.h5")}


def stopped(executable, scene, run, stop, code):
    """Starts a run and stops it by a signal once it has left a checkpoint and a snapshot."""
    process = subprocess.Popen([executable, "run", scene, "-o", run, *OVERRIDES], stdout=subprocess.DEVNULL,
                               stderr=subprocess.DEVNULL)
    deadline = time.monotonic() + 120
    while not ((run / "checkpoint.h5").exists() and list((run / "snapshots").glob("*.h5"))):
        require(process.poll() is None and time.monotonic() < deadline, f"{run.name}: no checkpoint and snapshot in time")
        time.sleep(0.001)
    process.send_signal(stop)
    require(process.wait(timeout=60) == code, f"{run.name}: exit code {process.returncode} instead of {code}")


def main():
    executable, tests = sys.argv[1], pathlib.Path(sys.argv[2])
    drumlin = Drumlin(executable)
    scene = tests / "tiny-drum.toml"
    with tempfile.TemporaryDirectory(prefix="drumlin-interruption-") as name:
        work = pathlib.Path(name)
        whole = work / "whole"
        drumlin("run", scene, "-o", whole, *OVERRIDES)
        expected = results(whole)

        for stop, code, status in ((signal.SIGINT, 130, "interrupted"), (signal.SIGTERM, 143, "interrupted"),
                                   (signal.SIGKILL, -signal.SIGKILL, "running")):
            run = work / stop.name
            stopped(executable, scene, run, stop, code)
            require(read_json(run / "run.json")["status"] == status, f"{stop.name}: run.json does not say {status}")
            shutil.copytree(run, work / (stop.name + "-kept"))
            drumlin("run", scene, "-o", run, "--resume", "--threads", "2", *OVERRIDES)
            require(results(run) == expected, f"{stop.name}: the resumed run left other bytes than the whole one")
            require(read_json(run / "run.json")["status"] == "finished", f"{stop.name}: not finished")

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
        checkpoint = bytearray((kept / "checkpoint.h5").read_bytes())
        checkpoint[len(checkpoint) // 2] ^= 4
        (kept / "checkpoint.h5").write_bytes(checkpoint)
        _, error = drumlin("run", scene, "-o", kept, "--resume", *OVERRIDES, code=2)
        require("checkpoint.h5" in error and "damaged" in error, "damaged checkpoint: the message does not say so")
        require((kept / "log.csv").read_bytes() == log, "a refused resumption touched the log")


if __name__ == "__main__":
    main()
