"""The library of laws: its table, the law of given grains, and each kind of grains by the law of all others."""

import math
import pickle

import drumlin
import numpy as np
import pytest

pytest.importorskip("sklearn")
from drumlin.library.table import GRAINS, NORMAL_99, Library, library  # noqa: E402


def kinds():
    return sorted({tuple(one) for one in zip(*(library().columns[name] for name in GRAINS))})


def test_the_table_holds_what_rigid_discs_obey():
    columns = library().columns
    assert len(kinds()) == 26 and int(library().header["runs"]) >= 250 and (columns["grains"] >= 400).all()
    assert (abs(columns["sigma_zz_over_P"] - 1) < np.maximum(2 * columns["sigma_zz_over_P_ci99"], 0.03)).mean() > 0.95  # the cell holds its pressure
    assert np.allclose(columns["I"], columns["I_of_mass"] * 2 / math.sqrt(math.pi), rtol=1e-5)
    assert ((columns["nu"] > 0.6) & (columns["nu"] < 0.9)).all()


def test_a_law_is_a_file_that_flows_read(tmp_path):
    law = drumlin.law(0.3, restitution=0.5)
    law.write(tmp_path / "law.toml")
    again = drumlin.Law(tmp_path / "law.toml")
    I = np.geomspace(law.I[0], law.I[-1], 200)  # noqa: E741
    mu, slope = again.mu(I), again.slope(I)
    assert (np.diff(mu) > 0).all() and not law.extrapolates
    linear, square = 4 + mu**2, 4 + mu**2 / 4
    assert (slope >= 0.99 * mu * (linear - np.sqrt(linear**2 - 4 * square * mu**2)) / (2 * square)).all()  # well-posed in simple shear
    assert (law.low < law.high).all() and pickle.loads(pickle.dumps(law)).text == law.text
    assert len(drumlin.read(tmp_path / "law.toml")["band"]["draws"]) == 16 * len(law.I)


def test_beyond_the_table_it_refuses_or_says_so():
    with pytest.raises(drumlin.InputError, match="friction = 3 is outside 0 to 1"):
        drumlin.law(3)
    with pytest.raises(drumlin.InputError, match="restitution: is 2"):
        drumlin.law(0.3, restitution=2, extrapolate=True)
    law = drumlin.law(2, rolling_resistance=0.5, extrapolate=True)
    assert len(law.extrapolates) == 2 and "# Extrapolates: friction = 2" in law.text
    inside = drumlin.law(0.4)
    assert np.median(law.high - law.low) > 2 * np.median(inside.high - inside.low)


def test_each_kind_of_grains_is_within_the_interval_of_the_law_of_all_others():
    columns, inside = library().columns, []
    for one in kinds():
        grains = dict(zip(GRAINS, one))
        here = np.all([columns[name] == value for name, value in grains.items()], axis=0)
        mean, covariance = Library(left_out=grains).normal("mu", grains, columns["I"][here])
        half = np.hypot(NORMAL_99 * np.exp(mean) * np.sqrt(np.diag(covariance)), columns["mu_ci99"][here])
        inside += list(abs(columns["mu"][here] - np.exp(mean)) <= half)
    assert np.mean(inside) >= 0.95  # data/limits/laws.toml


def test_the_command_writes_the_same_law(tmp_path):
    said = drumlin.command("law", "--friction", 0.3, "--restitution", 0.5, "-o", tmp_path / "law.toml")
    assert (tmp_path / "law.toml").read_text() == drumlin.law(0.3, restitution=0.5).text and "mu = " in said
    with pytest.raises(drumlin.InputError, match="friction = 3 is outside"):
        drumlin.command("law", "--friction", 3, "-o", tmp_path / "beyond.toml")
    assert "extrapolates: friction = 3" in drumlin.command("law", "--friction", 3, "--extrapolate", "-o", tmp_path / "beyond.toml")
