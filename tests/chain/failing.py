"""Calls of a run to the system fail, one in each trial: the run says so and ends cleanly, and --resume goes on to the same bytes.

usage: failing.py DRUMLIN FAILING_CALLS_LIBRARY FOLDER_OF_THIS_TEST [--calls COUNT] [--allocations COUNT] [--from NUMBER] [--to NUMBER] [--show]
  --calls COUNT        about how many calls of each kind that files are written with are tried, spread evenly (default: 0, all)
  --allocations COUNT  about how many of the run's tens of thousands of allocations are tried, spread evenly (default: 60); 0: all
  --from NUMBER, --to NUMBER
                       nothing but the allocations from one number to another, each of them: to share them, or to go on
  --show               lists every failure that was tried with what the run said
"""

import argparse
import os
import pathlib
import shutil
import signal
import subprocess
import tempfile

from command import bytes_below, has_address_sanitizer, require, require_whole_files, results_of_run

# 40 discs, 60 steps: a run of a twentieth of a second with all its kinds of files.
SMALL = ["--set", "grains.generated.count=40", "--set", "grains.generated.diameter_min_mm=9", "--set", "grains.generated.diameter_max_mm=10",
         "--set", "stages.0.duration_s=0.02", "--set", "stages.1.turns=0.005", "--set", "stages.2.turns=0.005", "--set", "stages.2.snapshots=2",
         "--set", "output.checkpoint_every_s=0.03", "--set", "output.energy_ledger=true", "--set", "output.velocity_window_s=2e-3"]
FILE_CALLS = ("open", "write", "fsync", "rename", "close")
# HDF5 1.10 reads and frees what it did not get; the run must then go on to the same bytes all the same.
CRASHES_OF_HDF5 = (-signal.SIGSEGV, -signal.SIGABRT)
# The TOML library takes a number that it has no memory to read for one that is none; the message names it.
MISTAKEN = (2,)
PATIENCE = 1200  # seconds for what takes a tenth of one


def place_of_hdf5(executable):
    """Where a program holds HDF5 within itself: FIRST:LAST, hexadecimal; None if it loads it. Its functions stand side by side."""
    listed = subprocess.run(["nm", "--numeric-sort", "--defined-only", executable], capture_output=True, text=True, check=True).stdout
    functions = [line.split() for line in listed.splitlines()]
    places = [address for address, kind, name in functions if kind in "tT" and name.startswith("H5") and not name.endswith(".cold")]
    return f"{places[0]}:{places[-1]}" if places else None


def counted(file):
    """{kind: calls} as the library wrote them."""
    lines = (line.split() for line in file.read_text(encoding="utf-8").splitlines())
    return {kind: int(count) for kind, count in lines}


