"""Where the tests find the package of the build tree and the data of the sources."""

import os
import pathlib
import signal
import sys
import threading
import time

import pytest

sys.path.insert(0, os.environ["DRUMLIN_PACKAGE"])
SOURCES = pathlib.Path(os.environ["DRUMLIN_SOURCES"])


@pytest.fixture
def data():
    return SOURCES / "data"


@pytest.fixture
def box():
    """Twenty discs that fall into a box, as a dict."""
    return {
        "title": "A box of discs",
        "grains": {"density_kg_m3": 2700,
                   "generated": {"count": 20, "diameter_min_mm": 1.8, "diameter_max_mm": 2.2,
                                 "region": {"shape": "rectangle", "min_mm": [0, 0], "max_mm": [12, 30]}}},
        "walls": [{"name": "box", "shape": "polyline", "x_mm": [0, 0, 12, 12], "z_mm": [60, 0, 0, 60]}],
        "effects": {"gravity": {}, "friction": {"grain_grain": 0.4, "grain_wall": 0.4}, "spin": {}},
        "stages": [{"name": "fall", "duration_s": 0.3, "time_step_s": 1e-3}],
        "solver": {"tolerance": 1e-4},
    }


@pytest.fixture
def interrupt_when():
    """Sends Ctrl-C as soon as all of these files are there, or after so many seconds."""

    def interrupt(files, seconds):
        time.sleep(seconds)
        while not all(file.exists() for file in files):
            time.sleep(0.01)
        os.kill(os.getpid(), signal.SIGINT)

    return lambda *files, seconds=0: threading.Thread(target=interrupt, args=(files, seconds), daemon=True).start()
