"""Statistics and laws of many runs, on runs made from known laws."""

import copy
import csv
import math
import os
import subprocess
import sys

import drumlin
import numpy as np
import pytest
from conftest import SOURCES
from drums import drum_run, six_speeds, write_run
from drumlin import study
from drumlin.study import Scalar

PAPER = SOURCES / "data/paper"
Q = np.array([7.3, 14.5, 18.2, 21.8, 36.0, 53.9])
NORMAL = 2.5758293035489
T1, T3 = 63.656741162872, 5.8409093097  # Student's t, two-sided 99 %
NONE = math.nan


def test_nothing_compiled_is_needed():
    code = "import sys, drumlin.study; sys.exit('drumlin._drumlin' in sys.modules)"
    assert subprocess.run([sys.executable, "-B", "-c", code], env={"PYTHONPATH": os.environ["DRUMLIN_PACKAGE"]}, check=False).returncode == 0


# The lines and means behind the laws.


def test_points_on_a_line_give_the_line():
    fit = study.fit_line(Q, 0.31 + 1.9e-3 * Q, 0.1, 0.01)
    assert [c.value for c in fit.coefficients] == pytest.approx([0.31, 1.9e-3], rel=1e-11)
    assert fit.reduced_chi2 == pytest.approx(0, abs=1e-18) and fit.coefficients[1].ci99 > 0
    assert [c.value for c in study.fit_power(Q, 3 * np.sqrt(Q), 0.1, 0.2).coefficients] == pytest.approx([3, 0.5])
    assert study.fit_line(np.sqrt(Q), 3 * np.sqrt(Q), offset=False).coefficients[0].value == pytest.approx(3)
    assert study.fit_line(np.ones(4), np.full(4, 5.0), NONE, 0.4, offset=False).coefficients[0].ci99 == pytest.approx(0.2)


def test_errors_of_x_count_through_the_slope():
    uncertain, exact = (study.fit_line(Q, 2 * Q, error, 0.5).coefficients[1].ci99 for error in (0.5, 0))
    assert uncertain / exact == pytest.approx(math.sqrt(5))


@pytest.mark.parametrize("y, y_ci99, points", [([1, 2, 3], NONE, 3), ([1, 2, 9], [0.1, 0.1, NONE], 2), ([1, NONE, NONE], 0.1, 1)])
def test_points_without_intervals_stand_aside_only_where_others_have_them(y, y_ci99, points):
    fit = study.fit_line([1, 2, 3], y, 0, y_ci99)
    assert fit.points == points and math.isnan(fit.coefficients[0].value) == (points < 2)


def pooled(*runs):
    return study.pooled_speeds([[Scalar(*run) for run in runs]])[0]


def test_means_of_runs():
    assert pooled((14, 0.5)) == (14, 0.5)
    assert pooled((14.1, 0.6), (13.9, 0.6), (14, 0.6), (14, 0.6)) == pytest.approx((14, 0.3))
    # 4 apart with standard errors of 1: that of their mean is 2 by their spread, known with one degree of freedom.
    assert pooled((12, NORMAL), (16, NORMAL)).ci99 == pytest.approx(2 * T1)
    assert pooled((NONE, 0.5), (14, 0.5)).value == 14 and math.isnan(pooled((NONE, 0.5)).value)
    assert pooled((14,), (15, 0.5)).ci99 is None
    two = [Scalar(12, NORMAL), Scalar(16, NORMAL)]
    means = study.pooled_speeds([two, two, [Scalar(30, 0.5)], two])  # three degrees of freedom
    assert means[1] == pytest.approx((14, 2 * T3)) and means[2].ci99 == 0.5


@pytest.mark.parametrize("runs, told", [(3, 1), (2, 1 / 3), (3, 1 / 3), (4, 1 / 3), (5, 1 / 3)])
def test_intervals_of_means_hold_the_truth(runs, told):
    noise, inside = np.random.default_rng(3), 0
    for values in 14 + noise.normal(size=(4000, runs)):
        mean = pooled(*((value, NORMAL * told) for value in values))
        inside += abs(mean.value - 14) <= mean.ci99
    assert inside / 4000 == pytest.approx(0.99, abs=0.005) if told < 1 else inside / 4000 > 0.985


