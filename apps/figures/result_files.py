"""Files of results as arrays: the one place where Python reads tables, maps and snapshots. The package `drumlin` and the figures use it.

What does not fit is DoesNotFit, a ValueError that names the file.
"""

import csv
import math

import h5py
import numpy as np


class DoesNotFit(ValueError):
    """A file that holds something else than it should: its text names the file."""

    exit_code = 2  # of a script, as of the commands


class Columns(dict):
    """Columns of a table by their names."""

    def __init__(self, path, values):
        super().__init__(values)
        self.path = path

    def __missing__(self, name):
        raise DoesNotFit(f"{self.path}: {name}: no such column (it has {', '.join(self)})")


def text_of(data):
    """The text of an HDF5 dataset: a string or, in older files, bytes."""
    return bytes(np.asarray(data[()]).reshape(-1)).decode().rstrip("\0")


def number_of(data):
    """The number of an HDF5 dataset: a scalar or, in older files, an array of one."""
    return data[()].item()


def read_table(path, kind=None):
    """(format, header, columns) of a CSV file: lines "# key = value", a line of names, rows. An empty field is NaN, a column of words an array of
    texts. Of a table that still grows the last line may be half there: it is dropped. `kind`: the format that the file must have."""
    with open(path, newline="", encoding="utf-8") as stream:
        try:
            text = stream.read()
        except ValueError as error:
            raise DoesNotFit(f"{path}: is no text in UTF-8: {error}") from error
    lines = text[:text.rfind("\n") + 1].splitlines()
    comments = [line[1:].strip() for line in lines if line.startswith("#")]
    found = comments[0] if comments and "=" not in comments[0] else ""
    if kind is not None and found != kind:
        raise DoesNotFit(f"{path}: is {found or 'a table without a format'} (allowed: {kind})")
    entries = [line.partition("=") for line in comments if "=" in line]
    rows = list(csv.reader(line for line in lines if line and not line.startswith("#")))
    names = [name.strip() for name in rows[0]] if rows else []
    if any(len(row) != len(names) for row in rows):
        raise DoesNotFit(f"{path}: a line has more or fewer fields than the line of names")

    def column(values):
        try:
            return np.array([float(value) if value.strip() else math.nan for value in values])
        except ValueError:
            return np.array(values)

    columns = Columns(path, {name: column([row[i] for row in rows[1:]]) for i, name in enumerate(names)})
    return found, {key.strip(): value.strip() for key, _, value in entries}, columns


def read_rows(path):
    """The rows of a table as {name of the column: number or text}."""
    columns = read_table(path)[2]
    return [dict(zip(columns, row)) for row in zip(*(column.tolist() for column in columns.values()))]


def read_maps(path, names=None, most_columns=None):
    """(header, x, z, fields, half widths of 99 % intervals): each field over (z, x), NaN where it was not computed. `names`: fields to read, all unless
    told; `most_columns`: of a wider map every second (third, ...) node along x and z is read, so that no more columns are left."""
    with h5py.File(path) as file:
        if text_of(file["format"]) != "drumlin-maps-1":
            raise DoesNotFit(f"{path}: is not a file of maps of this version")
        header = dict(line.split(" = ", 1) for line in text_of(file["header"]).splitlines())
        step = 1 if most_columns is None else max(1, math.ceil(file["x"].shape[0] / most_columns))

        def read(group):
            return {name: data[:] if step == 1 else data[:][::step, ::step] for name, data in group.items() if names is None or name in names}

        half_widths = read(file["ci99"]) if "ci99" in file else {}
        return header, file["x"][::step], file["z"][::step], read(file["fields"]), half_widths


def contact_forces(contacts, time_step):
    """Contacts of a step with their impulses as contacts with forces: i, j, normal (contacts, 2), force on i along it, along the tangent (n_z, -n_x), and
    as a vector (contacts, 2)."""
    normal = np.array([contacts["normal_x"], contacts["normal_z"]], float).T
    tangent = np.array([normal[:, 1], -normal[:, 0]]).T
    force_n, force_t = contacts["impulse_n"] / time_step, contacts["impulse_t"] / time_step
    return {"i": contacts["i"], "j": contacts["j"], "normal": normal, "force_n": force_n, "force_t": force_t,
            "force": force_n[:, None] * normal + force_t[:, None] * tangent}


def read_snapshot(path):
    """Numbers and arrays of a snapshot by name: grains, contacts with their forces, the frame. Units of the run: d, sqrt(d/g), rho0 d^2."""
    with h5py.File(path) as stored:
        result = {name: stored["grains/" + name][:] for name in stored["grains"]}
        result.update(time=number_of(stored["time"]), gravity=np.array([number_of(stored["gravity_x"]), number_of(stored["gravity_z"])]),
                      period=number_of(stored["period_x"]), window=number_of(stored["velocity_window"]))
        if "contacts" in stored:
            result.update(contact_forces({name: values[:] for name, values in stored["contacts"].items()}, number_of(stored["time_step"])))
        if "cell" in stored:
            result["cell"] = {name: number_of(stored["cell/" + name]) for name in stored["cell"]}
        if "walls/x" in stored:
            result["walls"] = np.array([stored["walls/x"][:], stored["walls/z"][:]]).T
        if "scales" in stored:
            result["scales"] = {name: number_of(stored["scales/" + name]) for name in stored["scales"]}
    # A stored mass stands for itself: a density of the grain's own.
    result.setdefault("mass", math.pi * result["radius"] ** 2)
    return result


def read_arrays(path):
    """Every dataset of an HDF5 file by its path, and the format of the file."""
    arrays = {}
    with h5py.File(path) as file:
        def add(name, entry):
            if isinstance(entry, h5py.Dataset):
                arrays[name] = text_of(entry) if entry.dtype.kind == "S" else entry[()]

        file.visititems(add)
        return (text_of(file["format"]) if "format" in file else ""), arrays
