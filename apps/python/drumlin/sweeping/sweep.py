"""A scene with many settings, each a run of its own, on the workers of an executor."""

import functools
import itertools
import os
import pathlib
import tomllib
import typing
import warnings

from .. import _drumlin
from ..commands import changes_of, measure, run, scene_file, scene_from_here
from ..errors import DrumlinError
from ..files import Folder
from ..scenes import resolved, toml_of
from ..study.fits import Scalar
from ..study.runs import scalars_of
from .executors import AT_WORK, arrived, run_all, workers_of
from .report import Report

FORM = "drumlin-scene-1"


class SweptRun(typing.NamedTuple):
    """A run of a sweep: what was changed in the scene, the folder of its results, the error if it failed, else None, and its numbers by name, each with
    `value` and `ci99`, the half width of its 99 % interval (NaN, None: not known).

    >>> [(run.changes, run.error) for run in drumlin.sweep("drum-smoke", {"seed": [1, 2]}, "SWEEP")]
    """

    changes: dict
    folder: Folder
    error: Exception | None
    numbers: dict


def numbers_of(folder):
    """What a run says of itself: the numbers of its measurement if it has one, and the rates of its outlets and sources."""
    report = folder["run.json"]
    rates = {f"{region['name']}.grains_per_s": {"value": region["rate"]["grains_per_s"], "ci99": region["rate"]["ci99"]}
             for region in report.get("regions", []) if "rate" in region}
    measured = folder["measured/measured.json"] if "measured/measured.json" in folder else {}
    return scalars_of({name: entry for name, entry in measured.items() if name != "seconds"} | rates | {"cpu_seconds": report["cpu_seconds"]})


def _scalar(value):
    return Scalar(*(None if part is None else float(part) for part in (value if isinstance(value, (tuple, list)) else [value])))


def _swept(scene, folder, changes, measured, numbers, options):
    """One run, from its checkpoint if it has one, its measurement unless `measured`, the options, is None, and its numbers."""
    made = run(scene, folder, changes, resume=True, **options)
    if measured is not None:
        measure(folder, resume=True, **measured)
    return {name: _scalar(value) for name, value in numbers(made).items()}


def settings_of(values):
    """The settings, dicts, of every combination of {key: [value, ...]}, or of a list as it is."""
    return [dict(zip(values, chosen)) for chosen in itertools.product(*values.values())] if isinstance(values, dict) else [dict(each) for each in values]


class Sweep:
    """The runs of a scene in a folder, and their report. A setting that the scene cannot have is refused before anything is written."""

    def __init__(self, scene, values, output, changes=()):
        self.settings, self.output = settings_of(values), pathlib.Path(output)
        described = scene_from_here(scene, FORM)
        is_file, described = described is scene, toml_of(described) if isinstance(described, dict) else described
        common = changes_of(changes, not is_file)
        self.changes = [common + changes_of(each, not is_file) for each in self.settings]
        self.scene, self.resolved = scene, resolved(described, common)
        for each in self.changes:
            resolved(described, each)
        self.folders = [Folder(self.output.absolute() / f"{number:03}") for number in range(len(self.settings))]

    def begin(self, overwrite=False, resume=True, request=""):
        """Claims the folder. request: the sum of what the command line asks for."""
        inputs = [self.scene] if os.path.exists(str(self.scene)) else []
        self.claimed = _drumlin.GrowingOutput(str(self.output), "sweep", resume and not overwrite, overwrite, [os.fspath(each) for each in inputs],
                                              ["sweep.json", "quantities.png", "index.html", "sweep-scene.toml"], request)
        for left in self.output.glob(f".drumlin-*{AT_WORK}"):  # by a call that was killed: what still works for it ends
            left.unlink(missing_ok=True)
        self.claimed.forget("*")
        self.claimed.save()
        file = scene_file(self.scene, self.output / "sweep", FORM)
        self.scene = os.path.abspath(file) if os.path.exists(file) else file  # workers may stand elsewhere
        return self

    def execute(self, executor, progress, measured, numbers, options, quantities=(), report=True):  # pylint: disable=too-many-arguments
        """(all runs, what failed of the report's figure and page, an empty text if nothing)."""
        described = tomllib.loads(self.resolved)
        report = Report(self.output, described.get("title", ""), described.get("reduced", False), self.settings, quantities, report)
        jobs = [functools.partial(_swept, self.scene, folder.path, changes, measured, numbers or numbers_of, options)
                for folder, changes in zip(self.folders, self.changes)]
        try:
            outcomes = run_all(jobs, self.output, executor, progress, report.ended)
            failed, runs = report.renew("finished"), [self._run(number, outcome) for number, outcome in enumerate(outcomes)]
            if not any(run.error for run in runs):  # else the next call tries them again
                self.claimed.finish()
        except BaseException:
            report.renew("interrupted")
            raise
        finally:
            self.claimed = None  # to others, also while somebody looks at the traceback
        return runs, failed

    def _run(self, number, outcome):
        error = outcome.error
        try:
            arrived(self.folders[number]) if error is None else None  # pylint: disable=expression-not-assigned
        except DrumlinError as late:
            error = late
        return SweptRun(self.settings[number], self.folders[number], error, outcome.value or {})


def sweep(scene, values, output, executor=None, progress: bool | None = None, measured: dict | None = None, numbers=None, changes=(), overwrite: bool = False,
          report: bool = True, **options) -> list[SweptRun]:
    """Runs a scene with every combination of values, {"effects.friction.grain_grain": [0.2, 0.4]}, or with each of a list of such settings, [{"seed": 1}, ...].

    Returns a SweptRun for each, in their order, failed ones too; the folders lie in `output`, named by their numbers, from 000 on, beside index.html, a page
    of numbers over settings that is renewed as runs end. A setting that the scene cannot have is refused before anything runs. The same call again goes on
    where one was interrupted: Ctrl-C leaves a checkpoint of each run. executor: as in run_all; all workers see `output` and the scene's files. measured:
    options of drumlin.measure for each run, {} for the usual; None: not measured. numbers(folder): called in the worker, {name: number, or (number, half
    width of its 99 % interval)}; absent: those of the measurement and rates of outlets. changes: of all runs, as in run. report: with figure and page.
    options: of drumlin.run.

    >>> runs = drumlin.sweep("drum-smoke", {"effects.friction.grain_grain": [0.2, 0.4]}, "SWEEP", measured={})
    """
    work = Sweep(scene, values, output, changes)
    with workers_of(executor) as workers:
        runs, failed = work.begin(overwrite).execute(workers, progress, measured, numbers, options, report=report)
    if failed:
        warnings.warn(failed)
    return runs
