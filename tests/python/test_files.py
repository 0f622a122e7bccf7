"""Every kind of file into numpy."""

import pickle

import drumlin
import matplotlib.patches
import matplotlib.pyplot as plt
import numpy as np
import pytest


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    scene = tmp_path_factory.mktemp("run")
    drumlin.run(__import__("conftest").SOURCES / "tests/chain/tiny-drum.toml", scene / "RUN",
                {"stages.1.turns": 0.02, "stages.2.turns": 0.02, "stages.2.snapshots": 4})
    return drumlin.read(scene / "RUN")


def test_a_run_is_read(run):
    assert run["run.json"]["status"] == "finished" and run["scene.toml"]["reduced"] is True
    assert len(run.snapshots) == 4 and "log.csv" in run and "run.json" in run.files
    log = run["log.csv"]
    assert log.step[-1] == len(log["step"]) and log["stage"][0] == "settle"
    last = drumlin.read(run.snapshots[-1])
    assert last.format == "drumlin-snapshot-1" and last.x.shape == last.radius.shape == (350,)
    # Forces on a grain that rests cancel its weight; over all grains those of the walls carry what is not accelerated.
    assert last.force[last.j < 0].sum(axis=0)[1] == pytest.approx(last.mass.sum(), rel=0.5)
    for kind, work in ((AttributeError, lambda: last.vx), (KeyError, lambda: last["vx"])):
        with pytest.raises(kind, match="holds no vx .it holds .*v_x, "):
            work()
    with pytest.raises(drumlin.IoError, match="holds no log .it holds .*log.csv, "):
        run["log"]
    assert (pickle.loads(pickle.dumps(last)).x == last.x).all()


def test_a_snapshot_is_what_the_simulation_saw(run, tmp_path):
    simulation = drumlin.Simulation(run.path / "scene.toml")
    simulation.run(steps=20)
    simulation.save_snapshot(str(tmp_path / "s.h5"))
    stored = drumlin.read(tmp_path / "s.h5")
    assert (stored.x == simulation.x).all()
    for name in ("i", "j", "normal", "force_n", "force_t", "force"):
        assert (stored[name] == simulation.contacts[name]).all()


def test_measurements_are_read(data):
    folder = drumlin.read(data / "bed/6rpm-5turns-seed1/measured")
    profiles, maps = folder["profiles.csv"], folder["maps.h5"]
    assert profiles.format == "drumlin-profiles-1" and profiles.header["side"] == "particles"
    assert np.isfinite(profiles.v_x).any() and profiles.v_x_ci99.shape == profiles.z.shape
    assert maps.nu.shape == (len(maps.z), len(maps.x)) and "theta_deg" in maps.header
    theta, half_width = drumlin.value_of(folder["measured.json"], "theta_deg")
    assert 15 < theta < 25 and 0 < half_width < 2
    assert np.isnan(drumlin.value_of({"theta_deg": None}, "theta_deg")[0])
    with pytest.raises(KeyError, match="thetadeg: is no number .*allowed: theta_deg, "):
        drumlin.value_of(folder["measured.json"], "thetadeg")


def test_every_file_of_the_data_is_read(data):
    for file in drumlin.read(data).files:
        assert drumlin.read(data / file) is not None


def test_what_is_no_file_of_the_project_is_refused(tmp_path):
    for reader in (drumlin.read, drumlin.Law):
        with pytest.raises(drumlin.IoError, match="/dev/zero: is no file but .* a device"):
            reader("/dev/zero")
    with pytest.raises(drumlin.IoError, match="is missing"):
        drumlin.read(tmp_path / "none.csv")
    (tmp_path / "a.png").write_bytes(b"")
    with pytest.raises(drumlin.InputError, match="no file of Drumlin"):
        drumlin.read(tmp_path / "a.png")
    (tmp_path / "a.csv").write_text("a,b\n1\n", encoding="utf-8")
    with pytest.raises(drumlin.InputError, match="a.csv: a line has more or fewer fields"):
        drumlin.read(tmp_path / "a.csv")
    (tmp_path / "a.json").write_text("{", encoding="utf-8")
    with pytest.raises(drumlin.InputError, match="a.json: "):
        drumlin.read(tmp_path / "a.json")
    (tmp_path / "a.h5").write_bytes(b"no HDF5")
    with pytest.raises(drumlin.InputError, match="a.h5: not an HDF5 file"):
        drumlin.read(tmp_path / "a.h5")


