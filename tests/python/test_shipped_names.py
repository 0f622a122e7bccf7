"""Shipped scenes and laws by their names, as the commands take them; what an editor and a type checker see of the package."""

import ast
import pathlib
import shutil
import subprocess
import sys

import drumlin
import pytest

HERE = pathlib.Path(drumlin.__file__).parent


def test_a_simulation_and_a_law_know_shipped_names(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "drum-smoke").mkdir()  # a folder of that name is no scene
    assert len(drumlin.Simulation("drum-smoke", {"grains.generated.count": 20}).x) == 20
    assert "798" in drumlin.resolved("drum-smoke") and drumlin.Law("paper").nu > 0.7
    with pytest.raises(drumlin.InputError, match='did you mean "drum-smoke"'):
        drumlin.Simulation("drum-smokee")
    with pytest.raises(drumlin.InputError, match='did you mean "paper"'):
        drumlin.Law("papr")
    (tmp_path / "drum-smoke").rmdir()
    (tmp_path / "drum-smoke").write_text("nonsense", encoding="utf-8")  # a file is
    with pytest.raises(drumlin.InputError):
        drumlin.Simulation("drum-smoke")


def test_the_stub_names_what_the_package_gives():
    stub = ast.parse((HERE / "__init__.pyi").read_text(encoding="utf-8"))
    named = {alias.asname for node in stub.body if isinstance(node, ast.ImportFrom) for alias in node.names}
    assert named | {"version"} == set(drumlin.__all__)


WRONG = """
import drumlin
simulation = drumlin.Simulation("drum-smoke")
print(simulation.x + 1, drumlin.read("RUN"), drumlin.Law("paper").nu * 2)
simulation.nothing
text: int = drumlin.resolved("drum-smoke")
drumlin.shwo("RUN")
"""


@pytest.mark.skipif(shutil.which("mypy") is None, reason="mypy is missing")
def test_a_type_checker_finds_what_is_wrong_and_nothing_else(tmp_path):
    (tmp_path / "wrong.py").write_text(WRONG, encoding="utf-8")
    said = subprocess.run([shutil.which("mypy"), "--python-executable", sys.executable, "--cache-dir", tmp_path / "cache", "wrong.py"], cwd=tmp_path,
                          env={"MYPYPATH": str(HERE.parent), "PATH": "/usr/bin:/bin"}, capture_output=True, text=True, check=False).stdout
    lines = [line.split(":")[1] for line in said.splitlines() if line.startswith("wrong.py")]
    assert lines == ["5", "6", "7"], said


def test_tables_and_folders_say_shapes_and_units(tmp_path):
    (tmp_path / "profiles.csv").write_text("# drumlin-profiles-1\nz,v_x,v_x_ci99\n-1,0.1,0.01\n0,0.2,0.01\n", encoding="utf-8")
    said = repr(drumlin.read(tmp_path / "profiles.csv"))
    assert "(2,)" in said and "sqrt(g d)" in said and "mean velocity along x" in said and "99 % half width" in said
    assert "profiles.csv" in repr(drumlin.read(tmp_path))
