"""A small drum gives the numbers it has always given, with one thread and with two: a hash of its snapshots and its log.

usage: golden.py DRUMLIN FOLDER_OF_THIS_TEST

A change of physics or solver that is meant renews GOLDEN: take over the hash that this test then prints, and say in the commit why it changed.
"""

import hashlib
import pathlib
import sys
import tempfile

from command import SHORT_RUN, Drumlin, require
from result_hashes import content_of

GOLDEN = "9264eecf69c18e5ad1e33b9b1701b983f65381a9e12698b137ce5ad7d60435d1"


def hash_of(run):
    """Of the names and numbers of all snapshots and of the log, whatever way HDF5 stores them; none of them holds a time of day."""
    total = hashlib.sha256()
    for file in [run / "log.csv", *sorted((run / "snapshots").iterdir())]:
        total.update(f"{file.name} {hashlib.sha256(content_of(file, {}, lambda name: False)).hexdigest()}\n".encode())
    return total.hexdigest()


def main():
    drumlin, scene = Drumlin(sys.argv[1]), pathlib.Path(sys.argv[2]) / "tiny-drum.toml"
    with tempfile.TemporaryDirectory(prefix="drumlin-golden-") as name:
        for threads in (1, 2):
            run = pathlib.Path(name) / str(threads)
            drumlin("run", scene, "-o", run, *SHORT_RUN, "--threads", threads)
            found = hash_of(run)
            require(found == GOLDEN, f"{threads} threads: the hash is\n{found}, not\n{GOLDEN}")
    print(f"the golden hash, {GOLDEN[:16]}, with one thread and with two")


if __name__ == "__main__":
    main()
