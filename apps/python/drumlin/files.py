"""Every file of the project into numpy: runs, snapshots, profiles, maps, laws, flows, comparisons."""

import json
import os
import pathlib
import tomllib

import numpy as np
import scipy.sparse

from . import _drumlin
from .errors import DrumlinError, InputError, IoError
from .figures import quantity_table, result_files
from .inputs import file_name, require_file


SNAPSHOT_FORMAT = "drumlin-snapshot-1"
# Unit and meaning of what a snapshot holds; other files take theirs from docs/formats/quantities.md.
SNAPSHOT = {"x": ("d", "centres"), "z": ("d", "centres"), "v_x": ("sqrt(g d)", ""), "v_z": ("sqrt(g d)", ""), "spin": ("sqrt(g/d)", "clockwise"), "radius": ("d", ""),
            "mass": ("rho0 d^2", ""), "displacement_x": ("d", "over the window"), "displacement_z": ("d", "over the window"), "time": ("sqrt(d/g)", ""),
            "window": ("sqrt(d/g)", "of the displacements"), "gravity": ("g", "along x and z"), "period": ("d", "0: none"), "i": ("", "grains in contact"),
            "j": ("", "grains in contact; below 0: wall shape -1 - j"), "normal": ("", "from j to i"), "force_n": ("rho0 g d^2", "on i along the normal"),
            "force_t": ("rho0 g d^2", "on i along (n_z, -n_x)"), "force": ("rho0 g d^2", "on i along x and z"), "scales": ("", "in SI")}


class Arrays(dict):
    """Numbers and arrays of a file by name, table["v_x"] or table.v_x, in the units of its page in docs/formats: (rows,) of a table, (z, x) of maps,
    (grains,) and (contacts,) or (contacts, 2) of a snapshot. `format`, `header` (texts by name) and `path` say what it is.

    >>> profile = drumlin.read("RUN/measured/profiles.csv")
    >>> profile.z, profile.v_x, profile.v_x_ci99
    """

    def __init__(self, values, path, form="", header=None):
        super().__init__(values)
        self.path, self.format, self.header = pathlib.Path(path), form, header or {}

    def __missing__(self, name):
        raise KeyError(f"{self.path}: holds no {name} (it holds {', '.join(self)})")

    def __getattr__(self, name):
        if name.startswith("__") or name == "path":  # asked for by copies, before there is anything
            raise AttributeError(name)
        try:
            return self[name]
        except KeyError as error:
            raise AttributeError(error.args[0]) from None

    def __dir__(self):
        return [*super().__dir__(), *(name for name in self if name.isidentifier())]

    def to_frame(self):
        """A pandas.DataFrame of the columns of a table: one-dimensional arrays of one length."""
        import pandas  # pylint: disable=import-outside-toplevel  # of those who ask for it

        length = max((np.size(values) for values in self.values() if np.ndim(values) == 1), default=0)
        return pandas.DataFrame({name: values for name, values in self.items() if np.ndim(values) == 1 and np.size(values) == length})

    def __repr__(self):
        """A line for each entry: name, shape, unit and meaning as far as docs/formats says them."""
        lines = [f"<{self.format or self.path.suffix[1:]} of {self.path}"]
        for name, value in self.items():
            outer, of_interval = name.removesuffix("_ci99"), name.endswith("_ci99")
            quantity = quantity_table.SCALARS.get(outer) or quantity_table.field(outer)
            unit, meaning = SNAPSHOT.get(name, ("", "")) if self.format == SNAPSHOT_FORMAT else (quantity.unit, quantity.meaning)
            unit, meaning = "" if unit == "1" else unit, "99 % half width" if of_interval else meaning
            shape = str(np.shape(value)) if np.shape(value) else str(value)
            lines.append(f"  {name:24} {' '.join(shape.split())[:28]:14} {unit:12} {meaning}".rstrip())
        return "\n".join(lines) + ">"


class Folder:
    """A folder of results: its files are read when they are asked for, folder["log.csv"], folder["measured/maps.h5"]; `path` is where it lies.

    >>> run = drumlin.read("RUN")
    >>> run["log.csv"].residual.mean(), run.snapshots[-1]
    """

    def __init__(self, path):
        self.path = pathlib.Path(path)

    @property
    def files(self) -> list[str]:
        """Names of all files that can be read, a list of texts."""
        return [str(file.relative_to(self.path)) for file in sorted(self.path.rglob("*")) if file.is_file() and file.suffix in READERS]

    @property
    def snapshots(self) -> list[pathlib.Path]:
        """Paths of the snapshots of a run, a list in order of time."""
        return sorted((self.path / "snapshots").glob("*.h5"))

    def is_complete(self):
        """Whether its manifest says so, and all that it lists is there with its size."""
        try:
            lines = (self.path / "manifest.txt").read_text(encoding="utf-8").splitlines()
            sizes = [int(line.removeprefix("# bytes = ").split(",")[0]) for line in lines if line.startswith("# bytes = ")]
            files = [line[66:] for line in lines if not line.startswith("#")]
            return "# state = complete" in lines and all((self.path / name).stat().st_size >= size for name, size in zip(files, sizes, strict=True))
        except (OSError, ValueError):
            return False

    def __getitem__(self, name):
        if name not in self and not (self.path / name).is_dir():
            raise IoError(f"{self.path}: holds no {name} (it holds {', '.join(self.files)})")
        return read(self.path / name)

    def __contains__(self, name):
        return (self.path / name).is_file()

    def __repr__(self):
        """The files, those of a folder with many in one line."""
        folders: dict = {}
        for name in self.files:
            folders.setdefault(os.path.dirname(name), []).append(os.path.basename(name))
        lines = [f"  {os.path.join(folder, names[0])} ... {names[-1]} ({len(names)})" if len(names) > 8 else f"  {os.path.join(folder, name)}"
                 for folder, names in folders.items() for name in (names if len(names) <= 8 else names[:1])]
        return "\n".join([f"<results in {self.path}: {len(self.files)} files", *lines]) + ">"