class Trials:
    """One small run, repeated with one failure after the other."""

    def __init__(self, given, work):
        self.executable, self.words = str(given.executable.resolve()), [given.tests / "tiny-drum.toml", *SMALL]
        self.library, self.show, self.run = str(given.library.resolve()), given.show, work / "run"
        place = place_of_hdf5(given.executable)
        self.environment = os.environ | {"LD_PRELOAD": self.library} | ({"FAILING_HDF5": place} if place else {})
        whole, counts = work / "whole", work / "counts"
        code, said = self.started(whole, FAILING_COUNTS_TO=str(counts))
        require(code == 0, f"nothing fails: exit code {code}\n{said}")
        self.expected = results_of_run(whole)
        self.calls = counted(counts)
        require(all(self.calls.values()), f"not every kind of call was seen: {self.calls}")

    def started(self, run, *words, scene=None, **failing):
        """Exit code of the run and what it said but for its progress. `scene`: another than the small one."""
        environment, of = self.environment | failing if failing else os.environ, [scene] if scene else self.words
        result = subprocess.run([self.executable, "run", *of, "-o", run, *words], capture_output=True, text=True, check=False, timeout=PATIENCE, env=environment)
        lines = (result.stdout + result.stderr).splitlines()
        return result.returncode, "\n".join(line for line in lines if not line.startswith("reduced run"))

    def fail(self, kind, number, count=1, crashes=()):
        """One failure, or `count` from there on; True if it ended the run. `crashes`: exit codes that a library is to blame for."""
        run, what = self.run, f"{kind} {number} of {self.calls[kind]}" + (" and all after it" if count > 1 else "")
        shutil.rmtree(run, ignore_errors=True)
        code, said = self.started(run, FAILING_CALL=kind, FAILING_FROM=str(number), FAILING_COUNT=str(count))
        if self.show:
            print(f"{what}: {code} {said.splitlines()[-1:] if code else ''}", flush=True)
        require(code in (0, 74, *crashes), f"{what}: exit code {code}\n{said}")
        require(code not in (2, 74) or said, f"{what}: ended with {code} and without a word")
        if run.exists() and code not in crashes:
            require_whole_files(run)
        if code == 0:
            require(results_of_run(run) == self.expected, f"{what}: ended well with other bytes")
        again, said_again = self.started(run, "--resume")
        require(again == 0, f"{what}: {said}\nresumed: exit code {again}\n{said_again}")
        require(results_of_run(run) == self.expected, f"{what}: {said}\nthe resumed run left other bytes than the whole one")
        require_whole_files(run)
        require(not [file for file in bytes_below(run) if file.startswith(".")], f"{what}: files are left")
        return code != 0

    def fail_extended(self, kind):
        """The calls of one kind, one after the other, of a run that is prolonged: what is left goes on to the same bytes."""
        finished, longer, run = self.run.with_name("finished"), self.run.with_name("longer"), self.run.with_name("extended")
        require(self.started(finished)[0] == 0, "a run to prolong")

        def extended(folder, *words, **failing):
            return self.started(folder, *words, scene=folder / "scene.toml", **failing)

        counts = self.run.with_name("counts-extended")
        shutil.copytree(finished, longer)
        code, said = extended(longer, "--extend", "0.01", FAILING_COUNTS_TO=str(counts))
        require(code == 0, f"nothing fails: exit code {code}\n{said}")
        expected = results_of_run(longer)
        calls = counted(counts)[kind]
        for number in range(1, calls + 1):
            what = f"--extend, {kind} {number} of {calls}"
            shutil.rmtree(run, ignore_errors=True)
            shutil.copytree(finished, run)
            code, said = extended(run, "--extend", "0.01", FAILING_CALL=kind, FAILING_FROM=str(number), FAILING_COUNT="1")
            require(code in (0, 74), f"{what}: exit code {code}\n{said}")
            again, said_again = extended(run, "--resume")
            require(again == 0, f"{what}: {said}\nresumed: exit code {again}\n{said_again}")
            if results_of_run(run) != expected:
                again, said_again = extended(run, "--extend", "0.01")
                require(again == 0, f"{what}: {said}\nprolonged again: exit code {again}\n{said_again}")
            require(results_of_run(run) == expected, f"{what}: {said}\nthe run left other bytes than one that was prolonged at once")
            require_whole_files(run)
        print(f"--extend, {kind}: {calls} failures tried", flush=True)

    def fail_each(self, kind, wanted, crashes=()):
        """About so many of the calls of this kind, spread evenly; all of them where 0 is wanted."""
        self.fail_numbers(kind, range(1, self.calls[kind] + 1, max(1, self.calls[kind] // wanted) if wanted else 1), crashes)

    def fail_numbers(self, kind, numbers, crashes):
        """One failure after the other; says every 500 how far it is."""
        ended = 0
        for trial, number in enumerate(numbers, 1):
            ended += self.fail(kind, number, crashes=crashes)
            if trial % 500 == 0:
                print(f"{kind}: {number} of {self.calls[kind]}, {ended} of {trial} ended the run", flush=True)
        print(f"{kind}: {len(numbers)} failures of {self.calls[kind]} calls tried, {ended} ended the run", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("executable", type=pathlib.Path)
    parser.add_argument("library", type=pathlib.Path)
    parser.add_argument("tests", type=pathlib.Path)
    parser.add_argument("--calls", type=int, default=0)
    parser.add_argument("--allocations", type=int, default=60)
    parser.add_argument("--from", type=int, dest="first")
    parser.add_argument("--to", type=int, default=1 << 40, dest="last")
    parser.add_argument("--show", action="store_true")
    given = parser.parse_args()
    if has_address_sanitizer(given.executable):
        print("the address sanitizer keeps these calls to itself: nothing tried")
        return
    with tempfile.TemporaryDirectory(prefix="drumlin-failing-") as name:
        trials = Trials(given, pathlib.Path(name))
        calls = trials.calls
        if given.first is not None:
            trials.fail_numbers("malloc", range(given.first, min(given.last, calls["malloc"]) + 1), MISTAKEN)
            return
        for kind in FILE_CALLS:
            trials.fail_each(kind, given.calls)
        trials.fail_extended("rename")
        for kind, crashes in (("malloc", MISTAKEN), ("malloc-in-hdf5", CRASHES_OF_HDF5)):
            trials.fail_each(kind, given.allocations, crashes)
        # Memory that stays short: what tells of it and cleans up needs none.
        for number in range(1, calls["malloc"], calls["malloc"] // min(10, given.allocations or 10)):
            trials.fail("malloc", number, count=1 << 40, crashes=MISTAKEN)


if __name__ == "__main__":
    main()
