"""The runs of the library of laws: `law_runs.py FOLDER [--executor local:2] [--first K]` runs what is missing of the design, in the order of its use.

Each run is data/scenes/plane-shear-cell.toml with other grains, shear rate, seed and accuracy; a finished run is skipped, so that a call goes on where
the last one ended. `measure_laws.py` measures the runs. PYTHONPATH holds the package.
"""
import argparse
import csv
import functools
import itertools
import json
import math
import os
import pathlib
import sys

import drumlin

SCENE = pathlib.Path(__file__).resolve().parents[2] / "data/scenes/plane-shear-cell.toml"
PRESSURE, DENSITY, DIAMETER = 270.0, 2700.0, 2e-3                       # of the scene: N/m2, kg/m3, m
INERTIAL_TIME = math.sqrt(DENSITY * math.pi / 4 * DIAMETER**2 / PRESSURE)   # sqrt(m/P), m the mass of the mean disc

AXIS = [0.4, 0.0, 0.2, 0.1, 1.0, 0.05, 0.3, 0.6]
DEFAULT = {"friction": 0.4, "restitution": 0.1, "sizes": "0.2", "rolling_resistance": 0.0}
OTHERS = [{"restitution": 0.5}, {"restitution": 0.9}, {"sizes": "0.05"}, {"sizes": "0.1"}, {"sizes": "0.5"}, {"sizes": "1:2"},
          {"rolling_resistance": 0.05}, {"rolling_resistance": 0.1}, {"rolling_resistance": 0.3}]

# I: (time step in s, strain to forget the start, strain that is measured, snapshots of both)
PLAN = {0.3: (1e-4, 6, 12, (60, 600)), 0.16: (1.5e-4, 5, 12, (60, 600)), 0.08: (3e-4, 3, 12, (60, 500)), 0.04: (5e-4, 3, 12, (60, 400)),
        0.02: (6e-4, 2, 8, (60, 300)), 0.01: (8e-4, 1.5, 6, (60, 300)), 0.003: (1e-3, 1.2, 5, (60, 300)), 0.001: (1e-3, 0.7, 3, (60, 240)),
        1e-4: (1e-3, 0.3, 1, (50, 200))}


def grains():
    """Every kind of grains of the design, the axis of friction first."""
    kinds = [dict(DEFAULT, friction=mu) for mu in AXIS]
    return kinds + [dict(DEFAULT, friction=mu, **change) for mu in (0.4, 0.2) for change in OTHERS]


def run(kind, inertial, seed=1, count=400, step_factor=1.0, tolerance_factor=1.0):
    return dict(kind, I=inertial, seed=seed, count=count, step_factor=step_factor, tolerance_factor=tolerance_factor)


def design():
    """All runs, the most useful first."""
    every = [i for i in PLAN if i >= 1e-3]
    cheap = [i for i in every if i >= 0.01]
    axis, others = grains()[:len(AXIS)], grains()[len(AXIS):]
    runs = [run(kind, i) for kind in axis for i in every] + [run(kind, i) for kind in others for i in cheap]
    runs += [run(kind, i) for i in every if i not in cheap for kind in others]
    checked = (dict(DEFAULT), 0.08), (dict(DEFAULT, friction=0.2), 0.01)
    checks = [run(kind, i, **change) for change in ({"count": 800}, {"step_factor": 0.5, "tolerance_factor": 0.5}) for kind, i in checked]
    slowest = [run(dict(DEFAULT, friction=mu), 1e-4) for mu in (0.4, 0.0)]
    of_seeds = {seed: [run(kind, i, seed) for i in cheap for kind in grains()] for seed in (2, 3)}
    costly = [run(kind, i, seed) for seed, i, kind in itertools.product((2, 3), every, grains()) if i not in cheap]
    again = [dict(one, seed=seed) for seed in (2, 3) for one in checks + slowest]
    return runs + checks + slowest + of_seeds[2] + of_seeds[3] + costly + again


MOST_SEEDS = 6


def further(table):
    """One more seed, MOST_SEEDS at most, of each point of the table whose interval of mu is above 3 %."""
    rows = csv.DictReader(line for line in table.read_text().splitlines() if not line.startswith("#"))
    wide = [row for row in rows if float(row["mu_ci99"]) > 0.03 * float(row["mu"]) and int(row["seeds"]) < MOST_SEEDS]
    return [run({"friction": float(row["friction"]), "restitution": float(row["restitution"]), "sizes": row["sizes"],
                 "rolling_resistance": float(row["rolling_resistance"])}, float(row["I_of_mass"]), int(row["seeds"]) + 1)
            for row in wide if row["half_accuracy"] == "0" and row["grains"] == "400"]


