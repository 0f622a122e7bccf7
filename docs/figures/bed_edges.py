"""The edges of the bed, read off the particles: the wall, along which it slips, and the line I = 1e-2 below the flow.

usage: bed_edges.py RECORD.json --runs RUN... [--contacts SNAPSHOTRUN...]
Each RUN has measured/maps.h5 with displacement fields; a SNAPSHOTRUN its snapshots, too. Angles phi are from below the axis, positive
downslope: material meets the wall at 87 deg and leaves it at -87.
"""

import argparse
import json
import math
import pathlib

import h5py
import numpy
import whole_file
from result_files import number_of, read_maps

CORNER = list(range(70, 89, 2))
ANGLES = [-a for a in CORNER[::-1]] + list(range(-65, 66, 5)) + CORNER  # deg
LINE_I = 1e-2
LINE_X = list(range(-44, 45, 4))  # d
FRICTION = 0.95  # of the wall in the scenes of the drum
SURFACE_END = 87.7  # deg, of the half full drum
BLIND = ("3", "8", "12")  # rpm


def fields_of(run):
    """Header and fields over the plane, velocity relative to the drum by displacements where there are any; the axis is the origin."""
    header, x, z, f, _ = read_maps(run / "measured" / "maps.h5")
    for name in ("v_x", "v_z", "I", "d_v_x_dz"):
        f[name] = numpy.where(numpy.isfinite(f["displacement_" + name]), f["displacement_" + name], f[name])
    axis, radius, rotation = (float(header[name]) for name in ("axis_depth", "drum_radius", "rotation"))
    f["x"], f["z"] = numpy.meshgrid(x, z - axis)
    f["r"] = numpy.hypot(f["x"], f["z"])
    f["phi"] = numpy.degrees(numpy.arctan2(f["x"], -f["z"]))
    return f, radius, rotation


def over_angle(f, values, near, far, radius):
    """Means at the angles, between two distances from the wall."""
    ring = (f["r"] < radius - near) & (f["r"] > radius - far) & numpy.isfinite(values)
    here = [ring & (abs(f["phi"] - angle) <= (1.5 if abs(angle) >= CORNER[0] else 4)) for angle in ANGLES]
    return [float(numpy.mean(values[at])) if at.any() else math.nan for at in here]


def wall_of(f, radius, rotation):
    """Over the angles: share of the wall's speed that the first layer and the material behind it lack, traction ratio, nu."""
    lag = -(f["v_x"] * f["z"] - f["v_z"] * f["x"]) / f["r"] / (rotation * radius)
    n_x, n_z = f["x"] / f["r"], f["z"] / f["r"]
    shear = (f["sigma_xz"] + f["sigma_zx"]) / 2
    normal = n_x**2 * f["sigma_xx"] + n_z**2 * f["sigma_zz"] - 2 * n_x * n_z * shear
    along = n_x * n_z * (f["sigma_xx"] - f["sigma_zz"]) + (n_x**2 - n_z**2) * shear
    ring = {name: over_angle(f, values, near, far, radius) for name, values, near, far in (
        ("slip", lag, 0, 1), ("lag_2_d", lag, 2, 3), ("lag_4_d", lag, 4, 5), ("normal", normal, 2, 4), ("along", along, 2, 4), ("nu", f["nu"], 0.6, 1.6),
        ("nu_6_d", f["nu"], 5.5, 6.5))}
    # A loose grain on the wall lags more than the material behind it.
    ring["slip"] = [float(numpy.fmin(first, behind)) if abs(angle) < CORNER[0] else first
                    for angle, first, behind in zip(ANGLES, ring["slip"], ring["lag_2_d"])]
    ring["traction_ratio"] = [a / n for a, n in zip(ring.pop("along"), ring.pop("normal"))]
    return ring


