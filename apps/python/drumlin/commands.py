"""The commands, for what Python does not do by itself: each is started as a process and raises what it refuses or fails at."""

import functools
import json
import os
import pathlib
import re
import select
import shutil
import signal
import subprocess
import sys
import tempfile
import tomllib

from .errors import DrumlinError, InputError, Interrupted, IoError, Killed, NotConvergedError
from .sweeping.executors import at_work, has_been_interrupted
from .files import Folder, read
from .inputs import file_name
from .progress import Progress
from .scenes import overrides_of, toml_of

_SHARE = re.compile(r"^(?:reduced )?[a-z ]+? +([\d.]+) %.*\n", re.MULTILINE)  # a line of progress
# What mpirun and srun tell a rank: a program with MPI that it starts is none of theirs.
_OF_A_RANK = re.compile(r"PMIX?_|OMPI_(?!ALLOW_|MCA_)|OMPI_MCA_(?:ess|orte|pmix|initial_wdir|mpi_oversubscribe)")
_KINDS = {kind.exit_code: kind for kind in (InputError, NotConvergedError, IoError)}


def program(name="drumlin"):
    """Path of a command: that of the tree that this package lies in, or the one that PATH finds.

    >>> drumlin.program()
    """
    above = pathlib.Path(__file__).parents
    for folder in [above[2], above[4] / "bin"] if len(above) > 4 else []:  # of a build tree; below a prefix
        if os.access(folder / name, os.X_OK) and (folder / name).is_file():
            return folder / name
    found = shutil.which(name)
    if found is None:
        raise IoError(f"{name}: is missing; neither beside the package nor along PATH")
    return pathlib.Path(found)


def _environment():
    is_rank = "PMIX_RANK" in os.environ or "PMI_RANK" in os.environ
    return {name: value for name, value in os.environ.items() if not (is_rank and _OF_A_RANK.match(name))}


def draw(script, *words):
    """Runs a script of figures or of pages, as the commands do."""
    here = pathlib.Path(__file__).parent
    done = subprocess.run([sys.executable, "-I", "-B", here / "figures/isolated.py", here / script, *map(str, words)], stdin=subprocess.DEVNULL,
                          capture_output=True, text=True, check=False, env=os.environ | {"MPLBACKEND": "Agg"})
    if done.returncode:
        raise DrumlinError(f"{script}: {done.stderr.strip()}")


class _Process:
    """A command at work. What it prints goes to files: nobody has to read it meanwhile."""

    def __init__(self, words, watched=False):
        self._printed, self._said = (tempfile.TemporaryFile("a+", errors="backslashreplace") for _ in range(2))
        self._process = subprocess.Popen([program(), *map(_text, words)], stdin=subprocess.DEVNULL, stdout=self._printed, stderr=self._said,
                                         env=_environment() | {"DRUMLIN_PARENT": str(os.getpid())} | ({"DRUMLIN_PROGRESS": "1"} if watched else {}))

    def has_ended(self, seconds=None):
        """Whether it has ended within so many seconds; None: waits for its end."""
        if self._process.returncode is None:
            file = os.pidfd_open(self._process.pid)  # tells the end at once, which subprocess would look for every 50 ms
            try:
                end = select.poll()
                end.register(file, select.POLLIN)
                if not end.poll(None if seconds is None else 1e3 * seconds):
                    return False
            finally:
                os.close(file)
        return True

    def interrupt(self):
        """Hands Ctrl-C on: a run leaves a checkpoint."""
        self._process.send_signal(signal.SIGINT)  # it has it already where both stand in one group of a terminal

    def last_word(self):
        """What it says at its end, for which it waits; Ctrl-C meanwhile kills it."""
        try:
            self._process.wait()
        except KeyboardInterrupt:
            self._process.kill()
        return self._words() or ("finished" if self._process.returncode == 0 else "interrupted")

    def percent(self):
        """How far it says that it has come; None before it says so."""
        found = _SHARE.findall(self._text(self._said))
        return float(found[-1]) if found else None

    def result(self):
        """What it printed. Raises the error that its exit code stands for, with its text."""
        code = self._process.wait()
        if code == 0:
            return self._text(self._printed)
        text = self._words() or f"drumlin ended with exit code {code}"
        if code in (130, -signal.SIGINT):
            raise KeyboardInterrupt(text)
        raise Killed(text) if code < 0 or code == 128 + signal.SIGTERM else _KINDS.get(code, DrumlinError)(text)

    def _words(self):
        return _SHARE.sub("", self._text(self._said)).strip()

    @staticmethod
    def _text(file):
        file.seek(0)
        return file.read()


