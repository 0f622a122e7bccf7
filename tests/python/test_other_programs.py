"""Files of other programs (tests/import/files): what is in them, the balance of forces that their programs printed, and what is refused."""

import gzip
import shutil
import weakref

import h5py
import numpy as np
import pytest
from conftest import SOURCES
from drumlin.errors import InputError
from drumlin.importing import frames
from drumlin.importing.grains import nearest_image
from drumlin.importing.h5md_files import unit_in_si
from drumlin.importing.run import Import

FILES = SOURCES / "tests" / "import" / "files"
SOURCE = {"columns": [], "plane": "xz", "wall_types": [], "contacts": [], "contact_ids": [], "contact_forces": [], "wall_ids": [], "force_on": "first"}
GRAINS = {"density_kg_m3": 1.0, "mean_diameter_m": 1.0, "may_change": False, "velocities": "given"}


def imported(grains, contacts=(), folder=FILES, dimensions=3, tables=None, **source):
    """(report, snapshots) in SI: d = 1 m, sqrt(d/g) = 1 s, density 1."""
    description = {"files": SOURCE | source, "dimensions": dimensions, "gravity": {"acceleration_m_s2": 1.0, "direction_deg": -90.0},
                   "grains": GRAINS} | (tables or {})
    found = Import(description, {"grains": [str(folder / name) for name in grains], "contacts": [str(folder / name) for name in contacts]})
    snapshots = list(found)
    return found.report, snapshots


def refusal(*words, **source):
    with pytest.raises(InputError) as refused:
        imported(*words, **source)
    return str(refused.value)


def forces_on_grains(s):
    """Sums of the contacts' forces, (grains, 3)."""
    force = np.array([s["contacts/force_" + axis] for axis in "xyz"]).T
    total = np.zeros((len(s["grains/x"]), 3))
    np.add.at(total, s["contacts/i"], force)
    inside = s["contacts/j"] >= 0
    np.add.at(total, s["contacts/j"][inside], -force[inside])
    return total


def vectors(s, name, axes="xyz"):
    return np.array([s[f"grains/{name}{axis}"] for axis in axes]).T


LIGGGHTS = {"step_s": 2e-6, "contact_ids": ["c_contacts[1]", "c_contacts[2]"], "contact_forces": [f"c_contacts[{k}]" for k in (4, 5, 6)]}
LAMMPS = {"contact_ids": ["c_pairs[1]", "c_pairs[2]"], "contact_forces": [f"c_forces[{k}]" for k in range(1, 7)]}
MASS = 2500 * np.pi / 6 * 0.002**3


def balance(s, rows, fields, share):
    """The forces that a dump of LAMMPS or LIGGGHTS prints, with the weight that is in them, to a share of the largest."""
    dumped = np.array([[float(row.split()[k]) for k in fields] for row in sorted(rows, key=lambda row: int(row.split()[0]))])
    weight = np.array([0, 0, -9.81 * MASS])
    np.testing.assert_allclose(forces_on_grains(s) + weight, dumped, atol=share * np.abs(dumped).max())


def test_liggghts_dumps_hold_the_forces_that_they_print():
    report, found = imported(["liggghts.dump"], ["liggghts.contacts"], **LIGGGHTS)
    assert (report.kind, report.snapshots, report.grains, report.with_spin) == ("lammps", 3, 5, True)
    rows = (FILES / "liggghts.dump").read_text(encoding="utf-8").splitlines()
    for k, s in enumerate(found):
        # Those of contacts are computed anew for the dump, with the velocities of the end of a step: at the start they are the same, in the middle of this
        # impact one that is about to end differs by a sixth.
        balance(s, rows[14 * k + 9:14 * k + 14], (8, 9, 10), (1e-8, 0.2, 0.01)[k])
        assert [s["period_x"], s["period_y"], s["period_z"], s["time"]] == pytest.approx([0.01, 0.01, 0, 1e-4 * k])
    across = (found[0]["contacts/i"] == 3) | (found[0]["contacts/j"] == 3)  # grain 4, at the seam
    assert across.sum() == 1 and abs(found[0]["contacts/normal_x"][across][0]) > 0.9


