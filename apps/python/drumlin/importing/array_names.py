"""Arrays of grains and contacts by the names that programs give them: VTK, VTKHDF, GSD, extended XYZ, H5MD."""

import numpy as np

from .frame import Column
from .units import force_unit

# Of docs/formats/import.md: Yade, LIGGGHTS, MercuryDPM, ASE, OVITO, drumlin export.
NAMES = {"radius": ("radius", "radii", "Radius", "radius_m"), "diameter": ("diameter", "Diameter"), "id": ("id", "ID", "Id", "grain"),
         "type": ("type", "species", "materialId", "speciesIndex"),
         "velocity": ("v", "velocity", "Velocity", "linVelVec", "vel", "velo", "velocities", "velocity_m_s"),
         "omega": ("omega", "angVelVec", "AngularVelocity", "angular_velocity", "omega_rad_s")}
QUANTITIES = {"radius": "length", "diameter": "length", "id": "number", "type": "number", "velocity": "velocity", "omega": "rate"}
FORCES, ENDS = ("force_N", "force_N_m"), ("grain_i", "grain_or_wall_j")  # of drumlin export; of other files the description names them


def known_names(names, source):
    """{what an array is, a key of NAMES: its name} of those that matter; types do where some are walls."""
    found = {what: [name for name in known if name in names] for what, known in NAMES.items() if what != "type" or source["wall_types"]}
    return {what: names[0] for what, names in found.items() if names}


def _in_space(values, name, count, refuse, least=2):
    """Rows of three: of a plane x and y, or the one component of an angular velocity across it."""
    if values.ndim > 2 or len(values) != count:
        refuse(name, f"has the shape {values.shape}", f"{count} rows, as many as there are places")
    values = values.reshape(count, -1) if count else np.zeros((0, 3))
    width = values.shape[1]
    if not least <= width <= 3:
        refuse(name, f"has {width} components", "3, or 2 in a plane")
    return values if width == 3 else np.pad(values, ((0, 0), (2, 0) if width == 1 else (0, 1)))


def grain_columns(points, arrays, frames, refuse):
    """(number, columns) of grains at points (rows, 2 or 3), with arrays by their names, as a reader `frames` (frame.py) takes them. Points of an array `grain`
    below 0 are ends of contacts."""
    units, used = frames.units, known_names(arrays, frames.source)
    frames.unused |= arrays.keys() - set(used.values())
    points = np.asarray(points, float)
    count, kept = len(points), slice(None) if "grain" not in arrays else np.asarray(arrays["grain"]) >= 0
    places = _in_space(points, "places", count, refuse)[kept]
    columns = {axis: Column(places[:, k] * units.of("length"), "length") for k, axis in enumerate("xyz")}
    for what, name in used.items():
        values, kind = np.asarray(arrays[name], float), QUANTITIES[what]
        if what in ("velocity", "omega"):
            letter, values = "v_" if what == "velocity" else "omega_", _in_space(values, name, count, refuse, 1 if what == "omega" else 2)[kept]
            columns |= {letter + axis: Column(values[:, k] * units.of(kind), kind) for k, axis in enumerate("xyz")}
            continue
        if values.size != count:
            refuse(name, f"has the shape {values.shape}", f"{count} numbers, as many as there are places")
        values = values.reshape(count)[kept] * units.of(kind)
        columns.setdefault("radius" if what == "diameter" else what, Column(values / 2 if what == "diameter" else values, kind))
    return len(places), columns


def contact_columns(ends, arrays, source, units, refuse):
    """Columns of contacts between two ends (rows, 2), ids unless arrays hold them, with arrays of the lines: forces of several arrays are added. A normal
    points towards the body that the force acts on."""
    names = source["contact_forces"] or [name for name in FORCES if name in arrays]
    if not names:
        refuse("contacts", "which arrays are the force is not known: " + (", ".join(arrays) or "there are none"), "their names in contact_forces")

    def vectors(name):
        if name not in arrays or np.asarray(arrays[name]).reshape(len(ends), -1).shape[1] != 3:
            refuse(name, "is no array of vectors of the contacts", ", ".join(arrays))
        return np.asarray(arrays[name], float).reshape(len(ends), 3)

    ids = source["contact_ids"] or (ENDS if set(ENDS) <= arrays.keys() else ())
    if ids:
        for name in ids:
            if name not in arrays:
                refuse(name, "no such array of the contacts", ", ".join(arrays))
        ends = np.array([np.asarray(arrays[name], float) for name in ids]).T.reshape(-1, 2)
    ends = np.where(np.isin(ends, source["wall_ids"]), -1, ends).astype(float)
    if source["force_on"] == "second":
        ends = ends[:, ::-1]
    force = sum(vectors(name) for name in names) * force_unit(source | {"force_on": "first"}, units)
    columns = {"i": Column(ends[:, 0], "number"), "j": Column(ends[:, 1], "number")}
    columns |= {"f_" + axis: Column(force[:, k], "force") for k, axis in enumerate("xyz")}
    if "normal" in arrays:
        columns |= {"normal_" + axis: Column(vectors("normal")[:, k], "number") for k, axis in enumerate("xyz")}
    return len(ends), columns
