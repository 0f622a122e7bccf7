"""Both sides of a pair: measures on frames that are known, limits, pair.json and its page."""

import json
import math

import numpy as np
import pytest

from conftest import SOURCES
from drumlin.errors import InputError
from drumlin.figures import result_files
from drumlin.hdf5 import write_hdf5
from drumlin.pair import comparison, frames, geometry, judgement, loads, measures

LIMITS = SOURCES / "data/limits/pair.toml"
X, Z, TIMES = np.arange(0, 61.0), np.arange(0, 31.0), np.arange(0, 9.0)
NU = 0.8


def spread(t, run=0.0):
    """Height of a triangle of one area that spreads, over x; `run` moves its top."""
    width = 20 + 5 * min(t, 6)
    return np.maximum(0, 400 / width * (1 - X / width)) * (1 + run)


def side(file, runs=1, noise=0.0, faster=1.0, more=None, drift=False):
    """A file of frames of heaps that spread: v_x over x and t, a hydrostatic pressure; run k differs by `noise` times its number from the middle."""
    shift = noise * (np.arange(runs) - (runs - 1) / 2)
    h = np.array([[spread(t, one) for t in TIMES] for one in shift])
    there = Z[None, None, :, None] <= h[:, :, None, :] - 0.5
    moving = np.where(TIMES < 6, 1.0, 0.0)[None, :, None, None]
    full = np.ones_like(there, float)
    p = np.maximum(0, h[:, :, None, :] - Z[None, None, :, None]) * NU
    fields = {"nu": NU * full, "v_x": faster * moving * (1 + X / 60) * (1 + shift[:, None, None, None]) * full, "v_z": 0 * full, "sigma_xx": p, "sigma_zz": p,
              "sigma_xz": 0.3 * p, "I": 0.1 * moving * full, "mu": 0.3 * full, "p": p}
    area = 200 * (1 + shift[:, None]) * np.ones(len(TIMES))
    scalars = {"area": area, "centre_x": (h * X).sum(axis=-1) / h.sum(axis=-1) * (1 + drift * shift[:, None]),
               "centre_z": (h**2).sum(axis=-1) / h.sum(axis=-1) / 2,
               "kinetic_energy": area * faster**2 * moving[:, :, 0, 0], "discharged": 0 * area, "discharge_rate": 0 * area}
    write_hdf5(file, {"format": "drumlin-frames-1", "names": "\n".join(fields), "header": f"nu_bulk = {NU}\ntitle = heap",
                      "scales/length_m": 2e-3, "scales/time_s": 0.0143, "scales/density_kg_m3": 2700.0, "runs": "\n".join(f"run-{k}" for k in range(runs)),
                      "times": TIMES, "x": X, "z": Z, "height": np.where(h > 0, h, np.nan), "mass_height": h,
                      "loads/floor": np.stack([0.1 * area, -NU * area], axis=-1)}
               | {f"fields/{name}": np.where(there, values, np.nan) for name, values in fields.items()}
               | {f"scalars/{name}": values for name, values in scalars.items()} | (more or {}))
    return file


def of(rows, quantity):
    return next(row for row in rows if row["quantity"] == quantity)


def test_the_same_on_both_sides_differs_by_nothing(tmp_path):
    one = side(tmp_path / "a.h5", 6, 0.01)
    content = comparison.compare(one, side(tmp_path / "b.h5"), tmp_path / "out", "collapse", LIMITS, figures=False)
    assert max(content["heights"]["rms"]["value"]) < 1e-12
    assert content["errors"]["v"]["flowing"]["pooled"]["value"] < 0.01, "at the surface runs differ in whether they have material"
    assert {row["must_outcome"] for row in content["rows"] if row["quantity"] in ("h", "v", "floor", "mass")} == {"met"}
    assert {row["must_outcome"] for row in content["rows"] if row["quantity"] in ("energy",)} == {"not_measured"}
    assert content["time_of_stopping"]["continuum"] == 6 and content["fill"]["height"] == pytest.approx(20)
    assert json.loads((tmp_path / "out/pair.json").read_text())["rows"] == content["rows"]


def test_a_faster_continuum_is_off_by_as_much(tmp_path):
    content = comparison.compare(side(tmp_path / "a.h5", 6, 0.01), side(tmp_path / "b.h5", faster=1.2), tmp_path / "out", "collapse", LIMITS, figures=False)
    v = content["errors"]["v"]["flowing"]
    assert v["pooled"]["value"] == pytest.approx(0.2, abs=0.005) and v["value"][0] == pytest.approx(0.2, abs=0.005)
    assert v["value"][-1] is None, "nothing flows in the last frame"
    assert of(content["rows"], "v")["must_outcome"] == "missed"


