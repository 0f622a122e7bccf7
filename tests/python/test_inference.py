"""What `drumlin infer` is made of, with closed forms in place of runs."""

import json
import types

import numpy as np
import pytest
import scipy.stats
from conftest import SOURCES

import drumlin
from drumlin.errors import InputError
from drumlin.inference import answer, command, design, emulator, observables, posterior, question
from drumlin.pair.frames import Frames

RANGES = {"friction": (0.1, 0.8), "wall_friction": (0.3, 1.0), "rolling_resistance": (0.005, 0.2)}
SD = np.array([0.8, 0.8, 0.05])


@pytest.fixture(autouse=True, scope="module")
def _short_chains():
    """Of a process's parameters: closed forms need no more."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(emulator, "STEPS", 50)
        yield


def priors(names=RANGES):
    return {name: question.Prior(*RANGES[name]) for name in names}


def angles(unit):
    """Two angles, which grow with two of the unknowns, and a speed; the second unknown changes nothing."""
    friction, _, rolling = unit.T
    bent = np.tanh(2 * friction)
    return np.stack([20 + 20 * bent + 3 * rolling, 25 + 15 * bent + 8 * rolling * friction, 1 - 0.5 * friction - 0.3 * rolling], -1)


@pytest.fixture(name="emulated", scope="module")
def _emulated():
    unit = scipy.stats.qmc.Sobol(3, seed=1).random(64)
    values = angles(unit) + SD * np.random.default_rng(1).standard_normal((64, 3))
    return emulator.Emulator(unit, values, np.tile(0.6 * SD, (64, 1)), ["drum: theta_deg", "fast: theta_deg", "drum: v_x"])


def asked(emulated, values):
    return posterior.Posterior(priors(), [posterior.Datum(emulated, values, 0.6 * SD)])


def one_truth(random):
    unit = random.uniform(size=(1, 3))
    return unit, (angles(unit) + SD * random.standard_normal((1, 3)))[0]


def test_what_no_interval_of_a_run_knows_is_found_as_spread(emulated):
    # Each number scatters by SD, of which the run's interval knows 0.6. 64 runs tell a deviation to a tenth.
    means, own, spread = emulated.predict(np.array([[0.3, 0.5, 0.6]]))
    assert np.hypot(spread[0], 0.6 * SD) == pytest.approx(SD, rel=0.3)
    assert np.abs(means - angles(np.array([[0.3, 0.5, 0.6]]))) == pytest.approx(0, abs=1.5) and (own < SD).all()
    many = posterior.Datum(emulated, means[0], 0 * SD, 10**9)
    assert many.at(np.array([[0.3, 0.5, 0.6]]))[1] == pytest.approx(own, rel=1e-3)


def test_the_spread_may_grow_with_the_number():
    """It scatters by 14 %, as the angle of a heap does from one filling to the next."""
    unit = scipy.stats.qmc.Sobol(1, seed=1).random(64)
    values = 20 * np.exp(unit + 0.14 * np.random.default_rng(2).standard_normal((64, 1)))
    found = emulator.Emulator(unit, values, np.full((64, 1), np.nan), ["ledge: repose_deg"])
    means, _, spread = found.predict(np.array([[0.1], [0.9]]))
    assert found.processes[0].logarithm and spread / means == pytest.approx(0.14, rel=0.3)
    # Where numbers may be negative there is no logarithm.
    assert not emulator.Emulator(unit, values - 30, np.full((64, 1), np.nan), ["x"]).processes[0].logarithm


def test_few_runs_do_not_make_an_emulator_sure():
    """Of 12 runs that scatter as much as they differ: what it says of the means is off by no more than it knows."""
    off = []
    for seed in range(4):
        unit, random = scipy.stats.qmc.Sobol(2, seed=seed).random(16)[:12], np.random.default_rng(seed)
        values = np.sin(4 * unit[:, :1]) + 0.7 * random.standard_normal((12, 1))
        tried = random.uniform(size=(50, 2))
        means, own, _ = emulator.Emulator(unit, values, np.full((12, 1), np.nan), ["x"]).predict(tried)
        off.append(np.mean(((means - np.sin(4 * tried[:, :1])) / own) ** 2))
    assert np.mean(off) < 1.7  # 1 on the average, of 4 designs to 0.3


def test_regions_of_ninety_per_cent_hold_the_truth(emulated):
    random, inside, each = np.random.default_rng(7), [], []
    for _ in range(8):
        unit, values = one_truth(random)
        of = asked(emulated, values)
        samples, densities = of.sample()
        truth = of.low + unit * (of.high - of.low)
        inside.append(posterior.share_above(densities, of.log_density(truth)[0]) < 0.9)
        each.append(np.abs((samples < truth).mean(axis=0) - 0.5) < 0.45)
    # Of 8 that hold with 0.9 each 5 or more do with 99.5 %, of 24 17 or more with 99.8 %.
    assert np.sum(inside) >= 5 and np.sum(each) >= 17


def test_biased_data_are_a_misfit_and_others_are_not(emulated):
    random, shares = np.random.default_rng(3), []
    for bias in (0, 10):  # of an angle that is known to 0.8
        _, values = one_truth(random)
        of = asked(emulated, values + [0, bias, 0])
        shares.append(answer.answer(of, of.sample()[0], [types.SimpleNamespace(name="all")]))
    assert not shares[0]["misfit"]["is_misfit"] and shares[0]["words"][0].startswith("the data fit, but 3 numbers")
    assert shares[1]["misfit"]["is_misfit"] and shares[1]["words"][0].startswith("MISFIT")
    assert "fast: theta_deg" in " ".join(shares[1]["words"][1:3])


def test_an_entry_that_contradicts_the_others_is_named():
    """A profile is one entry. Of two numbers that one unknown gives, and a profile of two more, the profile lies off."""
    unit = scipy.stats.qmc.Sobol(1, seed=1).random(32)
    names = [f"a (old): {name}" for name in ("H", "theta_deg", "v_x(z=0)", "v_x(z=-1)")]
    found = emulator.Emulator(unit, unit + 0.05 * np.random.default_rng(5).standard_normal((32, 4)), np.full((32, 4), np.nan), names)
    of = posterior.Posterior(priors(["friction"]), [posterior.Datum(found, np.array([0.3, 0.3, 0.6, 0.6]), np.full(4, 0.01))])
    fit = of.misfit(of.sample()[0])
    assert fit["share"] < 0.01 and min(fit["without"], key=fit["without"].get) == "a (old): v_x" and len(fit["without"]) == 3
    assert fit["without"]["a (old): v_x"] < 5 < 20 < fit["chi_square"]


def test_what_the_data_do_not_determine_is_said(emulated):
    of = asked(emulated, angles(np.array([[0.5, 0.5, 0.5]]))[0])
    content = answer.answer(of, of.sample()[0], [types.SimpleNamespace(name="all")])
    assert content["unknowns"]["wall_friction"]["width_over_prior"] == pytest.approx(1, abs=0.1)
    assert content["unknowns"]["friction"]["width_over_prior"] < 0.4
    assert any(line.startswith("wall_friction: not determined") for line in content["words"])
    least = content["directions"][-1]
    assert max(least["weights"], key=lambda name: abs(least["weights"][name])) == "wall_friction" and least["sd"] == pytest.approx(1, abs=0.1)


def test_a_combination_is_named():
    """A sum of both unknowns alone is known."""
    unit = scipy.stats.qmc.Sobol(2, seed=1).random(32)
    emulated = emulator.Emulator(unit, unit.sum(axis=1, keepdims=True), np.full((32, 1), 0.01), ["sum"])
    of = posterior.Posterior(priors(["friction", "rolling_resistance"]), [posterior.Datum(emulated, np.array([1.0]), np.array([0.02]))])
    content = answer.answer(of, of.sample()[0], [types.SimpleNamespace(name="one")])
    assert content["correlations"][0][1] < -0.95 and any("combination of both" in line and "less" in line for line in content["words"])
    assert abs(content["directions"][0]["weights"]["friction"]) == pytest.approx(np.sqrt(0.5), abs=0.05)
    assert "nearly always" in content["words"][0]  # one number, two unknowns


def test_the_same_question_gives_the_same_samples(emulated, monkeypatch):
    monkeypatch.setattr(posterior, "FIRST_STEPS", 30)
    monkeypatch.setattr(posterior, "LONG_ENOUGH", 0)
    of = asked(emulated, angles(np.array([[0.2, 0.5, 0.5]]))[0])
    assert (of.sample()[0] == of.sample()[0]).all()


def test_a_prior_is_kept_where_there_are_no_data():
    of = posterior.Posterior({"friction": question.Prior(0.1, 0.8, mean=0.4, sd=0.05), "rolling_resistance": question.Prior(1e-3, 0.1, log=True)}, [])
    samples = of.sample()[0] if of.data else of.of_prior(4096)
    assert (samples[:, 0].mean(), samples[:, 0].std()) == pytest.approx((0.4, 0.05), rel=0.02)
    assert np.median(samples[:, 1]) == pytest.approx(0.01, rel=0.02)


@pytest.fixture(name="scene")
def _scene(tmp_path):
    file = tmp_path / "silo.toml"
    file.write_text((SOURCES / "data" / "infer" / "silo.toml").read_text(encoding="utf-8"), encoding="utf-8")
    return file


def finished(planned):
    """As if it had been run."""
    planned.folder.mkdir(parents=True)
    text = design.resolved(planned.family.scene, planned.changes)
    (planned.folder / "scene.toml").write_text(text, encoding="utf-8")
    (planned.folder / "run.json").write_text(json.dumps({"status": "finished", "cpu_seconds": 2.0}), encoding="utf-8")


def test_runs_are_kept_for_the_next_question(scene, tmp_path):
    of = design.family(scene, {}, RANGES, tmp_path / "designs")
    first = design.plan(of, 16)
    assert len({run.folder for run in first}) == 16 and all(run.status() == "" for run in first)
    for run in first[:10]:
        finished(run)
    # Interrupted: the same call goes on with the six that are missing.
    assert {run.folder for run in design.plan(of, 16)} == {run.folder for run in first}
    for run in first[10:]:
        finished(run)
    # Another question with half the range takes those that lie in it and makes the rest anew.
    half = design.family(scene, {}, RANGES | {"friction": (0.1, 0.45)}, tmp_path / "designs")
    again = design.plan(half, 16)
    inside = {run.folder for run in first if run.point[0] <= 0.45}
    assert half.folder == of.folder and inside and inside < {run.folder for run in again} and len(again) == 16
    # One with wall friction given has none of them.
    assert not [run for run in design.plan(design.family(scene, {}, {"friction": (0.1, 0.8)}, tmp_path / "designs"), 16) if run.status()]
    # Another setting is another family.
    assert design.family(scene, {"stages.1.duration_s": 2.0}, RANGES, tmp_path / "designs").folder != of.folder


def test_unknowns_may_be_equal(scene, tmp_path):
    of = design.family(scene, {}, {"friction": (0.1, 0.8), "wall_friction": "friction"}, tmp_path)
    run = design.plan(of, 4)[0]
    assert run.changes["effects.friction.grain_wall"] == run.changes["effects.friction.grain_grain"] == run.point[0]
    finished(run)
    assert of.values(run.folder) == pytest.approx(run.point)


def test_the_price_is_said_before_the_runs(scene, tmp_path, monkeypatch):
    rate = question.Measured(observables.RATE, None, np.array([900.0]), np.array([9.0]))
    asked_for = question.Question("", 16, priors(), {}, [question.Scene("silo", str(scene), {}, 1, [rate])])
    one, said, made = command.Design(asked_for, asked_for.scenes[0], tmp_path), [], []

    def make_all(runs, *_):
        made.append(len(runs))
        for run, _ in runs:
            finished(run)
    monkeypatch.setattr(design, "make_all", make_all)
    command.make([one], tmp_path, "local", said.append)
    assert made == [1, 15] and said[0] == "16 runs to make of 16" and said[1].startswith("cost: 30 s of a processor")
    command.make([one], tmp_path, "local", said.append)
    assert made[2:] == [0]


def heap(slope_deg):
    """A heap at a wall on a floor, whose surface falls at this angle from 12 d, on nodes 1 d apart; over the edge there is nothing."""
    x, z = np.arange(0.0, 40), np.arange(-3.0, 20)
    height = np.clip(12 - np.tan(np.radians(slope_deg)) * x, 0, None)
    nu = np.where((z[:, None] <= height) & (z[:, None] >= 0) & (height > 0.5), 0.8, 0.0)[None, None]
    there = np.where(height > 0.5, height, np.nan)[None, None]
    return Frames("", {"nu_bulk": "0.8"}, {}, ["run"], np.array([0.0]), x, z, there, there, {"nu": nu, "v_x": nu, "I": nu}, {}, {})


@pytest.mark.parametrize("slope_deg", [18, 30])
def test_the_angle_of_repose_is_that_of_the_surface(slope_deg):
    assert observables.repose_angle(heap(slope_deg)) == pytest.approx(slope_deg, abs=0.1)


QUESTION = """
format = "drumlin-question-1"
runs = 32
[unknowns]
friction = [0.1, 0.8]
wall_friction = "friction"
[[scenes]]
scene = "silo"
[[scenes.measured]]
quantity = "rate_grains_per_s"
value = 1000
interval = 30
confidence = 0.95
"""


def test_a_question_is_read(tmp_path):
    file = tmp_path / "question.toml"
    file.write_text(QUESTION, encoding="utf-8")
    found = question.read_question(file)
    assert found.runs == 32 and found.equal == {"wall_friction": "friction"} and found.scenes[0].scene == "silo"
    assert found.scenes[0].values()[1] == pytest.approx(30 / 1.959964)


def write_table(folder):
    """Two speeds, twelve frictions: an angle that grows by 10 a unit of friction and 0.1 a revolution."""
    rows = [f"{friction},{rpm},{18 + 10 * friction + 0.1 * rpm},0.5" for rpm in (2, 6) for friction in np.linspace(0.05, 0.9, 12)]
    (folder / "runs.csv").write_text("\n".join(["friction,rotation_rpm,theta_deg,theta_deg_ci99", *rows]) + "\n", encoding="utf-8")


def table_question(folder, slow, fast, settings="settings = { rotation_rpm = 6 }"):
    text = """format = "drumlin-question-1"
