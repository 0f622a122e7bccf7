"""The score of a continuum: fields of another program read as they are meant, errors that are known, faults that say where they are."""

import json

import drumlin
import numpy as np
import pytest
from conftest import SOURCES
from drums import TIME_S, drum_run, flow, write_flow, write_run
from drumlin import study

LIMITS = SOURCES / "data/limits/bed.toml"
X, Z = np.arange(-60.0, 61), np.arange(-70.0, 1)  # nodes, d
HEAD = {"rotation_rpm": 6, "drum_diameter_mm": 450, "grain_diameter_mm": 3.3, "density_kg_m3": 2700, "theta_deg": 19.5, "surface_depth_mm": 13.2,
        "axes": "surface", "velocities": "drum"}


def fields(rate=1.0, shear=1.0):
    """A layer that flows over a bed, z = -15, in surface axes, as arrays over the points; z from the drum's axis, 4 d above the surface. NaN outside."""
    x, z = (axis.ravel() for axis in np.meshgrid(X, Z))
    local = rate * 0.15 * np.exp(np.minimum(z + 15, 0) / 3)
    speed = rate * 0.15 * np.where(z > -15, z + 18, 3 * np.exp(np.minimum(z + 15, 0) / 3))
    stress, zero = 0.1 - 0.77 * z, 0 * x
    inside = np.where(np.hypot(x, z - 4) < 68, 1, np.nan)
    found = {"vx": speed, "vz": zero, "sxx": stress, "sxz": shear * (0.3 + 1e-3 * x) * stress, "szz": stress, "dvx_dx": zero, "dvx_dz": local,
             "dvz_dx": zero, "dvz_dz": zero}
    return {"x": x, "z": z - 4} | {name: values * inside for name, values in found.items()}


def write_fields(path, f, units=None, **head):
    names = [f"{name} ({(units or {}).get(name, '1')})" for name in f]
    lines = [f"# {key} = {value}" for key, value in (HEAD | head).items()] + [",".join(names)]
    path.write_text("\n".join(lines + [",".join("" if np.isnan(value) else repr(float(value)) for value in row) for row in zip(*f.values())]) + "\n")
    return path


def maps_of(f, side):
    """What write_maps() takes, with the invariants that a run's maps hold."""
    header, x, z, found, scales = study.map_of_fields(HEAD, dict(f))
    p, rate = found["sigma_xx"], abs(found["d_v_x_dz"])
    found |= {"nu": 0.8 + 0 * p, "strain_rate": rate, "p": p, "I": rate / np.sqrt(p), "mu": found["sigma_xz"] / p, "axis_angle_deg": 0 * p}
    theta, rotation = (float(drum_run(6).profile.header[key]) for key in ("theta_deg", "rotation"))
    return header | {"side": side, "theta_deg": theta, "rotation": rotation}, x, z, found, scales


@pytest.fixture
def bed(tmp_path):
    """A run with the maps of fields()."""
    run = write_run(tmp_path, drum_run(6))
    study.write_maps(run / "measured/maps.h5", *maps_of(fields(), "particles"))
    return run


def scored(given, run, **more):
    content = drumlin.score(given, LIMITS, run.parent / "score", against=[run], **more)
    return {(row["quantity"], row["where"], row["zone"]): row for row in content["rows"] if row["registered_by"] == "axis"}, content


