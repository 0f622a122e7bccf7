"""A small drum gives the numbers it has always given, with one thread and with two, and as on older processors: a hash of its snapshots and its log.

usage: golden.py DRUMLIN OLDER_PROCESSOR_LIBRARY FOLDER_OF_THIS_TEST

A change of physics or solver that is meant renews GOLDEN: take over the hash that this test then prints, and say in the commit why it changed.
"""

import argparse
import hashlib
import os
import pathlib
import shutil
import subprocess
import tempfile

from command import SHORT_RUN, has_address_sanitizer, require
from result_hashes import content_of

GOLDEN = "79145cd9c542b2f133b58a3003f7c935c93d15ad09488d3221d2dc47ee00264f"
# As Highway names them; those that the processor lacks are left out.
KERNELS = ("AVX3", "AVX2", "SSE4", "SSSE3", "SCALAR")


def hash_of(run):
    """Of the names and numbers of all snapshots and of the log, whatever way HDF5 stores them; none of them holds a time of day."""
    total = hashlib.sha256()
    for file in [run / "log.csv", *sorted((run / "snapshots").iterdir())]:
        total.update(f"{file.name} {hashlib.sha256(content_of(file, {}, lambda name: False)).hexdigest()}\n".encode())
    return total.hexdigest()


def drum(work, given, threads, environment):
    """Hash of the drum, as it runs in this environment."""
    run = work / "run"
    words = [given.executable, "run", given.tests / "tiny-drum.toml", "-o", run, *SHORT_RUN, "--threads", threads]
    result = subprocess.run([str(word) for word in words], capture_output=True, text=True, timeout=3000, check=False, env=os.environ | environment)
    require(result.returncode == 0, f"exit code {result.returncode}\n{result.stdout}{result.stderr}")
    found = hash_of(run)
    shutil.rmtree(run)
    return found


def main():
    parser = argparse.ArgumentParser()
    for name in ("executable", "library", "tests"):
        parser.add_argument(name, type=pathlib.Path)
    given = parser.parse_args()
    library = str(given.library.resolve())
    ways = {f"{threads} threads": (threads, {}) for threads in (1, 2)}
    # Functions of the C library round alike without fused multiply-add.
    ways["a C library without AVX2 and FMA"] = (1, {"GLIBC_TUNABLES": "glibc.cpu.hwcaps=-AVX2,-FMA,-FMA4,-AVX512F"})
    with tempfile.TemporaryDirectory(prefix="drumlin-golden-") as name:
        work = pathlib.Path(name)
        kernels = () if has_address_sanitizer(given.executable) else KERNELS
        for kernel in kernels:
            ways[f"{kernel} kernels"] = (1, {"LD_PRELOAD": library, "OLDER_PROCESSOR": kernel, "OLDER_PROCESSOR_TELLS": str(work / kernel)})
        for way, (threads, environment) in ways.items():
            found = drum(work, given, threads, environment)
            require(found == GOLDEN, f"{way}: the hash is\n{found}, not\n{GOLDEN}")
        used = [kernel for kernel in kernels if (work / kernel).exists()]
    require(not kernels or "SCALAR" in used, "no kernels of an older processor were used")
    print(f"the golden hash, {GOLDEN[:16]}, with one thread and with two, without AVX2 and FMA in the C library, with the kernels of {', '.join(used)}")


if __name__ == "__main__":
    main()
