"""Commands and Python package of the build tree by pip, without a network, into a virtual environment: imported elsewhere, it reads, steps and finds its commands.
Ends with 77 where this Python has no venv or no pip (Debian: python3-venv).

usage: pip_install.py BUILD_FOLDER SOURCES
"""

import os
import pathlib
import subprocess
import sys
import tempfile

PROGRAM = """
import pathlib, drumlin
box = {"title": "One disc", "grains": {"density_kg_m3": 2700, "listed": {"file": "disc.csv"}}, "effects": {"gravity": {}},
       "stages": [{"name": "fall", "duration_s": 0.01, "time_step_s": 1e-3}]}
pathlib.Path("disc.csv").write_text("x_mm,z_mm,diameter_mm\\n0,0,2\\n")
simulation = drumlin.Simulation(box)
assert simulation.run() == 10 and simulation.z[0] < 0
style = drumlin.plot.figure_module("style")
print(drumlin.__file__, drumlin.program(), drumlin.command("--version").split()[0], style.PARTICLES, sep="|")
"""


def run(*words, **keywords):
    result = subprocess.run([str(word) for word in words], capture_output=True, text=True, check=False, **keywords)
    if result.returncode != 0:
        sys.exit(f"{' '.join(map(str, words))}\nexit code {result.returncode}\n{result.stdout}{result.stderr}")
    return result.stdout


def main():
    build, sources = (pathlib.Path(word).resolve() for word in sys.argv[1:3])
    with tempfile.TemporaryDirectory(prefix="drumlin-pip-") as name:
        folder = pathlib.Path(name)
        made = subprocess.run([sys.executable, "-m", "venv", "--system-site-packages", folder / "venv"], capture_output=True, text=True, check=False)
        if made.returncode != 0:
            print(f"no virtual environment, nothing tried:\n{made.stdout}{made.stderr}")
            sys.exit(77)
        python = folder / "venv" / "bin" / "python"
        run(python, "-m", "pip", "install", "--no-index", "--no-deps", "--no-build-isolation", sources, cwd=folder, env=os.environ | {"DRUMLIN_BUILD": str(build)})
        said = run(python, "-c", PROGRAM, cwd=folder, env=os.environ | {"PATH": "/usr/bin:/bin"}).strip().split("|")
        if not said[0].startswith(str(folder / "venv")) or pathlib.Path(said[1]).parent != folder / "venv" / "bin" or said[2] != "drumlin":
            sys.exit(f"another package or other commands: {said}")
    print("installed by pip without a network")


if __name__ == "__main__":
    main()