def test_a_limit_below_the_noise_floor_is_judged_against_that(tmp_path):
    content = comparison.compare(side(tmp_path / "a.h5", 2, 0.3), side(tmp_path / "b.h5", faster=1.2), tmp_path / "out", "collapse", LIMITS, figures=False)
    row = of(content["rows"], "v")
    # Halves of runs of 0.85 and 1.15 differ by 0.3/0.85.
    assert row["floor"] == pytest.approx(0.3 / 0.85, rel=1e-9)
    assert row["limit"] == row["floor"] and row["must_outcome"] == "met" and row["must"] == 0.15


def test_halvings_are_all_ways_to_part_runs_into_two():
    assert [len(measures.halvings(count)) for count in (1, 2, 3, 4, 6)] == [0, 1, 3, 3, 10]
    assert all(set(a) & set(b) == set() and len(a) == len(b) for a, b in measures.halvings(5))


def test_run_out_is_that_of_the_height_asked_for(tmp_path):
    mean = measures.Mean(frames.read_frames(side(tmp_path / "a.h5")), np.zeros(len(X)))
    # Above 1.5 d the triangle reaches to width (1 - 1.5 width/400): 18.5 at first, 40.6 at the end; nodes are 1 d apart.
    assert measures.run_out(mean, 1.5)[-1] == pytest.approx((40 - 18) / 18)
    assert measures.repose_angle(mean) == pytest.approx(math.degrees(math.atan(400 / 50**2)), rel=1e-6)


def test_other_grids_are_refused(tmp_path):
    with pytest.raises(InputError, match="times: has 8"):
        comparison.compare(side(tmp_path / "a.h5"), side(tmp_path / "b.h5", more={"times": TIMES[1:]}), tmp_path / "out", figures=False)


def test_limits_say_what_they_hold_of_wrong(tmp_path):
    file = tmp_path / "limits.toml"
    file.write_text('format = "drumlin-limits-1"\n[[limits]]\ncase = "collapse"\nquantity = "h"\nwhere = "hight"\nmeasure = "rms"\n'
                    'times = "often"\nmust = -1\n')
    with pytest.raises(InputError) as refusal:
        judgement.read_pair_limits(file)
    assert {problem["key"] for problem in refusal.value.problems} == {f"limits.0.{key}" for key in ("where", "zone", "measure", "times", "must")}


def test_offsets_of_slots_are_taken_out():
    widths = np.array([8.0, 12, 16])
    contents = [{"slot_width": w, "rate": {"particles": 0.8 * (w - 2) ** 1.5, "continuum": 0.9 * (w + 1) ** 1.5}} for w in widths]
    found = judgement.rate_offsets(judgement.read_pair_limits(LIMITS), contents)
    assert found["k"] == pytest.approx({"particles": 2, "continuum": -1})
    assert [row["value"] for row in found["rows"]] == pytest.approx([0.125] * 3)
    assert {row["must_outcome"] for row in found["rows"]} == {"met"}


def test_published_heights_are_met_by_themselves(tmp_path):
    read = frames.read_frames(side(tmp_path / "a.h5"))
    table = [{"time": str(t / math.sqrt(20)), "x": x / 20, "h": spread(t)[x] / 20} for t in (2, 5, 8) for x in (0, 10, 20, 30)]
    row = judgement.against_heights(judgement.read_pair_limits(LIMITS), "lagree-column", read, table)
    assert row["value"] < 1e-12 and row["must_outcome"] == "met"


def test_a_silo_is_judged_in_its_steady_part(tmp_path):
    scene = tmp_path / "flow.toml"
    scene.write_text('format = "drumlin-flow-scene-1"\n[[walls]]\nname = "floor"\nfrom_mm = [0, 0]\nto_mm = [16, 0]\n'
                     '[[openings]]\nname = "slot"\nfrom_mm = [16, 0]\nto_mm = [28, 0]\n')

    def silo(name, factor):
        v_z = np.full((1, len(TIMES), len(Z), len(X)), -1.0 * factor)
        return side(tmp_path / name, more={"scalars/discharged": [20 * factor * TIMES], "fields/v_z": v_z})
    content = comparison.compare(silo("a.h5", 1.0), silo("b.h5", 1.2), tmp_path / "out", "silo", LIMITS, scene, figures=False)
    assert (content["slot_width"], content["rate"]["particles"], content["rate"]["continuum"]) == pytest.approx((6, 20, 24))
    assert content["rate"]["steady"]["particles"] == pytest.approx([1, 5])
    assert of(content["rows"], "v_z")["value"] == pytest.approx(0.2)
    # The heap sinks: over the continuum's shorter steady part, 0.83 to 4.2, it is the higher one.
    assert 0 < of(content["rows"], "floor")["value"] < 0.1 and of(content["rows"], "left")["must_outcome"] == "not_measured"


