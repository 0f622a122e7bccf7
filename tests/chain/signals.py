"""Signals end a run cleanly, and what a command has started ends with it, also at kill -9.

usage: signals.py DRUMLIN FOLDER_OF_THIS_TEST DATA
"""

import os
import pathlib
import shutil
import signal

from command import SHORT_RUN, given, read_json, require, require_whole_files, wait_until
from command import started as started_masked

# Steps that nobody waits for, for what must be stopped.
ENDLESS = ["--set", "stages.2.turns=1000"]
SIGNALS = {signal.SIGINT: 130, signal.SIGTERM: 143, signal.SIGHUP: 129}
PATIENCE = 1200  # seconds for what takes less than one


def unmasked():
    """A test that is started in the background, or by nohup, inherits signals that are ignored."""
    for number in SIGNALS:
        signal.signal(number, signal.SIG_DFL)


def started(words):
    return started_masked(*words, preexec_fn=unmasked)


def processes_of(folder):
    """Processes whose command line names the folder, but this one."""
    found = []
    for entry in pathlib.Path("/proc").iterdir():
        if entry.name.isdigit() and int(entry.name) != os.getpid():
            try:
                if str(folder).encode() in (entry / "cmdline").read_bytes():
                    found.append(int(entry.name))
            except OSError:
                pass
    return found


def check_signals(executable, scene, folder):
    """A run ends by a signal with its code, a checkpoint and without parts of files; of every command contract.py says so."""
    for number, code in SIGNALS.items():
        stopped = folder / f"stopped-{code}"
        process = started([executable, "run", scene, "-o", stopped, *ENDLESS, "--set", "output.checkpoint_every_s=0.01"])
        wait_until((stopped / "checkpoint.h5").exists, "a checkpoint")
        process.send_signal(number)
        require(process.wait(PATIENCE) == code, f"run: exit code {process.returncode} instead of {code}")
        require(read_json(stopped / "run.json")["status"] == "interrupted", f"run: status after {number.name}")
        require_whole_files(stopped)
    print("signals: clean ends")


def check_children(executable, here, data, run, folder):
    """What a command has started ends with it, also at kill -9."""
    drawn = folder / "drawn"
    shutil.copytree(run, drawn)
    for number in (signal.SIGKILL, signal.SIGTERM):
        process = started([executable, "measure", drawn, "--parts", "none", "--resume"])
        wait_until(lambda: len(processes_of(drawn)) >= 2 or process.poll() is not None, "a script of figures")
        require(process.poll() is None, "measure ended before it drew")
        process.send_signal(number)
        require(process.wait(PATIENCE) == (143 if number == signal.SIGTERM else -number), f"measure: exit code {process.returncode}")
        wait_until(lambda: not processes_of(drawn), "the end of the script")
        if number == signal.SIGTERM:
            require_whole_files(drawn)
    flow = folder / "flow"
    march = ["flow", here / "tiny-drum-flow.toml", "--rheology", data / "rheology" / "paper.toml", "-o", flow,
             "--set", "time.step_s=0.001", "--set", "time.steps=100000", "--set", "time.every=1"]
    for number, code in {signal.SIGKILL: -signal.SIGKILL, signal.SIGHUP: 129}.items():
        process = started([executable, *march, "--resume"])
        (flow / "checkpoint.h5").unlink(missing_ok=True)
        wait_until(lambda: (flow / "checkpoint.h5").exists() or process.poll() is not None, "a kept state")
        require(process.poll() is None and len(processes_of(flow)) >= 2, f"flow: ended with {process.returncode}")
        process.send_signal(number)
        require(process.wait(PATIENCE) == code, f"flow: exit code {process.returncode} instead of {code}")
        wait_until(lambda: not processes_of(flow), "the end of drumlin-flow")
        require((flow / "checkpoint.h5").exists(), "flow: no checkpoint")
    print("children: gone with their parents")


def main():
    with given() as (drumlin, here, data, folder):
        executable, run = drumlin.executable, folder / "run"
        scene = here / "tiny-drum.toml"
        drumlin("run", scene, "-o", run, *SHORT_RUN)
        check_signals(executable, scene, folder)
        check_children(executable, here, data, run, folder)


if __name__ == "__main__":
    main()
