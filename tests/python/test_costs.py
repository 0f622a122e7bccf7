"""`drumlin cost`: which points a sweep has, what errors they are given, what it advises; a sweep and a price list of a drum of a dozen discs; programs that it starts. Flows: chain."""

import json
import subprocess
import sys

import drumlin
import pytest
from conftest import SOURCES

sys.path[:0] = [str(SOURCES / "apps" / folder) for folder in ("costs", "figures")]
import flows  # pylint: disable=wrong-import-position
import particles  # pylint: disable=wrong-import-position
import sweeping  # pylint: disable=wrong-import-position

SCENE = flows.Settings(2, 1e-5, 1e-8)


def test_axes_are_read_and_refused():
    axes = sweeping.axes_of(["mesh=1:2", "eps"], flows.AXES)
    assert sweeping.numbers_of("mesh", axes["mesh"], []) == [1, 2] and sweeping.numbers_of("eps", axes["eps"], [7]) == [7]
    assert list(sweeping.axes_of([], flows.AXES)) == flows.AXES
    for words in (["step"], ["mesh=1=2"], ["eps", "eps=1"]):
        with pytest.raises(sweeping.InputError):
            sweeping.axes_of(words, flows.AXES)
    for value in ("small", "0", "-1", "inf", "nan", "", "1_0", " 1"):
        with pytest.raises(sweeping.InputError):
            sweeping.numbers_of("eps", [value], [])


def point(name, seconds, default=False, **errors):
    return {"name": name, "default": default, "cpu_seconds": seconds, "errors": errors}


def test_a_front_holds_what_no_other_point_beats():
    points = [point("a", 1, e=8), point("b", 2, e=4), point("c", 3, e=5), point("d", 4, e=1), point("e", 2.5, e=4), point("like b", 2, e=4),
              point("no error", 0.5, e=None, f=1), point("no time", None, e=0)]
    sweeping.mark_fronts(points, ["e", "f"])
    assert [one["name"] for one in points if "e" in one["pareto"]] == ["a", "b", "d", "like b"]
    assert [one["name"] for one in points if "f" in one["pareto"]] == ["no error"]


@pytest.mark.parametrize("points, said, not_said", [
    ([point("fine", 40, H=0.004, theta=0.001), point("scene", 10, True, H=0.015, theta=0.002), point("coarse", 2, H=0.04, theta=0.06)],
     ["H: 5 %: coarse (0.2 times the scene's); 2 %: scene (the scene as it is); 1 %: fine (4 times the scene's)", "theta: 5 %: scene (the scene as it is); 2 %",
      "coarse:  --set coarse", "fine:  --set fine"], ["wastes", "leaves"]),
    ([point("scene", 10, True, H=0.08, theta=0.002), point("other", 3, H=0.07, theta=0.002)],
     ["H: 5 %: none; 2 %: none; 1 %: none", "the scene as it is leaves 8 %", "other is as exact in all of these at 0.3 of its cost"], []),
    ([point("scene", 10, True, H=0.01, theta=0.01), point("failed", None), point("half known", 1, H=0.01)], [], ["failed", "wastes"]),
])
def test_advice(points, said, not_said):
    text = sweeping.advice(points, ["H", "theta"], lambda made: f"--set {made['name']}")
    assert all(part in text for part in said) and not any(part in text for part in not_said), text
    assert sweeping.advice([], ["H"], str) == ""


def test_a_particle_sweep_is_measured_against_a_finer_point_than_any():
    standard = particles.Settings("nlgs", 1e-2, 1e-3)
    plan = particles.plan_of(standard, {"tolerance": ["1e-1", "1e-2", "1e-3"], "step": ["1e-3", "5e-4"], "solver": ["nncg"]}, ["nlgs", "nncg"])
    assert plan.points[0] == standard
    assert len(plan.points) == 8  # six of the scene's solver, two of the other: 1e-3 is too tight for it
    assert plan.finest == ("nlgs", 1e-3, 5e-4) and plan.reference == ("accelerated", 1e-3 / 3, 2.5e-4)
    assert [particles.last_followed(errors) for errors in ([0.001, 0.01, 0.5], [0.5, 0.5, None])] == [1, 0]