def test_lammps_dumps_of_a_tilted_box_hold_the_forces_that_they_print():
    report, found = imported(["lammps.dump.gz"], ["lammps.contacts"], **LAMMPS)
    with gzip.open(FILES / "lammps.dump.gz", "rt") as stream:
        rows = stream.read().splitlines()
    rows = [row for row in rows if len(row.split()) == 15]
    for k, s in enumerate(found):
        balance(s, rows[5 * k:5 * k + 5], (8, 9, 10), 1e-4)
        assert s["tilt_xy"] == pytest.approx(0.001) and s["period_x"] == pytest.approx(0.01)
    np.testing.assert_allclose(vectors(found[0], "")[0], [0.0021, 0.005, 0.01], rtol=1e-9)  # xs, ys, zs in the box
    other = LAMMPS | {"contact_forces": LAMMPS["contact_forces"][:3]}  # without the tangential part
    _, normal = imported(["lammps.dump.gz"], ["lammps.contacts"], **other)
    assert np.abs(forces_on_grains(normal[2]) - forces_on_grains(found[2])).max() > 1e-4


def test_mercury_tells_contacts_from_both_sides_and_walls_turned():
    report, (first, last) = imported(["mercury-plane.data"], ["mercury-plane.fstat"], dimensions=2, plane="xy", depth_m=1.0)
    assert (report.kind, report.contacts, first["grains/spin"].tolist()) == ("mercury", 2, [-3, 5, 0])  # the file has it clockwise
    assert last["grains/z"].tolist() == [0.00099, 0.00099, 0.008] and last["time"] == 0.01
    assert (first["contacts/i"].tolist(), first["contacts/j"].tolist()) == ([0, 0], [1, -1])
    n, t = (first["contacts/" + name] / first["time_step"] for name in ("impulse_n", "impulse_t"))
    np.testing.assert_allclose([n, t], [[2, 3], [0.5, 0.25]])  # tangent (n_z, -n_x): (0, 1) and (1, 0)
    report, (first, _) = imported(["mercury-space.data"], ["mercury-space.fstat"])
    np.testing.assert_allclose(forces_on_grains(first), [[0.25, 0.5, 1], [0, -0.5, 2], [0, 0, 0]])
    assert vectors(first, "omega_")[0].tolist() == [1, 2, 3] and first["contacts/normal_z"].tolist() == [-1, 1]
    walls = imported(["mercury-space.data"], ["mercury-space.fstat"], wall_types=[1])[1]
    assert len(walls[0]["grains/x"]) == 2


def test_mercury_names_images_across_a_period_by_ids_beyond_the_grains(tmp_path):
    """Grain 0 at one end of the box touches 1 at the other, and an image of the fixed grain 2. As BaseInteraction::writeToFStat tells it: each contact of two
    grains that move with an image from each side; that of an image that moves on a fixed grain, too, which says nothing new."""
    grain = "{} 0.5 {} 0 0 0 {} 0 0 0 0 0 0 {}\n".format
    (tmp_path / "a.data").write_text("3 0 0 0 0 10 1 3\n" + grain(0.3, 1.0, 0.5, 0) + grain(9.5, 1.0, 0.4, 0) + grain(9.7, 0.4, 0.4, 1), encoding="utf-8")
    contact = "0 {} {} 0 0 0 {} 0 {} 0 {} 0 {} 0 0 0\n".format
    off = np.sqrt(0.36 + 0.36)
    heading = "# 0 1\n# 0 0 0 10 1 3\n# 0.5 0.4 0 0 0 0\n"
    lines = contact(0, 3, 0.1, 2, 1, 0) + contact(1, 4, 0.1, 2, -1, 0) + contact(0, 5, 0.9 - off, 3, 0.6 / off, 0.6 / off)
    (tmp_path / "a.fstat").write_text(heading + lines + contact(4, 2, 0.9 - off, 3, 0.6 / off, 0.6 / off), encoding="utf-8")
    periods = {"tables": {"periodic_x": {"length_m": 10.0}}}
    _, (s,) = imported(["a.data"], ["a.fstat"], tmp_path, wall_types=[1], **periods)
    assert (s["contacts/i"].tolist(), s["contacts/j"].tolist()) == ([0, 0], [1, -1])
    np.testing.assert_allclose([s["contacts/force_" + axis] for axis in "xyz"], [[2, 3 * 0.6 / off], [0, 0], [0, 3 * 0.6 / off]], rtol=1e-9)
    assert "there is no grain 3, nor does a grain lie where its image would (allowed: periodic_x and periodic_y" in refusal(
        ["a.data"], ["a.fstat"], folder=tmp_path, wall_types=[1])


