"""Memory of `drumlin measure` over the number of discs and of snapshots.

usage: python3 tests/benchmarks/measure_memory.py BUILD RECORD.json [--keep FOLDER] [DISCSxSNAPSHOTS...]   (7183x10 7183x24 7183x200 100000x10 100000x24 unless told)

Each drum starts from deposited discs, lies for 4 steps of 1e-3 s, and then turns, so slowly that it hardly moves, with a snapshot after each step: what a
measurement holds depends on how many discs and snapshots there are and where they lie, not on how they flow. `--keep`: folder in which the runs stay; what is
there already is measured as it is. Told are the size of a snapshot as a file and as the arrays that a program holds of it, and the peak of `measure` with all
its parts and its figures, as the system counts it.
"""

import argparse
import os
import pathlib
import re
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "apps/figures"))
import result_files  # noqa: E402
from drums import drum, rotation, solved_to, stage  # noqa: E402
from million import taken  # noqa: E402
from records import called, content_of, machine, write  # noqa: E402

CASES = ("7183x10", "7183x24", "7183x200", "100000x10", "100000x24")
CONTACT = 32  # bytes of one in memory


def scene(discs, snapshots):
    start, solver = drum(discs)
    start = re.sub(r'(region = .*"circle".*)', r'\1\nplacement = "deposited"', start)
    stages = stage("settle", "duration_s = 0.004", snapshots=0) + stage("turn", f"duration_s = {snapshots / 1000}", rotation("0.002"), snapshots=snapshots)
    return start + stages + solved_to("0.3", solver) + "\n[output]\nvelocity_window_s = 1e-3\n"


def size_of_snapshot(file):
    """As a file and in memory, MB."""
    _, arrays = result_files.read_arrays(file)
    held = sum(array.nbytes for name, array in arrays.items() if name.startswith("grains/")) + CONTACT * len(arrays["contacts/i"])
    return file.stat().st_size / 2 ** 20, held / 2 ** 20


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("record", type=pathlib.Path)
    parser.add_argument("cases", nargs="*", default=list(CASES))
    parser.add_argument("--threads", type=int, default=os.cpu_count())
    parser.add_argument("--keep", type=pathlib.Path)
    given = parser.parse_intermixed_args()
    program, cases = given.build.resolve() / "drumlin", []
    with tempfile.TemporaryDirectory() as name:
        folder = given.keep or pathlib.Path(name)
        folder.mkdir(parents=True, exist_ok=True)
        for case in given.cases:
            discs, snapshots = (int(number) for number in case.split("x"))
            file, run = folder / f"{case}.toml", folder / case
            if not (run / "run.json").exists():
                file.write_text(scene(discs, snapshots), encoding="utf-8")
                called(program, "run", file, "-o", run, "--threads", given.threads)
            last = sorted((run / "snapshots").glob("*.h5"))[-1]
            on_disk, held = size_of_snapshot(last)
            found = {"discs": discs, "snapshots": snapshots, "snapshot_file_mb": on_disk, "snapshot_mb": held,
                     "measure": taken([program, "measure", run, "--overwrite"])}
            found["in_snapshots"] = found["measure"]["peak_memory_mb"] / held
            print(f"{case}: {found['measure']['peak_memory_mb']:.0f} MB, a snapshot {held:.1f} MB", flush=True)
            cases.append(found)
            measured = content_of(run / "measured/measured.json")
    whole = {"format": "drumlin-measure-memory-1", "revision": measured["provenance"]["measurement"]["revision"],
             "command": "python3 tests/benchmarks/measure_memory.py BUILD RECORD.json", **machine(), "cases": cases}
    write(given.record, whole)


if __name__ == "__main__":
    main()
