"""Snapshots of a run as arrays, with what scenes beyond the drum are judged by: stress and shear rate of a box, forces on walls, intervals.

Everything is in the units of the run: d, sqrt(d/g), rho0 d^2 per unit of depth (docs/conventions.md).
"""

import json
import math
import pathlib
import tomllib

import numpy

from result_files import read_snapshot

BATCHES = 10
FACTOR = 3.250  # Student's t for 99 % with 9 degrees of freedom


def read_run(folder):
    folder = pathlib.Path(folder)
    report = json.loads((folder / "run.json").read_text(encoding="utf-8"))
    scene = tomllib.loads((folder / "scene.toml").read_text(encoding="utf-8"))
    snapshots = [read_snapshot(file) for file in sorted((folder / "snapshots").glob("*.h5"))]
    return {"folder": folder, "report": report, "scene": scene, "snapshots": snapshots, "d_mm": 1e3 * report["scales"]["length_m"],
            "second": report["scales"]["time_s"], "density": report["scales"]["density_kg_m3"]}


def velocities(snapshot):
    """Means over the stored window, as everywhere in this project; those at the end of the step where there is none."""
    if snapshot["window"] > 0:
        return numpy.array([snapshot["displacement_x"], snapshot["displacement_z"]]).T / snapshot["window"]
    return numpy.array([snapshot["v_x"], snapshot["v_z"]]).T


def inertial_number(shear_rate, pressure):
    """I of da Cruz et al.: shear rate sqrt(m/P), m = pi/4 the mass of the mean disc."""
    return shear_rate * math.sqrt(math.pi / 4 / pressure)


def layer_state(snapshot, low, high, width):
    """nu, shear rate, stress of the grains with their centres between two heights; compression positive, sigma_xz as in docs/conventions.md."""
    inside = (snapshot["z"] >= low) & (snapshot["z"] < high)
    area, mass, v = width * (high - low), snapshot["mass"], velocities(snapshot)
    slope, middle = numpy.polyfit(snapshot["z"][inside], v[inside, 0], 1) if inside.sum() > 2 else (math.nan, math.nan)
    dv = v[inside] - numpy.array([slope * snapshot["z"][inside] + middle, numpy.full(inside.sum(), v[inside, 1].mean())]).T
    i, j = snapshot["i"], snapshot["j"]
    both = numpy.where(inside[i], snapshot["radius"][i], 0)
    grains = j >= 0
    both[grains] += numpy.where(inside[j[grains]], snapshot["radius"][j[grains]], 0)
    contact = numpy.einsum("c,ca,cb->ab", both, snapshot["force"], snapshot["normal"]) / area
    motion = numpy.einsum("g,ga,gb->ab", mass[inside], dv, dv) / area
    total = contact + motion
    return {"nu": mass[inside].sum() / area, "shear_rate": slope, "sigma_xx": total[0, 0], "sigma_zz": total[1, 1], "sigma_xz": -total[0, 1]}


def wall_forces(snapshot):
    """Force of the grains on the walls, by where the wall lies as seen from the grain: below, above, left, right."""
    wall = snapshot["j"] < 0
    normal, force = snapshot["normal"][wall], -snapshot["force"][wall]
    # A periodic scene has no sides: discs glued to its floor push sideways as well.
    steep = numpy.full(len(normal), True) if snapshot["period"] else numpy.abs(normal[:, 1]) > numpy.abs(normal[:, 0])
    sides = {"below": steep & (normal[:, 1] > 0), "above": steep & (normal[:, 1] < 0),
             "left": ~steep & (normal[:, 0] > 0), "right": ~steep & (normal[:, 0] < 0)}
    return {side: force[chosen].sum(axis=0) for side, chosen in sides.items()}


def mean(values):
    """Mean and half width of its 99 % interval, from ten batches of what follows in time."""
    values = numpy.asarray(values, float)
    if len(values) < 2 * BATCHES:
        return {"value": float(values.mean()), "ci99": None}
    batches = numpy.array([part.mean() for part in numpy.array_split(values, BATCHES)])
    return {"value": float(values.mean()), "ci99": float(FACTOR * batches.std(ddof=1) / math.sqrt(BATCHES))}


def da_cruz(inertial, suffix=""):
    """What da Cruz et al. found of discs in plane shear."""
    return {"mu" + suffix: 0.25 + 1.1 * inertial, "nu" + suffix: 0.81 - 0.3 * inertial}


def strength(strain, sine, nu, nu_start):
    """sin phi over axial strain: its peak, its late value, and how the volume changes."""
    smooth = numpy.convolve(sine, numpy.ones(9) / 9, "valid")
    late = strain > 0.5 * strain[-1]
    return {"sin_phi_peak": float(smooth.max()), "strain_at_peak": float(strain[4 + smooth.argmax()]), "sin_phi_late": mean(sine[late]),
            "strain": float(strain[-1]), "nu_start": float(nu_start), "nu_late": mean(nu[late])}


def line(x, y):
    """Slope, constant and share of the variance that a straight line explains."""
    slope, constant = numpy.polyfit(x, y, 1)
    rest = numpy.asarray(y) - slope * numpy.asarray(x) - constant
    return float(slope), float(constant), float(1 - rest.var() / numpy.var(y))
