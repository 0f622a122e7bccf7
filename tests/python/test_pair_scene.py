"""Particle scenes as flow scenes: what stands in them, and what is refused by its key."""

import math
import tomllib

import numpy as np
import pytest

from conftest import SOURCES

import drumlin
from drumlin.errors import InputError
from drumlin.pair import layers, scene as scenes

SCENES = SOURCES / "data" / "scenes"
NU = 0.8


def scene_of(name, changes=()):
    return tomllib.loads(drumlin.resolved(SCENES / f"{name}.toml", changes))


def flow_of(name, changes=(), **run):
    scene = scene_of(name, changes)
    return layers.flow_scene(scene, NU, name, **run) if "periodic_x" in scene else scenes.flow_scene(scene, NU, name, **run)[0]


def area(outline):
    x, z = np.array(outline).T
    return 0.5 * float(np.sum(x * np.roll(z, -1) - np.roll(x, -1) * z))


def named(flow, name):
    return [wall for wall in flow["walls"] if wall["name"] == name]


def discs(count, small, large):
    return count * math.pi / 12 * (small**2 + small * large + large**2)


@pytest.mark.parametrize("name, grains", [("column-collapse", discs(800, 1.6, 2.4)), ("silo", discs(1200, 1.6, 2.4)), ("hourglass", discs(800, 1.6, 2.4)),
                                          ("drum-6rpm", discs(7183, 3, 3.6))])
def test_the_fill_holds_the_grains_anticlockwise(name, grains):
    assert area(flow_of(name)["region"]["fill_mm"]) == pytest.approx(grains / NU, rel=1e-3)


def test_a_fast_gate_is_gone_and_leaves_a_free_side():
    flow = flow_of("column-collapse")
    assert [wall["name"] for wall in flow["walls"]] == ["plane", "middle"] and not flow["openings"]
    assert max(x for x, _ in flow["region"]["fill_mm"]) == pytest.approx(40)
    assert flow["time"]["end_s"] == pytest.approx(0.8)


def test_a_slow_gate_moves():
    gate, = named(flow_of("column-collapse", {"stages.1.motions.0.velocity_mm_s": [0, 300]}), "gate")
    assert gate["velocity_mm_s"] == [0, 300] and gate["begins_s"] == 0 and "ends_s" not in gate


def test_a_gate_that_opens_later_holds_until_then():
    later = {"stages.1.motions": [], "stages.1.opens": ["gate"], "stages.0.duration_s": 0.1}
    stages = scene_of("column-collapse", later)["stages"]
    first = stages[0] | {"name": "tilt", "gravity": {"direction_deg": -80.0, "ramp": False}}
    scene = scene_of("column-collapse", later) | {"stages": [stages[0], first, stages[1]]}
    flow, origin = scenes.flow_scene(scene, NU)
    gate, = named(flow, "gate")
    assert gate["ends_s"] == pytest.approx(0.1) and origin == pytest.approx(0.1)
    assert flow["gravity"]["direction_deg"] == -80


def test_a_hole_between_walls_is_an_opening():
    flow = flow_of("silo")
    assert [flow["openings"][0][key] for key in ("from_mm", "to_mm")] == [[28, 0], [52, 0]]
    run = scenes.Grains(area=5000, center=(40, 20), surface=(np.arange(0.0, 81.0, 2.0), np.full(41, 34.0)))
    assert flow_of("silo", grains=run)["openings"] == flow["openings"]
    neck = flow_of("hourglass")
    assert [neck["openings"][0][key] for key in ("from_mm", "to_mm")] == [[-10, 0], [10, 0]]
    # The lower chamber catches what has left.
    assert {wall["to_mm"][1] for wall in neck["walls"]} == {40, 0}


# The plane lies half a glued disc above its segment, and so does the opening.
def test_glued_discs_are_a_rough_wall_half_a_disc_inside():
    glued = {f"walls.{k}.rough": {"diameter_mm": 2, "spacing_mm": 3} for k in (0, 1)}
    flow = flow_of("silo", glued)
    assert [wall["condition"] for wall in flow["walls"]] == ["rough", "rough", "friction", "friction"]
    assert flow["walls"][0]["to_mm"] == [28, 1] and flow["openings"][0]["from_mm"] == [28, 1]
    assert min(z for _, z in flow["region"]["fill_mm"]) == 1