def test_log_friction_takes_the_scatter_for_an_error():
    I = np.geomspace(1e-4, 1e-1, 20)  # noqa: E741
    mu = 0.35 + 0.013 * np.log(I)
    exact = study.fit_log_friction(I, mu, 0.1 * I, np.full(20, 1e-3))
    assert (exact.a.value, exact.b.value) == pytest.approx((0.35, 0.013)) and exact.birge_ratio < 1e-6
    scattered = [study.fit_log_friction(I, mu + 0.01 * (-1) ** np.arange(20), 0 * I, np.full(20, error)) for error in (1e-6, NONE)]
    assert scattered[0].birge_ratio > 1000 and math.isnan(scattered[1].birge_ratio)
    for mine, other in zip(scattered[0][:2], scattered[1][:2]):
        assert mine == pytest.approx(other, rel=1e-6)  # whatever the errors say


# Which runs belong together.


def test_seeds_of_one_speed_form_a_group():
    groups = study.speed_groups([*six_speeds(), drum_run(6.01)])
    assert [[run.name for run in group.runs] for group in groups][3] == ["rpm-6", "rpm-6.01"]
    assert [group.rotation_rpm for group in groups] == [2, 4, 5, 6, 10, 15]


def test_other_drums_grains_and_definitions_are_refused_with_every_difference():
    runs = six_speeds()
    runs[1].identity["drum_radius"] = "68.19"
    study.require_one_study(runs)  # rounding
    runs[1].identity["grains.generated.count"] = 7184
    runs[2].identity |= {"settings.linear_share": 0.5, "drum_radius": "69"}
    with pytest.raises(drumlin.InputError, match="rpm-4: grains.generated.count: 7184, but 7183 in rpm-2 [(]allowed: the same") as refusal:
        study.require_one_study(runs)
    assert [problem["key"] for problem in refusal.value.problems] == ["grains.generated.count", "drum_radius", "settings.linear_share"]
    for wrong in ([], [drum_run(6), drum_run(6)], [drum_run(0)]):
        with pytest.raises(drumlin.InputError):
            study.require_one_study(wrong)


def test_scenes_of_one_study_differ_in_nothing_but_what_says_nothing(tmp_path):
    scene = "[effects.friction]\ngrain_grain = {}\n{}"
    runs = [study.read_run(write_run(tmp_path, drum_run(rpm), scene=text)) for rpm, text in
            ((2, scene.format(0.4, "")), (4, scene.format(0.4, "pairs = []\n")), (5, scene.format(0.2, "")), (6, "[effects.friction]\n"))]
    study.require_one_study(runs[:2])  # an older program wrote no list of groups where there is none
    for other in runs[2:]:
        with pytest.raises(drumlin.InputError, match="effects.friction"):
            study.require_one_study([runs[0], other])


def test_runs_of_earlier_programs_belong_to_those_of_now(data, tmp_path):
    folders = sorted((data / "profiles").iterdir())
    for folder in folders:
        (tmp_path / "scene.toml").write_text(drumlin.resolved(folder / "scene.toml"), encoding="utf-8")
        earlier = study.read_run(folder)
        now = copy.copy(earlier)
        now.name, now.identity = "now", {key: value for key, value in earlier.identity.items() if not key.startswith(("grains", "effects"))}
        now.identity |= study.runs._scene(tmp_path / "scene.toml")[0]  # pylint: disable=protected-access
        study.require_one_study([earlier, now])
    assert len(folders) == 8


# What follows from them.


def test_derived_scalars_follow_from_the_profile():
    run = drum_run(6)
    found = study.with_derived(run)
    for name, value in {"mu_eff": 0.31 + 1.9e-3 * 21.9, "nu_flowing_drop": 0.02, "shear_rate_change": 0, "kinetic_share": 0.001, "mu_b_below": 0.013,
                        "mu_b_excess": 0}.items():
        assert found[name].value == pytest.approx(value, abs=1e-9), name
    theta = math.atan(0.31 + 1.9e-3 * 21.9)  # tan: 3 % of the angle is 3 % theta/(sin cos) of the tangent
    assert found["mu_eff"].ci99 / found["mu_eff"].value == pytest.approx(0.03 * theta / math.sin(theta) / math.cos(theta))
    run.scalars["mu_eff"] = Scalar(0.5, 0.1)
    assert study.with_derived(run)["mu_eff"].value == 0.5