def _command(words, name=None, output=None, progress=False):
    call = at_work.get()
    with Progress(name, 100 if name in ("run", "measure") else None, False if call and progress is None else progress, output) as bar:
        process = _Process(words, bar.shown)
        try:
            while not process.has_ended(0.25 if bar.shown or call else None):
                bar.to(process.percent())
                if has_been_interrupted(call):
                    raise Interrupted
        except (KeyboardInterrupt, Interrupted) as error:
            process.interrupt()
            raise type(error)((f"{output}: " if output else "") + process.last_word()) from None
        return process.result()


@functools.cache
def _table():
    """{command: {option: what the program says of it}}, by names of Python."""
    said = subprocess.run([program(), "--commands"], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, check=True).stdout
    return {command["name"]: {option["name"].replace("-", "_"): option for option in command["options"]} for command in json.loads(said)}


def _words(name, *positional, **options):
    """The words of a command for these values of its options."""
    if name not in _table() and positional and f"{name} {positional[0]}" in _table():
        name, positional = f"{name} {positional[0]}", positional[1:]
    known, words = _table().get(name), [*name.split(), *positional]
    if known is None:
        raise InputError(f"no command is called {name!r} (there are {', '.join(_table())})")
    for key, value in options.items():
        option = known.get(key.rstrip("_"))
        if option is None or option["is_positional"]:
            raise TypeError(f"drumlin {name}: no option is called {key} (it has {', '.join(key for key in known if not known[key]['is_positional'])})")
        is_one = isinstance(value, (str, os.PathLike)) or not hasattr(value, "__iter__")
        values = list(value) if not is_one else [] if value is None or value is False else [value]
        if option["is_list"] and not option["is_repeated"] and not option["is_of_paths"]:
            values = [",".join(map(str, values))] if values else []
        for number, one in enumerate(values):
            words += ["--" + option["name"]] if number == 0 or option["is_repeated"] else []
            words += [] if one is True else [one]
    return words


def command(*words, **options) -> str:
    """Runs `drumlin WORDS...` and returns what it printed, a text. options: those of `drumlin COMMAND --help` by their long names, slice_width=10,
    slices=[-5, 5], from_="maps". Raises the error that its exit code stands for, with its text; Ctrl-C ends it and is a KeyboardInterrupt here.

    >>> drumlin.command("scene", "check", "drum-smoke")
    """
    return _command(_words(*words, **options) if options else words)


def _text(word):
    return file_name(word if isinstance(word, os.PathLike) else str(word))


def _written(value, output, kind):
    """The file of a scene or a law that is no file yet: beside the folder of the results."""
    file = output.with_name(f"{output.name}-{kind}.toml")
    output.parent.mkdir(parents=True, exist_ok=True)
    if hasattr(value, "write"):
        value.write(file)
    else:
        file.write_text(toml_of(value) if isinstance(value, dict) else value, encoding="utf-8")
    return file


def _from_here(entry):
    """A part of a scene that is no file yet: its lists of grains and its runs count from the current folder."""
    if isinstance(entry, dict):
        return {key: os.path.abspath(value) if value and str(key).split(".")[-1] in ("file", "run") and isinstance(value, (str, os.PathLike))
                else _from_here(value) for key, value in entry.items()}
    return [_from_here(value) for value in entry] if isinstance(entry, (list, tuple)) else entry


def scene_from_here(scene, form):
    """A scene that is no file, a text or a dict, as a dict whose files count from the current folder; a file as it is, and a text that is no TOML."""
    if isinstance(scene, str) and "\n" in scene:
        try:
            scene = tomllib.loads(scene)
        except tomllib.TOMLDecodeError:  # the command says what is wrong, and where
            return scene
    return {"format": form} | _from_here(scene) if isinstance(scene, dict) else scene


def scene_file(scene, output, form):
    """The file of a scene, written beside the folder of the results if it is none."""
    scene = scene_from_here(scene, form)
    return _written(scene, output, "scene") if isinstance(scene, dict) or (isinstance(scene, str) and "\n" in scene) else scene


def changes_of(changes, from_here):
    """Changes as words after --set; of a scene that is no file, files count from the current folder."""
    return list(overrides_of(_from_here(changes) if from_here else changes))


def run(scene, output, changes=(), threads: int = 1, overwrite: bool = False, resume: bool = False, progress: bool | None = None, **options) -> Folder:
    """`drumlin run`: steps a scene of grains to its end, into a folder of results, which is returned.

    scene: a file, the name of a shipped one, a text of TOML or a dict of its keys, in their units (mm, s, ...); changes: {"solver.tolerance": 1e-3}.
    resume: goes on where a call was interrupted. Ctrl-C leaves a checkpoint. progress: shown or not; None: on a terminal alone.
    options, here and below: the others of the command, as in drumlin.command.

    >>> run = drumlin.run("drum-smoke", "RUN", {"stages.2.turns": 2})
    """
    output = pathlib.Path(output)
    file = scene_file(scene, output, "drumlin-scene-1")
    _command(_words("run", file, output=output, threads=threads, set=changes_of(changes, file is not scene), overwrite=overwrite, resume=resume, **options),
             "run", output, progress)
    return read(output)