def test_yade_writes_text_and_vtk_with_the_forces_that_it_adds_up():
    pytest.importorskip("vtk")
    text = {"columns": ["v_x", "v_y", "v_z", "id"], "interval_s": 1e-3}
    contacts = {"contact_ids": ["first", "second"], "contact_forces": ["fn", "fs"], "wall_ids": [0], "force_on": "second"}
    report, found = imported(["yade-0.txt", "yade-1.txt"], ["yade-export-intrs-00000000.vtk", "yade-export-intrs-00000001.vtk"], **text, **contacts)
    assert (report.kind, report.contacts) == ("yade", 12)
    for k, s in enumerate(found):
        np.testing.assert_allclose(forces_on_grains(s), np.loadtxt(FILES / f"yade-forces-{k}.txt"), atol=2e-3)  # six digits of 100 N
        assert s["time"] == 1e-3 * k
    _, (first, second) = imported(["yade-spheres.100.vtu", "yade-spheres.200.vtu"], step_s=1e-5)
    np.testing.assert_allclose(vectors(second, ""), vectors(found[1], ""), atol=1e-6)
    np.testing.assert_allclose(vectors(second, "v_"), vectors(found[1], "v_"), rtol=1e-5, atol=1e-9)
    assert [first["time"], second["time"]] == pytest.approx([1e-3, 2e-3]) and second["grains/radius"].tolist() == [0.05] * 4
    assert "is no array of vectors" in refusal(["yade-0.txt", "yade-1.txt"], ["yade-export-intrs-00000000.vtk"], **text, **contacts | {"contact_forces": ["kn"]})


def packing(count, seed=0):
    random = np.random.default_rng(seed)
    return random.random((count, 3)), random.random((count, 3)), 0.1 + random.random(count)


def write_gsd(path, frames_, log=True):
    hoomd = pytest.importorskip("gsd.hoomd")
    with hoomd.open(name=str(path), mode="wb") as file:
        for k in range(frames_):
            places, speeds, radii = packing(6, k)
            frame = getattr(hoomd, "Frame", getattr(hoomd, "Snapshot", None))()
            frame.configuration.step, frame.configuration.box = 100 * k, [4, 4, 4, 0, 0.5, 0]
            frame.particles.N, frame.particles.position, frame.particles.velocity = 6, places, speeds
            frame.particles.diameter = 2 * packing(6)[2]
            if log:
                frame.bonds.N, frame.bonds.types, frame.bonds.group = 1, ["contact"], [[0, 1]]
                frame.log["bonds/force_N"] = [[1.0, 2.0, 3.0]] * np.sign(places[0] - places[1])
            file.append(frame)


def test_gsd_of_hoomd(tmp_path):
    write_gsd(tmp_path / "a.gsd", 3)
    report, found = imported(["a.gsd"], ["a.gsd"], tmp_path, step_s=0.5)
    np.testing.assert_allclose(vectors(found[1], ""), packing(6, 1)[0], rtol=1e-6)
    np.testing.assert_allclose(found[1]["grains/radius"], packing(6)[2], rtol=1e-6)
    assert (found[2]["time"], found[0]["tilt_xz"], found[0]["period_z"], report.contacts) == (100, 2, 4, 3)
    assert "frame 0: configuration/step: counts steps whose length is not known" in refusal(["a.gsd"], (), tmp_path)
    write_gsd(tmp_path / "b.gsd", 1, log=False)
    assert "HOOMD stores no contacts" in refusal(["a.gsd"], ["b.gsd"], tmp_path, step_s=0.5)


