"""Fields of a drum that another program computed, as a map of Drumlin's (docs/formats/score.md).

`drumlin score` starts it. usage: fields.py FIELDS.csv MAPS.h5; a refusal is printed and ends with exit code 2.
"""

import csv
import math
import re
import sys

import numpy as np
import scipy.interpolate
import scipy.spatial

from drumlin.errors import InputError
from drumlin.hdf5 import write_hdf5
from drumlin.study.runs import refused

G = 9.81  # m/s^2
SPACING = 0.5  # d, of the nodes that scattered points are interpolated to
ROOM = 1.02  # radii of the drum within which all points lie
AGREE = 0.01  # p against the mean of sxx and szz, of the largest p
MOST = 1e9  # of any number, in the unit of the header or in d, sqrt(g d), rho0 g d: beyond, squares and their sums would overflow
NUMBERS = {"rotation_rpm": 1e-9, "drum_diameter_mm": 1e-9, "grain_diameter_mm": 1e-9, "density_kg_m3": 1e-9, "theta_deg": -90, "surface_depth_mm": -MOST}
CHOICES = {"axes": ("laboratory", "surface"), "velocities": ("laboratory", "drum")}
GRADIENT = ("dvx_dx", "dvx_dz", "dvz_dx", "dvz_dz")
# What a column measures, and the units that it may have beside 1, Drumlin's own: one of each in SI.
UNITS = {"length": {"m": 1, "mm": 1e-3}, "velocity": {"m/s": 1, "mm/s": 1e-3}, "stress": {"Pa": 1, "kPa": 1e3}, "gradient": {"1/s": 1}}
COLUMNS = {"x": "length", "z": "length", "vx": "velocity", "vz": "velocity", "sxx": "stress", "sxz": "stress", "szz": "stress"}
OPTIONAL = {"p": "stress"} | dict.fromkeys(GRADIENT, "gradient")


def _header(path, lines):
    """The lines "# key = value" as numbers and words."""
    found, problems = {}, []
    for line, text in lines:
        key, _, value = (part.strip() for part in text[1:].partition("="))
        place = f"{path}:{line}"
        if key in found:
            problems.append((place, key, "appears twice", "once"))
        elif key in NUMBERS:
            try:
                found[key] = float(value)
            except ValueError:
                found[key] = math.nan
            if not NUMBERS[key] < found[key] < MOST:
                problems.append((place, key, f'"{value}" does not do', f"a number above {NUMBERS[key]:g}, below {MOST:g}"))
        elif key in CHOICES:
            found[key] = value
            if value not in CHOICES[key]:
                problems.append((place, key, f'"{value}" is not known', ", ".join(CHOICES[key])))
    problems += [(str(path), key, "is missing in the header", f"a line # {key} = ...") for key in (*NUMBERS, *CHOICES) if key not in found]
    if problems:
        raise refused(problems)
    return found


def _units(path, line, names, scales):
    """[(column, what one of its unit is in Drumlin's)] of the line of names, "x (mm)"."""
    known, found, problems = COLUMNS | OPTIONAL, [], []
    for i, text in enumerate(names, 1):
        match = re.fullmatch(r"\s*(\w+)\s*\(([^()]*)\)\s*", text)
        name, unit = match.groups() if match else (text.strip(), "")
        kind = known.get(name)
        units = {"1": scales[kind]} | UNITS[kind] if kind else {}
        if kind is None or name in [one for one, _ in found]:
            problems.append((f"{path}:{line}:{i}", name, "is no column of fields, or appears twice", ", ".join(known)))
        elif unit not in units:
            problems.append((f"{path}:{line}:{i}", name, f'has the unit "{unit}"', ", ".join(f"{name} ({one})" for one in units)))
        else:
            found.append((name, units[unit] / scales[kind]))
    have = {name for name, _ in found}
    if not problems:
        problems += [(f"{path}:{line}", name, "is missing", "a column of its own") for name in COLUMNS if name not in have]
        if have & set(GRADIENT) and not have >= set(GRADIENT):
            problems.append((f"{path}:{line}", ", ".join(GRADIENT), "some are missing", "all four, or none"))
    if problems:
        raise refused(problems)
    return found