def solve_flow(scene, law, output, changes=(), overwrite: bool = False, progress: bool | None = None, **options) -> Folder:
    """`drumlin flow`: a scene of the continuum with a law (a file, or a Law) into a folder of results, which is returned.

    scene, changes, progress: as in run. Needs the half of Drumlin with deal.II.

    >>> flow = drumlin.solve_flow("drum-smoke-flow", "rheology.toml", "FLOW")
    """
    output = pathlib.Path(output)
    law = _written(law, output, "law") if hasattr(law, "write") else law
    file = scene_file(scene, output, "drumlin-flow-scene-1")
    _command(_words("flow", file, rheology=law, output=output, set=changes_of(changes, file is not scene), overwrite=overwrite, **options), "flow", output, progress)
    return read(output)


def measure(run_folder, overwrite: bool = False, parts=(), progress: bool | None = None, **options) -> Folder:
    """`drumlin measure`: averages of a run into its folder `measured`, which is returned.

    parts: what is measured beside the profiles (`drumlin measure --help`); all that is usual unless told. progress: as in run.

    >>> measured = drumlin.measure("RUN", parts=["none"])
    """
    output = pathlib.Path(run_folder) / "measured"
    _command(_words("measure", run_folder, overwrite=overwrite, parts=parts, **options), "measure", output, progress)
    return read(output)


def compare(run_folder, flow_folder, output, overwrite: bool = False, accept_unsteady: bool = False, progress: bool | None = None, **options) -> Folder:
    """`drumlin compare`: a measured run beside a flow, into a folder with comparison.json and a page, which is returned. progress: as in run.

    >>> report = drumlin.compare("RUN", "FLOW", "REPORT")
    """
    _command(_words("compare", run_folder, flow_folder, output=output, overwrite=overwrite, accept_unsteady=accept_unsteady, **options), "compare", output, progress)
    return read(output)


def make_pair(scene, law, output, changes=(), runs=(), seeds: int = 1, at=(), overwrite: bool = False, resume: bool = False, progress: bool | None = None,
              **options) -> Folder:
    """`drumlin pair`: particles and continuum of one scene, into a folder with flow.toml, the runs, the flow and a report, which is returned.

    runs: finished ones in place of new ones, one for each of `seeds`; at: seconds since the flow begins at which both sides are compared. scene, law, changes,
    resume, progress: as in run and solve_flow.

    >>> pair = drumlin.make_pair("column-collapse-rough", "collapse-grains", "PAIR", seeds=6)
    """
    output = pathlib.Path(output)
    law = _written(law, output, "law") if hasattr(law, "write") else law
    file = scene_file(scene, output, "drumlin-scene-1")
    _command(_words("pair", file, law=law, output=output, set=changes_of(changes, file is not scene), run=runs, seeds=seeds, at=at, overwrite=overwrite,
                    resume=resume, **options), "pair", output, progress)
    return read(output)


def infer(question, output, designs=None, executor: str = "local", overwrite: bool = False, resume: bool = False, progress: bool | None = None) -> Folder:
    """`drumlin infer`: the grains behind measured numbers, into a folder with infer.json, samples.csv and figures, which is returned.

    question: a file (docs/formats/infer.md) or a dict of its keys, whose scenes and tables count from the current folder. designs: folder of the runs, kept
    for other questions; None: beside the output. executor: local, local:N (so many runs at a time) or dask:ADDRESS. progress: as in run.

    >>> drumlin.infer("question.toml", "INFER")["infer.json"]
    """
    output = pathlib.Path(output)
    if isinstance(question, dict):
        scenes = [one | {kind: os.path.abspath(one[kind]) for kind in ("scene", "table") if kind in one and os.path.isfile(one[kind])}
                  for one in question.get("scenes", [])]
        question = _written({"format": "drumlin-question-1"} | question | {"scenes": scenes}, output, "question")
    _command(_words("infer", question, output=output, designs=designs, executor=executor, overwrite=overwrite, resume=resume), "infer", output, progress)
    return read(output)


def score(fields, limits, output, against=(), overwrite: bool = False, progress: bool | None = None) -> dict:
    """`drumlin score`: errors of a continuum (the folder of a flow, or a file of its profiles, maps or fields) against runs, by limits; the content of
    score.json (docs/formats/score.md). against: measured runs, those of data/bed at that speed unless told. progress: as in run.

    >>> drumlin.score("FLOW", "bed.toml", "SCORE")["verdict"]
    """
    output = pathlib.Path(output)
    _command(_words("score", fields, limits=limits, output=output, against=against, overwrite=overwrite), "score", output, progress)
    return read(output / "score.json")
