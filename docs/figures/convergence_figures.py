"""What tolerance and time step change in the measured numbers, and what they cost: a table.

usage: convergence_figures.py STANDARD CONVERGENCE OUTPUT
STANDARD and CONVERGENCE are the folders that apps/paper_runs left, without and with --convergence; OUTPUT takes
convergence.md and convergence.json.
"""

import json
import math
import pathlib
import re
import sys
import tomllib

import scipy.special

import script
import whole_file

SCALARS = {"theta_com_deg": 2, "H": 1, "shear_rate": 4, "lambda": 1, "I_th": 4, "dv_over_shear": 2, "domega_over_shear": 2, "mu_b": 4, "dv_exponent": 3,
           "overlap_mean": 7}  # digits after the point


def runs_of(standard, convergence):
    """{setting: [(run.json, measured.json, folder), ...]}, the standard first."""
    groups = {}
    for folder in sorted(standard.glob("6rpm-seed*")):
        groups.setdefault("tolerance-3e-3, the standard", []).append(folder)
    for folder in sorted(convergence.glob("6rpm-*-seed*")):
        groups.setdefault(re.sub(r"^6rpm-|-seed\d+$", "", folder.name), []).append(folder)
    return {name: [(script.content_of(folder / "run.json"), script.content_of(folder / "measured" / "measured.json"), folder) for folder in folders
                   if (folder / "measured" / "measured.json").exists()] for name, folders in groups.items()}


def entries_of(runs, scalar):
    return [measured[scalar] for _, measured, _ in runs if measured[scalar]["value"] is not None]


def seed_spread(groups, scalar):
    """Student's t times the standard deviation between seeds, one for all settings: that of one setting has two degrees
    of freedom at most (t = 9.9), those of all settings together have more. 0 where no setting has two seeds."""
    squares, freedom = 0, 0
    for runs in groups.values():
        values = [entry["value"] for entry in entries_of(runs, scalar)]
        mean = sum(values) / max(len(values), 1)
        squares += sum((value - mean) ** 2 for value in values)
        freedom += max(len(values) - 1, 0)
    # Beyond ten degrees of freedom that of ten, which is wider.
    return scipy.special.stdtrit(min(freedom, 10), 0.995) * math.sqrt(squares / freedom) if freedom > 0 else 0


def pooled(groups, runs, scalar):
    """Mean over the seeds; half width from the runs' own 99 % intervals, or from the spread between seeds where that is
    larger. One seed keeps its own interval."""
    entries = entries_of(runs, scalar)
    n = len(entries)
    if n == 0:
        return math.nan, math.nan
    mean = sum(entry["value"] for entry in entries) / n
    own = math.sqrt(sum(entry["ci99"] ** 2 for entry in entries)) / n
    return mean, own if n < 2 else max(own, seed_spread(groups, scalar) / math.sqrt(n))


def steps(runs):
    """Mean CPU seconds and sweeps a step."""
    cpu = sum(run["cpu_seconds"] for run, *_ in runs) / len(runs)
    sweeps = sum(run["cost"]["sweeps_mean"] for run, *_ in runs) / len(runs)
    return cpu, sweeps


def settings_of(runs):
    """What distinguishes the runs, as drumlin measure looks for it (apps/commands/accuracy_statement.hpp)."""
    scene = tomllib.loads((runs[0][2] / "scene.toml").read_text(encoding="utf-8"))
    result = {"solver": scene["solver"]["name"], "tolerance": scene["solver"]["tolerance"], "step_s": scene["stages"][-1]["time_step_s"],
              "missed_share": sum(run["unconverged_steps"] / run["steps"] for run, *_ in runs) / len(runs)}
    if scene["effects"]["friction"]["grain_grain"] != 0.4:
        result["another_scene"] = True
    return result


def table(groups):
    heads = ["setting", "seeds", "CPU s", "sweeps a step", "missed steps"] + list(SCALARS)
    lines = ["| " + " | ".join(heads) + " |", "|" + "---|" * len(heads)]
    for name, runs in groups.items():
        cpu, sweeps = steps(runs)
        missed = sum(run["unconverged_steps"] for run, *_ in runs) / len(runs)
        cells = [name, str(len(runs)), f"{cpu:.0f}", f"{sweeps:.0f}", f"{missed:.0f}"]
        for scalar, digits in SCALARS.items():
            mean, half = pooled(groups, runs, scalar)
            cells.append(f"{mean:.2e}" if scalar == "overlap_mean" else f"{mean:.{digits}f} +- {half:.{digits}f}")
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


def main():
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    standard, convergence, output = map(pathlib.Path, sys.argv[1:])
    groups = {name: runs for name, runs in runs_of(standard, convergence).items() if runs}
    text = table(groups)
    whole_file.write_text(output / "convergence.md", text)
    content = {"format": "drumlin-convergence-1", "settings": {
        name: {"seeds": len(runs), **settings_of(runs), "cpu_seconds": steps(runs)[0], "sweeps_mean": steps(runs)[1],
               **{scalar: dict(zip(("value", "ci99"), pooled(groups, runs, scalar))) for scalar in SCALARS}}
        for name, runs in groups.items()},
        "scene": (next(iter(groups.values()))[0][2] / "scene.toml").read_text(encoding="utf-8"),
        "machine": next(iter(groups.values()))[0][0]["provenance"].get("machine"),
        "revisions": sorted({run["revision"] for runs in groups.values() for run, *_ in runs})}
    whole_file.write_text(output / "convergence.json", json.dumps(content, indent=2) + "\n")
    print(text)


if __name__ == "__main__":
    main()