def line_of(f):
    """z from the axis, v_x, its rate of shear and v_z along the line I = 1e-2, at LINE_X."""
    columns = []
    for j in range(f["x"].shape[1]):
        inertial = numpy.where(numpy.isfinite(f["I"]) & (f["nu"] > 0.6), f["I"], 0)[:, j]
        above = numpy.flatnonzero((inertial[1:] >= LINE_I) & (inertial[:-1] < LINE_I) & (inertial[:-1] > 0))
        if not len(above):
            columns.append([math.nan] * 4)
            continue
        k = above[-1]
        share = math.log(LINE_I / inertial[k]) / math.log(inertial[k + 1] / inertial[k])
        columns.append([float((1 - share) * f[name][k, j] + share * f[name][k + 1, j]) for name in ("z", "v_x", "d_v_x_dz", "v_z")])
    near = [numpy.nanmean([columns[j] for j in numpy.flatnonzero(abs(f["x"][0] - x) <= 2)], axis=0) for x in LINE_X]
    return dict(zip(("z", "v_x", "shear_rate", "v_z"), numpy.array(near).T.tolist()))


def contacts_of(run):
    """What the contacts of the wall do, by sectors of 30 deg: how many slide, traction, speeds against the wall at the contact and of the centres."""
    measured = json.loads((run / "measured" / "measured.json").read_text())
    turn = math.radians(measured["theta_deg"]["value"])
    sectors = {centre: [] for centre in (-75, -60, -45, -30, 0, 30, 60)}
    for path in sorted((run / "snapshots").glob("*.h5")):
        with h5py.File(path) as s:
            g = {name: s["grains/" + name][:] for name in ("x", "z", "v_x", "v_z", "radius", "spin")}
            i, j = s["contacts/i"][:], s["contacts/j"][:]
            n_x, n_z = s["contacts/normal_x"][:], s["contacts/normal_z"][:]
            normal, along = s["contacts/impulse_n"][:], s["contacts/impulse_t"][:]
            axis, wall, size = (number_of(s["container/x"]), number_of(s["container/z"])), number_of(s["wall/spin"]), number_of(s["container/radius"])
        of_wall = j < 0
        i, n_x, n_z, normal, along = i[of_wall], n_x[of_wall], n_z[of_wall], normal[of_wall], along[of_wall]
        x, z, radius = g["x"][i] - axis[0], g["z"][i] - axis[1], g["radius"][i]
        phi = numpy.degrees(numpy.arctan2(x, -z) + turn)
        t_x, t_z = z / numpy.hypot(x, z), -x / numpy.hypot(x, z)  # the way the wall moves
        centre = (g["v_x"][i] - wall * z) * t_x + (g["v_z"][i] + wall * x) * t_z
        turned = -(g["spin"][i] - wall) * radius * (n_z * t_x - n_x * t_z)
        along = along * (n_z * t_x - n_x * t_z)  # along the wall's motion
        for middle, found in sectors.items():
            at = abs(phi - middle) < 7.5
            found.append(numpy.array([at.sum(), (abs(along) > 0.99 * FRICTION * normal)[at].sum(), normal[at].sum(), along[at].sum(),
                                      abs(along)[at].sum(), -centre[at].sum() / (wall * size), -(centre + turned)[at].sum() / (wall * size),
                                      abs(centre + turned)[at].sum() / (wall * size), abs(centre)[at].sum() / (wall * size)]))
    result = {}
    for middle, found in sectors.items():
        n, sliding, normal, along, magnitude, centre, point, point_size, centre_size = numpy.sum(found, axis=0)
        result[middle] = {"contacts": int(n), "sliding": sliding / n, "traction_ratio": along / normal, "mobilised": magnitude / normal / FRICTION,
                          "lag_of_centres": centre / n, "lag_at_contacts": point / n, "size_at_contacts": point_size / n, "size_of_centres": centre_size / n}
    return result


def slip_length(wall):
    """Slip over the shear rate of the first 4 d, in d: mean and standard deviation over the angles from -55 to -20."""
    lengths = [4 * slip / (lag - slip) for angle, slip, lag in zip(ANGLES, wall["slip"], wall["lag_4_d"]) if -55 <= angle <= -20]
    return {"mean": float(numpy.mean(lengths)), "deviation": float(numpy.std(lengths, ddof=1))}