unknowns = { friction = [0.05, 0.9] }
[[scenes]]
name = "slow"
table = "runs.csv"
settings = { rotation_rpm = 2 }
measured = [{ quantity = "theta_deg", value = SLOW, interval = 0.5 }]
[[scenes]]
name = "fast"
table = "runs.csv"
SETTINGS
measured = [{ quantity = "theta_deg", value = FAST, interval = 0.5 }]
""".replace("SLOW", str(slow)).replace("FAST", str(fast)).replace("SETTINGS", settings)
    (folder / "question.toml").write_text(text, encoding="utf-8")
    return question.read_question(folder / "question.toml")


def test_runs_of_others_are_a_table(tmp_path):
    write_table(tmp_path)
    read = table_question(tmp_path, 22.2, 22.6)
    samples, content = command.inferred(read, command.designs_of(read, tmp_path))
    # Both angles say 0.4; each is known to 0.5/2.576 deg, both to 0.7 of that, 10 deg a unit of friction.
    assert content["unknowns"]["friction"]["median"] == pytest.approx(0.4, abs=0.01)
    assert content["unknowns"]["friction"]["sd"] == pytest.approx(0.0137, rel=0.35) and samples.shape[1] == 1
    assert [one["runs"] for one in content["designs"]] == [12, 12] and not content["misfit"]["is_misfit"]
    assert content["law"] is None  # nothing is known of sizes and restitution


@pytest.mark.parametrize("settings, said", [("settings = { rotation_rpm = 7 }", "0 rows"), ("settings = { speed = 6 }", "holds no column speed")])
def test_a_table_without_such_runs_is_refused(tmp_path, settings, said):
    write_table(tmp_path)
    read = table_question(tmp_path, 22.2, 22.6, settings)
    with pytest.raises(InputError, match=said):
        command.inferred(read, command.designs_of(read, tmp_path))


@pytest.mark.parametrize("wrong, by, said", [
    ("[0.1, 0.8]", "[0.8, 0.1]", "unknowns.friction.range"), ('"friction"', '"restitution"', "unknowns.wall_friction"), ("runs = 32", "runs = 2", "runs"),
    ("interval = 30", "", "scenes.0.measured.0.interval"), ("value = 1000", "value = [1, 2]", "scenes.0.measured.0.value"),
    ('scene = "silo"', "", "scenes.0.scene"), ("friction = [", "smoothness = [", "unknowns.smoothness"), ("confidence", "konfidence", "konfidence"),
    ("interval = 30", "interval = -3", "at least 0"), ('scene = "silo"', 'table = "none.csv"', "scenes.0.table")])
def test_what_is_wrong_in_a_question_is_named(tmp_path, wrong, by, said):
    file = tmp_path / "question.toml"
    file.write_text(QUESTION.replace(wrong, by, 1), encoding="utf-8")
    with pytest.raises(InputError) as error:
        question.read_question(file)
    assert said in str(error.value) and str(file) in str(error.value)


def test_mu_at_given_inertial_number_is_that_of_the_library(tmp_path):
    (tmp_path / "question.toml").write_text("""format = "drumlin-question-1"