def test_figures_are_drawn_on_axes_of_ones_own(run, data):
    figure, (left, right) = plt.subplots(1, 2)
    snapshot = drumlin.read(run.snapshots[0])
    discs = drumlin.plot.grains(left, snapshot, np.hypot(snapshot.v_x, snapshot.v_z))
    assert len(discs.get_offsets()) == 350
    circle, = (patch for patch in left.patches if isinstance(patch, matplotlib.patches.Circle))
    assert circle.radius == pytest.approx(run["scene.toml"]["walls"][0]["radius_mm"] * 1e-3 / snapshot.scales["length_m"]) and left.get_xlim()[1] > circle.radius, "the drum is not there"
    drumlin.plot.profile(right, drumlin.read(data / "bed/6rpm-5turns-seed1/measured/profiles.csv"), "v_x", label="particles")
    assert right.get_lines() and right.get_ylabel().startswith("$v_x$")
    figure.canvas.draw()


def test_a_command_raises_what_it_fails_at(run, tmp_path):
    with pytest.raises(drumlin.InputError, match="none.toml"):
        drumlin.run(tmp_path / "none.toml", tmp_path / "OUT")
    with pytest.raises(drumlin.InputError):
        drumlin.compare(run.path, tmp_path / "none", tmp_path / "OUT")
    assert drumlin.command("--version").split()[1] == drumlin.__version__


def test_every_option_of_a_command_is_an_argument(run, tmp_path):
    said = drumlin.command("history", run.path, output=tmp_path / "HISTORY", box=[-2, 2, -20, -18], sectors=8)
    assert "4 snapshots" in said and "# box = -2 2 -20 -18\n# sectors = 8\n" in (tmp_path / "HISTORY/walls.csv").read_text()
    settings = drumlin.measure(run.path, parts=["slices"], slices=[-1, 1.5], slice_width=3, overwrite=True)["measured.json"]["slices"]
    assert [one["position"] for one in settings] == [-1, 1.5]
    with pytest.raises(TypeError, match="slice_widht.*slice_width"):
        drumlin.measure(run.path, slice_widht=3)
    with pytest.raises(drumlin.InputError, match="slice-width"):
        drumlin.measure(run.path, slice_width=-3)


def test_frames_of_an_ensemble_at_rest_stand_on_their_walls(box, tmp_path):
    box["stages"][0] |= {"duration_s": 0.6, "snapshots": 60}
    runs = [drumlin.run(box | {"seed": seed}, tmp_path / f"RUN-{seed}").path for seed in (1, 2)]
    ask = {"output": tmp_path / "FRAMES", "origin": 0.1, "at": ["0:0.4:0.1", 0.5]}
    with pytest.raises(drumlin.InputError, match="--nu-bulk"):
        drumlin.command("measure", *runs, **ask)
    assert "2 runs at 6 times" in drumlin.command("measure", *runs, **ask, nu_bulk=0.8)
    frames = drumlin.read(tmp_path / "FRAMES/frames.h5")
    assert frames.runs.splitlines() == [run.name for run in runs]
    assert frames.times * frames.scales_time_s == pytest.approx(np.arange(6) / 10)
    assert frames.fields_nu.shape == (2, 6, len(frames.z), len(frames.x)) and frames.height.shape == (2, 6, len(frames.x))
    # All that there is stays, and its weight stands on the walls to the solver's tolerance.
    weight = [drumlin.read(drumlin.read(run).snapshots[-1]).mass.sum() for run in runs]
    assert 0.8 * frames.scalars_area == pytest.approx(np.repeat(weight, 6).reshape(2, 6)) and (frames.scalars_discharged == 0).all()
    assert -frames.loads_box[:, -1, 1] == pytest.approx(weight, rel=1e-3) and frames.loads_box[:, -1, 0] == pytest.approx([0, 0], abs=1e-2)
    for words, said in (({"at": ["0.2", "0.1"]}, "ascending"), ({"at": ["0:1"]}, "from:to:step"), ({"at": [3]}, "has no snapshot"),
                        ({"x": [2, 1]}, "the smaller one first"), ({"map_width": 0.5}, "1 to 15 spacings")):
        with pytest.raises(drumlin.InputError, match=said):
            drumlin.command("measure", *runs, **ask | {"output": tmp_path / "OTHER"} | words, nu_bulk=0.8)
    assert not (tmp_path / "OTHER").exists()