def write_vtkhdf(path, frames_, nan=False):
    """A series of VTKHDF as its document has it."""
    with h5py.File(path, "w") as file:
        root = file.create_group("VTKHDF")
        root.attrs["Version"], root.attrs["Type"] = (2, 0), np.bytes_("PolyData")
        steps = root.create_group("Steps")
        steps.attrs["NSteps"] = frames_
        steps["Values"], steps["PointOffsets"] = 0.5 * np.arange(frames_), 6 * np.arange(frames_)
        steps["NumberOfParts"], steps["PartOffsets"] = np.ones(frames_, int), np.arange(frames_)
        steps["PointDataOffsets/radius"], steps["PointDataOffsets/velocity"] = np.zeros(frames_, int), 6 * np.arange(frames_)
        root["NumberOfPoints"] = np.full(frames_, 6)
        places = np.concatenate([packing(6, k)[0] for k in range(frames_)])
        if nan:
            places[8, 1] = np.nan
        root["Points"], root["PointData/velocity"] = places, np.concatenate([packing(6, k)[1] for k in range(frames_)])
        root["PointData/radius"] = packing(6)[2]  # once for all


def test_series_of_vtkhdf(tmp_path):
    write_vtkhdf(tmp_path / "a.vtkhdf", 3)
    report, found = imported(["a.vtkhdf"], (), tmp_path)
    assert (report.kind, report.snapshots, found[2]["time"]) == ("vtkhdf", 3, 1.0)
    for k, s in enumerate(found):
        for name, values in (("", packing(6, k)[0]), ("v_", packing(6, k)[1])):
            np.testing.assert_array_equal(vectors(s, name), values)
        np.testing.assert_array_equal(s["grains/radius"], packing(6)[2])
    write_vtkhdf(tmp_path / "nan.vtkhdf", 3, nan=True)
    assert "nan.vtkhdf:frame 1, row 3: y: is nan (allowed: finite numbers)" in refusal(["nan.vtkhdf"], (), tmp_path)


