"""What a flow costs on finer and finer meshes, on 1 and 2 ranks: the 6 rpm drum, cold.

usage: python3 tests/benchmarks/flow_ranks.py BUILD RECORD.json [CASE...]   (CASE: LEVELS:SURFACE_CELL:RANKS)

Each mesh halves the cells of the last one, from cells of 2 d. Without CASE: 2 to 4 meshes, 1 and 2 ranks. A case that stands in RECORD.json
already is kept, so that the largest ones can be added by themselves. Processor seconds are those of each whole process; wall seconds mean something on an
idle machine only: the load stands beside them.
"""

import os
import pathlib
import sys
import tempfile

from records import called, content_of, machine, write

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCALARS = ("theta_deg", "H", "lambda")


def solved(build, levels, cell, ranks):
    os.environ |= {"OMP_NUM_THREADS": "1", "OMPI_MCA_mpi_yield_when_idle": str(int(ranks > (os.cpu_count() or 1)))}  # else a rank that waits gives its processor to others
    keys = {"mesh.levels": levels, "mesh.surface_cell": cell, "solver.sensitivity": "false", "output.figures": "false"}
    with tempfile.TemporaryDirectory() as name:
        words = ["mpirun", "-n", ranks, build / "drumlin-flow", ROOT / "data/scenes/drum-6rpm-flow.toml", "--rheology", ROOT / "data/rheology/drum-6rpm.toml", "-o", f"{name}/flow"]
        for key, value in keys.items():
            words += ["--set", f"{key}={value}"]
        load = os.getloadavg()[0]
        called(*words)
        flow = content_of(pathlib.Path(f"{name}/flow/flow.json"))
        table = [line.split(",") for line in pathlib.Path(f"{name}/flow/iterations.csv").read_text(encoding="utf-8").splitlines() if not line.startswith("#")]
    last = [row for row in table[1:] if int(row[0]) == levels - 1]
    return {
        "revision": flow["provenance"].get("revision"),
        "unknowns": flow["unknowns"],
        "newton_iterations": flow["iterations"],
        "newton_iterations_last_mesh": len(last),
        "largest_linear_residual": max(float(row[7]) for row in table[1:]),
        "residual": flow["residual"],
        "wall_seconds": flow["seconds"],
        "load": [load, os.getloadavg()[0]],
        "rank_costs": flow["rank_costs"],
        "phases": flow["phases"],
        **{name: flow[name] for name in SCALARS},
    }


def main():
    build, record = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2])
    cases = sys.argv[3:] or [f"{levels}:{2 / 2 ** (levels - 1):g}:{ranks}" for levels in (2, 3, 4) for ranks in (1, 2)]
    content = content_of(record) if record.exists() else {"format": "drumlin-flow-ranks-1", "command": "python3 tests/benchmarks/flow_ranks.py build RECORD.json", "cases": {}}
    for case in cases:
        if case in content["cases"]:
            continue
        levels, cell, ranks = case.split(":")
        content["cases"][case] = found = solved(build, int(levels), float(cell), int(ranks)) | machine()
        write(record, content)
        print(case, found["unknowns"], found["newton_iterations"], found["rank_costs"], f"{found['wall_seconds']:.1f} s", flush=True)


if __name__ == "__main__":
    main()