def _is_number(entry):
    value = entry.get("value", "") if isinstance(entry, dict) else entry
    return value is None or (isinstance(value, (int, float)) and not isinstance(value, bool))


def value_of(content, name):
    """(value, half width of its 99 % interval) of a number of a JSON file that was read, in the units of its page in docs/formats; NaN for what was not
    measured. KeyError for what it does not know.

    >>> theta, half_width = drumlin.value_of(run["measured/measured.json"], "theta_deg")
    """
    if name not in content:
        known = [key for key, entry in content.items() if _is_number(entry)]
        raise KeyError(f"{name}: is no number of this file (allowed: {', '.join(known)})")
    entry = content[name]
    value, half = (entry.get("value"), entry.get("ci99")) if isinstance(entry, dict) else (entry, None)
    return tuple(np.nan if number is None else number for number in (value, half))


def _read_csv(path):
    form, header, columns = result_files.read_table(path)
    return Arrays(columns, path, form, header)


def _read_json(path):
    return json.loads(path.read_text(encoding="utf-8"))


def _read_toml(path):
    return tomllib.loads(path.read_text(encoding="utf-8"))


def _contact_problem(arrays, path):
    _drumlin.check_contact_problem(file_name(path))  # scipy follows indices wherever they lead
    size = int(arrays["fclib_local/W/m"].reshape(-1)[0])
    p, i, x = (arrays["fclib_local/W/" + name].reshape(-1) for name in "pix")
    count = int(arrays["fclib_local/W/nz"].reshape(-1)[0])
    if count == -2:
        W = scipy.sparse.csr_matrix((x, i, p), (size, size))
    elif count == -1:
        W = scipy.sparse.csc_matrix((x, i, p), (size, size)).tocsr()
    else:
        W = scipy.sparse.coo_matrix((x[:count], (i[:count], p[:count])), (size, size)).tocsr()
    further = {name.removeprefix("drumlin/"): values for name, values in arrays.items() if name.startswith("drumlin/")}
    return Arrays({"W": W, "q": arrays["fclib_local/vectors/q"].reshape(-1), "mu": arrays["fclib_local/vectors/mu"].reshape(-1)} | further,
                  path, "contact problem")


def _read_hdf5(path):
    _drumlin.check_hdf5(file_name(path))
    form, arrays = result_files.read_arrays(path)
    if form == SNAPSHOT_FORMAT:
        return Arrays(result_files.read_snapshot(path), path, form)
    if form == "drumlin-maps-1":
        header, x, z, fields, half_widths = result_files.read_maps(path)
        return Arrays({"x": x, "z": z} | fields | {name + "_ci99": values for name, values in half_widths.items()}, path, form, header)
    if "fclib_local/W/m" in arrays:
        return _contact_problem(arrays, path)
    return Arrays({name.removeprefix("grains/").replace("/", "_"): values for name, values in arrays.items()}, path, form)


READERS = {".csv": _read_csv, ".json": _read_json, ".toml": _read_toml, ".h5": _read_hdf5}


def read(path):
    """A folder of results, or one file of it: tables, maps, snapshots and contact problems as arrays by name, JSON and TOML as dicts. docs/formats says what each
    holds, and in which units.

    >>> snapshot = drumlin.read(run.snapshots[-1])
    """
    path = pathlib.Path(os.fsdecode(file_name(path)))
    if path.is_dir():
        return Folder(path)
    require_file(path)
    if path.suffix not in READERS:
        raise InputError(f"{path}: no file of Drumlin's (allowed: a folder, {', '.join(READERS)})")
    try:
        return READERS[path.suffix](path)
    except DrumlinError:
        raise
    except MemoryError as error:
        raise IoError(f"{path}: not enough memory") from error
    except OSError as error:
        raise IoError(f"{path}: {error}") from error
    except Exception as error:  # what a file holds shows in whatever a reader trips over
        text = str(error)
        raise InputError(text if str(path) in text else f"{path}: {text}") from error
