"""The commands, for what Python does not do by itself: each is started as a process and raises what it refuses or fails at."""

import os
import pathlib
import shutil
import signal
import subprocess

from .errors import DrumlinError, InputError, IoError, NotConvergedError
from .files import read
from .inputs import file_name
from .scenes import overrides_of

_KINDS = {2: InputError, 3: NotConvergedError, 74: IoError}


def program(name="drumlin"):
    """Path of a command: that of the tree that this package lies in, or the one that PATH finds."""
    above = pathlib.Path(__file__).parents
    for folder in [above[2], above[4] / "bin"] if len(above) > 4 else []:  # of a build tree; below a prefix
        if os.access(folder / name, os.X_OK) and (folder / name).is_file():
            return folder / name
    found = shutil.which(name)
    if found is None:
        raise IoError(f"{name}: is missing; neither beside the package nor along PATH")
    return pathlib.Path(found)


def command(*words):
    """Runs `drumlin WORDS...` and returns what it printed. Raises the error that its exit code stands for, with its text; Ctrl-C ends it and is a
    KeyboardInterrupt here."""
    with subprocess.Popen([program(), *map(_text, words)], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, text=True) as process:
        try:
            printed, said = process.communicate()
        except KeyboardInterrupt:
            process.send_signal(signal.SIGINT)  # it has it already where both stand in one group of a terminal
            process.communicate()
            raise
    if process.returncode == 0:
        return printed
    text = said.strip().removeprefix("drumlin: ") or f"drumlin ended with exit code {process.returncode}"
    if process.returncode in (130, -signal.SIGINT):
        raise KeyboardInterrupt(text)
    raise _KINDS.get(process.returncode, DrumlinError)(text)


def _text(word):
    return file_name(word if isinstance(word, os.PathLike) else str(word))


def _existing(overwrite):
    return ["--overwrite"] if overwrite else []


def run(scene, output, changes=(), threads=1, overwrite=False):
    """`drumlin run`: a scene file into a folder of results, which is returned."""
    sets = [word for change in overrides_of(changes) for word in ("--set", change)]
    command("run", scene, "-o", output, "--threads", threads, *sets, *_existing(overwrite))
    return read(output)


def solve_flow(scene, law, output, changes=(), overwrite=False):
    """`drumlin flow`: a scene file of the continuum with a law (a file, or a Law) into a folder of results, which is returned."""
    output = pathlib.Path(output)
    if hasattr(law, "write"):
        output.parent.mkdir(parents=True, exist_ok=True)
        written = output.with_name(output.name + "-law.toml")
        law.write(written)
        law = written
    sets = [word for change in overrides_of(changes) for word in ("--set", change)]
    command("flow", scene, "--rheology", law, "-o", output, *sets, *_existing(overwrite))
    return read(output)


def measure(run_folder, overwrite=False):
    """`drumlin measure`: the folder RUN/measured."""
    command("measure", run_folder, *_existing(overwrite))
    return read(pathlib.Path(run_folder) / "measured")


def compare(run_folder, flow_folder, output, overwrite=False, accept_unsteady=False):
    """`drumlin compare`: a measured run beside a flow, into a folder with comparison.json and a page."""
    command("compare", run_folder, flow_folder, "-o", output, *_existing(overwrite), *(["--accept-unsteady"] if accept_unsteady else []))
    return read(output)
