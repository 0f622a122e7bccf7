"""Particles and continuum over the speed of rotation, judged by targets and limits; both commands that start a study."""

import importlib
import json
import math
import pathlib

import drumlin
import numpy as np
import pytest
from conftest import SOURCES
from drums import drum_run, flow, write_flow, write_run
from drumlin import study

PAPER = SOURCES / "data/paper"


# Both sides.


def studied(folder, *folders, limits=()):
    said = drumlin.command("compare", "--study", *folders, *limits, "-o", folder)
    return said, json.loads((folder / "study.json").read_text(encoding="utf-8"))


def target(speed, quantity, zone=None):
    return next(one for one in speed["targets"] if one["quantity"] == quantity and one.get("zone") == zone)


def test_a_flow_that_shows_what_the_particles_show_has_no_error(tmp_path):
    folders = [write_flow(tmp_path, flow(6)), write_run(tmp_path, drum_run(5)), write_run(tmp_path, drum_run(6)), write_flow(tmp_path, flow(5))]
    out = tmp_path / "study"
    said, content = studied(out, *folders, limits=["--limits", SOURCES / "data/limits/bed.toml"])
    assert content["format"] == "drumlin-comparison-study-1" and content["warnings"] == [] and content["law"] == {"law": "log", "a": 0.35, "b": 0.013}
    assert [speed["role"] for speed in content["speeds"]] == ["predicted", "calibrated"]
    for speed in content["speeds"]:
        assert target(speed, "sigma_zz", "all")["value"] == target(speed, "sigma_xx", "all")["value"] == 0
        assert target(speed, "sigma_zz", "all")["outcome"] == "met" and speed["seconds"]["ratio"] == 40
    assert content["speeds"][1]["scalars"]["theta_deg"]["paper"] == 19.7 and content["laws"]["flowing_layer_depth"]["paper"]["c"]["value"] == 3
    assert len(content["limits"]["rows"]) == 32 and content["limits"]["judged_by_calibrating_runs"] == ["rpm-6"]  # sixteen limits, two registrations
    assert "| 5 | predicted |" in (out / "table.md").read_text() and "| sigma_xz static, centre, relative |" in (out / "limits.md").read_text()
    assert content["verdict_lines"][0] in said and (out / "limits.md").read_text() in said
    page = (out / "index.html").read_text(encoding="utf-8")
    assert page.index('class="verdict') < page.index("<figure>")
    assert {path.name for path in out.iterdir()} >= {"speeds.png", "rates.png", "errors.png"} and not (out / "figures.pending").exists()
    with pytest.raises(drumlin.InputError, match="--overwrite"):  # nothing is overwritten unasked
        studied(out, *folders)


def test_both_sides_are_read_at_the_same_place_of_the_drum_and_seeds_are_averaged(tmp_path):
    """The same material, whose surface the continuum draws 1.3 d higher: nothing may differ but the slope of one of two seeds, by 0.4 deg."""
    steeper = drum_run(6)
    theta = steeper.scalars["theta_deg"]
    steeper.scalars["theta_deg"] = study.Scalar(theta.value + 0.4, theta.ci99)
    folders = [write_run(tmp_path, drum_run(6), "a"), write_run(tmp_path, steeper, "b"), write_run(tmp_path, drum_run(4)),
               write_flow(tmp_path, flow(6, fitted_on=["somewhere"]), lower=1.3), write_flow(tmp_path, flow(10, fitted_on=["somewhere"]))]
    four, six, ten = studied(tmp_path / "study", *folders)[1]["speeds"]
    assert (four["role"], six["role"], ten["role"]) == ("particles only", "unknown", "continuum only")
    assert four["targets"] == [] and six["particles"] == ["a", "b"] and six["scalars"]["H"]["paper"] == 14.6
    assert target(six, "theta_deg")["value"] == pytest.approx(0.2)
    for field, zone in (("v_x", "flowing"), ("sigma_zz", "all")):
        assert target(six, field, zone)["value"] == pytest.approx(0, abs=1e-9)
    assert six["scalars"]["lambda"]["continuum"] == pytest.approx(3, abs=1e-6)
    warnings = json.loads((tmp_path / "study/study.json").read_text())["warnings"]
    assert warnings[:2] == ["no flow at 4.0 rpm, the speed of rpm-4", "no particle run at 10.0 rpm, the speed of flow-10"] and "not known" in warnings[2]


def refusal(folder, *folders):
    with pytest.raises(drumlin.InputError) as refused:
        studied(folder / "study", *folders)
    assert not (folder / "study").exists(), "a refusal leaves nothing"
    return str(refused.value)