def test_layers_at_surface_and_wall_and_below_the_resolved_shear_stand_aside():
    profile = drum_run(6).profile
    deep = profile.z < -40
    profile.columns["shear_rate_ci99"][deep] = 2 * profile.columns["shear_rate"][deep]
    inertial = study.inertial_curve(profile, "mu")[0]
    assert inertial.size == 38 and (np.diff(inertial) > 0).all()  # -39.5 ... -2.5


def test_curves_of_one_law_collapse_and_others_do_not():
    one = study.collapse("mu", study.speed_groups(six_speeds()))
    assert one["collapse"] and one["ratio"] < 0.05 and len(one["points"]) >= 8  # interpolation in ln I is exact for a + b ln I
    assert one["limit"] == pytest.approx(math.sqrt(15.086 / 5), abs=1e-4)
    # 0.004 per rpm: 0.052 between 2 and 15 rpm, where the standard error of mu is 0.003.
    moving = study.collapse("mu", study.speed_groups(six_speeds(mu_per_rpm=0.004)))
    assert not moving["collapse"] and moving["ratio"] > 3 and moving["spread"] == pytest.approx(0.019, abs=0.002)
    assert study.collapse("mu", study.speed_groups([drum_run(6)]))["collapse"] is None


def test_laws_that_the_runs_were_made_from_come_back(data):
    content = study.study_of(six_speeds(), PAPER)
    found = {(law, name): c.value for law, entry in content["laws"].items() for name, c in entry["coefficients"].items()}
    for key, value in {("flowing_layer_depth", "c"): 3, ("flowing_layer_depth_power", "p"): 0.5, ("effective_friction", "c0"): 0.31,
                       ("effective_friction", "c1"): 1.9e-3, ("shear_rate", "Phi_deg"): math.degrees(math.atan(0.31))}.items():
        assert found[key] == pytest.approx(value, rel=1e-8), key
    friction = content["friction"]
    assert (friction["a"].value, friction["b"].value) == pytest.approx((0.35, 0.013)) and friction["rms_own"] < 1e-9
    curve = content["paper_friction"]["curve"]
    assert curve["mu"] == pytest.approx(drumlin.Law(data / "rheology/paper.toml").mu(curve["I"]), rel=1e-12) and len(curve["I"]) == 41


def test_intervals_of_the_laws_hold_the_truth():
    noise, inside = np.random.default_rng(5), np.zeros(3)
    for _ in range(400):
        laws = study.speed_laws(study.speed_groups(six_speeds(noise=noise)))
        found = [laws["flowing_layer_depth"]["coefficients"]["c"], *laws["flowing_layer_depth_power"]["coefficients"].values()]
        inside += [abs(c.value - truth) <= c.ci99 for c, truth in zip(found, (3, 3, 0.5))]
    assert (inside >= 388).all()  # 4 +- 2 misses are expected


# The paper.


VERDICTS = """
    agrees          15.0 0.5        value        value=14.6
    near            15.6 0.5        value        value=14.6
    differs         18.2 0.9        value        value=14.6
    not_measured    nan  0.9        value        value=14.6
    near            14.7 none       value        value=14.6       without an interval nothing agrees
    agrees          3.5  0.25       value        value=3 half_width=0.3
    differs         3.5  0.25       value        value=3
    open            3.4  1.5        value        value=3
    imposed         28   0.5        value        value=28 quantity=Q
    not_measured    nan  0.5        value        value=28 quantity=Q
    open            0.1  0.3        zero
    agrees          0.01 0.02       zero         scale=0.28
    near            0.02 0.01       zero         scale=0.28
    differs         0.07 0.04       zero         scale=0.28
    agrees         -0.2  0.05       not_zero
    near           -0.2  0.3        not_zero
    agrees          0.2  0.05       positive
    differs        -0.2  0.05       positive
    near            0.2  0.3        positive
    agrees          1.2  none       collapse     limit=1.7
    near            2.0  none       collapse     limit=1.7
    differs         4.0  none       collapse     limit=1.7
    agrees          4.0  none       no_collapse  limit=1.7
    differs         0.8  none       no_collapse  limit=1.7
"""