def test_fields_with_a_known_error_score_just_that(tmp_path, bed):
    """Shear stress 10 % too high, everything 10^0.25 too fast: 0.1 and 0.25 decades wherever both are read off maps."""
    rows, content = scored(write_fields(tmp_path / "other.csv", fields(10**0.25, 1.1)), bed)
    assert rows["sigma_xz", "map", "static"]["error"] == pytest.approx(0.1, rel=1e-9) and rows["sigma_xz", "map", "static"]["met"]
    assert rows["log10_shear_rate", "map", "static"]["error"] == pytest.approx(0.25, rel=1e-9)
    assert rows["traction_ratio", "wall", ""]["error"] > 0.02 and not rows["axis_angle_deg", "map", "all"]["error"] > 20
    assert rows["theta_deg", "scalar", ""]["error"] == pytest.approx(abs(19.5 - float(drum_run(6).profile.header["theta_deg"])))
    assert rows["seconds_cold", "cost", ""]["met"] is None and content["scored"] == "other.csv" and content["against"] == ["rpm-6"]
    written = json.loads((tmp_path / "score/score.json").read_text())
    assert written["format"] == "drumlin-score-1" and written["verdict"] == content["verdict"] and sum(content["verdict"].values()) == 16
    assert "| sigma_xz static, map, relative | 0.1 | 0.15; 0.1 | - | yes |" in (tmp_path / "score/score.md").read_text()


def test_a_flow_scores_the_same_through_maps_and_fields_and_as_its_study_says(tmp_path, bed):
    shown = write_flow(tmp_path, flow(6, fitted_on=["somewhere"]))
    study.write_maps(shown / "maps.h5", *maps_of(fields(1.2, 1.05), "continuum"))
    rows = scored(shown, bed)[0]
    drumlin.command("compare", "--study", bed, shown, "--limits", LIMITS, "-o", tmp_path / "study")
    judged = {(row["quantity"], row["where"], row["zone"]): row["cells"][0] for row in json.loads((tmp_path / "study/study.json").read_text())["limits"]["rows"]
              if row["registered_by"] == "axis"}
    assert {name: row["error"] for name, row in rows.items()} == {name: cell["value"] for name, cell in judged.items()}
    theta = drum_run(6).profile.header["theta_deg"]
    for given in (shown / "maps.h5", write_fields(tmp_path / "fields.csv", fields(1.2, 1.05), theta_deg=theta)):
        again = scored(given, bed, overwrite=True)[0]
        for name in (("sigma_xz", "map", "static"), ("log10_shear_rate", "map", "static"), ("traction_ratio", "wall", "")):
            assert again[name]["error"] == pytest.approx(rows[name]["error"], rel=1e-9)
        assert again["theta_deg", "scalar", ""]["error"] == pytest.approx(rows["theta_deg", "scalar", ""]["error"], abs=1e-9)
    only = scored(shown / "profiles.csv", bed, overwrite=True)[0]
    assert only["sigma_xz", "centre", "static"]["error"] == rows["sigma_xz", "centre", "static"]["error"] and only["sigma_xz", "map", "static"]["met"] is None


def test_axes_units_and_scattered_points_change_nothing(tmp_path):
    """The same fields with laboratory axes and velocities, in SI, without gradients and in another order: the map is that of the nodes."""
    f, turn, d = fields(), np.radians(19.5), 3.3e-3
    c, s, omega = np.cos(turn), np.sin(turn), 6 * np.pi / 30 * TIME_S
    speed, stress = np.sqrt(9.81 * d), 2700 * 9.81 * d
    to_lab = np.array([[c, s], [-s, c]])
    vx, vz = to_lab @ [f["vx"] + omega * f["z"], f["vz"] - omega * f["x"]] * speed
    x, z = to_lab @ [f["x"], f["z"]] * d * 1000
    pressure = np.einsum("ia,abn,jb->ijn", to_lab, [[f["sxx"], -f["sxz"]], [-f["sxz"], f["szz"]]], to_lab) * stress
    inside = np.random.default_rng(1).permutation(np.flatnonzero(np.isfinite(f["sxx"])))
    there = {"x": x, "z": z, "vx": vx, "vz": vz, "sxx": pressure[0, 0], "sxz": -pressure[0, 1], "szz": pressure[1, 1], "p": (pressure[0, 0] + pressure[1, 1]) / 2}
    units = {"x": "mm", "z": "mm", "vx": "m/s", "vz": "m/s"} | dict.fromkeys(("sxx", "sxz", "szz", "p"), "Pa")
    path = write_fields(tmp_path / "lab.csv", {name: values[inside] for name, values in there.items()}, units, axes="laboratory", velocities="laboratory")
    header, x, z, found, _ = study.map_of_fields(*study.read_fields(path))
    here, there = (np.ix_(np.searchsorted(rows, np.arange(-60, 0)), np.searchsorted(columns, np.arange(-50, 51))) for rows, columns in ((Z, X), (z, x)))
    ours = study.map_of_fields(HEAD, f)[3]
    for name, near in (("v_x", 1e-9), ("sigma_xz", 1e-8), ("sigma_zz", 1e-8), ("d_v_x_dz", 0.08)):  # the kink at -15 cut off
        known = np.isfinite(found[name][there])
        assert known.mean() > 0.7 and np.allclose(found[name][there][known], ours[name][here][known], rtol=near, atol=near * np.nanmax(abs(ours[name])))
    assert header["axis_depth"] == pytest.approx(4) and header["rotation"] == pytest.approx(omega)