def test_what_is_no_pair_of_sides_is_refused(tmp_path):
    run, six, five = write_run(tmp_path, drum_run(6)), write_flow(tmp_path, flow(6)), write_flow(tmp_path, flow(5), "[effects.inertia]\n")
    assert "flow-5: effects: inertia, but nothing in flow-6 (allowed: one law and the same effects" in refusal(tmp_path, run, six, five)
    assert "no such folder" in refusal(tmp_path, run, tmp_path / "nowhere")
    assert "continuum flow; there is none" in refusal(tmp_path, run)
    faster = flow(6)
    faster.name, faster.profile.header["rotation"] = "faster", str(1.004 * float(faster.profile.header["rotation"]))
    assert "rotation: " in refusal(tmp_path, run, write_flow(tmp_path, faster))  # the study's speed, not that of a comparison
    write_flow(tmp_path, flow(6), geometry="chute")
    assert "chute" in refusal(tmp_path, run, six)
    (six / "flow.json").unlink()
    assert "not finished" in refusal(tmp_path, run, six)


@pytest.mark.parametrize("change, words", [
    ({"law": "mu = 0.4"}, "law: mu = 0.4, but"), ({"effects": "inertia"}, "effects: inertia"), ({"rotation_rpm": 6}, "one flow per speed"),
    ({"reduced": "true"}, "reduced: true, but false"), ({"diameter_m": "0.004"}, "diameter_m: 0.004"), ({"drum_radius": "70"}, "drum_radius: 70"),
])
def test_other_laws_speeds_and_drums_are_refused(change, words):
    other = flow(5)
    (key, value), = change.items()
    if key == "rotation_rpm":
        other.rotation_rpm = value
    else:
        (other.identity if key in other.identity else other.profile.header)[key] = value
    with pytest.raises(drumlin.InputError, match=words):
        study.compared_speeds([drum_run(6)], [flow(6), other], {}, PAPER)
    for runs, flows in (([], [other]), ([drum_run(6)], [])):
        with pytest.raises(drumlin.InputError, match="there is none"):
            study.compared_speeds(runs, flows, {}, PAPER)


# Targets: means over the runs, and what judges.


def comparison(error, floor=0.01, undefined=0, H=15.0, lam=3.0, **scalars):
    zone = {"rel_l2": error, "rms": error, "interval_rms": floor, "particles_rms": 1.0, "layers": 10, "undefined": undefined}
    scalars = {name: {"particles": {"value": value, "ci99": 0.3}, "continuum": value + error} for name, value in ({"H": H, "lambda": lam} | scalars).items()}
    return {"errors": {"v_x": {"flowing": zone}, "mu": None}, "maps": None, "scalars": scalars,
            "targets": [{"quantity": "v_x", "zone": "flowing", "measure": "relative", "limit": 0.2},
                        {"quantity": "mu", "zone": "all", "measure": "relative", "limit": 0.2}, {"quantity": "H", "measure": "d", "limit": 2}]}


@pytest.mark.parametrize("floor, undefined, outcome, judge, remark", [
    (0.01, 0, "missed", "limit", None), (0.4, 0, "met", "noise floor", "interval amounts to 0.4"), (0.01, 3, "missed", "limit", "6 of 26 layers undefined")])
def test_targets_are_judged_by_means_or_by_what_the_particles_leave_open(floor, undefined, outcome, judge, remark):
    sides = {"H": {"particles": study.Scalar(15, 4), "continuum": study.Scalar(18)}}
    field, absent, depth = study.judged_targets([comparison(error, floor, undefined) for error in (0.1, 0.5)], sides)
    assert (field["value"], field["outcome"], field["judged_by"]) == (pytest.approx(0.3), outcome, judge) and (remark or "") in field.get("remark", "")
    assert absent["outcome"] == "not_measured" and absent["remark"] == "a side has no such field"
    assert depth["value"] == 3 and depth["judged_by"] == "noise floor" and depth["inside_interval"]  # 4 d are wider than the limit of 2


# Limits.


@pytest.mark.parametrize("entry, words", [
    ('where = "scalar"\nmeasure = "difference"\nzone = "all"\nmust = 1', "limits.toml:2: limits.0.zone: is 'all' .allowed: none"),
    ('where = "somewhere"\nmeasure = "difference"\nmust = 1', "limits.0.where: is 'somewhere' .allowed: centre, map"),
    ('where = "scalar"\nmeasure = "rms"\nmust = 1', "limits.0.measure: is 'rms' .allowed: difference, relative, inside_interval"),
    ('where = "scalar"\nmeasure = "difference"\nmust = -1', "limits.0.must: is -1 .allowed: above 0"),
    ('where = "scalar"\nmeasure = "difference"', "limits.0.must: is missing"),
    ('where = "scalar"\nmeasure = "difference"\nmust = 1\nmost = 2', "limits.0.most: is 2")])