@pytest.mark.parametrize("row", VERDICTS.strip().splitlines())
def test_verdicts(row):
    """verdict, our value and half width, what the paper expects, and what else is told."""
    verdict, value, ci99, expects, *more = row.split()
    told = dict(word.split("=") for word in more if "=" in word)
    numbers = {key: float(text) for key, text in told.items() if key != "quantity"}
    entry = {"quantity": told.get("quantity", "some"), "expects": expects.replace("_", " "), "value": numbers.pop("value", 0.0),
             "half_width": numbers.pop("half_width", None)}
    assert study.verdict_on(entry, Scalar(float(value), None if ci99 == "none" else float(ci99)), **numbers)[0] == verdict.replace("_", " ")


def test_the_paper_is_asked_everything_once():
    entries = study.paper_entries(PAPER)
    assert all(entry["source"] and entry["quantity"] and math.isfinite(entry["value"]) for entry in entries)
    assert sum(entry["source"] == "Table I" and entry["quantity"] != "theta_com_deg" for entry in entries) == 18
    assert len({(entry["quantity"], entry["rotation_rpm"]) for entry in entries}) == len(entries)
    assert all(entry["value"] == 0.05 for entry in entries if entry["quantity"].startswith("dk_dx")), "along the upslope axis"


def test_a_paper_made_from_its_own_laws_agrees_with_itself():
    content = study.study_of(six_speeds(), PAPER)
    verdicts = {(row["quantity"], row["rotation_rpm"]): row["verdict"] for row in content["paper_table"]}
    for name in ("lambda", "I_th", "friction.a", "friction.b", "flowing_layer_depth.c", "effective_friction.c0", "effective_friction_com.c1", "lambda_trend",
                 "I_th_trend", "mu_collapse"):
        assert verdicts[name, None] == "agrees", name
    assert verdicts["theta_deg", 6] == "agrees" and verdicts["nu_wall_width", None] == "not measured"
    assert verdicts["k_collapse", None] == "differs"  # k = 1 at every speed here
    six, two = content["consistency"][3], content["consistency"][0]
    assert six["H_over_sqrt_Q"].value == pytest.approx(3) and six["shear_rate_laboratory"].value == pytest.approx(0.15 + 6 * math.pi / 30 * 0.018341, abs=1e-6)
    assert six["paper_layer_balance"] == pytest.approx(0.4 * 0.15 * 14.6**2 / 21.8) and six["paper_H_over_sqrt_Q"] == pytest.approx(14.6 / math.sqrt(21.8))
    assert two["paper_shear_rate"] == pytest.approx(0.083, abs=0.001)  # its law at its slope of 18.1 deg


def test_a_missing_speed_is_not_measured_and_another_drum_has_no_table():
    content = study.study_of([drum_run(6), drum_run(15)], PAPER)
    verdicts = {(row["quantity"], row["rotation_rpm"]): row["verdict"] for row in content["paper_table"]}
    assert verdicts["H", 2] == "not measured" != verdicts["H", 15]
    runs = six_speeds()
    for run in runs:
        run.profile.header["drum_radius"] = run.identity["drum_radius"] = "20"
    assert study.study_of(runs, PAPER)["paper_table"] is None


def test_other_numerics_and_unsteady_runs_are_warned_of():
    runs = six_speeds()
    for run in runs:
        run.numerics["time_step_s"] = 6e-3 if run.name == "rpm-6" else 1e-3
    runs[4].warnings.append("half a turn only")
    assert study.study_of(runs, PAPER)["warnings"] == ["rpm-6: time_step_s = 0.006, other than in rpm-2", "rpm-10: half a turn only"]


def test_the_recorded_table_of_the_bed_comes_back_to_the_letter(data):
    runs = [run for run in sorted((data / "bed").iterdir()) if run.name.split("rpm")[0] in ("2", "4", "5", "6", "10", "15")]
    content = study.plain(study.study_of([study.read_run(run) for run in runs], PAPER))
    recorded = csv.reader((data / "memory/paper-table.csv").read_text(encoding="utf-8").splitlines()[1:])
    table = study.paper_table(content).replace("**", "").splitlines()
    assert [["", *row, ""] for row in recorded] == [[cell.strip() for cell in line.split("|")] for line in table[:1] + table[2:]]