def _numbers(path, rows, columns):
    """The rows, shape (rows, columns), in Drumlin's units; an empty field is NaN."""
    table, problems = np.full((len(rows), len(columns)), math.nan), []
    for i, (line, row) in enumerate(rows):
        if len(row) != len(columns):
            problems.append((f"{path}:{line}", "", f"has {len(row)} fields", str(len(columns))))
            continue
        for j, ((name, unit), text) in enumerate(zip(columns, row)):
            try:
                table[i, j] = float(text) * unit if text.strip() else math.nan
            except ValueError:
                table[i, j] = math.inf
            if abs(table[i, j]) > MOST or (name in "xz" and math.isnan(table[i, j])):
                problems.append((f"{path}:{line}:{j + 1}", name, f'"{text}" does not do',
                                 f"a number of at most {MOST * unit:.3g}" + ("" if name in "xz" else ", or nothing")))
    problems += [(f"{path}:{rows[0][0]}", name, "holds no number", "a column that has some")
                 for (name, _), values in zip(columns, table.T) if not problems and np.isnan(values).all()]
    first = {}
    for (line, _), place in zip(rows, np.round(table[:, [[name for name, _ in columns].index(axis) for axis in "xz"]], 6).tolist()):
        if first.setdefault(tuple(place), line) != line and not problems:
            problems.append((f"{path}:{line}", "x, z", f"is the point of line {first[tuple(place)]} again", "each point once"))
    if problems:
        raise refused(problems[:20])
    return table


def read_fields(path):
    """(header, {column: array over the points}) of a CSV file of fields, in d, sqrt(d/g) and rho0 g d; InputError, with line and column, where it is
    none, where a point lies outside of the drum, the material is pulled or p is not the mean of sxx and szz."""
    try:
        with open(path, newline="", encoding="utf-8") as stream:
            lines = list(enumerate(stream.read().splitlines(), 1))
    except ValueError as error:
        raise InputError(f"{path}: is no text in UTF-8: {error}") from error
    header = _header(path, [(number, text) for number, text in lines if text.startswith("#")])
    rows = [(number, next(csv.reader([text]))) for number, text in lines if text.strip() and not text.startswith("#")]
    if len(rows) < 4:
        raise refused([(str(path), "", "holds less than three points", "a line of names and a line per point")])
    d = header["grain_diameter_mm"] / 1000
    scales = {"length": d, "velocity": math.sqrt(G * d), "stress": header["density_kg_m3"] * G * d, "gradient": math.sqrt(G / d)}
    columns = _units(path, *rows[0], scales)
    f = dict(zip([name for name, _ in columns], _numbers(path, rows[1:], columns).T))
    mean, at = (f["sxx"] + f["szz"]) / 2, [number for number, _ in rows[1:]]
    radius = header["drum_diameter_mm"] / 2 / header["grain_diameter_mm"]
    outside = np.flatnonzero(np.isfinite(mean) & (np.hypot(f["x"], f["z"]) > ROOM * radius))
    if outside.size:
        raise refused([(f"{path}:{at[outside[0]]}", "x, z", "lies outside of the drum", "places counted from its axis, in the unit of the column")])
    if not np.nanmean(mean) > 0:
        raise refused([(str(path), "sxx, szz", "are tensions", "stress with compression positive, the whole of it")])
    off = np.flatnonzero(abs(f.get("p", mean) - mean) > AGREE * np.nanmax(abs(mean)))
    if off.size:
        column = [name for name, _ in columns].index("p") + 1
        raise refused([(f"{path}:{at[off[0]]}:{column}", "p", f"{f['p'][off[0]]:.6g} in rho0 g d", f"the mean of sxx and szz, {mean[off[0]]:.6g}")])
    return header, f


def _turned(f, angle):
    """All fields in axes whose x points `angle` further down."""
    c, s = math.cos(angle), math.sin(angle)
    turn = np.array([[c, -s], [s, c]])
    result = dict(zip(("x", "z"), turn @ [f["x"], f["z"]])) | dict(zip(("vx", "vz"), turn @ [f["vx"], f["vz"]]))
    # sxz is minus the entry of the pressure tensor.
    stress = np.einsum("ia,abn,jb->ijn", turn, np.array([[f["sxx"], -f["sxz"]], [-f["sxz"], f["szz"]]]), turn)
    result |= {"sxx": stress[0, 0], "sxz": -stress[0, 1], "szz": stress[1, 1]}
    if GRADIENT[0] in f:
        gradient = np.einsum("ia,abn,jb->ijn", turn, np.array([f[name] for name in GRADIENT]).reshape(2, 2, -1), turn)
        result |= dict(zip(GRADIENT, gradient.reshape(4, -1)))
    return result


