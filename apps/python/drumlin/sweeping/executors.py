"""Many jobs on the workers of an executor: anything whose submit(function, *arguments) gives a future."""

import collections
import concurrent.futures
import contextlib
import contextvars
import functools
import os
import pathlib
import queue
import secrets
import socket
import time
import typing

from ..errors import InputError, Interrupted, IoError, Killed
from ..files import Folder
from ..progress import Progress

AT_WORK = ".at-work"  # how the name of a file ends that says that a call goes on
PATIENCE_S = 60  # for another process to leave a folder, for a shared file system to show a file, for jobs that are told to end

at_work = contextvars.ContextVar("at_work", default=None)  # the file that is there while the call of run_all goes on to which a job belongs


class Outcome(typing.NamedTuple):
    """What became of a job: the value that it returned, or the error that it raised.

    >>> [outcome.value for outcome in drumlin.run_all(jobs, "JOBS") if outcome.error is None]
    """

    value: object = None
    error: Exception | None = None


def has_been_interrupted(call):
    """Whether the call of run_all with this file (at_work) has been interrupted. A file system that does not answer says nothing."""
    try:
        return call is not None and not os.stat(call)
    except FileNotFoundError:
        return True
    except OSError:
        return False


def _is_in_use(error):
    return isinstance(error, InputError) and "is being written by" in str(error)


def _called(job, call):
    """The job, in a worker. A run whose worker was killed may still leave its checkpoint: its folder is waited for."""
    if has_been_interrupted(call):
        raise Interrupted(f"{call}: is not seen on {socket.gethostname()}: the call that the job belongs to was interrupted, or the folder is not shared")
    context, end = at_work.set(call), time.monotonic() + PATIENCE_S
    try:
        while True:
            try:
                return job()
            except InputError as error:
                if not _is_in_use(error) or time.monotonic() > end or has_been_interrupted(call):
                    raise
                time.sleep(0.5)
    except KeyboardInterrupt as error:  # would end the worker
        raise Interrupted(str(error) or "interrupted") from None
    finally:
        at_work.reset(context)


@contextlib.contextmanager
def _call_in(folder):
    """The file that says to all workers that the call goes on."""
    file = pathlib.Path(os.path.abspath(folder)) / f".drumlin-{os.getpid()}-{secrets.token_hex(8)}{AT_WORK}"
    file.parent.mkdir(parents=True, exist_ok=True)
    try:
        file.write_text(f"process {os.getpid()} on {socket.gethostname()}\n", encoding="utf-8")
    except OSError as error:
        raise IoError(f"{file}: cannot be written: {error.strerror}") from error
    try:
        yield file
    finally:
        file.unlink(missing_ok=True)


def processors_at_hand():
    """How many processors this process may use."""
    return len(os.sched_getaffinity(0))


@contextlib.contextmanager
def workers_of(executor):
    """The executor itself, or one that a text names, which is ended: "local" or "local:2" (so many threads, each of which waits for a run), "dask:ADDRESS".
    None: local."""
    if hasattr(executor, "submit"):
        yield executor
        return
    kind, _, of = str(executor or "local").partition(":")
    if kind == "local" and (not of or (of.isascii() and of.isdigit() and int(of) >= 1)):
        pool = concurrent.futures.ThreadPoolExecutor(int(of or processors_at_hand()))
        try:
            yield pool
        finally:
            pool.shutdown(wait=False, cancel_futures=True)
    elif kind == "dask" and of:
        with _dask_client(of) as client:
            yield client
    else:
        raise InputError(f"executor: '{executor}' is none (allowed: local, local:N, dask:ADDRESS, or an object with submit)")


def _dask_client(address):
    try:
        from distributed import Client  # pylint: disable=import-outside-toplevel  # of those who have a cluster
    except ModuleNotFoundError as error:
        raise InputError(f"executor dask:{address}: dask is not installed (Debian: python3-distributed)") from error
    try:
        return Client(address)
    except (OSError, ValueError) as error:
        raise IoError(f"executor dask:{address}: no scheduler answers: {error}") from error


def _anew(pool):
    """The like of a pool of processes that broke, which has no public copy; None of any other executor."""
    if not isinstance(pool, concurrent.futures.ProcessPoolExecutor):
        return None
    return concurrent.futures.ProcessPoolExecutor(pool._max_workers, pool._mp_context, pool._initializer, pool._initargs)  # pylint: disable=protected-access