def test_curves_of_flows_go_through_the_scene_from_coarse_to_fine():
    curves = flows.curves_of(SCENE, {"mesh": ["3", "1"], "eps": ["1e-3"]})
    assert curves == {"mesh": [(1, 1e-5, 1e-8), SCENE, (3, 1e-5, 1e-8)], "eps": [(2, 1e-3, 1e-8), SCENE]}
    assert flows.reference_of(SCENE, curves) == (4, SCENE.eps / 10, 1e-8)
    # The coarsest mesh stays that of the scene: cells at the surface halve with each further one.
    assert flows.changes_of(curves["mesh"][2], SCENE, 2.0)[1] == "mesh.surface_cell=1"
    with pytest.raises(sweeping.InputError, match="integer >= 1 and <= 8"):
        flows.curves_of(SCENE, {"mesh": ["1.5"]})


def flow(H, v_x, **more):
    return {"scalars": {"H": H, "Q": 0.0}, "profile": {"v_x": v_x}} | more


def test_errors_are_against_the_reference_and_along_each_curve():
    curves = flows.curves_of(SCENE, {"mesh": ["1", "3"]})
    solved = dict(zip(curves["mesh"], [flow(11, [1, 2, None]), {"failure": "none"}, flow(10.5, [1, 2, 3])]))
    coarse, failed, fine = (flows.Sweep.errors(settings, solved, curves, flow(10, [1, 4, 3])) for settings in curves["mesh"])
    assert coarse["errors"] == pytest.approx({"H": 0.1, "v_x": 2 / 17 ** 0.5})  # nothing is relative to 0
    assert coarse["errors_alone"] == {"mesh": pytest.approx({"H": 11 / 10.5 - 1, "v_x": 0})}
    assert failed["errors"] == {} and fine["errors_alone"] == {}
    assert flows.profile_difference([1], [1, 2]) is None  # other layers


def test_errors_are_against_the_closed_form_where_there_is_one():
    found = flow(1.1, [1], closed_form={"v_x": 0.02, "v_x_mesh": 0.01, "scalars": {"H": 1.0}})
    assert flows.closed_form_errors(found) == pytest.approx({"H": 0.1, "v_x": 0.02, "v_x_mesh": 0.01})


def test_variants_are_each_effect_alone_or_those_named():
    assert list(flows.variants_of([])) == list(flows.EFFECTS)
    assert flows.variants_of(["none", "inertia+k"]) == {"none": [], "inertia+k": ["inertia", "k"]}
    for word in ("", "gravity", "inertia+inertia", "inertia+"):
        with pytest.raises(sweeping.InputError):
            flows.variants_of([word])


def test_a_program_is_told_to_end_at_its_time_limit(monkeypatch):
    monkeypatch.setattr(sweeping, "program", lambda name: name)
    assert sweeping.ended(["sh", "-c", "exec sleep 30"], time_limit_s=0.05) == (None, "")
    assert sweeping.ended(["sh", "-c", "echo one; echo two >&2; exit 3"], time_limit_s=30, output=subprocess.PIPE) == (3, "one\ntwo\n")


@pytest.fixture(scope="module")
def dozen(tmp_path_factory):
    """A folder with the scene and a sweep of it."""
    scene = {"format": "drumlin-scene-1",
             "grains": {"density_kg_m3": 2700, "generated": {"count": 12, "diameter_min_mm": 3.0, "diameter_max_mm": 3.6,
                                                             "region": {"shape": "circle", "center_mm": [0, -1], "radius_mm": 13}}},
             "walls": [{"name": "drum", "shape": "container", "radius_mm": 15}],
             "effects": {"gravity": {}, "friction": {"grain_grain": 0.4, "grain_wall": 0.9}, "spin": {}},
             "stages": [{"name": "fall", "duration_s": 0.2, "time_step_s": 1e-3},
                        {"name": "turn", "duration_s": 0.5, "time_step_s": 1e-3, "motions": [{"wall": "drum", "kind": "rotation", "speed_rpm": 60}]}],
             "solver": {"tolerance": 1e-2}}
    place = tmp_path_factory.mktemp("dozen")
    (place / "scene.toml").write_text(drumlin.toml_of(scene), encoding="utf-8")
    swept(place)
    return place