def _on_grid(f):
    """(x, z, fields over (z, x)): points that are the nodes of a grid as they are, others interpolated linearly."""
    x, z = (np.unique(np.round(f[axis], 6)) for axis in "xz")
    names = [name for name in f if name not in "xz"]
    if x.size * z.size == f["x"].size and all(axis.size > 2 and np.ptp(np.diff(axis)) < 1e-5 for axis in (x, z)):
        order = np.lexsort((np.round(f["x"], 6), np.round(f["z"], 6)))
        return x, z, {name: f[name][order].reshape(z.size, x.size) for name in names}
    known = np.all([np.isfinite(f[name]) for name in names], axis=0)
    points = np.array([f["x"], f["z"]]).T[known]
    x, z = (np.arange(np.floor(p.min()), np.ceil(p.max()) + SPACING / 2, SPACING) for p in points.T)
    try:
        found = scipy.interpolate.LinearNDInterpolator(points, np.array([f[name][known] for name in names]).T)(*np.meshgrid(x, z))
    except scipy.spatial.QhullError as error:
        raise InputError("x, z: the points span no area") from error
    return x, z, dict(zip(names, np.moveaxis(found, 2, 0)))


def map_of_fields(header, f):
    """(header, x, z, fields, scales) of a map from what read_fields() gave: axes of the surface, z from it, velocity relative to the drum."""
    d = header["grain_diameter_mm"] / 1000
    scales = {"length_m": d, "time_s": math.sqrt(d / G), "density_kg_m3": header["density_kg_m3"]}
    rotation, depth = header["rotation_rpm"] * math.pi / 30 * scales["time_s"], header["surface_depth_mm"] / header["grain_diameter_mm"]
    f = _turned(f, math.radians(header["theta_deg"]) if header["axes"] == "laboratory" else 0.0)
    moves = rotation if header["velocities"] == "laboratory" else 0.0
    f["vx"], f["vz"], f["z"] = f["vx"] - moves * f["z"], f["vz"] + moves * f["x"], f["z"] + depth
    x, z, f = _on_grid(f)
    if GRADIENT[0] in f:
        f["dvx_dz"], f["dvz_dx"] = f["dvx_dz"] - moves, f["dvz_dx"] + moves
    else:
        f["dvx_dz"], f["dvx_dx"] = np.gradient(f["vx"], z, x)
        f["dvz_dz"], f["dvz_dx"] = np.gradient(f["vz"], z, x)
    fields = {"v_" + axis: f["v" + axis] for axis in "xz"} | {f"d_v_{a}_d{b}": f[f"dv{a}_d{b}"] for a in "xz" for b in "xz"}
    fields |= {f"sigma_{name}": f["s" + name] for name in ("xx", "zz", "xz")}
    header = {"side": "continuum", "geometry": "drum", "reduced": "false", "theta_deg": header["theta_deg"], "axis_depth": depth, "rotation": rotation,
              "drum_radius": header["drum_diameter_mm"] / 2 / header["grain_diameter_mm"], "diameter_m": d}
    return header, x, z, fields, scales


def write_maps(path, header, x, z, fields, scales):
    """A file of maps (docs/formats/maps.md); fields: {name: array over (z, x)}."""
    texts = {"format": "drumlin-maps-1", "names": "".join(f"{name}\n" for name in fields),
             "header": "".join(f"{key} = {value}\n" for key, value in sorted(header.items()))}
    grid = {"x": x, "z": z} | {f"fields/{name}": values for name, values in fields.items()}
    write_hdf5(path, texts | {name: np.asarray(values, float) for name, values in grid.items()}
               | {f"scales/{name}": float(value) for name, value in scales.items()})


def main(csv_file, maps_file):
    write_maps(maps_file, *map_of_fields(*read_fields(csv_file)))


if __name__ == "__main__":
    main(*sys.argv[1:])
