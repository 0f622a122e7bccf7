"""Laws over arrays, and calibration from arrays."""

import drumlin
import numpy as np
import pytest

I = np.logspace(-3, -1, 60)  # noqa: E741
ERROR = 0.003


def measured(seed):
    return 0.35 + 0.02 * np.log(I) + ERROR * np.random.default_rng(seed).normal(size=I.size)


def test_points_of_a_logarithm_give_it_back():
    law = drumlin.calibrate([I, I], [measured(1), measured(2)], mu_error=[np.full_like(I, ERROR)] * 2, nu=0.81, form="log")
    a, b = law.coefficients
    assert (law.form, law.points) == ("log", 120)
    assert a == pytest.approx(0.35, abs=5e-3) and b == pytest.approx(0.02, abs=1e-3)
    low, high = law.band(I)
    assert ((low < law.mu(I)) & (law.mu(I) < high)).all()
    assert law.mu(I) == pytest.approx(0.35 + 0.02 * np.log(I), abs=5e-3)
    assert law.slope(I) == pytest.approx(b, rel=0.05)


def test_a_law_goes_through_its_file(tmp_path):
    law = drumlin.calibrate(I, measured(3), nu=0.81, form="table")
    law.write(tmp_path / "law.toml")
    again = drumlin.Law(tmp_path / "law.toml")
    assert again.nu == law.nu == 0.81 and (again.mu(I) == law.mu(I)).all()
    assert drumlin.read(tmp_path / "law.toml")["format"] == "drumlin-rheology-1"


def test_the_laws_of_the_repository_are_read(data):
    paper = drumlin.Law(data / "rheology/paper.toml")
    assert paper.mu(1e-2) == pytest.approx(0.35 + 0.013 * np.log(1e-2), abs=1e-4)
    assert paper.mu(np.full((2, 3), 1e-2)).shape == (2, 3)


def test_wrong_points_are_refused(tmp_path):
    with pytest.raises(drumlin.InputError, match="does not grow"):
        drumlin.calibrate(I, measured(1)[::-1], nu=0.81, form="log")
    with pytest.raises(drumlin.InputError, match="volume fraction"):
        drumlin.calibrate(I, measured(1), nu=81)
    with pytest.raises(drumlin.InputError, match="not of one length"):
        drumlin.calibrate(I, measured(1)[1:], nu=0.81)
    for wrong in (0, -ERROR, np.nan, np.inf):
        for name in ("I_error", "mu_error"):
            with pytest.raises(drumlin.InputError, match=f"{name}: is .* at point 7"):
                drumlin.calibrate(I, measured(1), **{name: np.where(np.arange(I.size) == 7, wrong, ERROR)}, nu=0.81)
    for names in ([], ["a"], ["a", "b", "c"]):
        with pytest.raises(drumlin.InputError, match=f"names: are {len(names)} of 2 runs"):
            drumlin.calibrate([I, I], [measured(1), measured(2)], nu=0.81, names=names)
    with pytest.raises(drumlin.InputError, match="above 0"):
        drumlin.Law(drumlin.calibrate(I, measured(1), nu=0.81, form="log").text).mu([-1.0])
    with pytest.raises(drumlin.InputError, match="law.toml:1"):
        file = tmp_path / "law.toml"
        file.write_text("format = 3\n", encoding="utf-8")
        drumlin.Law(file)
    with pytest.raises(drumlin.IoError, match="none.toml"):
        drumlin.Law(tmp_path / "none.toml")
