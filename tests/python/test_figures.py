"""The commands' figures on axes of one's own: they show what the files hold, and what the files do not hold is refused by name."""

import drumlin
import h5py
import matplotlib.mathtext
import matplotlib.pyplot as plt
import numpy as np
import pytest
from conftest import SOURCES

TESTS = SOURCES / "tests/chain"


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    """A tiny drum on both sides: run, law, flow, comparison."""
    place = tmp_path_factory.mktemp("results")
    drumlin.run(TESTS / "tiny-drum.toml", place / "RUN", {"stages.1.turns": 0.3, "stages.2.turns": 0.4, "stages.2.snapshots": 8})
    drumlin.command("measure", place / "RUN", "--parts", "maps")
    drumlin.command("calibrate", place / "RUN", "-o", place / "law.toml", "--accept-unsteady")
    drumlin.solve_flow(TESTS / "tiny-drum-flow.toml", SOURCES / "data/rheology/paper.toml", place / "FLOW", {"solver.sensitivity": False})
    drumlin.compare(place / "RUN", place / "FLOW", place / "REPORT", accept_unsteady=True)
    return drumlin.read(place)


def test_the_hdf5_files_say_what_they_hold(results):
    datasets = []
    for file in results.path.rglob("*.h5"):
        with h5py.File(file) as content:
            content.visititems(lambda name, entry: datasets.append((f"{file.name}:{name}", entry.dtype, entry.shape, dict(entry.attrs)))
                               if isinstance(entry, h5py.Dataset) else None)
    assert {"maps.h5:fields/mu", "maps.h5:ci99/v_x", "000008.h5:grains/x", "checkpoint.h5:bodies/x", "state.h5:values"} <= {name for name, *_ in datasets}
    for name, kind, shape, words in datasets:
        assert kind.kind != "f" or all(words[key] for key in ("unit", "description")), name
        assert kind != np.uint8 and (kind.kind != "S" or (shape, h5py.check_string_dtype(kind).encoding) == ((), "utf-8")), name
        assert shape != (1,), f"{name}: no scalar"


@pytest.mark.parametrize("file", ["RUN/measured/profiles.csv", "FLOW/profiles.csv", "REPORT/overlay.csv"])
def test_the_heads_of_profiles_say_what_they_hold(results, file):
    lines = (results.path / file).read_text(encoding="utf-8").splitlines()
    told = [line.split()[2] for line in lines if line.startswith("# column ")]
    assert told == [name for name in next(line for line in lines if line[0] != "#").split(",")[1:] if not name.endswith("_ci99")]


def test_the_table_of_quantities_has_labels_that_figures_and_pages_can_show():
    quantities = drumlin.plot.figure_module("quantity_table")
    names = [name for name in quantities.FIELDS if "NAME" not in name] + ["log10_I", "sigma_rt_kinetic"]
    rows = [*map(quantities.field, names), *quantities.SCALARS.values()]
    mathtext = matplotlib.mathtext.MathTextParser("path")
    for row in rows:
        assert mathtext.parse(row.axis_label()) and not set(row.in_html()) & set("$\\{}^"), row
    shown = {name: quantities.field(name) for name in ("sigma_xz", "log10_shear_rate", "mu", "d_k_dx", "what_is_not_known")}
    assert {name: (one.axis_label(), one.in_html()) for name, one in shown.items()} == {
        "sigma_xz": (r"$\sigma_{xz}$  [$\rho_0 g d$]", "σ<sub>xz</sub>"),
        "log10_shear_rate": (r"$\log_{10}$ $\dot\gamma$  [decades]", "log<sub>10</sub> γ\u0307 (decades)"),
        "mu": (r"$\mu = \sigma_{xz}/\sigma_{zz}$", "μ"),
        "d_k_dx": (r"$\partial k/\partial x$  [$1/d$]", "∂ k/∂ x"),
        "what_is_not_known": ("what_is_not_known", "what_is_not_known")}
    assert quantities.SCALARS["lambda"].in_html() == "decay length λ (d)" and quantities.field("log10_I").compared == "log10"