def test_series_of_vtp(tmp_path):
    vtk = pytest.importorskip("vtk")
    from vtk.util.numpy_support import numpy_to_vtk
    for k in range(2):
        places, speeds, radii = packing(5, k)
        grid, points = vtk.vtkPolyData(), vtk.vtkPoints()
        points.SetData(numpy_to_vtk(places, deep=True))
        grid.SetPoints(points)
        for name, values in (("Velocity", speeds), ("Radius", packing(5)[2])):
            array = numpy_to_vtk(values, deep=True)
            array.SetName(name)
            grid.GetPointData().AddArray(array)
        writer = vtk.vtkXMLPolyDataWriter()
        writer.SetFileName(str(tmp_path / f"s{k}.vtp"))
        writer.SetInputData(grid)
        writer.Write()
    entries = "".join(f'<DataSet timestep="{0.25 * k}" file="s{k}.vtp"/>' for k in range(2))
    (tmp_path / "s.pvd").write_text(f'<?xml version="1.0"?><VTKFile type="Collection"><Collection>{entries}</Collection></VTKFile>', encoding="utf-8")
    for files, more in ((["s.pvd"], {}), (["s0.vtp", "s1.vtp"], {"interval_s": 0.25})):
        _, found = imported(files, (), tmp_path, **more)
        np.testing.assert_array_equal(vectors(found[1], "v_"), packing(5, 1)[1])
        assert found[1]["time"] == 0.25
    whole = (tmp_path / "s1.vtp").read_bytes()
    (tmp_path / "cut.vtp").write_bytes(whole[:len(whole) // 2])
    assert "cut.vtp" in refusal(["cut.vtp"], (), tmp_path, interval_s=1.0)
    report, found = imported(["s0.vtp", "s1.vtp", "cut.vtp"], (), tmp_path, interval_s=1.0)
    assert len(found) == 2 and "cut.vtp" in report.left_out[0]
    assert "has no time" in refusal(["s0.vtp"], (), tmp_path)


def require_free_flight(snapshots, distances):
    """Of grains that fly freely, whose distances at the end another program told in m, across the border of its box."""
    first, last = snapshots[0], snapshots[-1]
    for s in snapshots:
        moved = (s["time"] - first["time"]) * vectors(first, "v_")
        np.testing.assert_allclose(vectors(s, ""), vectors(first, "") + moved, rtol=1e-5, atol=1e-6 * distances.max())
    apart = vectors(last, "")[:, None] - vectors(last, "")
    for i, j in np.ndindex(distances.shape):
        # The nearest image of a tilted box may be the next one but one.
        shortest = min(np.linalg.norm(nearest_image(last, "xyz", apart[i, j].copy()) + [k * last["period_x"] + m * last["tilt_xy"], m * last["period_y"], 0])
                       for k in (-1, 0, 1) for m in (-1, 0, 1))
        assert shortest == pytest.approx(distances[i, j], rel=1e-5, abs=1e-6 * distances.max())


def test_extended_xyz_of_ase(tmp_path):
    report, found = imported(["ase.xyz"], length_unit_m=1e-3)
    assert (report.kind, report.snapshots, report.with_spin, report.unused_columns) == ("xyz", 3, True, ["shade", "species"])
    require_free_flight(found, 1e-3 * np.loadtxt(FILES / "ase-distances.txt"))
    assert [found[2][name] for name in ("time", "period_x", "period_y", "period_z", "tilt_xy")] == pytest.approx([1.0, 0.01, 0.009, 0, 0.002])
    row = (FILES / "ase.xyz").read_text(encoding="utf-8").splitlines()[4].split()  # of id 1
    assert row[4] == "1" and [1e3 * found[0]["grains/radius"][0], *vectors(found[0], "omega_")[0]] == pytest.approx([float(word) for word in row[8:12]])
    with gzip.open(tmp_path / "f.gz", "wb") as stream:
        stream.write((FILES / "ase.xyz").read_bytes())
    np.testing.assert_array_equal(vectors(imported(["f.gz"], (), tmp_path, length_unit_m=1e-3)[1][1], ""), vectors(found[1], ""))
    assert "ase.xyz: contacts: there are none in files of the format xyz" in refusal(["ase.xyz"], ["ase.xyz"])


def test_headings_of_extended_xyz(tmp_path):
    def written(head, rows="1 0 0 0 1 2 3 0.5\n"):
        (tmp_path / "f").write_text(f"1\n{head}\n{rows}", encoding="utf-8")
        return "f"

    properties = "Properties=type:I:1:pos:R:3:vel:R:3:Radius:R:1 "
    for head, source in ((properties + "step=4", {"step_s": 0.25}), (properties + "Time=1", {}), ("Timestep=2 time='1'  " + properties, {"step_s": 9.0})):
        _, (s,) = imported([written(head)], (), tmp_path, **source)
        assert (s["time"], s["period_x"], vectors(s, "v_").tolist()) == (1, 0, [[1, 2, 3]])
    lattice = 'Time=0 Lattice="2 0 0 0 2 0 0 0 2" '
    assert imported([written(lattice + properties)], (), tmp_path)[1][0]["period_z"] == 2  # periodic where it does not say
    assert imported([written(lattice + "pbc=[F,F,F] " + properties)], (), tmp_path)[1][0]["period_z"] == 0
    assert imported([written("Time=0 " + properties)], (), tmp_path, wall_types=[2])[1][0]["grains/radius"] == 0.5
    for head, message in {properties: "f:2: has no time (allowed: Time or Step, or files.interval_s",
                          properties + "Step=1": "Step: counts steps whose length is not known",
                          "Time=0 Properties=pos:R": 'Properties: is "pos:R"', "Time=0 Properties=x:R:8": "names no pos",
                          "Time=0 Properties=pos:R:3:pos:R:5": "names pos twice", "Time=0 Properties=type:I:1:pos:R:3:vel:R:4": "vel: has 4 components",
                          "Time=0 Properties=type:I:1:pos:R:3:vel:R:3:size:R:1": "radius: no such column among type, pos, vel, size",
                          lattice.replace("0 0 0 2", "0 1 0 2") + properties: "Lattice: has the edges", "Time=x " + properties: 'time: "x" is no number',
                          lattice + "pbc=yes " + properties: 'pbc: is "yes"', lattice.replace(" 0 2", "") + properties: "Lattice: holds 5 numbers"}.items():
        assert message in refusal([written(head)], (), tmp_path), head


def test_h5md_of_mdanalysis(tmp_path):
    (tmp_path / "m.h5").write_bytes(gzip.decompress((FILES / "mdanalysis.h5md.gz").read_bytes()))
    report, found = imported(["m.h5"], (), tmp_path)
    assert (report.kind, report.snapshots, report.with_spin) == ("h5md", 3, False)
    require_free_flight(found, np.loadtxt(FILES / "mdanalysis-distances.txt"))
    assert [found[2][name] for name in ("time", "period_x", "tilt_xy")] == pytest.approx([20e-12, 10e-9, 3.0781813e-9], rel=1e-7)
    np.testing.assert_allclose(found[1]["grains/radius"], 1e-9 * np.linspace(1, 2, 5))
    assert "edges/value: has the unit \"nm\", which length_unit_m of the description contradict" in refusal(["m.h5"], (), tmp_path, length_unit_m=1e-3)
    assert len(imported(["m.h5"], (), tmp_path, length_unit_m=1e-9)[1]) == 3


def write_h5md(path, frames_):
    """By its document, version 1.1."""
    with h5py.File(path, "w") as file:
        file.create_group("h5md").attrs["version"] = (1, 1)
        group = file.create_group("particles/grains")
        box = group.create_group("box")
        box.attrs["dimension"], box.attrs["boundary"] = 3, [b"periodic", b"none", b"none"]
        box["edges"] = np.array([2.0, 1.0, 1.0])
        for k, name in enumerate(("position/value", "velocity/value")):
            group[name] = np.array([packing(6, number)[k] for number in range(frames_)])
        group["position/step"], group["position/time"] = 10 * np.arange(frames_), 0.5 * np.arange(frames_)
        group["velocity/step"], group["velocity/time"] = group["position/step"], group["position/time"]
        group["radii"] = packing(6)[2]


def test_h5md_by_its_document(tmp_path):
    path = tmp_path / "a.h5"

    def changed(change, *words, **source):
        write_h5md(path, 5)
        with h5py.File(path, "a") as file:
            change(file["particles/grains"], *words)
        return imported(["a.h5"], (), tmp_path, **source)[1]

    def each_second(group):  # as LAMMPS does: position velocity every 2
        group["velocity/value_"] = group["velocity/value"][::2]
        del group["velocity/value"], group["velocity/step"], group["velocity/time"]
        group["velocity/value"], group["velocity/step"] = group["velocity/value_"], [0, 20, 40]

    found = changed(each_second)
    assert [s["time"] for s in found] == [0, 1, 2] and found[0]["period_x"] == 2 and found[0]["period_y"] == 0
    for s, k in zip(found, (0, 2, 4)):
        for name, values in (("", packing(6, k)[0]), ("v_", packing(6, k)[1])):
            np.testing.assert_array_equal(vectors(s, name), values)
        np.testing.assert_array_equal(s["grains/radius"], packing(6)[2])

    def equally_spaced(group):
        del group["position/step"], group["position/time"], group["velocity"]
        group["position/step"] = 20
        group["position/step"].attrs["offset"] = 100

    with pytest.raises(InputError, match="v_x: no such column"):
        changed(equally_spaced, step_s=0.1)
    found = changed(equally_spaced, step_s=0.1, tables={"grains": GRAINS | {"velocities": "displacements"}})
    assert [s["time"] for s in found] == pytest.approx([12, 14, 16, 18])

    def images_and_gaps(group):
        """Grain 2 has left the box twice; the last place is not taken at the end."""
        group["image"] = np.array([[0, 7, 7]] * 2 + [[-2, 7, 7]] + [[0, 0, 0]] * 3)
        group.create_dataset("id/value", data=[[5, 4, 3, 2, 1, 0]] * 4 + [[5, 4, 3, 2, 1, -1]], fillvalue=-1)
        group["id/step"] = group["position/step"]

    found = changed(images_and_gaps, tables={"grains": GRAINS | {"may_change": True}})
    assert [len(s["grains/x"]) for s in found] == [6, 6, 6, 6, 5]
    np.testing.assert_array_equal(vectors(found[0], "")[::-1], packing(6)[0] + np.outer(np.arange(6) == 2, [-4, 0, 0]))

    def in_a_plane(group):
        for name in ("position", "velocity"):
            values = group[name + "/value"][..., :2]
            del group[name + "/value"]
            group[name + "/value"] = values
        del group["box/edges"]
        group["box"].attrs["boundary"], group["omega"] = [b"none", b"none"], np.arange(6.0)

    found = changed(in_a_plane, dimensions=2, plane="xy")
    assert found[0]["grains/spin"].tolist() == [0, -1, -2, -3, -4, -5]
    np.testing.assert_array_equal(vectors(found[1], "", "xz"), packing(6, 1)[0][:, :2])

    def doubled_then_not_a_number(group):
        for name in ("position/step", "position/time", "position/value", "velocity/value"):
            group[name][2] = group[name][1]
        group["position/value"][3, 2, 1] = np.nan

    with pytest.raises(InputError, match="a.h5:frame 3, row 3: y: is nan"):
        changed(doubled_then_not_a_number)
    with h5py.File(path, "a") as file:
        file["particles/grains/position/value"][3, 2, 1] = 0.5
    report, found = imported(["a.h5"], (), tmp_path)
    assert len(found) == 4 and report.left_out == [f"{path}:frame 2: is the snapshot before once more"]

    def other_unit(group, name, unit):
        group[name].attrs["unit"] = unit

    assert changed(other_unit, "position/time", "60 s")[1]["time"] == 30
    assert changed(other_unit, "radii", "cm")[0]["grains/radius"][0] == pytest.approx(0.01 * packing(6)[2][0])
    for (name, unit), message in {("position/time", "AKMA"): '/position/time: has the unit "AKMA" (allowed: one of a time',
                                  ("radii", "s"): "one of a length", ("radii", "m 1e99"): "one of a length", ("radii", "0-1 m"): "cannot be read"}.items():
        with pytest.raises(InputError) as refused:
            changed(other_unit, name, unit)
        assert message in str(refused.value)

    def shorter(group):
        group["velocity/value_"] = group["velocity/value"][:3]
        group["velocity/step_"] = group["velocity/step"][:3]
        for name in ("value", "step"):
            del group["velocity/" + name]
            group.move(f"velocity/{name}_", f"velocity/{name}")

    assert len(changed(shorter)) == 3
    report, _ = imported(["a.h5"], (), tmp_path)
    assert report.left_out == [f"{path}:frame 3: is cut off"]


def test_units_of_h5md():
    for text, value, powers in (("nm ps-1", 1e3, (1, -1)), ("60 s", 60, (0, 1)), ("10+3 m", 1e3, (1, 0)), ("um+2 s-1", 1e-12, (2, -1)),
                                ("degree s-1", np.pi / 180, (0, -1)), ("Angstrom", 1e-10, (1, 0)), ("dam", 10, (1, 0)), ("kHz", 1e3, (0, -1))):
        found, dimension = unit_in_si(text)
        assert found == pytest.approx(value, rel=1e-12) and dimension == powers, text
    assert unit_in_si("AKMA") is None and unit_in_si("nm/ps") is None


TEXT = {"liggghts.dump": LIGGGHTS, "mercury-space.data": {}, "mercury-plane.data": {"dimensions": 2, "plane": "xy"}, "ase.xyz": {}}
LAST_FRAME = {"liggghts.dump": "ITEM: TIMESTEP", "ase.xyz": "5\nLattice"}


@pytest.mark.parametrize("name", TEXT)
def test_frames_cut_off_doubled_or_not_a_number(tmp_path, name):
    whole, source = (FILES / name).read_text(encoding="utf-8"), TEXT[name]
    (tmp_path / "f").write_text(whole[:-9], encoding="utf-8")
    report, found = imported(["f"], (), tmp_path, **source)
    assert len(report.left_out) == 1 and "f:" in report.left_out[0] and "is cut off" in report.left_out[0], report
    (tmp_path / "f").write_text(whole[:len(whole) // 8], encoding="utf-8")
    assert "f:" in refusal(["f"], (), tmp_path, **source)
    begin = whole.rindex(LAST_FRAME.get(name, "3 0.01"))
    (tmp_path / "f").write_text(whole + whole[begin:], encoding="utf-8")
    report, twice = imported(["f"], (), tmp_path, **source)
    assert len(twice) == len(found) + 1 and "once more" in report.left_out[0]
    words = whole.split(" ")
    place = next(k for k in range(len(words) - 5, 0, -1) if "." in words[k] and "\n" not in words[k])
    (tmp_path / "f").write_text(" ".join([*words[:place], "nan", *words[place + 1:]]), encoding="utf-8")
    assert '"nan" is no number' in refusal(["f"], (), tmp_path, **source)


@pytest.mark.parametrize("name, write", [("a.gsd", write_gsd), ("a.vtkhdf", write_vtkhdf), ("a.h5", write_h5md)])
def test_binary_files_that_are_cut_off(tmp_path, name, write):
    write(tmp_path / name, 3)
    whole = (tmp_path / name).read_bytes()
    (tmp_path / name).write_bytes(whole[:len(whole) // 2])
    assert name in refusal([name], (), tmp_path, step_s=1.0)
    write(tmp_path / "b", 3)
    report, found = imported(["b", name], (), tmp_path, step_s=1.0)
    assert len(found) == 3 and name in report.left_out[0] and "is cut off" in report.left_out[0]


def test_files_in_other_units_or_formats_are_refused(tmp_path):
    shutil.copy(FILES / "mercury-space.data", tmp_path / "a")
    millimetres = (tmp_path / "a").read_text(encoding="utf-8").split("3 0.01", 1)[1].replace("0.001 0 0 0", "1 0 0 0")
    (tmp_path / "b").write_text("3 0.02" + millimetres, encoding="utf-8")
    assert "b:2: radius: the mean is 1, in the snapshot before 0.001 (allowed: one unit" in refusal(["a", "b"], (), tmp_path).replace("b:1", "b:2")
    (tmp_path / "c").write_bytes((FILES / "liggghts.dump").read_bytes())
    assert "c: is of the format lammps" in refusal(["a", "c"], (), tmp_path)
    (tmp_path / "d").write_bytes(b"\x7fELF" + bytes(100))
    assert "d: is of no format that is known" in refusal(["d"], (), tmp_path)


def test_every_format_is_told_by_its_first_bytes(tmp_path):
    write_vtkhdf(tmp_path / "a.vtkhdf", 1)
    write_h5md(tmp_path / "a.h5", 1)
    for name, kind in {"liggghts.dump": "lammps", "lammps.dump.gz": "lammps", "liggghts.contacts": "lammps", "yade-0.txt": "yade", "mercury-plane.data":
                       "mercury", "mercury-space.data": "mercury", "mercury-plane.fstat": "mercury-fstat", "yade-spheres.100.vtu": "vtk",
                       "yade-export-intrs-00000000.vtk": "vtk", tmp_path / "a.vtkhdf": "vtkhdf", tmp_path / "a.h5": "h5md", "ase.xyz": "xyz"}.items():
        assert frames.format_of(FILES / name).name == kind
    (tmp_path / "t.csv").write_text("# a comment\ntime_s,x_m,z_m\n0,1,2\n", encoding="utf-8")
    assert frames.format_of(tmp_path / "t.csv").name == "csv"


def test_at_most_a_few_frames_live_at_a_time(tmp_path):
    """Of any number: those of two instants and of their contacts."""
    heading = (FILES / "mercury-space.data").read_text(encoding="utf-8").split("\n", 1)[1].split("3 0.01")[0]
    contacts = (FILES / "mercury-space.fstat").read_text(encoding="utf-8").split("\n", 3)[3].split("# 0.01")[0]
    count = 60
    (tmp_path / "d").write_text("".join(f"3 {k} 0 0 0 1 1 1\n{heading}" for k in range(count)), encoding="utf-8")
    (tmp_path / "f").write_text("".join(f"# {k} 1\n# 0 0 0 1 1 1\n# 1 1 0 0 0 0\n{contacts}" for k in range(count)), encoding="utf-8")
    description = {"files": SOURCE, "dimensions": 3, "gravity": {"acceleration_m_s2": 1.0, "direction_deg": -90.0},
                   "grains": GRAINS}
    found = Import(description, {"grains": [str(tmp_path / "d")], "contacts": [str(tmp_path / "f")]})
    seen, most = [], 0

    def watched(source):
        for frame in source:
            seen.append(weakref.ref(frame))
            yield frame

    found.frames.frames_of = (lambda own: lambda text: watched(own(text)))(found.frames.frames_of)
    found.contact_frames.frames_of = (lambda own: lambda text: watched(own(text)))(found.contact_frames.frames_of)
    for _ in found:
        most = max(most, sum(frame() is not None for frame in seen))
    assert found.report.snapshots == count and most <= 6