def test_limits_that_do_not_belong_together_are_refused_with_their_place(tmp_path, entry, words):
    (tmp_path / "limits.toml").write_text(f'format = "drumlin-limits-1"\n[[limits]]\nquantity = "H"\naim = 1\n{entry}\n')
    with pytest.raises(drumlin.InputError, match=words):
        study.read_limits(tmp_path / "limits.toml")


def limit(quantity="v_x", where="centre", measure="relative", must=0.2, aim=0.1, **more):
    return {"quantity": quantity, "where": where, "measure": measure, "must": must, "aim": aim} | ({"zone": "flowing"} if where == "centre" else {}) | more


def judged(limits, runs, flows, errors, fitted_on=()):
    """`errors` by (first, second): a comparison, or its error."""
    for one in flows:
        one.fitted_on = list(fitted_on)
    pairs = {(*names, by): found if isinstance(found, dict) else comparison(found) for names, found in errors.items() for by in ("axis", "surface")}
    return study.judged_limits({"floor_factor": 1.5, "limits": limits}, runs, flows, pairs)


def seeds(rpm, *names):
    runs = [drum_run(rpm) for _ in names]
    for run, name in zip(runs, names):
        run.name = run.folder = name
    return runs


def test_errors_are_means_over_the_runs_that_calibrated_nothing():
    found = judged([limit()], seeds(6, "a", "b", "c"), [flow(6)], {("b", "flow-6"): 0.3, ("c", "flow-6"): 0.5, ("b", "c"): 0.3}, ["a"])
    cell, row = found["rows"][0]["cells"][0], found["rows"][0]
    assert found["judged_by"] == ["b", "c"] and found["judged_by_calibrating_runs"] == [] and len(found["rows"]) == 2
    assert (cell["value"], cell["floor"], cell["limit"], cell["met"]) == (pytest.approx(0.4), 0.3, pytest.approx(0.45), True)
    assert (row["must_outcome"], row["aim_outcome"]) == ("met", "met")


def test_a_speed_with_one_run_borrows_the_floor_of_the_others():
    errors = {("a", "flow-6"): 0.0, ("b", "flow-6"): 0.0, ("a", "b"): 0.1, ("c", "flow-4"): 0.4}
    found = judged([limit(must=0.01)], seeds(6, "a", "b") + seeds(4, "c"), [flow(6), flow(4)], errors)
    slow, fast = found["rows"][0]["cells"]
    assert found["speeds_rpm"] == [4, 6] and slow["floor_of_other_speeds"] and not fast["floor_of_other_speeds"]
    assert slow["floor"] == fast["floor"] == 0.1 and not slow["met"] and fast["met"] and found["rows"][0]["must_outcome"] == "missed"


@pytest.mark.parametrize("error, outcome", [(0.15, "met"), (0.25, "missed")])
def test_a_worst_speed_is_judged_apart_from_the_mean(error, outcome):
    errors = {("a", "flow-6"): 0.0, ("b", "flow-5"): error}
    found = judged([limit(must=0.13, must_worst=0.2)], seeds(6, "a") + seeds(5, "b"), [flow(6), flow(5)], errors)
    assert found["rows"][0]["must_outcome"] == outcome  # the mean is 0.08 or 0.13


def test_scalars_keep_their_signs_and_are_counted_where_the_intervals_hold_them():
    limits = [limit("lambda", "scalar", "inside_interval", 0.5, 1), limit("H", "scalar", "difference")]
    errors = {("a", "flow-6"): 0.05, ("b", "flow-5"): 0.2, ("c", "flow-5"): -0.3, ("b", "c"): 0.1}
    inside, depth = judged(limits, seeds(6, "a") + seeds(5, "b", "c"), [flow(6), flow(5)], errors)["rows"][:2]
    assert (inside["must_outcome"], inside["aim_outcome"]) == ("met", "met")  # 0.09 each; of two equal seeds 0.09/sqrt(2) > 0.05
    assert depth["cells"][0]["value"] == pytest.approx(0.05)  # |0.2 - 0.3|/2


def test_places_that_a_flow_leaves_undefined_miss():
    cell = judged([limit()], seeds(6, "a"), [flow(6)], {("a", "flow-6"): comparison(0.0, undefined=2)})["rows"][0]["cells"][0]
    assert cell["undefined"] and not cell["met"]


