"""Runs of programs and records of them."""

import csv
import json
import os
import pathlib
import platform
import subprocess


def machine():
    """Its processor's name, and how many there are."""
    lines = pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    named = (line.split(":")[1].strip() for line in lines if line.startswith("model name"))
    return {"machine": next(named, platform.machine()), "processors": os.cpu_count()}


def called(*words):
    """A command of any number of ranks, with nothing printed."""
    allowed = {f"OMPI_ALLOW_RUN_AS_ROOT{more}": "1" for more in ("", "_CONFIRM")}
    subprocess.run([str(word) for word in words], check=True, env={**os.environ, **allowed}, stdout=subprocess.DEVNULL)


def content_of(file):
    return json.loads(file.read_text(encoding="utf-8"))


def steps_of(run):
    """Rows of log.csv."""
    with (run / "log.csv").open(encoding="utf-8") as log:
        return list(csv.DictReader(log))


def write(record, content):
    record.parent.mkdir(parents=True, exist_ok=True)
    record.write_text(json.dumps(content, indent=1) + "\n", encoding="utf-8")
