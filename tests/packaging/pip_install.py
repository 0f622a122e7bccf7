"""A wheel that needs nothing but the C and C++ libraries, by pip into a virtual environment: imported elsewhere, it reads, steps and finds its commands.
Ends with 77 where this Python has no venv or no pip (Debian: python3-venv), or where sources of the libraries that the wheel holds cannot be had.

usage: pip_install.py SOURCES
"""

import pathlib
import subprocess
import sys
import tempfile

from installed import require, require_no_path, run

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


def main():
    sources = pathlib.Path(sys.argv[1]).resolve()
    with tempfile.TemporaryDirectory(prefix="drumlin-pip-") as name:
        folder = pathlib.Path(name)
        made = subprocess.run([sys.executable, "-m", "venv", "--system-site-packages", folder / "venv"], capture_output=True, text=True, check=False)
        if made.returncode != 0:
            print(f"no virtual environment, nothing tried:\n{made.stdout}{made.stderr}")
            sys.exit(77)
        python = folder / "venv" / "bin" / "python"
        built = subprocess.run([sources / "packaging/wheels/libraries"], capture_output=True, text=True, check=False)
        require(built.returncode in (0, 77), f"the libraries of the wheel:\n{built.stdout}{built.stderr}")
        if built.returncode == 77:
            print(f"nothing tried:\n{built.stderr}")
            sys.exit(77)
        run(python, "-m", "pip", "wheel", "--no-index", "--no-deps", "--no-build-isolation", "-w", folder, sources, cwd=folder)
        wheel = next(folder.glob("drumlin-*.whl"))
        print(run(sys.executable, sources / "packaging/wheels/portable.py", wheel))
        require(wheel.stat().st_size < 40e6, "the wheel is larger than 40 MB")
        run(python, "-m", "pip", "install", "--no-index", "--no-deps", wheel, cwd=folder)
        require_no_path(folder / "venv", [sources])
        said = run(python, "-c", PROGRAM, cwd=folder, environment={"PATH": "/usr/bin:/bin"}).strip().split("|")
        require(said[0].startswith(str(folder / "venv")) and pathlib.Path(said[1]).parent == folder / "venv" / "bin" and said[2] == "drumlin",
                f"another package or other commands: {said}")
        flow = subprocess.run([folder / "venv/bin/drumlin", "flow", "incline-flow", "--rheology", "paper", "-o", folder / "FLOW"], capture_output=True, text=True, check=False)
        require(flow.returncode == 2 and "libdeal.ii-dev" in flow.stderr, f"drumlin flow does not say what to install: {flow.returncode}, {flow.stderr}")
    print("built as a wheel, installed by pip without a network")


if __name__ == "__main__":
    main()