def swept(place, *words):
    drumlin.command("cost", place / "scene.toml", "-o", place / "cost", "--sweep", "tolerance=1e-1:1e-2:1e-3,step=1e-3,solver", *words)
    return drumlin.read(place / "cost" / "cost.json")


def test_a_sweep_says_what_a_tighter_solve_buys_and_takes(dozen):
    points = drumlin.read(dozen / "cost" / "cost.json")["points"]
    assert [one["default"] for one in points].count(True) == 1 and {one["solver"] for one in points} == {"accelerated", "nlgs"}
    loose, tight = (next(one for one in points if one["tolerance"] == tolerance and one["solver"] == "accelerated") for tolerance in (1e-1, 1e-3))
    assert tight["sweeps"] > loose["sweeps"] and tight["errors"]["solver"] < loose["errors"]["solver"]
    assert "solver" in min(points, key=lambda one: one["errors"]["solver"])["pareto"]
    assert (dozen / "cost" / "work_precision.png").exists()


def test_no_point_is_done_twice(dozen):
    first = drumlin.read(dozen / "cost" / "cost.json")["points"]
    # One point is lost, as if the call had been interrupted before it; another is marked, to be known again.
    (dozen / "cost/points/accelerated-tolerance-0.001-step-0.001.json").unlink()
    kept = dozen / "cost/points/accelerated-tolerance-0.1-step-0.001.json"
    kept.write_text(json.dumps(drumlin.read(kept) | {"load_before": -7}), encoding="utf-8")
    drumlin.command("accept", dozen / "cost", "--reason", "one point lost, one marked")
    second = swept(dozen, "--resume")["points"]
    for before, after in zip(first, second, strict=True):
        assert [before[key] == after[key] for key in ("name", "sweeps", "errors")] == [True] * 3
        assert (after["load_before"] == -7) == (after["name"] == kept.stem)
    swept(dozen, "--resume")  # what is finished can be gone on with


@pytest.mark.parametrize("words, said", [
    ([], "give --resume or --overwrite"),
    (["--resume", "--set", "effects.friction.grain_grain=0.3"], "were made with another 'scene'"),
])
def test_points_of_another_call_are_kept_apart(dozen, words, said):
    with pytest.raises(drumlin.InputError, match=said):
        swept(dozen, *words)


@pytest.mark.parametrize("words", ["-o new --sweep mesh", "-o new --sweep tolerance=abc", "-o new --sweep solver=best", "-o new --sweep step=1e-3=2", "--sweep step",
                                   "-o new --ranks 2"])
def test_what_no_sweep_knows_is_refused(dozen, words):
    with pytest.raises(drumlin.InputError):
        drumlin.command("cost", dozen / "scene.toml", *words.replace("new", str(dozen / "new")).split())
    assert not (dozen / "new").exists()


def test_effects_are_priced(dozen):
    said = drumlin.command("cost", dozen / "scene.toml", "--effects", "--seconds", 0.15, "-o", dozen / "prices")
    rows = {row["name"]: row for row in drumlin.read(dozen / "prices" / "cost.json")["variants"]}
    base, again, floating = rows["as it is"], rows["as it is, again"], rows["without gravity"]
    assert "without gravity" in said and (dozen / "prices" / "prices.png").exists()
    # The scene once more is the same to the last bit: only the machine's part may differ.
    assert {key for key in base if base[key] != again[key]} <= {"name", "cpu_seconds", "detection_seconds", "solver_seconds", "bytes"}
    assert floating["kinetic_energy_J_kg"] == 0 < base["kinetic_energy_J_kg"] and base["center_of_mass_mm"][1] < floating["center_of_mass_mm"][1]
    assert [rows[name]["unknowns_per_contact"] for name in ("as it is", "without friction: and spin, which needs it", "with rolling_resistance: 0.1")] == [2, 1, 3]
