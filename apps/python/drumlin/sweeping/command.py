"""`drumlin sweep` once it has read the scene.

usage: command.py GIVEN
  GIVEN  JSON: the options of the command by their long names (apps/commands/sweep.cpp), and the sum of what was requested
"""

import contextlib
import json
import pathlib
import sys
import tomllib

from drumlin.errors import InputError, IoError
from drumlin.sweeping.executors import workers_of
from drumlin.sweeping.sweep import Sweep


def values_of(words):
    """{key: values} of words such as "seed=1:2:3"; a value that is none in TOML is a text."""
    varied = {}
    for word in words:
        key, sign, values = word.partition("=")
        if not sign or not key or "" in values.split(":"):
            raise InputError(f"--vary: '{word}' does not name a key and its values (allowed: KEY=VALUE:VALUE...)")
        if key in varied:
            raise InputError(f"--vary: {key} is named twice")
        varied[key] = [_value(value) for value in values.split(":")]
    return varied


def _value(text):
    try:
        return tomllib.loads(f"value = {text}")["value"]
    except tomllib.TOMLDecodeError:
        return text


@contextlib.contextmanager
def executor_of(text):
    """The executor that the word of an option names; None on a rank that computes for the first."""
    if text != "mpi":
        with workers_of(text) as workers:
            yield workers
        return
    try:
        from mpi4py import MPI  # pylint: disable=import-outside-toplevel  # of those who have a cluster
        from mpi4py.futures import MPICommExecutor  # pylint: disable=import-outside-toplevel
    except ModuleNotFoundError as error:
        raise InputError("--executor mpi: mpi4py is not installed (Debian: python3-mpi4py)") from error
    if MPI.COMM_WORLD.size < 2:
        raise InputError("--executor mpi: there is one rank (allowed: 2 or more, mpirun -n N drumlin sweep ...; the first hands out the runs)")
    with MPICommExecutor(MPI.COMM_WORLD, root=0) as executor:
        yield executor


def swept(given, executor):
    """Exit code of the sweep."""
    work = Sweep(given["scene"], values_of(given["vary"]), given["output"], given["set"])
    work.begin(given["overwrite"], given["resume"], given["sum"])
    print(f"report: {pathlib.Path(given['output']).absolute() / 'index.html'}", flush=True)
    runs, unwritten = work.execute(executor, None, {} if given["measure"] else None, None, {"threads": given["threads"]}, given["quantities"])
    failed = [run for run in runs if run.error is not None]
    for run in failed:
        print(f"{run.folder.path.name}: {run.error}", file=sys.stderr)
    print(f"{len(runs)} runs, {len(failed)} failed")
    if failed:
        return getattr(failed[0].error, "exit_code", 1)
    if unwritten:
        raise IoError(unwritten)
    return 0


def main(words):
    given = json.loads(words)
    with executor_of(given["executor"]) as executor:
        return swept(given, executor) if executor is not None else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
