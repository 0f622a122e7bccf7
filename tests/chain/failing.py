"""Calls of a run to the system fail, one in each trial: the run says so and ends cleanly, and --resume goes on to the same bytes.

usage: failing.py DRUMLIN FAILING_CALLS_LIBRARY FOLDER_OF_THIS_TEST [--calls COUNT] [--show]
  --calls COUNT  about how many calls of each kind that files are written with are tried, spread evenly (default: 0, all)
  --show         lists every failure that was tried with what the run said
"""

import argparse
import os
import pathlib
import shutil
import subprocess
import tempfile

from command import bytes_below, has_address_sanitizer, require, require_whole_files, results_of_run

# 40 discs, 60 steps: a run of a twentieth of a second with all its kinds of files.
SMALL = ["--set", "grains.generated.count=40", "--set", "grains.generated.diameter_min_mm=9", "--set", "grains.generated.diameter_max_mm=10",
         "--set", "stages.0.duration_s=0.02", "--set", "stages.1.turns=0.005", "--set", "stages.2.turns=0.005", "--set", "stages.2.snapshots=2",
         "--set", "output.checkpoint_every_s=0.03", "--set", "output.energy_ledger=true", "--set", "output.velocity_window_s=2e-3"]
FILE_CALLS = ("open", "write", "fsync", "rename", "close")
PATIENCE = 1200  # seconds for what takes a tenth of one


def counted(file):
    """{kind: calls} as the library wrote them."""
    lines = (line.split() for line in file.read_text(encoding="utf-8").splitlines())
    return {kind: int(count) for kind, count in lines}


class Trials:
    """One small run, repeated with one failure after the other."""

    def __init__(self, given, work):
        self.executable, self.words = str(given.executable.resolve()), [given.tests / "tiny-drum.toml", *SMALL]
        self.library, self.show, self.run = str(given.library.resolve()), given.show, work / "run"
        self.environment = os.environ | {"LD_PRELOAD": self.library}
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

    def fail(self, kind, number):
        """One failure; True if it ended the run."""
        run, what = self.run, f"{kind} {number} of {self.calls[kind]}"
        shutil.rmtree(run, ignore_errors=True)
        code, said = self.started(run, FAILING_CALL=kind, FAILING_NUMBER=str(number))
        if self.show:
            print(f"{what}: {code} {said.splitlines()[-1:] if code else ''}", flush=True)
        require(code in (0, 74), f"{what}: exit code {code}\n{said}")
        require(code == 0 or said, f"{what}: ended with {code} and without a word")
        if run.exists():
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
            code, said = extended(run, "--extend", "0.01", FAILING_CALL=kind, FAILING_NUMBER=str(number))
            require(code in (0, 74), f"{what}: exit code {code}\n{said}")
            again, said_again = extended(run, "--resume")
            require(again == 0, f"{what}: {said}\nresumed: exit code {again}\n{said_again}")
            if results_of_run(run) != expected:
                again, said_again = extended(run, "--extend", "0.01")
                require(again == 0, f"{what}: {said}\nprolonged again: exit code {again}\n{said_again}")
            require(results_of_run(run) == expected, f"{what}: {said}\nthe run left other bytes than one that was prolonged at once")
            require_whole_files(run)
        print(f"--extend, {kind}: {calls} failures tried", flush=True)

    def fail_each(self, kind, wanted):
        """About so many of the calls of this kind, spread evenly; all of them where 0 is wanted."""
        numbers = range(1, self.calls[kind] + 1, max(1, self.calls[kind] // wanted) if wanted else 1)
        ended = sum(self.fail(kind, number) for number in numbers)
        print(f"{kind}: {len(numbers)} failures of {self.calls[kind]} calls tried, {ended} ended the run", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("executable", type=pathlib.Path)
    parser.add_argument("library", type=pathlib.Path)
    parser.add_argument("tests", type=pathlib.Path)
    parser.add_argument("--calls", type=int, default=0)
    parser.add_argument("--show", action="store_true")
    given = parser.parse_args()
    if has_address_sanitizer(given.executable):
        print("the address sanitizer keeps these calls to itself: nothing tried")
        return
    with tempfile.TemporaryDirectory(prefix="drumlin-failing-") as name:
        trials = Trials(given, pathlib.Path(name))
        for kind in FILE_CALLS:
            trials.fail_each(kind, given.calls)
        trials.fail_extended("rename")


if __name__ == "__main__":
    main()