unknowns = { friction = [0.05, 0.6] }
[[scenes]]
library = { spread = 0.2 }
measured = [{ quantity = "mu", I = [0.0113, 0.09], value = [0.28, 0.378], interval = [0.01, 0.01] }]
""", encoding="utf-8")
    read = question.read_question(tmp_path / "question.toml")
    samples, content = command.inferred(read, command.designs_of(read, tmp_path))
    # The library's own numbers at 0.4; 0.256 and 0.344 at 0.2.
    assert content["unknowns"]["friction"]["low"] > 0.2 and content["unknowns"]["friction"]["low"] < 0.4 < content["unknowns"]["friction"]["high"]
    law = content["law"]
    assert np.interp(0.09, law["I"], law["mu"]) == pytest.approx(0.378, abs=0.02) and samples.shape[1] == 1
    assert [row["name"] for row in content["data"]] == ["mu(I=0.0113)", "mu(I=0.09)"]


def test_the_command_answers(tmp_path):
    write_table(tmp_path)
    asked_for = {"unknowns": {"friction": [0.05, 0.9]}, "scenes": [
        {"name": f"{rpm} rpm", "table": str(tmp_path / "runs.csv"), "settings": {"rotation_rpm": rpm},
         "measured": [{"quantity": "theta_deg", "value": value, "interval": 0.5}]} for rpm, value in ((2, 22.2), (6, 24.6))]}
    answered = drumlin.infer(asked_for, tmp_path / "INFER")
    content = answered["infer.json"]
    # 2 deg too many at one speed: no friction gives both, and the exit code is that of an answer.
    assert content["misfit"]["is_misfit"] and content["words"][0].startswith("MISFIT")
    assert {"infer.json", "samples.csv"} <= set(answered.files)
    assert all((tmp_path / "INFER" / f"{name}.png").stat().st_size > 5000 for name in ("corner", "data"))
    assert len(answered["samples.csv"]["friction"]) == content["samples"]
    with pytest.raises(InputError):
        drumlin.infer(asked_for, tmp_path / "INFER")