@pytest.mark.parametrize("old, new, words", [
    ("# theta_deg = 19.5\n", "", "fields.csv: theta_deg: is missing in the header"), ("= surface", "= mine", 'fields.csv:7: axes: "mine" is not known .allowed: lab'),
    ("rpm = 6", "rpm = fast", 'fields.csv:1: rotation_rpm: "fast"'), ("vz (1)", "vz (km/h)", 'fields.csv:9:4: vz: has the unit "km/h" .allowed: vz .1., vz .m/s'),
    ("szz (1)", "pzz (1)", "fields.csv:9:7: pzz: is no column of fields"), ("dvz_dz (1)", "p (1)", "fields.csv:9: dvx_dx.*some are missing"),
    ("\n-60.0,", "\nleft,", 'fields.csv:10:1: x: "left" does not do .allowed: a number of at most'), ("\n-59.0,", "\n-59.0,,", "fields.csv:11: has 12 fields .allowed: 11"),
    ("diameter_mm = 450", "diameter_mm = 400", r"fields.csv:\d+: x, z: lies outside of the drum"),
    ("rpm = 6", "rpm = 1e300", "rpm: .*allowed: .*below 1e.09"),
    ("\n-59.0,", "\n-60.0,", "fields.csv:11: x, z: is the point of line 10 again .allowed: each point once"),
    (",0.0,", ",1e300,", r'fields.csv:\d+:4: vz: "1e300" does not do .allowed: a number of at most 1e.09, or nothing'),
    ("# axes", "# theta_deg = 20\n# axes", "fields.csv:7: theta_deg: appears twice .allowed: once")])
def test_faults_of_a_file_of_fields_have_line_and_column(tmp_path, old, new, words):
    path = write_fields(tmp_path / "fields.csv", {name: values[:1000] for name, values in fields().items()})
    path.write_text(path.read_text().replace(old, new, 1))
    with pytest.raises(drumlin.InputError, match=words):
        study.read_fields(path)


def test_stress_that_is_not_what_it_should_be_is_refused(tmp_path):
    f = fields()
    for change, words in (({"vz": np.nan * f["vz"]}, "vz: holds no number"),
                          ({"sxx": -f["sxx"], "szz": -f["szz"]}, "tensions"), ({"p": 2 * f["sxx"]}, r"fields.csv:\d+:12: p: .*the mean of sxx and szz")):
        with pytest.raises(drumlin.InputError, match=words):
            study.read_fields(write_fields(tmp_path / "fields.csv", f | change))


def test_what_cannot_be_scored_is_refused_and_leaves_nothing(tmp_path, bed):
    other = write_run(tmp_path, drum_run(10))
    fields_file = write_fields(tmp_path / "fields.csv", fields())
    (tmp_path / "notes.txt").write_text("v_x\n")
    for given, run, words in ((fields_file, other, "no run turns at 6 rpm"), (tmp_path / "notes.txt", bed, "is no file of fields"),
                              (bed, bed, "no flow.json"), (bed / "measured/maps.h5", bed, "maps.h5: side: is not that of a continuum")):
        with pytest.raises(drumlin.InputError, match=words):
            scored(given, run)
        assert not (tmp_path / "score").exists()
