"""The commands, for what Python does not do by itself: each is started as a process and raises what it refuses or fails at."""

import concurrent.futures
import itertools
import os
import pathlib
import shutil
import signal
import subprocess
import sys

from .errors import DrumlinError, InputError, IoError, NotConvergedError
from .files import Folder, read
from .inputs import file_name
from .scenes import overrides_of, toml_of

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


def _written(value, output, kind):
    """The file of a scene or a law that is no file yet: beside the folder of the results."""
    file = output.with_name(f"{output.name}-{kind}.toml")
    output.parent.mkdir(parents=True, exist_ok=True)
    if hasattr(value, "write"):
        value.write(file)
    else:
        file.write_text(toml_of(value) if isinstance(value, dict) else value, encoding="utf-8")
    return file


def _scene_file(scene, output, form):
    if isinstance(scene, dict):
        return _written({"format": form} | scene, output, "scene")
    return _written(scene, output, "scene") if isinstance(scene, str) and "\n" in scene else scene


def _sets(changes):
    return [word for change in overrides_of(changes) for word in ("--set", change)]


def run(scene, output, changes=(), threads: int = 1, overwrite: bool = False) -> Folder:
    """`drumlin run`: a scene (a file, the name of a shipped one, a text, a dict) into a folder of results, which is returned."""
    output = pathlib.Path(output)
    command("run", _scene_file(scene, output, "drumlin-scene-1"), "-o", output, "--threads", threads, *_sets(changes), *_existing(overwrite))
    return read(output)


def solve_flow(scene, law, output, changes=(), overwrite: bool = False) -> Folder:
    """`drumlin flow`: a scene of the continuum (as in run) with a law (a file, or a Law) into a folder of results, which is returned."""
    output = pathlib.Path(output)
    law = _written(law, output, "law") if hasattr(law, "write") else law
    command("flow", _scene_file(scene, output, "drumlin-flow-scene-1"), "--rheology", law, "-o", output, *_sets(changes), *_existing(overwrite))
    return read(output)


def measure(run_folder, overwrite: bool = False, parts=()) -> Folder:
    """`drumlin measure`: the folder RUN/measured. parts: what is measured beside the profiles (`drumlin measure --help`); all that is usual unless told."""
    command("measure", run_folder, *_existing(overwrite), *(["--parts", ",".join(parts)] if parts else []))
    return read(pathlib.Path(run_folder) / "measured")


def compare(run_folder, flow_folder, output, overwrite: bool = False, accept_unsteady: bool = False) -> Folder:
    """`drumlin compare`: a measured run beside a flow, into a folder with comparison.json and a page."""
    command("compare", run_folder, flow_folder, "-o", output, *_existing(overwrite), *(["--accept-unsteady"] if accept_unsteady else []))
    return read(output)


def sweep(scene, values: dict, output, processes: int | None = None, progress: bool = True) -> list[tuple[dict, Folder]]:
    """Runs a scene with every combination of values, {"effects.friction.grain_grain": [0.2, 0.4]}, in parallel processes of one thread each.

    Returns [(changes, folder), ...] in the order of the combinations; the folders lie in `output`, named by their numbers, from 000 on. The same
    call again goes on where one was interrupted. A run that fails raises its error once the others have ended.
    """
    output = pathlib.Path(output)
    output.mkdir(parents=True, exist_ok=True)
    scene = _scene_file(scene, output / "sweep", "drumlin-scene-1")
    plans = [dict(zip(values, chosen)) for chosen in itertools.product(*values.values())]

    def one(number):
        command("run", scene, "-o", output / f"{number:03}", "--threads", 1, "--resume", *_sets(plans[number]))
        return plans[number], read(output / f"{number:03}")

    with concurrent.futures.ThreadPoolExecutor(processes or os.cpu_count()) as pool:
        futures = [pool.submit(one, number) for number in range(len(plans))]
        for done, _ in enumerate(concurrent.futures.as_completed(futures), 1):
            if progress:
                print(f"\r{done} of {len(plans)} runs", end="" if done < len(plans) else "\n", file=sys.stderr, flush=True)
    return [future.result() for future in futures]
