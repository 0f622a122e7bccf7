"""What `drumlin export --to FORMAT` starts: one folder of files of another program from snapshots. Prints a line of JSON after each.

usage: command.py FORMAT OUTPUT SNAPSHOT...
"""

import json
import pathlib
import sys

from drumlin.exporting.gsd_trajectory import GsdTrajectory
from drumlin.exporting.instant import instant_of
from drumlin.exporting.texts import ExtendedXyz, LammpsDump
from drumlin.exporting.vtkhdf_series import VtkhdfSeries

WRITERS = {"lammps": LammpsDump, "xyz": ExtendedXyz, "gsd": GsdTrajectory, "vtkhdf": VtkhdfSeries}


def main(kind, output, *snapshots):
    sys.stdout.reconfigure(encoding="utf-8", errors="surrogateescape")
    writer = WRITERS[kind](pathlib.Path(output))
    for number, path in enumerate(snapshots, 1):
        writer.add(instant_of(path))
        print(json.dumps({"done": number, "of": len(snapshots)}), flush=True)
    writer.close()


if __name__ == "__main__":
    main(*sys.argv[1:])
