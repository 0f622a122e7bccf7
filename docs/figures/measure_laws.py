"""What the runs of law_runs.py are measured by: `measure_laws.py PROGRAM FOLDER` measures what is finished and not yet measured, into RUN.json each, and
removes its snapshots. Means are those of BLOCKS equal stretches of time; make_laws.py pools them.
"""
import argparse
import json
import math
import os
import pathlib
import shutil
import subprocess

import h5py
import numpy as np

import law_runs

BLOCKS = 10


def of_contacts(file, friction, area):
    """Stress of the contacts, their number, share that slides and fabric; pressure positive, xz with the sign of the shear."""
    i, j = file["contacts/i"][()], file["contacts/j"][()]
    n = np.array([file["contacts/normal_x"][()], file["contacts/normal_z"][()]], float)
    normal, tangential = file["contacts/impulse_n"][()], file["contacts/impulse_t"][()]
    force = (normal * n + tangential * np.array([n[1], -n[0]])) / file["time_step"][()]
    radius = file["grains/radius"][()]
    stress = np.einsum("ac,bc,c->ab", force, n, radius[i] + radius[j]) / area
    angle = np.arctan2(n[1], n[0])
    sliding = np.count_nonzero(np.abs(tangential) > 0.999 * friction * normal) if friction > 0 else math.nan
    return {"contacts": len(i), "sliding": sliding, "cos": np.cos(2 * angle).sum(), "sin": np.sin(2 * angle).sum(),
            "contact_xx": stress[0, 0], "contact_zz": stress[1, 1], "contact_xz": -(stress[0, 1] + stress[1, 0]) / 2}


def of_motion(file, rate, area):
    """Kinetic stress, and fluctuations against the affine flow: squares, over the shear rate times d, and over the shear rate."""
    x, z = file["grains/x"][()], file["grains/z"][()]
    mass = math.pi * file["grains/radius"][()] ** 2
    centre = file["cell/x"][()] + file["period_x"][()] / 2, file["cell/z"][()] + file["cell/height"][()] / 2
    c = np.array([file["grains/v_x"][()] - file["cell/shear"][()] * (z - centre[1]) - file["cell/rate_x"][()] * (x - centre[0]),
                  file["grains/v_z"][()] - file["cell/rate_z"][()] * (z - centre[1])])
    c -= np.average(c, axis=1, weights=mass)[:, None]
    spin = file["grains/spin"][()]
    return {"kinetic_xx": (mass * c[0] ** 2).sum() / area, "kinetic_zz": (mass * c[1] ** 2).sum() / area, "kinetic_xz": -(mass * c[0] * c[1]).sum() / area,
            "dv2": (c**2).sum(0).mean() / rate**2, "spin": spin.mean() / (rate / 2), "domega2": spin.var() / rate**2, "nu": mass.sum() / area,
            "grains": len(x)}


def of_snapshot(path, friction, rate):
    with h5py.File(path) as file:
        area = file["period_x"][()] * file["cell/height"][()]
        return of_contacts(file, friction, area) | of_motion(file, rate, area) | {"time": file["time"][()]}


def steadiness(program, run, forget):
    """By the project's own test, over the snapshots of the last stage."""
    for path in sorted((run / "snapshots").glob("*.h5"))[:forget]:
        path.unlink()
    subprocess.run([program, "accept", run, "--reason", "snapshots of the start are measured elsewhere"], check=True, capture_output=True)
    subprocess.run([program, "measure", run, "--parts", "none", "--overwrite"], capture_output=True)  # its figures may be missing
    measured = json.loads((run / "measured/measured.json").read_text())
    return {"steady": measured["steadiness"]["steady"], "reasons": measured["steadiness"]["reasons"], "measured_mu": measured["bulk_mu"]}


def measured(program, run, r):
    record = json.loads((run / "run.json").read_text())
    rate = r["I"] / law_runs.INERTIAL_TIME * record["scales"]["time_s"]
    forget = law_runs.plan_of(r["I"])[3][0]
    series = [of_snapshot(path, r["friction"], rate) for path in sorted((run / "snapshots").glob("*.h5"))]
    columns = {key: np.array([one[key] for one in series], float) for key in series[0]}
    blocks = np.array_split(np.arange(forget, len(series)), BLOCKS)
    pressure = law_runs.PRESSURE / (record["scales"]["density_kg_m3"] * 9.81 * record["scales"]["length_m"])
    return {"run": run.name, **r, "revision": record["provenance"]["revision"], "cpu_seconds": record["cpu_seconds"], "steps": record["steps"],
            "unconverged_steps": record["unconverged_steps"], "rate": rate, "pressure": pressure,
            "strain": rate * (columns["time"][-1] - columns["time"][forget - 1]),
            "blocks": {key: [float(values[b].mean()) for b in blocks] for key, values in columns.items() if key != "time"},
            "start": {"strain": ((columns["time"][:forget] - columns["time"][0]) * rate + rate * (columns["time"][1] - columns["time"][0])).tolist(),
                      "nu": columns["nu"][:forget].tolist(), "contacts": columns["contacts"][:forget].tolist()},
            **steadiness(program, run, forget)}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("folder", type=pathlib.Path)
    arguments = parser.parse_args()
    os.nice(10)
    for r in law_runs.present(arguments.folder):
        run = arguments.folder / law_runs.name(r)
        result = run.with_name(run.name + ".json")
        if result.exists() or not law_runs.finished(run):
            continue
        result.write_text(json.dumps(measured(arguments.program, run, r)))
        for part in ("snapshots", "measured"):
            shutil.rmtree(run / part)
        (run / "checkpoint.h5").unlink(missing_ok=True)
        print(run.name, flush=True)


if __name__ == "__main__":
    main()
