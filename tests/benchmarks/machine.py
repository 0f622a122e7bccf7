"""The machine that a record was made on."""

import os
import pathlib
import platform


def machine():
    """Its processor's name, and how many there are."""
    lines = pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    named = (line.split(":")[1].strip() for line in lines if line.startswith("model name"))
    return {"machine": next(named, platform.machine()), "processors": os.cpu_count()}
