"""The drum by the library's law beside its grains: `law_drums.py FOLDER --record data/laws/drum.json` (docs/results/laws.md).

Solves data/scenes/drum-6rpm-inertial-flow.toml with laws of `drumlin law` into FOLDER, and compares with data/bed and data/sizes. PYTHONPATH holds the
package.
"""
import argparse
import json
import math
import os
import pathlib

import drumlin
import numpy as np
import scipy.stats
from drumlin.figures import whole_file

DATA = pathlib.Path(__file__).resolve().parents[2] / "data"
GRAINS = {"restitution": 0.46, "spread": 0.0909}  # of the drum of the paper
CASES = {"friction 0.4": {"friction": 0.4}, "friction 0.4, sizes +-20 %": {"friction": 0.4, "spread": 0.2}, "friction 0.2": {"friction": 0.2},
         "friction 0.4, 2 rpm": {"friction": 0.4, "rpm": 2}, "friction 0.4, 15 rpm": {"friction": 0.4, "rpm": 15}}
DRAWS = 8
READ = ("theta_deg", "H", "shear_rate", "Q")


def power(x, y):
    """Exponent of y over x by least squares of the logarithms, and its 99 % half width by the scatter."""
    found = scipy.stats.linregress(np.log(x), np.log(y))
    return {"value": found.slope, "ci99": scipy.stats.t.ppf(0.995, len(x) - 2) * found.stderr, "runs": len(x)}


def solved(folder, case):
    """The flow by the library's law of these grains, with the half width by the law's interval."""
    grains = GRAINS | {key: value for key, value in case.items() if key != "rpm"}
    rpm, law, flow = case.get("rpm", 6), folder / "law.toml", folder / "flow"
    drumlin.command("law", *(word for key, value in grains.items() for word in (f"--{key}", str(value))), "-o", law, "--overwrite")
    # p_min as for the drum's own laws (docs/results/bed.md)
    drumlin.command("flow", DATA / "scenes/drum-6rpm-inertial-flow.toml", "--rheology", law, "--law-draws", str(DRAWS), "--set", "regularisation.pressure=0.22",
                    "--set", "output.figures=false", "--set", f"drum.rotation_rpm={rpm}", "-o", flow, "--overwrite")
    found = json.loads((flow / "flow.json").read_text())
    row = {"grains": grains, "rotation_rpm": rpm, "revision": found["provenance"]["revision"], "cpu_seconds": found["cpu_seconds"],
           **{name: {"value": found[name], "law_ci99": found["law_band"]["scalars"][name], "mesh": found["mesh_change"][name]} for name in READ}}
    if rpm == 6 and grains["friction"] == 0.4:
        drumlin.command("score", flow, "--limits", DATA / "limits/bed.toml", "--against", *(DATA / f"bed/6rpm-5turns-seed{seed}" for seed in (3, 4, 5)),
                        "-o", folder / "score", "--overwrite")
        row["bed"] = json.loads((folder / "score/score.json").read_text())["verdict"]
    return row


def mean_of(rows):
    """Mean over the runs; its half width is that of their own intervals."""
    return {"value": float(np.mean([row["value"] for row in rows])), "ci99": math.hypot(*(row["ci99"] for row in rows)) / len(rows), "runs": len(rows)}


def particles():
    """theta and H of the grains at 6 rpm by friction, and the power of H over speed (450 mm) and size (one Froude number)."""
    sizes = json.loads((DATA / "sizes/sizes.json").read_text())
    same = {friction: [run for run in sizes["runs"] if (run["friction"], run["filling"], run["diameter_mm"], run["rotation_rpm"]) == (friction, "half", 450, 6)]
            for friction in (0.4, 0.2)}
    speeds = [(float(path.parts[-3].split("rpm")[0]), json.loads(path.read_text())["H"]["value"]) for path in sorted((DATA / "bed").glob("*/measured/measured.json"))]
    return {**{f"friction {friction}": {name: mean_of([run[name] for run in runs]) for name in READ} for friction, runs in same.items()},
            "power of H over speed": power(*zip(*speeds)), "power of H over size": sizes["powers"]["0.4"]["H"]}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--record", required=True, type=pathlib.Path)
    arguments = parser.parse_args()
    found = {"particles": particles(), "library": {}}
    for name, case in CASES.items():
        folder = arguments.folder / name.replace(" ", "-").replace("%", "percent")
        os.makedirs(folder, exist_ok=True)
        found["library"][name] = solved(folder, case)
        print(name, found["library"][name]["theta_deg"], flush=True)
    by_speed = {found["library"][name]["rotation_rpm"]: found["library"][name]["H"]["value"] for name in CASES if found["library"][name]["grains"] == GRAINS | {"friction": 0.4}}
    found["library"]["power of H over speed"] = power(list(by_speed), list(by_speed.values()))
    whole_file.write_text(arguments.record, json.dumps(found, indent=1) + "\n")


if __name__ == "__main__":
    main()