def entrainment_of(f, radius, rotation):
    """Where material meets the wall, 4 to 5 d from it, behind the layers that order along it: how high the surface (nu = 0.4) ends above the flat surface
    of the continuum, and over which length the lag falls by e, from one at that end (least squares of ln lag from 74 to 84 deg), in d."""
    ring = (f["r"] < radius - 4) & (f["r"] > radius - 5) & (f["phi"] > 60)
    angles = numpy.arange(60, 110)
    here = [ring & (abs(f["phi"] - angle) <= 0.5) for angle in angles]
    nu = numpy.array([numpy.mean(numpy.nan_to_num(f["nu"][at])) if at.any() else 0 for at in here])
    last = numpy.flatnonzero(nu >= 0.4)[-1]
    end = angles[last] + (nu[last] - 0.4) / (nu[last] - nu[last + 1])
    lag = -(f["v_x"] * f["z"] - f["v_z"] * f["x"]) / f["r"] / (rotation * radius)
    here = ring & (f["phi"] >= 74) & (f["phi"] <= 84) & (lag > 0)
    s = radius * numpy.radians(end - f["phi"][here])
    return [float(radius * math.radians(end - SURFACE_END)), float(numpy.sum(s**2) / -numpy.sum(s * numpy.log(lag[here])))]


def entrainment_line(speeds):
    """Length over height of the end, a straight line through the speeds that are not blind, and what it leaves at each."""
    points = {rpm: numpy.mean(speed["entrainment"], axis=0) for rpm, speed in speeds.items()}
    line = numpy.polyfit(*numpy.array([point for rpm, point in points.items() if rpm not in BLIND]).T, 1)
    return {"length": float(line[1]), "per_height": float(line[0]), "leaves": {rpm: float(length - numpy.polyval(line, height)) for rpm, (height, length) in points.items()}}


def speed_exponents(speeds):
    """d ln slip/d ln Omega at each angle where all speeds slip by more than 2e-4, by least squares."""
    found = {}
    for k, angle in enumerate(ANGLES):
        slip = numpy.array([speed["wall"]["slip"][k] for speed in speeds.values()])
        if (slip > 2e-4).all():
            found[angle] = float(numpy.polyfit(numpy.log([float(rpm) for rpm in speeds]), numpy.log(slip), 1)[0])
    return found


def mean_of(tables):
    return {name: numpy.mean([table[name] for table in tables], axis=0).tolist() for name in tables[0]}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("record", type=pathlib.Path)
    parser.add_argument("--runs", type=pathlib.Path, nargs="+", default=[])
    parser.add_argument("--contacts", type=pathlib.Path, nargs="+", default=[])
    options = parser.parse_args()
    speeds = {}
    for run in options.runs:
        f, radius, rotation = fields_of(run)
        speeds.setdefault(run.name.split("rpm")[0], []).append({"run": run.name, "wall": wall_of(f, radius, rotation), "line": line_of(f),
                                                            "entrainment": entrainment_of(f, radius, rotation)})
    speeds = {rpm: {"runs": [run["run"] for run in of], "wall": mean_of([run["wall"] for run in of]), "line": mean_of([run["line"] for run in of]),
                    "slip_length": slip_length(mean_of([run["wall"] for run in of])),
                    "entrainment": [run["entrainment"] for run in of],
                    "slip_between_runs": numpy.std([run["wall"]["slip"] for run in of], axis=0, ddof=1).tolist() if len(of) > 1 else None}
              for rpm, of in sorted(speeds.items(), key=lambda entry: float(entry[0]))}
    record = {"format": "drumlin-bed-edges-1", "angles_deg": ANGLES, "line_x": LINE_X, "speeds": speeds, "speed_exponents": speed_exponents(speeds), "entrainment_line": entrainment_line(speeds),
              "contacts": {run.name: contacts_of(run) for run in options.contacts}}
    if not options.contacts and options.record.exists():
        record["contacts"] = json.loads(options.record.read_text())["contacts"]
    record = json.loads(json.dumps(record), parse_constant=lambda _: None)
    whole_file.write_text(options.record, json.dumps(rounded(record)) + "\n")


def rounded(value):
    if isinstance(value, float):
        return float(f"{value:.4g}")
    if isinstance(value, dict):
        return {key: rounded(entry) for key, entry in value.items()}
    return [rounded(entry) for entry in value] if isinstance(value, list) else value


if __name__ == "__main__":
    main()