def test_costs_go_by_the_start_and_walls_need_maps():
    limits = [limit("seconds_cold", "cost", "value", 4, 1), limit("seconds_neighbour", "cost", "value", 4, 1), limit("traction_ratio", "wall", "rms")]
    found = judged(limits, seeds(6, "a"), [flow(6)], {("a", "flow-6"): 0.0}, ["a"])
    assert found["judged_by_calibrating_runs"] == ["a"]
    assert [row["must_outcome"] for row in found["rows"][:3]] == ["missed", "not_measured", "not_measured"]  # 5 s


def test_tractions_of_a_uniform_stress_turn_with_the_wall():
    x = np.arange(-60.0, 61)
    fields = {"sigma_xx": np.full((121, 121), 2.0), "sigma_zz": np.full((121, 121), 2.0), "sigma_xz": np.full((121, 121), 0.5)}
    ratios = study.traction_ratios({"axis_depth": "4", "drum_radius": "50"}, x, x, fields)
    assert ratios.shape == (19,) and ratios[9] == pytest.approx(0.25)  # straight below the axis: sigma_xz/sigma_zz
    assert ratios[[0, 18]] == pytest.approx([0, 0], abs=1e-12)  # 45 deg: a principal axis
    assert np.isnan(study.traction_ratios({"axis_depth": "4", "drum_radius": "90"}, x, x, fields)).any(), "beyond the map"


# The particles' command.


def test_the_study_of_particles_leaves_table_page_and_figures_and_names_an_unsteady_run(tmp_path):
    unsteady = drum_run(2)
    unsteady.warnings = ["half a turn only"]
    folders, out = [write_run(tmp_path, run) for run in (drum_run(6), unsteady, drum_run(15))], tmp_path / "study"
    said = drumlin.command("measure", "--study", *folders, "-o", out)
    content = json.loads((out / "study.json").read_text(encoding="utf-8"))
    assert content["format"] == "drumlin-study-1" and len(content["speeds"]) == 3 and content["warnings"] == ["rpm-2: half a turn only"]
    assert content["laws"]["flowing_layer_depth"]["coefficients"]["c"]["value"] == pytest.approx(3)
    assert "half a turn only" in said and "c = 3 +- " in said and "| H | 6 | 14.6 |" in (out / "paper_table.md").read_text()
    page = (out / "index.html").read_text(encoding="utf-8")
    assert "half a turn only" in page and "data:image/png;base64," in page
    assert {path.name for path in out.iterdir()} >= {"fig03_velocity.png", "fig06_depth_and_friction.png", "fig11_rheology.png", "study.json"}
    assert not {"figures.pending", "given.json"} & {path.name for path in out.iterdir()}
    assert "done already" in drumlin.command("measure", "--study", *folders, "-o", out, "--resume")


@pytest.mark.parametrize("change, words", [
    ({"linear_share": 0.5}, "settings.linear_share: 0.5, but 0.3 in rpm-6"), ({"scene": "[effects\n"}, "scene.toml:1"), ({"name": "rpm-6"}, "appears twice")])
def test_runs_of_other_settings_are_refused_and_leave_nothing(tmp_path, change, words):
    six, other = write_run(tmp_path, drum_run(6)), write_run(tmp_path / "other", drum_run(2), **change)
    with pytest.raises(drumlin.InputError, match=words):
        drumlin.command("measure", "--study", six, other, "-o", tmp_path / "study")
    assert not (tmp_path / "study").exists()


def test_nothing_measured_is_nan_and_null():
    assert study.plain({"a": study.Scalar(math.nan, 0.1), "b": [math.inf, np.float64(2)], "c": study.Scalar(1.0)}) == {
        "a": {"value": None, "ci99": 0.1}, "b": [None, 2.0], "c": 1.0}


def test_what_is_met_by_the_noise_alone_is_told_apart(monkeypatch):
    monkeypatch.syspath_prepend(str(pathlib.Path(drumlin.__file__).parent / "pages"))
    formats = importlib.import_module("formats")
    within, noisy, missed = ({"quantity": "H", "limit": 2, "measure": "d", "value": value, "outcome": outcome, "judged_by": judge, "noise_floor": 4}
                             for value, outcome, judge in ((1, "met", "noise floor"), (3, "met", "noise floor"), (5, "missed", "noise floor")))
    assert [formats.standing(target) for target in (within, noisy, missed)] == ["met", "near", "missed"]
    assert formats.verdict_words(noisy) == "met within the noise" and formats.over_limit(noisy) == 0.75
    speed = {"rotation_rpm": 5, "role": "predicted", "targets": [within, noisy, missed], "verdict": {"met": 2, "missed": 1}}
    line, = study.verdict_lines([speed])
    assert "by the noise floor alone: H 3 (limit 2, noise floor 4)" in line and "missed: H 5" in line
