"""The table of the library of laws from its measured runs: `make_laws.py FOLDER -o data/laws/laws.csv` (docs/formats/laws.md).

FOLDER holds the RUN.json of measure_laws.py. All seeds of a point are pooled; intervals are 99 %, delete-one jackknife over all blocks, Student's t.
"""
import argparse
import collections
import csv
import io
import json
import math
import pathlib

import numpy as np
import scipy.optimize
import scipy.stats

import law_runs
import script  # noqa: F401  (finds drumlin)
import whole_file
from drumlin.library import table

POINT = ("friction", "restitution", "sizes", "rolling_resistance", "I", "count", "step_factor")
LAW_I = 2 / math.sqrt(math.pi)  # I of a law, of the square of the mean diameter, over I of its disc's mass


def quantities(m):
    """All that is asked of a point from means over its blocks."""
    xx, zz, xz = (m["contact_" + c] + m["kinetic_" + c] for c in ("xx", "zz", "xz"))
    stress, fabric = math.atan2(-2 * xz, xx - zz), math.atan2(m["sin"], m["cos"])
    return {"mu": xz / zz, "nu": m["nu"], "k": xx / zz, "N1_over_p": 2 * (xx - zz) / (xx + zz), "axis_angle_deg": turned(stress),
            "kinetic_share": (m["kinetic_xx"] + m["kinetic_zz"]) / (xx + zz), "dv_over_shear": math.sqrt(m["dv2"]),
            "domega_over_shear": math.sqrt(m["domega2"]), "spin_over_half_vorticity": m["spin"], "coordination": 2 * m["contacts"] / m["grains"],
            "sliding_share": m["sliding"] / m["contacts"], "fabric": 2 * math.hypot(m["cos"], m["sin"]) / m["contacts"],
            "fabric_angle_deg": turned(fabric), "sigma_zz_over_P": zz / m["pressure"]}


def turned(double_angle):
    """From the axis of the fastest shortening (135 deg) to that of twice this angle, in degrees within a quarter turn."""
    return ((math.degrees(double_angle) / 2 - 135) + 90) % 180 - 90


def with_intervals(runs):
    """{name: (value, half width)} over the blocks of all runs."""
    blocks = {key: np.concatenate([run["blocks"][key] for run in runs]) for key in runs[0]["blocks"]}
    blocks["pressure"] = np.concatenate([np.full(len(run["blocks"]["nu"]), run["pressure"]) for run in runs])
    n = len(blocks["nu"])
    value = quantities({key: column.mean() for key, column in blocks.items()})
    left_out = [quantities({key: (column.sum() - column[b]) / (n - 1) for key, column in blocks.items()}) for b in range(n)]
    t = scipy.stats.t.ppf(0.995, n - 1)

    def half(name):
        of = np.array([one[name] for one in left_out])
        return t * math.sqrt((n - 1) / n * np.sum((of - of.mean()) ** 2))
    return {name: (value[name], half(name)) for name in value}


def strain_to_forget(runs):
    """Shear in which the difference of nu from its steady value falls by 1/e, and its half width; NaN where the start is not told from the steady state."""
    strain, excess = (np.concatenate(parts) for parts in zip(*((run["start"]["strain"], np.array(run["start"]["nu"]) - np.mean(run["blocks"]["nu"]))
                                                              for run in runs)))
    spread = math.sqrt(np.mean([np.var(run["blocks"]["nu"]) for run in runs]))
    if abs(excess[np.argsort(strain)][:3 * len(runs)].mean()) < 3 * spread:
        return math.nan, math.nan
    try:
        (_, found), covariance = scipy.optimize.curve_fit(lambda x, a, g: a * np.exp(-x / g), strain, excess, p0=(excess[0], 0.3), bounds=([-1, 1e-3], [1, 20]))
    except RuntimeError:
        return math.nan, math.nan
    return found, 2.58 * math.sqrt(covariance[1, 1])


def row(point, runs):
    found = with_intervals(runs) | {"strain_to_forget": strain_to_forget(runs)}
    smallest, largest, distribution = law_runs.diameters(point["sizes"])
    spread = 1 / math.sqrt(3) if distribution else (largest - smallest) / 4  # sqrt(3) times standard deviation over mean
    head = {"friction": point["friction"], "restitution": point["restitution"], "sizes": point["sizes"], "spread": spread,
            "rolling_resistance": point["rolling_resistance"], "I_of_mass": point["I"], "I": point["I"] * LAW_I, "grains": point["count"],
            "half_accuracy": int(point["step_factor"] != 1), "seeds": len({run["seed"] for run in runs}), "blocks": sum(len(run["blocks"]["nu"]) for run in runs),
            "strain": sum(run["strain"] for run in runs), "steady": sum(run["steady"] for run in runs),
            "unconverged_share": sum(run["unconverged_steps"] for run in runs) / sum(run["steps"] for run in runs),
            "cpu_seconds": round(sum(run["cpu_seconds"] for run in runs), 1)}
    for name, (value, half) in found.items():
        head |= {name: value, name + "_ci99": half}
    return head


def text_of(rows, header):
    out = io.StringIO()
    out.write("# drumlin-laws-1\n" + "".join(f"# {key} = {value}\n" for key, value in header.items()))
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(rows[0])
    for one in rows:
        writer.writerow(["" if isinstance(v, float) and not math.isfinite(v) else f"{v:.6g}" if isinstance(v, float) else v for v in one.values()])
    return out.getvalue()


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("-o", "--output", required=True, type=pathlib.Path)
    arguments = parser.parse_args()
    points = collections.defaultdict(list)
    for r in law_runs.present(arguments.folder, ".json"):
        points[tuple(r[key] for key in POINT)].append(json.loads((arguments.folder / (law_runs.name(r) + ".json")).read_text()))
    rows = [row(dict(zip(POINT, point)), runs) for point, runs in points.items()]
    rows.sort(key=lambda one: (one["half_accuracy"], one["grains"], one["rolling_resistance"], one["spread"] != 0.2, one["spread"], one["restitution"],
                               one["friction"], one["I"]))
    runs = [run for several in points.values() for run in several]
    header = {"revision": ", ".join(sorted({run["revision"] for run in runs})), "runs": len(runs),
              "command": "docs/figures/law_runs.py FOLDER [--further FILE]; measure_laws.py PROGRAM FOLDER; make_laws.py FOLDER -o FILE",
              "units": "dimensionless; angles in deg, processor time in s (docs/formats/laws.md)"}
    whole_file.write_text(arguments.output, text_of(rows, header))
    of = table.Library(arguments.output)
    header |= {"process_" + name: " ".join(f"{value:.4g}" for value in of.fitted_scales(name)) for name in table.FITTED}
    whole_file.write_text(arguments.output, text_of(rows, header))


if __name__ == "__main__":
    main()