@pytest.mark.parametrize("draft", [None, "1"])
def test_a_figure_whose_words_are_too_small_is_refused(tmp_path, monkeypatch, draft):
    monkeypatch.setenv("DRUMLIN_DRAFT_FIGURES", draft) if draft else monkeypatch.delenv("DRUMLIN_DRAFT_FIGURES", raising=False)
    style = drumlin.plot.figure_module("style")
    with matplotlib.rc_context():
        style.use_style()
        assert plt.rcParams["font.size"] * 400 / 96 / style.WIDEST >= 7
        for name, width, words, points in (("wide", 8.4, 12, 6.0), ("small", style.WIDEST, 10, 5.9)):
            figure, (axes, _) = style.panels(2, 2)
            figure.set_figwidth(width)
            axes.set_title("title", fontsize=words)
            with pytest.raises(AssertionError, match=f"would have {points:.1f} points, less than 7, in a picture 400 pixels wide"):
                style.save(figure, tmp_path / f"{name}.png", False)
            plt.close(figure)
        assert not list(tmp_path.iterdir())
        figure, panels = style.maps(3, 2, 2, 1)
        assert [axes.axison for axes in panels] == [True, True, True, False]
        style.save(figure, tmp_path / "right.png", True)
        assert [file.name for file in tmp_path.iterdir()] == ["right.png"]


def drawn(axes):
    axes.figure.canvas.draw()
    plt.close(axes.figure)
    return axes


def test_both_sides_of_a_comparison(results):
    _, axes = plt.subplots()
    report = drumlin.read(results.path / "REPORT")
    drumlin.plot.compared(axes, report, "sigma_zz")
    curves = {line.get_label(): line for line in axes.get_lines()}
    assert {"particles", "continuum"} <= set(curves)
    assert np.array_equal(curves["continuum"].get_ydata(), report["overlay.csv"].sigma_zz_continuum, equal_nan=True)
    assert axes.get_title() == "reduced" and drawn(axes)
    with pytest.raises(drumlin.InputError, match="compares no weight .allowed: v_x"):
        drumlin.plot.compared(axes, report, "weight")


@pytest.mark.parametrize("file", ["RUN/measured/maps.h5", "FLOW/maps.h5"])
def test_a_map_of_either_side(results, file):
    figure, axes = plt.subplots()
    maps = results[file]
    drumlin.plot.field(axes, maps, "p", logarithmic=True)
    shown = axes.collections[0].get_array()
    assert np.ma.count(shown) == (np.nan_to_num(maps.p) > 0).sum() and len(figure.axes) == 2
    assert len(axes.get_lines()) == 2 and drawn(axes)  # the drum and its surface
    with pytest.raises(drumlin.InputError, match="maps.h5: holds no field weight"):
        drumlin.plot.field(axes, maps, "weight")


def test_a_law_and_what_it_leaves(results):
    _, (left, right) = plt.subplots(1, 2)
    record = results["law.json"]
    drumlin.plot.law(left, record)
    drumlin.plot.law(right, record, rest=True)
    chosen = next(form for form in record["forms"] if form["chosen"])
    assert any(np.array_equal(line.get_ydata(), chosen["curve"]["value"]) for line in left.get_lines())
    assert left.get_xscale() == "log" and right.get_ylim() == (-0.1, 0.1) and drawn(left)


def test_how_newtons_method_went(results):
    _, (left, right) = plt.subplots(1, 2)
    flow = drumlin.read(results.path / "FLOW")
    drumlin.plot.newton(left, flow)
    drumlin.plot.newton(right, flow, over_time=True)
    residuals = [value for line in left.get_lines() if line.get_linestyle() == "-" for value in line.get_ydata()]
    assert residuals == list(flow["iterations.csv"].residual) and right.get_xlabel().startswith("seconds") and drawn(left)


def test_a_history_of_a_run(results):
    _, axes = plt.subplots()
    log = results["RUN/log.csv"]
    drumlin.plot.history(axes, log, "kinetic_energy", "residual", logarithmic=True)
    assert [text.get_text() for text in axes.get_legend().get_texts()] == ["kinetic energy", "residual"]
    assert np.array_equal(axes.get_lines()[0].get_xdata(), log.time_s) and drawn(axes)
    _, axes = plt.subplots()
    drumlin.plot.history(axes, results["RUN/measured/series.csv"], "theta_com_deg")
    assert "d/g" in axes.get_xlabel() and len(axes.get_lines()[0].get_xdata()) == 8 and drawn(axes)
    with pytest.raises(drumlin.InputError, match="log.csv: holds no weight over time"):
        drumlin.plot.history(axes, log, "weight")
