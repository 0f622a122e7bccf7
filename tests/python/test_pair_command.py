"""The steps of `drumlin pair`, with commands that a test answers and files that it writes."""

import json
import pathlib
import sys
import tomllib
import types

import h5py
import numpy as np
import pytest
from conftest import SOURCES

import drumlin
from drumlin.errors import InputError
from drumlin.pair import command

LENGTH_M, TIME_S = 2e-3, 0.0142784


def write_run(folder, scene):
    """A column of 20 d by 35 d, on a grid."""
    (folder / "snapshots").mkdir(parents=True)
    (folder / "scene.toml").write_text(scene, encoding="utf-8")
    (folder / "run.json").write_text(json.dumps({"scales": {"length_m": LENGTH_M, "time_s": TIME_S, "density_kg_m3": 2700}}), encoding="utf-8")
    x, z = (each.ravel() for each in np.meshgrid(np.arange(0.5, 20), np.arange(0.5, 35)))
    for k, time in enumerate((0.4, 0.8, 1.2)):
        with h5py.File(folder / "snapshots" / f"{k}.h5", "w") as file:
            file["time"] = time / TIME_S
            for name, values in {"x": x * (1 + k), "z": z, "radius": np.full(x.size, 0.5)}.items():
                file[f"grains/{name}"] = values


def write_frames(file):
    """A surface that falls by a quarter of a grain per grain, in two runs that differ by 2 d; none beyond the walls."""
    x = np.arange(-1.0, 61.0)
    height = np.where((x >= 0) & (x <= 20), 36 - 0.25 * x, np.nan)
    file.parent.mkdir(parents=True)
    with h5py.File(file, "w") as out:
        out["x"], out["height"] = x, np.stack([height - 1, height + 1])[:, None]


class Answers:
    """In place of apps/commands/pair.cpp."""

    def __init__(self, output):
        self.output, self.words, self.begun = output, [], False

    def __call__(self, begin=False, words=()):
        self.begun = self.begun or begin
        self.words.append(list(words))
        if words and words[0] == "measure" and "--at" in words:
            write_frames(self.output / "particles" / "frames.h5")
        if words and words[0] == "flow":
            (self.output / "flow").mkdir()
            (self.output / "flow" / "flow.json").write_text('{"cpu_seconds": 3}', encoding="utf-8")
        return {}

    def option(self, first, name):
        words = next(words for words in self.words if words[:1] == [first])
        return words[words.index(name) + 1]


@pytest.fixture(name="asked")
def _asked(tmp_path, monkeypatch):
    """asked(scene, **options): the answers of a call, its flow scene and what was compared."""
    compared = []
    monkeypatch.setitem(sys.modules, "drumlin.pair.comparison", types.SimpleNamespace(compare=lambda *words: compared.append(words)))
    monkeypatch.setattr("drumlin.pair.comparison", sys.modules["drumlin.pair.comparison"], raising=False)

    def ask(name, runs=0, **options):
        output = tmp_path / "pair"
        output.mkdir()
        scene = drumlin.resolved(SOURCES / "data" / "scenes" / f"{name}.toml")
        folders = [tmp_path / f"run-{k}" for k in range(runs)]
        for folder in folders:
            write_run(folder, scene)
        answers = Answers(output)
        monkeypatch.setattr(command, "tell", answers)
        given = {"output": str(output), "overwrite": False, "resume": True, "scene": scene, "nu": 0.8, "file": name, "run": [str(folder) for folder in folders], "seeds": 1,
                 "threads": 1, "at": [], "case": "any", "limits": "limits.toml", "scene-only": False, "accept-unsteady": False} | {key.replace("_", "-"): value for key, value in options.items()}
        content = tomllib.loads(scene)
        (command.pair_of_layers if "periodic_x" in content else command.pair_of_region)(given, content, output)
        return answers, tomllib.loads((output / "flow.toml").read_text(encoding="utf-8")), compared
    return ask


def test_a_region_is_measured_solved_and_compared(asked):
    answers, flow, compared = asked("column-collapse", 2, at=[0.1, 0.2])
    assert [words[0] for words in answers.words if words] == ["measure", "flow"] and answers.begun
    assert answers.option("measure", "--at") == "0,0.1,0.2" and float(answers.option("measure", "--origin")) == pytest.approx(0.4)
    assert flow["time"]["frames_s"] == [0, 0.1, 0.2]
    # Both sides have one grid.
    for axis in "xz":
        assert [float(end) for end in answers.option("measure", f"--{axis}").split(",")] == pytest.approx(np.array(flow["output"][f"{axis}_mm"]) / 2)
    # The mean of both runs, from 2 d off the walls on: 36 d - 0.25 x.
    assert flow["region"]["fill_mm"] == [[0, 0], [40, 0], [40, pytest.approx(63.5)], [34, pytest.approx(63.5)], [6, pytest.approx(70.5)], [0, pytest.approx(70.5)]]
    (particles, continuum, report, case, _, scene, record, _), = compared
    assert [pathlib.Path(each).parent.name for each in (particles, continuum)] == ["particles", "flow"]
    assert (report.name, case, scene.name, record["seconds"]) == ("report", "any", "flow.toml", 3)


def test_layers_are_measured_solved_and_compared(asked):
    answers, flow, _ = asked("chute", 2, accept_unsteady=True)
    assert [words[0] for words in answers.words if words] == ["measure", "measure", "flow", "compare"]
    assert "--accept-unsteady" in answers.words[-1] and "--floor" in answers.words[-1]
    assert flow["incline"]["height_mm"] == pytest.approx(700 * np.pi / 0.8 / 50)


def test_the_scene_alone_needs_no_run(asked):
    answers, flow, compared = asked("silo", scene_only=True)
    assert answers.words == [[]] and not compared and flow["openings"][0]["name"] == "opening"


def test_a_scene_without_a_snapshot_of_the_material_at_rest_is_refused(asked):
    with pytest.raises(InputError, match="stages.0.snapshots: is 0"):
        asked("janssen")


def test_a_run_of_another_scene_is_refused(tmp_path):
    silo = SOURCES / "data" / "scenes" / "silo.toml"
    write_run(tmp_path / "other", drumlin.resolved(silo, {"effects.friction.grain_wall": 0.3}))
    with pytest.raises(InputError, match="effects: is not that of the scene"):
        command.require_same_scene({"scene": drumlin.resolved(silo, {"seed": 7}), "file": "silo"}, tmp_path / "other")


def test_seeds_are_runs_on_an_executor(tmp_path, monkeypatch):
    called = []
    monkeypatch.setattr(command, "command", lambda *words: called.append(words))
    given = {"scene": "seed = 5", "run": [], "seeds": 3, "threads": 2, "executor": "local:2", "overwrite": False}
    folders = command.runs_of(given, tmp_path)
    assert [pathlib.Path(folder).name for folder in folders] == ["run-5", "run-6", "run-7"]
    assert {words[words.index("--set") + 1] for words in called} == {"seed=5", "seed=6", "seed=7"} and all("--resume" in words for words in called)
    monkeypatch.setattr(command, "command", lambda *words: (_ for _ in ()).throw(InputError("refused")))
    with pytest.raises(InputError, match="refused"):
        command.runs_of(given, tmp_path)
