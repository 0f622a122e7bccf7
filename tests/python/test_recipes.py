"""The recipes of docs/cookbook/python.md, each by itself, as a reader would run them."""

import os
import pathlib
import re
import subprocess
import sys

import pytest

from conftest import SOURCES

PAGE = (SOURCES / "docs/cookbook/python.md").read_text(encoding="utf-8")
RECIPES = dict(re.findall(r"^## (\d\. [^\n]*)\n(?:(?!^## ).)*?^```python\n(.*?)^```", PAGE, re.MULTILINE | re.DOTALL))


def test_there_are_six():
    assert [title[0] for title in RECIPES] == list("123456")


@pytest.mark.parametrize("title", RECIPES)
def test_recipe(title, tmp_path):
    (tmp_path / "data").symlink_to(SOURCES / "data")
    result = subprocess.run([sys.executable, "-B", "-c", RECIPES[title]], cwd=tmp_path, capture_output=True, text=True, check=False,
                            env=os.environ | {"PYTHONPATH": os.environ["DRUMLIN_PACKAGE"]})
    assert result.returncode == 0, result.stderr
    made = {pathlib.Path(path).name for path in tmp_path.iterdir()} - {"data"}
    assert result.stdout or made
