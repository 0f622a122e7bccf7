"""Scenes from dicts and files, stepped with a callback."""

import os
import pickle
import signal
import tomllib

import drumlin
import matplotlib.pyplot as plt
import numpy as np
import pytest


def test_a_dict_is_the_scene_that_its_text_is(box, tmp_path):
    text = drumlin.toml_of({"format": "drumlin-scene-1"} | box)
    file = tmp_path / "box.toml"
    file.write_text(text, encoding="utf-8")
    assert drumlin.resolved(box) == drumlin.resolved(text) == drumlin.resolved(file)
    assert tomllib.loads(drumlin.resolved(box, {"solver.tolerance": 1e-3}))["solver"]["tolerance"] == 1e-3


def test_the_walls_give_what_the_momentum_and_the_weight_take(box):
    simulation = drumlin.Simulation(box)
    mass = simulation.mass
    before, seen = np.zeros(2), []

    def stepped(at, report):
        momentum = np.array([mass @ at.v_x, mass @ at.v_z])
        seen.append(at.contacts.force[at.contacts.j < 0].sum(axis=0) * at.time_step - (momentum - before) - [0, mass.sum() * at.time_step])
        before[:] = momentum
        return at.steps < 120

    assert simulation.run(stepped) == len(seen) == simulation.steps == 120
    assert len(simulation.contacts) > 20
    assert np.abs(seen).max() < 1e-5 * mass.sum()  # normals have the digits of a float


def test_views_show_the_state_and_cannot_be_written(box):
    simulation = drumlin.Simulation(box)
    z = simulation.z
    before = z.copy()
    simulation.run(steps=5)
    assert (z < before).all() and z.base is not None  # the same memory, moved on
    assert np.shares_memory(z, simulation.z)
    with pytest.raises(ValueError, match="read-only"):
        z[0] = 0
    kept = simulation.x
    del simulation
    assert np.isfinite(kept).all()  # the view keeps its simulation alive


def test_a_simulation_is_drawn_with_its_walls(box, data):
    axes = plt.figure().add_subplot()
    simulation = drumlin.Simulation(box)
    drumlin.plot.grains(axes, simulation)
    assert len(axes.get_lines()) == len(simulation.wall_of_shape)
    turning = drumlin.Simulation("drum-smoke", {"stages.0.duration_s": 0.002, "grains.generated.count": 20})
    turning.run(steps=10)
    drumlin.plot.grains(other := plt.figure().add_subplot(), turning)
    assert [type(patch).__name__ for patch in other.patches] == ["Circle"]


def test_views_of_a_scene_whose_grains_come_and_go_are_copies(data):
    simulation = drumlin.Simulation(data / "scenes/silo-recycled.toml", {"grains.generated.count": 200})
    z = simulation.z
    simulation.run(steps=3)
    assert not np.shares_memory(z, simulation.z) and len(simulation.id) == len(simulation.z)


def test_steps_do_not_depend_on_threads_nor_on_who_calls_them(box):
    one, two = drumlin.Simulation(box), drumlin.Simulation(box, threads=2)
    one.run(steps=60)
    while two.steps < 60:
        two.step()
    assert (one.x == two.x).all() and (one.v_z == two.v_z).all() and (one.contacts == two.contacts).all()


def test_a_scene_starts_with_the_grains_of_another_run(box, tmp_path):
    file = tmp_path / "scene.toml"
    file.write_text(drumlin.toml_of({"format": "drumlin-scene-1"} | box), encoding="utf-8")
    left = drumlin.read(drumlin.run(file, tmp_path / "RUN", {"stages.0.snapshots": 2}).snapshots[-1])
    follows = box | {"grains": {"density_kg_m3": 2700, "from_run": {"run": str(tmp_path / "RUN")}}}
    found = drumlin.Simulation(follows)
    # The mean diameter is another where sizes are listed: compared in SI.
    ours, theirs = found.scales, left.scales
    for name, unit in (("x", lambda s: s["length_m"]), ("v_z", lambda s: s["length_m"] / s["time_s"]), ("spin", lambda s: 1 / s["time_s"])):
        assert getattr(found, name) * unit(ours) == pytest.approx(left[name] * unit(theirs), rel=1e-9, abs=1e-12)
    assert found.run(steps=10) == 10
    found.set_friction(0.1)
    other = pickle.loads(pickle.dumps(found))
    assert found.run(steps=10) == other.run(steps=10) and (found.x == other.x).all()
    follows["grains"]["from_run"]["time_s"] = 7.0
    with pytest.raises(drumlin.InputError, match="grains.from_run.time_s.*the nearest one is 0.3"):
        drumlin.Simulation(follows)


