"""The notebooks of docs/notebooks: stored without outputs, and each executes as plain Python; so do the blocks of docs/cookbook/python.md.

usage: notebooks.py FOLDER_OF_THE_PACKAGE SOURCES
"""

import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile


def executed(notebook, package):
    cells = [cell for cell in json.loads(notebook.read_text(encoding="utf-8"))["cells"] if cell["cell_type"] == "code"]
    if any(cell["outputs"] or cell["execution_count"] is not None for cell in cells):
        return "is stored with outputs"
    return printed("\n\n".join("".join(cell["source"]) for cell in cells), notebook.parent, package)


def printed(program, place, package):
    """"" where a program ends well and prints something; else why not."""
    with tempfile.TemporaryDirectory() as results:
        done = subprocess.run([sys.executable, "-B", "-c", program], cwd=place or results, capture_output=True, text=True, check=False,
                              env=os.environ | {"PYTHONPATH": package, "MPLBACKEND": "agg", "TMPDIR": results})
    return "" if done.returncode == 0 and done.stdout else done.stderr or "prints nothing"


if __name__ == "__main__":
    notebooks = sorted((pathlib.Path(sys.argv[2]) / "docs/notebooks").glob("*.ipynb"))
    failures = {notebook.name: why for notebook in notebooks if (why := executed(notebook, sys.argv[1]))}
    page = (pathlib.Path(sys.argv[2]) / "docs/cookbook/python.md").read_text(encoding="utf-8")
    failures |= {"python.md": why for why in [printed("\n".join(re.findall(r"```python\n(.*?)```", page, re.DOTALL)), None, sys.argv[1])] if why}
    print(f"{len(notebooks)} notebooks", *(f"{name}: {why}" for name, why in failures.items()), sep="\n")
    sys.exit(bool(failures) or len(notebooks) != 9)