def present(folder, suffix=""):
    """The runs of the design, with further seeds, whose NAME + suffix the folder holds."""
    seeds = [dict(r, seed=seed) for r in design() if r["seed"] == 1 for seed in range(1, MOST_SEEDS + 1)]
    return [r for r in seeds if (folder / (name(r) + suffix)).exists()]


def name(r):
    text = f"mu{r['friction']:g}-e{r['restitution']:g}-s{r['sizes'].replace(':', 'to')}-r{r['rolling_resistance']:g}-I{r['I']:g}-seed{r['seed']}"
    return text + (f"-n{r['count']}" if r["count"] != 400 else "") + ("-fine" if r["step_factor"] != 1 else "")


def diameters(sizes):
    """Smallest and largest diameter in mm, and the distribution: all of the mean 2 mm."""
    if sizes == "1:2":
        return 5 / 3, 10 / 3, '{ kind = "two", small_share = 0.5, by = "mass" }'
    return 2 * (1 - float(sizes)), 2 * (1 + float(sizes)), None


def plan_of(inertial):
    """That of this I, or of the nearest."""
    return PLAN[min(PLAN, key=lambda i: abs(math.log(i / inertial)))]


def overrides(r):
    """Options of `drumlin run` that turn the scene into this run."""
    step, forget, strain, snapshots = plan_of(r["I"])
    rate = r["I"] / INERTIAL_TIME
    smallest, largest, distribution = diameters(r["sizes"])
    height = (62 if largest <= 2.5 else 100) * r["count"] / 400
    values = {"seed": r["seed"], "grains.generated.count": r["count"], "grains.generated.diameter_min_mm": smallest,
              "grains.generated.diameter_max_mm": largest, "periodic_z.z_max_mm": height, "grains.generated.region.max_mm": f"[40, {height}]",
              "effects.friction.grain_grain": r["friction"], "effects.restitution.grain_grain": r["restitution"],
              "solver.tolerance": 0.03 * r["tolerance_factor"], "solver.penetration_tolerance": 2e-3 * r["tolerance_factor"], "solver.check_every": 5,
              "output.velocity_window_s": step * r["step_factor"], "output.checkpoint_every_s": 1e9}
    for stage, length, written in ((1, forget, snapshots[0]), (2, strain, snapshots[1])):
        values |= {f"stages.{stage}.cell.shear_rate_per_s": repr(rate), f"stages.{stage}.duration_s": repr(length / rate),
                   f"stages.{stage}.time_step_s": step * r["step_factor"], f"stages.{stage}.snapshots": written}
    if r["I"] > 0.2:  # else the cell is thrown wide open, of elastic grains for long
        values |= {"stages.0.cell.shear_rate_per_s": repr(0.4 * rate), "stages.0.duration_s": 0.5, "stages.0.time_step_s": 1.5e-4}
    if distribution:
        values["grains.generated.sizes"] = distribution
    if r["rolling_resistance"]:
        values["effects.rolling_resistance"] = f"{{ grain_grain = {r['rolling_resistance']}, grain_wall = 0 }}"
    return [word for key, value in values.items() for word in ("--set", f"{key}={value}")]


def finished(folder):
    try:
        return json.loads((folder / "run.json").read_text())["status"] == "finished"
    except (OSError, ValueError, KeyError):
        return False


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--executor", help="as of drumlin.run_all")
    parser.add_argument("--first", type=int, help="only so many runs of the design")
    parser.add_argument("--further", type=pathlib.Path, metavar="LAWS.csv", help="in place of the design, one more seed of what is above 3 %% in that table")
    arguments = parser.parse_args()
    wanted = further(arguments.further) if arguments.further else design()[:arguments.first]
    runs = [r for r in wanted if not finished(arguments.folder / name(r))]
    jobs = [functools.partial(drumlin.command, "run", str(SCENE), "-o", os.path.abspath(arguments.folder / name(r)), "--threads", "1", "--resume", *overrides(r))
            for r in runs]
    outcomes = drumlin.run_all(jobs, arguments.folder, arguments.executor, ended=lambda number, outcome: print(name(runs[number]), outcome.error or "", flush=True))
    return 1 if any(outcome.error for outcome in outcomes) else 0


if __name__ == "__main__":
    sys.exit(main())
