"""What a caller changes between two steps, with known outcomes."""

import pickle

import drumlin
import numpy as np
import pytest

ANGLE = 0.3


@pytest.fixture
def disc():
    """One disc a little above a floor that is wide and rough."""
    return {
        "title": "A disc on a floor",
        "grains": {"density_kg_m3": 2700, "generated": {"count": 1, "diameter_min_mm": 2, "diameter_max_mm": 2,
                                                        "region": {"shape": "rectangle", "min_mm": [3, 0], "max_mm": [5.1, 2.1]}}},
        "walls": [{"name": "floor", "shape": "segment", "from_mm": [-100, 0], "to_mm": [100, 0]}],
        "effects": {"gravity": {}, "friction": {"grain_grain": 1, "grain_wall": 1}},
        "stages": [{"name": "one", "duration_s": 0.1, "time_step_s": 1e-3}, {"name": "two", "duration_s": 0.1, "time_step_s": 5e-4}],
        "solver": {"tolerance": 1e-10},
    }


def test_a_grain_flies_by_v_t_where_gravity_is_turned_off(disc):
    simulation = drumlin.Simulation(disc)
    simulation.set_gravity(0, 0)
    simulation.set_velocity(0, v_x=0.25, v_z=0.5)
    x, z = simulation.x.copy(), simulation.z.copy()
    simulation.run(steps=150)  # into the second stage, which does not change gravity
    assert simulation.x - x == pytest.approx(0.25 * simulation.time) and simulation.z - z == pytest.approx(0.5 * simulation.time)
    assert simulation.v_z == 0.5
    simulation.set_gravity()
    simulation.run(steps=10)
    assert simulation.v_z == pytest.approx(0.5 - 10 * simulation.time_step)


def test_a_disc_that_sticks_to_an_incline_slides_by_g_sin_without_friction(disc):
    simulation = drumlin.Simulation(disc)
    simulation.run(steps=40)  # it lands
    simulation.set_gravity(np.sin(ANGLE), -np.cos(ANGLE))
    simulation.run(steps=30)
    assert abs(simulation.v_x) < 1e-9
    simulation.set_friction(0)
    simulation.run(steps=30)  # to the end of the stage
    speed = np.sin(ANGLE) * 30 * simulation.time_step
    assert simulation.v_x == pytest.approx(speed)
    simulation.run(steps=10)  # in the next one friction is that of the scene, 1
    assert simulation.v_x == pytest.approx(speed + (np.sin(ANGLE) - np.cos(ANGLE)) * 10 * simulation.time_step)


def test_a_wall_goes_on_from_where_it_is(disc):
    simulation = drumlin.Simulation(disc)
    simulation.run(steps=40)
    z, h = simulation.z.copy(), simulation.time_step
    simulation.set_wall("floor", (0, 0.05))
    simulation.run(steps=30)
    assert simulation.v_z == pytest.approx(0.05)
    simulation.set_wall("floor")
    simulation.run(steps=100)
    assert simulation.z - z == pytest.approx(30 * 0.05 * h) and abs(simulation.v_z) < 1e-9
    simulation.set_wall("floor", spin=-0.01)  # anticlockwise about the origin
    simulation.run(steps=2)
    assert simulation.v_z == pytest.approx(0.01 * simulation.x, rel=1e-2)


def test_the_motion_that_a_wall_has_changes_nothing(disc):
    disc["stages"][0]["motions"] = [{"wall": "floor", "kind": "rotation", "speed_rpm": -3, "center_mm": [1, 2]},
                                    {"wall": "floor", "kind": "translation", "velocity_mm_s": [5, 4]}]
    plain, told = drumlin.Simulation(disc), drumlin.Simulation(disc)
    plain.run(steps=60), told.run(steps=60)
    d, second = plain.scales["length_m"], plain.scales["time_s"]
    v = np.array([5e-3, 4e-3]) * second / d
    told.set_wall("floor", v, -3 * 2 * np.pi / 60 * second, np.array([1e-3, 2e-3]) / d + v * told.time)
    plain.run(steps=30), told.run(steps=30)
    for name in ("x", "z", "v_x", "v_z"):
        assert getattr(told, name) == pytest.approx(getattr(plain, name), abs=1e-9)


