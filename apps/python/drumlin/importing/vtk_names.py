"""The arrays of files of VTK by the names that programs give them."""

import numpy as np

from .frame import Column
from .units import force_unit

# Of docs/formats/import.md: Yade, LIGGGHTS, MercuryDPM, drumlin export.
NAMES = {"radius": ("radius", "radii", "Radius", "radius_m"), "diameter": ("diameter", "Diameter"), "id": ("id", "ID", "Id", "grain"),
         "type": ("type", "materialId", "speciesIndex"), "velocity": ("v", "velocity", "Velocity", "linVelVec", "vel", "velocity_m_s"),
         "omega": ("omega", "angVelVec", "AngularVelocity", "omega_rad_s")}
FORCES, ENDS = ("force_N", "force_N_m"), ("grain_i", "grain_or_wall_j")  # of drumlin export; of other files the description names them


def grain_columns(points, arrays, units, unused):
    """Columns of grains at points (rows, 3), with arrays by their names. Points of an array `grain` below 0 are ends of contacts."""
    found = {}
    for quantity, names in NAMES.items():
        name = next((name for name in names if name in arrays), None)
        if name is not None:
            found[quantity] = np.asarray(arrays[name], float)
    unused |= arrays.keys() - {name for names in NAMES.values() for name in names}
    kept = slice(None) if "grain" not in arrays else np.asarray(arrays["grain"]) >= 0
    points = np.asarray(points, float)[kept]
    columns = {axis: Column(points[:, k] * units.of("length"), "length") for k, axis in enumerate("xyz")}
    for quantity, values in found.items():
        values = values[kept]
        if quantity in ("velocity", "omega"):
            kind = "velocity" if quantity == "velocity" else "rate"
            columns |= {("v_" if quantity == "velocity" else "omega_") + axis: Column(values.reshape(-1, 3)[:, k] * units.of(kind), kind)
                        for k, axis in enumerate("xyz")}
        elif quantity == "diameter":
            columns.setdefault("radius", Column(values / 2 * units.of("length"), "length"))
        else:
            columns[quantity] = Column(values * (units.of("length") if quantity == "radius" else 1.0), "length" if quantity == "radius" else "number")
    return len(points), columns


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