def test_conditions_of_walls_follow_friction():
    smooth = {"effects.friction.pairs": [{"between": ["grain", "smooth"], "value": 0.0}], "grains.materials": [{"name": "grain"}]}
    assert [wall["condition"] for wall in flow_of("column-collapse", smooth)["walls"]] == ["friction", "smooth"]
    assert [wall["condition"] for wall in flow_of("silo", {"effects.friction.grain_wall": 0})["walls"]] == ["smooth"] * 4
    drum, = flow_of("drum-6rpm")["walls"]
    assert (drum["condition"], drum["rotation_rpm"], drum["begins_s"]) == ("rough", 6, 0)  # friction 0.95 holds the material


def test_the_fill_follows_the_surface_of_a_run():
    x = np.arange(-1.0, 44.0, 2.0)
    run = scenes.Grains(area=2000, center=(20, 30), surface=(x, 60 - 0.5 * x), reach=((0, 90), (-1, 70)))
    flow = flow_of("column-collapse", grains=run)
    # Two grains from the walls the surface is taken, and level beyond: a kernel reaches over walls.
    assert flow["region"]["fill_mm"] == [[0, 0], [40, 0], [40, pytest.approx(42.5)], [35, 42.5], [5, 57.5], [0, pytest.approx(57.5)]]
    assert flow["output"] == {"x_mm": [-2, 92], "z_mm": [-4, 72]}


def test_layers_are_gaps():
    shear = flow_of("plane-shear")["plane_shear"]
    assert (shear["wall_speed_mm_s"], shear["pressure_pa"]) == (320, pytest.approx(270))
    assert shear["gap_mm"] == pytest.approx(discs(330, 1.6, 2.4) / (NU * 40))
    assert flow_of("chute")["incline"]["slope_deg"] == 18
    upright = {"effects.gravity": {"direction_deg": 0}}
    assert flow_of("plane-shear", upright)["chute"] == {"half_width_mm": pytest.approx(0.5 * shear["gap_mm"]), "pressure_pa": pytest.approx(270)}


@pytest.mark.parametrize("name, changes, key", [
    ("silo-recycled", {}, "outlets.0.returns_to"), ("silo", {"effects.cohesion": {"grain_grain": 5, "grain_wall": 0}}, "effects.cohesion"),
    ("segregation-drum", {}, "grains"), ("granular-gas", {}, "grains"), ("biaxial-cell", {}, "periodic_z"), ("plane-shear-cell", {}, "periodic_z"),
    ("biaxial", {}, "effects.gravity"), ("vibrated-layer", {}, "effects.gravity.direction_deg"), ("intruder", {}, "grains"),
    ("plane-shear-turned", {}, "stages"),
    ("column-collapse", {"stages.1.motions": []}, "stages"),
    ("column-collapse", {"stages.1.gravity": {"direction_deg": -70, "ramp": True}}, "stages.1.gravity"),
    ("column-collapse", {"stages.1.motions": [{"wall": "plane", "kind": "oscillation", "amplitude_mm": [0, 1], "frequency_hz": 20}]}, "stages.1.motions.0.kind"),
    ("column-collapse", {"stages.1.motions": [{"wall": "gate", "kind": "force", "direction": [1, 0], "force_n_m": 1, "mass_kg_m": 1}]}, "stages.1.motions.0.kind"),
    ("drum-6rpm", {"stages.2.motions.0.speed_rpm": 8}, "stages.2.motions"), ("drum-6rpm", {f"stages.{k}.motions.0.center_mm": [1, 0] for k in (1, 2)}, "walls.0")])
def test_what_a_continuum_has_not_is_refused_by_its_key(name, changes, key):
    with pytest.raises(InputError) as error:
        flow_of(name, changes)
    assert key in [problem["key"] for problem in error.value.problems]