def test_one_run_has_no_noise_floor(tmp_path):
    content = comparison.compare(side(tmp_path / "a.h5"), side(tmp_path / "b.h5"), tmp_path / "out", "drum-start", LIMITS, figures=False)
    assert content["heights"]["rms"]["floor"] is None
    assert of(content["rows"], "slope_deg")["must_outcome"] == "not_measured"


def test_a_continuum_inside_the_interval_is_told_as_a_share_of_the_times(tmp_path):
    later = 1 + 0.3 * (TIMES > 4)
    other = {"scalars/centre_x": [later * (lambda h: (h * X).sum(axis=-1) / h.sum(axis=-1))(np.array([spread(t) for t in TIMES]))]}
    content = comparison.compare(side(tmp_path / "a.h5", 6, 0.01, drift=True), side(tmp_path / "b.h5", more=other), tmp_path / "out", "drum-start", LIMITS,
                                 figures=False)
    row = of(content["rows"], "centre_x")
    assert row["value"] == pytest.approx(5 / 9) and row["must_outcome"] == "missed"


def test_published_rates_are_met_by_the_wider_slots(tmp_path, data):
    table = result_files.read_rows(data / "pair/silo-rates.csv")
    found = {row["half_width"]: frames.read_frames(side(tmp_path / f"{k}.h5", more={"scalars/discharge_rate": [1.03 * row["rate"] * 30**1.5 * (TIMES > 1)]}))
             for k, row in enumerate(table)}
    rows = judgement.against_rates(judgement.read_pair_limits(LIMITS), found, table)
    assert [row["value"] for row in rows] == pytest.approx([0.03] * 4)
    assert [(row["must_outcome"], row["aim_outcome"]) for row in rows] == [(None, None)] + [("met", "missed")] * 3


def test_loads_are_means_over_time_where_a_run_has_them(tmp_path):
    read = frames.read_frames(side(tmp_path / "a.h5", more={"header": f"nu_bulk = {NU}\ntime_origin_s = 0.5"}))
    unit, lines = 2700 * 2e-3**3 / 0.0143**2, ["time_s,interval_s,wall,force_x_n_m,force_z_n_m"]
    # Two intervals of 0.2 sqrt(d/g) about each whole time, at 1 and 3 units, and others in between.
    for k in range(-4, 45):
        force = {-1: 1, 0: 3}.get((k + 2) % 5 - 2, 100) if k >= 0 else 1e9
        lines += [f"{0.5 + (k + 1) * 0.2 * 0.0143},{0.2 * 0.0143},{name},0,{-force * unit}" for name in ("floor", "gate")]
    (tmp_path / "walls.csv").write_text("\n".join(lines) + "\n")
    found = loads.mean_loads(read, [tmp_path], height=4.0)
    assert found.keys() == {"floor"} and found["floor"][0, 1:, 1] == pytest.approx(-2)
    assert math.isnan(found["floor"][0, 0, 1]), "nothing from before the origin"
    assert loads.mean_loads(read, [tmp_path / "none"], height=4.0) is None


def test_stress_inside_a_wall_is_normal_to_it(tmp_path):
    read = frames.read_frames(side(tmp_path / "a.h5"))
    walls = geometry.Walls({"floor": [np.array([[0.0, 0], [10, 0]])]})
    stress = {name: read.fields[name][0, 0] for name in ("sigma_xx", "sigma_zz", "sigma_xz")}
    lines = walls.inside("floor", 2.0, lambda points: np.isfinite(geometry.at(read, stress["sigma_zz"], points)))
    assert geometry.normal_stress(read, stress, lines) == pytest.approx((spread(0)[:10] - 2) * NU)


def test_a_page_moves_both_sides(tmp_path):
    comparison.compare(side(tmp_path / "a.h5", 6, 0.01), side(tmp_path / "b.h5", faster=1.2), tmp_path / "out", "collapse", LIMITS)
    page = (tmp_path / "out/index.html").read_text(encoding="utf-8")
    assert page.count("<canvas") >= 2 and "http" not in page.replace("http://www.w3.org", "")
    assert {file.name for file in (tmp_path / "out").glob("*.png")} >= {"heights.png", "maps.png", "differences.png", "series.png"}