def test_files_of_a_scene_that_is_no_file_count_from_the_current_folder(box, tmp_path, monkeypatch):
    here, there = tmp_path / "here", tmp_path / "there"
    for folder, count in ((here, 2), (there, 1)):
        folder.mkdir()
        (folder / "g.csv").write_text("x_mm,z_mm,diameter_mm\n" + "".join(f"{3 * k + 3},3,2\n" for k in range(count)))
    monkeypatch.chdir(here)
    listed = box | {"grains": {"density_kg_m3": 2700, "listed": {"file": "g.csv"}}}
    for number, (scene, changes) in enumerate([(listed, {}), (drumlin.toml_of({"format": "drumlin-scene-1"} | listed), {}),
                                               (listed, {"grains.listed.file": "g.csv"})]):
        run = drumlin.run(scene, there / f"RUN{number}", changes | {"stages.0.duration_s": 0.01})
        assert run["run.json"]["grains"] == len(drumlin.Simulation(scene, changes).x) == 2


def test_errors_have_the_texts_of_the_commands(box, tmp_path):
    box["effects"]["friction"]["grain_grain"] = -1
    with pytest.raises(drumlin.InputError) as refused:
        drumlin.Simulation(box)
    assert "effects.friction.grain_grain" in str(refused.value) and refused.value.problems[0]["allowed"]
    file = tmp_path / "scene.toml"
    file.write_text(drumlin.toml_of({"format": "drumlin-scene-1"} | box), encoding="utf-8")
    with pytest.raises(drumlin.InputError) as by_command:
        drumlin.command("scene", "check", file)
    assert str(by_command.value).replace(str(file), "scene") == str(refused.value)
    assert isinstance(refused.value, ValueError)


def test_what_a_scene_cannot_hold_is_named(box):
    box["effects"]["friction"]["grain_wall"] = object()
    with pytest.raises(drumlin.InputError, match="effects.friction.grain_wall: object has no place in a scene"):
        drumlin.Simulation(box)


def test_a_step_that_misses_what_its_scene_insists_on_raises_and_is_not_built_upon(box):
    simulation = drumlin.Simulation(box, {"solver.max_sweeps": 1, "solver.check_every": 1, "solver.tolerance": 1e-12, "solver.stop_when_unconverged": True})
    with pytest.raises(drumlin.NotConvergedError, match="contact solver accelerated"):
        simulation.run()
    with pytest.raises(drumlin.NotConvergedError):
        simulation.step()


def test_ctrl_c_ends_a_run_between_two_steps_and_it_goes_on(box):
    whole, stopped = drumlin.Simulation(box), drumlin.Simulation(box)

    def interrupt(at, _):
        if at.steps == 10:
            os.kill(os.getpid(), signal.SIGINT)

    with pytest.raises(KeyboardInterrupt):
        stopped.run(interrupt)
    assert stopped.steps <= 11
    stopped.run(steps=40 - stopped.steps)
    whole.run(steps=40)
    assert (whole.z == stopped.z).all()


def test_a_finished_scene_has_no_further_step(box):
    simulation = drumlin.Simulation(box, {"stages.0.duration_s": 0.005})
    assert simulation.run() == 5 and simulation.finished
    with pytest.raises(drumlin.InputError, match="finished"):
        simulation.step()
    assert simulation.run() == 0


def test_objects_tell_what_they_are(box, data):
    assert "20 grains, step 0 of 300" in repr(drumlin.Simulation(box))
    profiles = drumlin.read(data / "profiles/6rpm-seed1/measured/profiles.csv")
    assert "v_x" in dir(profiles)


def test_columns_become_a_frame(data):
    pytest.importorskip("pandas")
    profiles = drumlin.read(data / "profiles/6rpm-seed1/measured/profiles.csv")
    np.testing.assert_array_equal(profiles.to_frame()["v_x"], profiles.v_x)
