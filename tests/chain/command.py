"""Runs `drumlin` for the tests of the chain."""

import contextlib
import json
import pathlib
import subprocess
import sys
import tempfile
import time


# Changes of tiny-drum.toml that make a run of a fraction of a second.
SHORT_RUN = ["--set", "stages.1.turns=0.02", "--set", "stages.2.turns=0.02", "--set", "stages.2.snapshots=4"]


class Drumlin:
    def __init__(self, executable):
        self.executable = executable

    def __call__(self, *words, code=0):
        """Runs the command and checks its exit code; returns what it wrote to (standard output, standard error)."""
        command = [self.executable, *map(str, words)]
        result = subprocess.run(command, capture_output=True, text=True, timeout=3000, check=False)
        require(result.returncode == code,
                f"{' '.join(command)}\nexit code {result.returncode} instead of {code}\n{result.stdout}{result.stderr}")
        return result.stdout, result.stderr


@contextlib.contextmanager
def given():
    """The program, the folders that the command line names, and one that is removed at the end."""
    executable, *folders = (pathlib.Path(word).resolve() for word in sys.argv[1:] if not word.startswith("--"))
    with tempfile.TemporaryDirectory(prefix="drumlin-chain-") as name:
        yield (Drumlin(str(executable)), *folders, pathlib.Path(name))


def has_address_sanitizer(executable):
    """Such a program takes terabytes of addresses, wants to be loaded first, and keeps calls to the system to itself."""
    return b"__asan_init" in pathlib.Path(executable).read_bytes()


def require(condition, message):
    if not condition:
        sys.exit(message)


def read_json(file):
    # A NaN in a JSON file is none: other readers refuse it.
    def refuse(constant):
        sys.exit(f"{file}: {constant} is no JSON")
    return json.loads(pathlib.Path(file).read_text(encoding="utf-8"), parse_constant=refuse)


def started(*words, **options):
    """A process that prints nowhere."""
    return subprocess.Popen(list(map(str, words)), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, **options)


def wait_until(condition, what, process=None, patience=1200):
    """At most so many seconds, and while the process, if there is one, is at work."""
    deadline = time.monotonic() + patience
    while not condition():
        require((process is None or process.poll() is None) and time.monotonic() < deadline, f"not in time: {what}")
        time.sleep(0.001)


def require_keys(content, keys, where):
    missing = [key for key in keys if key not in content]
    require(not missing, f"{where}: missing {', '.join(missing)}")


def bytes_below(folder):
    """Every file below a folder with its content."""
    return {str(path.relative_to(folder)): path.read_bytes() for path in sorted(pathlib.Path(folder).rglob("*"))
            if path.is_file()}


def results_of_run(run):
    """What must not depend on how often a run was stopped, or on what failed: all but timings, their sums and the private checkpoints."""
    return {name: content for name, content in bytes_below(run).items()
            if name not in ("run.json", "manifest.txt", "checkpoint.h5", "checkpoint-previous.h5")}


def require_whole_files(folder):
    """No part of a file below the folder; JSON files are whole."""
    for path in folder.rglob("*"):
        require(".part" not in path.name, f"{path} was left")
        if path.suffix == ".json" and path.is_file():
            read_json(path)
        if path.suffix == ".png":
            require(path.read_bytes().endswith(b"IEND\xaeB`\x82"), f"{path} is half a picture")
