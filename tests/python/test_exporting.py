"""Runs written for other programs, read back by readers that are not ours: those of gsd, vtk, h5py and LAMMPS, and by our imports."""

import math
import shutil
import subprocess

import h5py
import numpy as np
import pytest
from drumlin.exporting.command import WRITERS
from drumlin.exporting.instant import instant_of
from drumlin.hdf5 import write_hdf5
from test_other_programs import imported, vectors

COUNT, PERIOD = 40, 8.0


def snapshot(path, spheres, step):
    """Grains and contacts anywhere, two of them across the border and one at a wall."""
    random = np.random.default_rng(step)
    axes = "xyz" if spheres else "xz"
    content = {"format": "drumlin-spheres-1" if spheres else "drumlin-snapshot-1", "step": step, "time": 0.5 * step, "period_x": PERIOD, "gravity_x": 0.0,
               "gravity_z": -1.0, "scales/length_m": 0.002, "scales/time_s": math.sqrt(0.002 / 9.81), "scales/density_kg_m3": 2500.0}
    places = random.random((COUNT, len(axes))) * PERIOD
    places[:2, 0] = 0.1, PERIOD - 0.3
    places[:2, 1:] = 4.0
    radius = 0.5 + 0.1 * np.random.default_rng(1).random(COUNT)
    i, j = np.array([1, 2, 3, 5]), np.array([0, 4, -1, 6])
    normal = random.normal(size=(4, len(axes)))
    normal[0] = np.array([-1.0, 0.0, 0.0])[:len(axes)]
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    if spheres:
        content |= {"period_y": PERIOD, "period_z": 0.0, "tilt_xy": 0.0, "tilt_xz": 0.0, "tilt_yz": 0.0}
        content |= {f"contacts/force_{axis}": random.normal(size=4) + 3 * normal[:, k] for k, axis in enumerate(axes)}
        content |= {f"grains/omega_{axis}": random.normal(size=COUNT) for axis in axes}
    else:
        content |= {"time_step": 0.01, "velocity_window": 0.0, "contacts/impulse_n": 3 * random.random(4), "contacts/impulse_t": random.normal(size=4),
                    "grains/spin": random.normal(size=COUNT)}
    content |= {"grains/radius": radius, "contacts/i": i.astype("i4"), "contacts/j": j.astype("i4")}
    for k, axis in enumerate(axes):
        content |= {"grains/" + axis: places[:, k], "grains/v_" + axis: random.normal(size=COUNT), "contacts/normal_" + axis: normal[:, k].astype("f4")}
    write_hdf5(path, content)


@pytest.fixture(params=[False, True], ids=["discs", "spheres"])
def run(request, tmp_path):
    """(whether of spheres, folder, instants)"""
    files = [tmp_path / f"{step:06}.h5" for step in (1, 2, 3)]
    for step, path in enumerate(files, 1):
        snapshot(path, request.param, step)
    return request.param, tmp_path, [instant_of(path) for path in files]


def written(kind, folder, instants):
    writer = WRITERS[kind](folder)
    for instant in instants:
        writer.add(instant)
    writer.close()
    return folder / writer.finished


def read_back(spheres, folder, grains, contacts=(), **source):
    _, found = imported(grains, contacts, folder, 3 if spheres else 2, tables=None if spheres else {"periodic_x": {"length_m": PERIOD * 0.002}}, plane="xy",
                        **source | ({} if spheres else {"depth_m": 1.0}))
    return found


def require_same(s, instant, spheres, rtol):
    """Of our own import; all contacts but those that a format cannot hold."""
    axes = "xyz" if spheres else "xz"
    columns = [0, 1, 2] if spheres else [0, 1]
    np.testing.assert_allclose(vectors(s, "", axes), instant.place[:, columns], rtol=0, atol=rtol * PERIOD * 0.002)
    np.testing.assert_allclose(vectors(s, "v_", axes), instant.velocity[:, columns], rtol=rtol, atol=rtol)
    np.testing.assert_allclose(s["grains/radius"], instant.radius, rtol=rtol)
    spin = vectors(s, "omega_") if spheres else -s["grains/spin"]
    np.testing.assert_allclose(spin, instant.omega if spheres else instant.omega[:, 2], rtol=rtol, atol=rtol)
    assert s["time"] == pytest.approx(instant.time, rel=1e-9)