def test_what_was_set_is_known_after_a_restart(disc, box, tmp_path):
    for scene, wall in ((disc, "floor"), (box, "box")):
        simulation = drumlin.Simulation(scene)
        simulation.run(steps=30)
        simulation.set_gravity(0.2, -1.1)
        simulation.set_friction(0.1, 0.3)
        simulation.set_wall(wall, (0.02, 0.01), 0.003, (1, 2))
        simulation.set_velocity(slice(None), v_x=0.1)
        simulation.save(tmp_path / "at.h5")
        others = [drumlin.Simulation.load(tmp_path / "at.h5", threads=2), pickle.loads(pickle.dumps(simulation))]
        simulation.run(steps=90)
        for other in others:
            other.run(steps=90)
            assert all((getattr(simulation, name) == getattr(other, name)).all() for name in ("x", "z", "v_x", "v_z", "contacts"))


def test_velocities_are_set_by_index_and_in_place(box):
    simulation = drumlin.Simulation(box)
    v_x, spin = simulation.v_x, simulation.spin
    simulation.set_velocity([3, 5], v_x=[1, 2], spin=0.5)
    simulation.set_velocity(simulation.z > np.median(simulation.z), v_z=-1)
    assert list(v_x[[2, 3, 5]]) == [0, 1, 2] and list(spin[[3, 4, 5]]) == [0.5, 0, 0.5] and (simulation.v_z == -1).sum() == 10
    with pytest.raises(IndexError):
        simulation.set_velocity(20, v_x=1)


def test_what_no_scene_could_say_is_refused_and_changes_nothing(box, tmp_path):
    box["walls"].append({"name": "lid", "shape": "segment", "from_mm": [1, 50], "to_mm": [11, 50]})
    box["stages"][0] |= {"motions": [{"wall": "lid", "kind": "force", "direction": [0, -1], "force_n_m": 1, "mass_kg_m": 1}],
                         "until": {"moved": {"wall": "box", "distance_mm": 30}}}
    simulation, plain = drumlin.Simulation(box), drumlin.Simulation(box)
    for work, said in [(lambda: simulation.set_velocity(3, v_x=np.nan), "grain 3 has a place or speed that is no finite number"),
                       (lambda: simulation.set_velocity(4, v_z=1e9), "grain 4 flies by more than 1000 d"),
                       (lambda: simulation.set_velocity(0, v_x=1j), "velocity: holds complex"),
                       (lambda: simulation.set_friction(-1), "stages.0.friction.grain_grain: is -1 .allowed: number, 0 to 100"),
                       (lambda: simulation.set_friction(0.1, np.nan), "stages.0.friction.grain_wall: is nan"),
                       (lambda: simulation.set_gravity(np.inf), "gravity.acceleration_m_s2: is inf"),
                       (lambda: simulation.set_wall("none"), "names no wall: \"none\" .allowed: box, lid"),
                       (lambda: simulation.set_wall("box", (np.nan, 0)), "velocity_mm_s.0: is nan"),
                       (lambda: simulation.set_wall("lid"), "lid.* is moved by a force"), (lambda: simulation.set_wall("box"), "box.* ends stage fall")]:
        with pytest.raises(drumlin.InputError, match=said):
            work()
    simulation.run(steps=60), plain.run(steps=60)
    assert (simulation.z == plain.z).all() and (simulation.contacts == plain.contacts).all()
    with pytest.raises(drumlin.InputError, match="changes an effect that the scene does not name"):
        drumlin.Simulation(box | {"effects": {"gravity": {}}}).set_friction(0.1)
    with pytest.raises(drumlin.InputError, match="energy_ledger"):
        drumlin.Simulation(box | {"output": {"energy_ledger": True}}).set_velocity(0, v_x=1)
    with pytest.raises(drumlin.InputError, match="none.h5"):
        drumlin.Simulation.load(tmp_path / "none.h5")