class _Work:
    """Jobs on an executor. What was lost with its worker is submitted once more: dask does so itself, a broken pool is made anew once."""

    def __init__(self, jobs, call, executor):
        self.jobs, self.call = jobs, call
        self.executor, self.anew = executor, contextlib.ExitStack()  # pools in place of broken ones, to be ended
        self.at_work, self.told, self.lost = {}, queue.SimpleQueue(), collections.Counter()

    def submit(self, number):
        try:
            future = self.executor.submit(_called, self.jobs[number], str(self.call))
        except concurrent.futures.BrokenExecutor as error:
            future = concurrent.futures.Future()
            future.set_exception(error)
        self.at_work[number] = future
        future.add_done_callback(functools.partial(self._tell, number, self.executor))

    def _tell(self, number, executor, future):
        self.told.put((number, future, executor))

    def _lost_with_the_pool(self, number, executor):
        """Whether it is at work again."""
        if executor is self.executor:
            anew = _anew(executor) if not self.lost["pool"] else None
            self.lost["pool"] += 1
            if anew is None:
                return False
            self.executor = self.anew.enter_context(anew)
        self.submit(number)
        return True

    def next_end(self):
        """(number, Outcome) of a job that has ended for good; waits for it."""
        while True:
            number, future, executor = self.told.get()
            self.at_work.pop(number, None)
            try:
                value = future.result()
                return number, Outcome(arrived(value) if isinstance(value, Folder) else value)
            except concurrent.futures.BrokenExecutor as error:
                if not self._lost_with_the_pool(number, executor):
                    return number, Outcome(error=error)
            except Killed as error:
                self.lost[number] += 1
                if self.lost[number] > 1 or has_been_interrupted(self.call):
                    return number, Outcome(error=error)
                self.submit(number)
            except Exception as error:  # pylint: disable=broad-except  # whatever a job raises, the others go on
                return number, Outcome(error=error)

    def interrupt(self):
        """Tells the jobs to end, and waits until they have left their checkpoints."""
        self.call.unlink(missing_ok=True)
        for future in list(self.at_work.values()):
            if isinstance(future, concurrent.futures.Future):  # dask forgets what it cancels, at work or not; what waits there ends as it begins
                future.cancel()
        end = time.monotonic() + PATIENCE_S
        while self.at_work and time.monotonic() < end:
            with contextlib.suppress(queue.Empty):
                self.at_work.pop(self.told.get(timeout=1)[0], None)


def arrived(folder):
    """A Folder of results once its manifest and what that lists is there: a shared file system may show files later than their worker."""
    end = time.monotonic() + PATIENCE_S
    while not folder.is_complete():
        if time.monotonic() > end:
            raise IoError(f"{folder.path}: its manifest has not come, or does not list what is there, {PATIENCE_S} s after the run has ended")
        time.sleep(0.2)
    return folder


def run_all(jobs, folder, executor=None, progress: bool | None = None, ended=None) -> list[Outcome]:
    """Calls all jobs on the workers of an executor; what became of each, in their order. One that fails does not keep the others from their end.

    jobs: functions without arguments that pickle can write, as functools.partial(drumlin.run, scene, folder, resume=True). Called again they are to go
    on: one that is lost with its worker is called once more elsewhere, and Ctrl-C ends all that they have started through this package, each run with a
    checkpoint. folder: any that all workers see; a hidden file there says that the call goes on. executor: concurrent.futures, dask.distributed.Client,
    mpi4py.futures, or "local:2" (so many at once, here), "dask:ADDRESS"; None: one for each processor here. ended(number, outcome) is called here as each
    ends. A Folder that a job returns is waited for until its manifest is seen here.

    >>> drumlin.run_all([functools.partial(drumlin.run, "drum-smoke", f"JOBS/{seed}", {"seed": seed}, resume=True) for seed in (1, 2)], "JOBS")
    """
    jobs = list(jobs)
    outcomes = [Outcome()] * len(jobs)
    with workers_of(executor) as workers, _call_in(folder) as call, Progress("jobs", len(jobs), progress, folder) as bar:
        work = _Work(jobs, call, workers)
        with work.anew:
            try:
                for number in range(len(jobs)):
                    work.submit(number)
                for count in range(len(jobs)):
                    number, outcome = work.next_end()
                    outcomes[number] = outcome
                    bar.to(count + 1)
                    if ended is not None:
                        ended(number, outcome)
            except BaseException:
                work.interrupt()
                raise
    return outcomes
