"""Compares `drumlin solve-contacts` with Siconos' Gauss-Seidel for planar friction on the same files.

usage: siconos.py BUILD RESULT.json REPEATS PROBLEM.h5=RESIDUAL ...

For each problem both start from no impulses and meet the residual (docs/conventions.md), which our code evaluates for
both. The least number of Siconos' sweeps that meets it is found first (to 5 %); then both programs run in turn, and the
processor time of the whole process counts, reading of the file included. Siconos does not pay for tests of its residual.
SICONOS_VERSION of the environment goes into the record.
"""
import json
import os
import statistics
import subprocess
import sys

MOST_SWEEPS = 20_000  # a residual that takes Siconos more counts as missed, and its time as a lower bound


def run(command):
    """(what a command prints as JSON, processor seconds of the process)"""
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    printed = process.stdout.read()
    _, status, used = os.wait4(process.pid, 0)
    if os.waitstatus_to_exitcode(status) != 0:
        sys.exit(f"{' '.join(command)} failed: {printed}")
    return json.loads(printed), used.ru_utime + used.ru_stime


def range_of(values):
    return {"median": statistics.median(values), "least": min(values), "largest": max(values)}


def in_turn(ours, other, repeats):
    """What both print and how long both take; `speed` is the ratio of the two, run by run."""
    runs = [(run(ours), run(other)) for _ in range(repeats)]
    (our_report, _), (other_report, _) = runs[-1]
    return our_report, other_report, {
        "speed_against_siconos": range_of([b / a for (_, a), (_, b) in runs]),
        "drumlin_process_seconds": range_of([a for (_, a), _ in runs]),
        "siconos_process_seconds": range_of([b for _, (_, b) in runs]),
        "drumlin_solve_wall_seconds": range_of([a["seconds"] for (a, _), _ in runs]),
        "siconos_solve_seconds": range_of([b["processor_seconds"] for _, (b, _) in runs]),
    }


def compare(build, problem, residual, repeats):
    other = [f"{build}/benchmark_siconos", problem]
    ours = [f"{build}/drumlin", "solve-contacts", problem, "--tolerance", residual, "--json"]
    sweeps, _ = run([*other, str(MOST_SWEEPS), residual])
    missed = sweeps["residual"] > float(residual)
    our_report, other_report, seconds = in_turn(ours, [*other, str(sweeps["iterations"])], 1 if missed else repeats)
    if not missed and other_report["residual"] > float(residual):
        sys.exit(f"{problem}: Siconos leaves {other_report['residual']} in one call, {sweeps['residual']} in parts")
    return {
        "problem": os.path.basename(problem), "contacts": our_report["contacts"], "residual": float(residual),
        "siconos_met_it": not missed,
        "drumlin_sweeps": our_report["sweeps"], "drumlin_residual": our_report["residual"],
        "siconos_sweeps": other_report["iterations"], "siconos_residual": other_report["residual"],
        **seconds,
    }, other_report["provenance"]


def main():
    if len(sys.argv) < 5:
        sys.exit(__doc__)
    build, result, repeats = sys.argv[1], sys.argv[2], int(sys.argv[3])
    content = {"format": "drumlin-siconos-1", "siconos": os.environ.get("SICONOS_VERSION", ""), "repeats": repeats,
               "threads": 1, "load_before": os.getloadavg()[0], "cases": []}
    for word in sys.argv[4:]:
        problem, residual = word.rsplit("=", 1)
        case, content["provenance"] = compare(build, problem, residual, repeats)
        content["cases"].append(case)
        content["load_after"] = os.getloadavg()[0]
        with open(result, "w") as file:
            json.dump(content, file, indent=2)
            file.write("\n")


main()