def forces_of(s, spheres):
    if spheres:
        return np.array([s["contacts/force_" + axis] for axis in "xyz"]).T
    n, t = (s["contacts/" + name][:, None] / s["time_step"] for name in ("impulse_n", "impulse_t"))
    normal = np.array([s["contacts/normal_" + axis] for axis in "xz"]).T.astype(float)
    return np.column_stack([n * normal + t * normal[:, ::-1] * [1, -1], np.zeros(len(n))])


def require_same_contacts(s, instant, spheres, rtol, rows=slice(None)):
    assert s["contacts/i"].tolist() == instant.i[rows].tolist() and s["contacts/j"].tolist() == instant.j[rows].tolist()
    np.testing.assert_allclose(forces_of(s, spheres), instant.force[rows], rtol=rtol, atol=rtol * np.abs(instant.force).max())


def test_dumps_of_lammps(run):
    spheres, folder, instants = run
    written("lammps", folder, instants)
    for s, instant in zip(read_back(spheres, folder, ["grains.dump"], ["contacts.dump"]), instants):
        require_same(s, instant, spheres, 1e-8)
        require_same_contacts(s, instant, spheres, 1e-6)


@pytest.mark.skipif(not shutil.which("lmp"), reason="LAMMPS is not installed")
def test_lammps_reads_its_dump(run):
    spheres, folder, instants = run
    if not spheres:
        pytest.skip("its discs lie in a plane of their own")
    written("lammps", folder, instants)
    (folder / "in").write_text(f"""units si
atom_style sphere
boundary p p f
region box block 0 {PERIOD * 0.002} 0 {PERIOD * 0.002} -1 1
create_box 1 box
pair_style zero 0.01
pair_coeff * *
read_dump grains.dump {instants[1].step} x y z vx vy vz box no add yes format native
dump all all custom 1 again.dump id xu yu zu vx vy vz
dump_modify all sort id format float %.12g
run 0
""")
    done = subprocess.run(["lmp", "-in", "in"], cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout[-2000:]
    table = np.loadtxt((folder / "again.dump").read_text().splitlines()[9:])
    moved = (table[:, 1:4] - instants[1].place)[:, :2] / (PERIOD * 0.002)
    np.testing.assert_allclose(moved - np.round(moved), 0, atol=1e-6)
    np.testing.assert_allclose(table[:, 4:7], instants[1].velocity, rtol=1e-7, atol=1e-9)


def test_extended_xyz(run):
    """By the rule of its document: properties tell the columns."""
    spheres, folder, instants = run
    lines = written("xyz", folder, instants).read_text().splitlines()
    for k, instant in enumerate(instants):
        block = lines[k * (COUNT + 2):(k + 1) * (COUNT + 2)]
        assert int(block[0]) == COUNT and f"Time={instant.time:.16g}" in block[1] and 'pbc="T' in block[1]
        properties = block[1].split("Properties=")[1].split(":")
        assert properties[0::3] == ["species", "id", "pos", "velo", "radius", "angular_velocity"]
        table = np.array([row.split()[1:] for row in block[2:]], float)
        assert table.shape[1] + 1 == sum(int(width) for width in properties[2::3])
        np.testing.assert_allclose(table[:, 1:4], instant.place, rtol=1e-8, atol=1e-11)
        np.testing.assert_allclose(table[:, 4:8], np.column_stack([instant.velocity, instant.radius]), rtol=1e-8)
    for s, instant in zip(read_back(spheres, folder, ["run.xyz"]), instants):
        require_same(s, instant, spheres, 1e-8)
        assert [s["period_" + axis] for axis in ("xyz" if spheres else "x")] == pytest.approx(instant.period[:3 if spheres else 1])


def test_ase_reads_extended_xyz(run):
    ase = pytest.importorskip("ase.io")
    _, folder, instants = run
    frames = ase.read(written("xyz", folder, instants), index=":", format="extxyz")
    assert len(frames) == 3
    for frame, instant in zip(frames, instants):
        np.testing.assert_allclose(frame.positions, instant.place, rtol=1e-8, atol=1e-11)
        for name, values in (("velo", instant.velocity), ("radius", instant.radius), ("angular_velocity", instant.omega)):
            np.testing.assert_allclose(frame.arrays[name], values, rtol=1e-8, atol=1e-8)
        assert (frame.info["Time"], frame.pbc.tolist()) == (pytest.approx(instant.time), (instant.period > 0).tolist())


def test_gsd(run):
    hoomd = pytest.importorskip("gsd.hoomd")
    spheres, folder, instants = run
    with hoomd.open(name=str(written("gsd", folder, instants)), mode="rb") as trajectory:
        assert len(trajectory) == 3
        for frame, instant in zip(trajectory, instants):
            assert (frame.configuration.step, frame.configuration.dimensions, frame.particles.N) == (instant.step, 3 if spheres else 2, COUNT)
            assert frame.configuration.box[0] == pytest.approx(PERIOD * 0.002)
            assert np.abs(frame.particles.position).max(axis=0)[0] <= PERIOD * 0.001  # HOOMD takes no others
            np.testing.assert_allclose(frame.particles.velocity, instant.velocity, rtol=1e-6)
            np.testing.assert_allclose(frame.particles.diameter, 2 * instant.radius, rtol=1e-6)
            np.testing.assert_array_equal(frame.bonds.group, [[1, 0], [2, 4], [5, 6]])
            np.testing.assert_allclose(frame.log["bonds/force_N"], instant.force[[0, 1, 3]], rtol=1e-12)
    found = read_back(spheres, folder, ["run.gsd"], ["run.gsd"])
    for s, instant in zip(found, instants):
        require_same(s, instant, spheres, 1e-6) if spheres else np.testing.assert_allclose(vectors(s, "", "xz"), instant.place[:, :2], atol=1e-8)
        require_same_contacts(s, instant, spheres, 1e-6, [0, 1, 3])


def test_vtkhdf(run):
    spheres, folder, instants = run
    written("vtkhdf", folder, instants)
    for s, instant in zip(read_back(spheres, folder, ["run.vtkhdf"], ["run.vtkhdf"]), instants):
        require_same(s, instant, spheres, 1e-6)
        require_same_contacts(s, instant, spheres, 1e-6)
    with h5py.File(folder / "run.vtkhdf") as file:
        steps = file["VTKHDF/Steps"]
        assert steps.attrs["NSteps"] == 3 and steps["CellOffsets"].shape == (3, 4) and file["VTKHDF"].attrs["Type"] == b"PolyData"


def test_vtk_plays_the_series(run):
    vtk = pytest.importorskip("vtk")
    from vtk.util.numpy_support import vtk_to_numpy
    if vtk.vtkVersion().GetVTKMajorVersion() * 100 + vtk.vtkVersion().GetVTKMinorVersion() < 903:
        pytest.skip("VTK reads series of VTKHDF from 9.3 on")
    spheres, folder, instants = run
    reader = vtk.vtkHDFReader()
    reader.SetFileName(str(written("vtkhdf", folder, instants)))
    reader.UpdateInformation()
    assert reader.GetNumberOfSteps() == 3
    for k, instant in enumerate(instants):
        reader.SetStep(k)
        reader.Update()
        grid = reader.GetOutput()
        points = vtk_to_numpy(grid.GetPoints().GetData())
        arrays = {grid.GetPointData().GetArrayName(n): vtk_to_numpy(grid.GetPointData().GetArray(n)) for n in range(grid.GetPointData().GetNumberOfArrays())}
        cells = {grid.GetCellData().GetArrayName(n): vtk_to_numpy(grid.GetCellData().GetArray(n)) for n in range(grid.GetCellData().GetNumberOfArrays())}
        np.testing.assert_allclose(points[:COUNT], instant.place, atol=1e-7)
        np.testing.assert_allclose(arrays["velocity_m_s"][:COUNT], instant.velocity, rtol=1e-6)
        np.testing.assert_allclose(arrays["radius_m"][:COUNT], instant.radius, rtol=1e-6)
        assert (grid.GetNumberOfVerts(), grid.GetNumberOfLines(), grid.GetNumberOfCells()) == (COUNT, 4, COUNT + 4)
        np.testing.assert_array_equal(cells["grain_i"][COUNT:], instant.i)
        np.testing.assert_allclose(cells[instant.force_name][COUNT:], instant.force, rtol=1e-6)
        lines = vtk_to_numpy(grid.GetLines().GetConnectivityArray()).reshape(-1, 2)
        np.testing.assert_array_equal(lines[[1, 3]], [[2, 4], [5, 6]])
        np.testing.assert_allclose(np.linalg.norm(points[lines[0, 1]] - points[lines[0, 0]]), instant.radius[:2].sum(), rtol=1e-5)  # across the border
