"""run.vtkhdf, a series of PolyData that ParaView (5.12 on) plays."""

import h5py
import numpy as np

KINDS = ("Vertices", "Lines", "Polygons", "Strips")


class VtkhdfSeries:
    """A vertex per grain, a line per contact from the centre of i to that of j's nearest image or to the wall. Points that are ends of such lines alone have
    grain = -1 and radius 0. Cell data belong to the lines."""

    finished = "run.vtkhdf"

    def __init__(self, folder):
        self.file, self.steps = h5py.File(folder / "run.vtkhdf", "w"), 0
        root = self.root = self.file.create_group("VTKHDF", track_order=True)
        root.attrs["Version"] = np.array([2, 0], "i8")
        root.attrs.create("Type", b"PolyData", dtype=h5py.string_dtype("ascii", 8))
        self._append("NumberOfPoints", np.zeros(0, "i8"))
        root.create_group("Steps")

    def _append(self, name, values):
        """Returns how many rows were there."""
        values = np.asarray(values)
        if name not in self.root:
            self.root.create_dataset(name, data=values, maxshape=(None, *values.shape[1:]), chunks=(max(1024, min(len(values), 1 << 16)), *values.shape[1:]),
                                     compression="gzip", compression_opts=1, shuffle=True)
            return 0
        data = self.root[name]
        before = len(data)
        data.resize(before + len(values), axis=0)
        data[before:] = values
        return before

    def add(self, s):
        count, contacts = len(s.radius), len(s.i)
        across = s.place[s.i] + s.across()
        apart = np.where(s.j >= 0, np.abs(across - s.place[np.maximum(s.j, 0)]).max(axis=1, initial=0), np.inf) > s.radius[s.i] if contacts else np.zeros(0, bool)
        ends = np.where(apart, count + np.cumsum(apart) - 1, s.j)
        extra = int(apart.sum())
        places = np.concatenate([s.place, across[apart]])

        def padded(values, fill=0):
            return np.concatenate([values, np.full((extra, *values.shape[1:]), fill, values.dtype)])

        first = self._append("Points", places.astype("f4"))
        self._append("NumberOfPoints", [len(places)])
        cells = {"Vertices": (np.arange(count), np.arange(count + 1)), "Lines": (np.column_stack([s.i, ends]).reshape(-1), 2 * np.arange(contacts + 1)),
                 "Polygons": (np.zeros(0), np.zeros(1)), "Strips": (np.zeros(0), np.zeros(1))}
        ids = []
        for kind, (connectivity, offsets) in cells.items():
            ids.append(self._append(f"{kind}/Connectivity", connectivity.astype("i8")))
            self._append(f"{kind}/Offsets", offsets.astype("i8"))
            self._append(f"{kind}/NumberOfCells", [len(offsets) - 1])
            self._append(f"{kind}/NumberOfConnectivityIds", [len(connectivity)])
        points = {"radius_m": padded(s.radius), "velocity_m_s": padded(s.velocity), "grain": padded(np.arange(count, dtype="i4"), -1)}
        if s.omega is not None:
            points["omega_rad_s"] = padded(s.omega)
        lines = {"grain_i": s.i, "grain_or_wall_j": s.j, s.force_name: s.force, "normal": s.normal}
        of = {"PointData": points, "CellData": {name: np.concatenate([np.full((count, *values.shape[1:]), -1 if values.dtype.kind == "i" else 0, values.dtype),
                                                                      values]) for name, values in lines.items()}}
        steps = {"Values": [s.time], "PartOffsets": [self.steps], "NumberOfParts": [1], "PointOffsets": [first],
                 "CellOffsets": [[sum(self.root[f"{kind}/NumberOfCells"][:self.steps]) for kind in KINDS]], "ConnectivityIdOffsets": [ids]}
        for group, arrays in of.items():
            for name, values in arrays.items():
                steps[f"{group}Offsets/{name}"] = [self._append(f"{group}/{name}", values.astype("i4" if values.dtype.kind == "i" else "f4"))]
        for name, values in steps.items():
            self._append("Steps/" + name, np.asarray(values, "f8" if name == "Values" else "i8"))
        self.steps += 1
        self.root["Steps"].attrs["NSteps"] = self.steps

    def close(self):
        self.file.close()
