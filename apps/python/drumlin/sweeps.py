"""A scene with many settings, each a run of its own, on the workers of an executor."""

import functools
import itertools
import os
import pathlib
import typing

from .commands import _changes, _scene_file, measure, run
from .executors import run_all
from .files import Folder
from .scenes import resolved


class SweptRun(typing.NamedTuple):
    """A run of a sweep: what was changed in the scene, the folder of its results, and the error if it failed, else None."""

    changes: dict
    folder: Folder
    error: Exception | None = None


def _swept(scene, folder, changes, measured, options):
    """One run, from its checkpoint if it has one, and its measurement unless `measured`, the options, is None; its folder."""
    made = run(scene, folder, changes, resume=True, **options)
    if measured is not None:
        measure(folder, resume=True, **measured)
    return made


def settings_of(values):
    """The settings, dicts, of every combination of {key: [value, ...]}, or of a list as it is."""
    return [dict(zip(values, chosen)) for chosen in itertools.product(*values.values())] if isinstance(values, dict) else [dict(each) for each in values]


def sweep(scene, values, output, executor=None, progress: bool | None = None, measured: dict | None = None, **options) -> list[SweptRun]:
    """Runs a scene with every combination of values, {"effects.friction.grain_grain": [0.2, 0.4]}, or with each of a list of such settings, [{"seed": 1}, ...].

    Returns [(changes, folder, error), ...] in their order, failed runs too; the folders lie in `output`, named by their numbers, from 000 on. A setting that
    the scene cannot have is refused before anything runs. The same call again goes on where one was interrupted: Ctrl-C leaves a checkpoint of each run.
    executor: as in run_all; `output` and the scene are files that all workers see. measured: options of drumlin.measure for each run, {} for the usual; None:
    nothing is measured. options: of drumlin.run.
    """
    output = pathlib.Path(output)
    output.mkdir(parents=True, exist_ok=True)
    settings = settings_of(values)
    file = _scene_file(scene, output / "sweep", "drumlin-scene-1")
    changes = [_changes(each, file is not scene) for each in settings]
    for each in changes:
        resolved(file, each)
    file = os.path.abspath(file) if os.path.exists(file) else file
    folders = [output.absolute() / f"{number:03}" for number in range(len(settings))]
    jobs = [functools.partial(_swept, file, *each, measured, options) for each in zip(folders, changes)]
    return [SweptRun(each, Folder(folder), outcome.error)
            for each, folder, outcome in zip(settings, folders, run_all(jobs, output, executor, progress))]
