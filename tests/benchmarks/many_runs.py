"""What many runs cost above their sum: a thousand tiny runs started one by one and by drumlin.sweep, in turn.

usage: TMPDIR=/dev/shm python3 tests/benchmarks/many_runs.py BUILD RECORD.json   (in memory: disks have moods)

Twenty discs fall into a box, in 300 steps, a thousand runs, and in 3000, a hundred. Blocks of 50 runs, one at a time, each with another seed: alone, by
`drumlin run`, then by drumlin.sweep without its page. Processor time is that of all processes. What one renewal of the page takes, with all runs in it, is
listed apart: the page takes at most report.SHARE of the time, and one renewal at the end.
"""

import functools
import json
import os
import pathlib
import resource
import subprocess
import sys
import tempfile
import time

from records import machine, write

BLOCK, STEPS = 50, {300: 1000, 3000: 100}  # steps: runs


def box(steps):
    return {"title": "A box of discs",
            "grains": {"density_kg_m3": 2700, "generated": {"count": 20, "diameter_min_mm": 1.8, "diameter_max_mm": 2.2,
                                                            "region": {"shape": "rectangle", "min_mm": [0, 0], "max_mm": [12, 30]}}},
            "walls": [{"name": "box", "shape": "polyline", "x_mm": [0, 0, 12, 12], "z_mm": [60, 0, 0, 60]}],
            "effects": {"gravity": {}, "friction": {"grain_grain": 0.4, "grain_wall": 0.4}, "spin": {}},
            "stages": [{"name": "fall", "duration_s": steps * 1e-3, "time_step_s": 1e-3}], "solver": {"tolerance": 1e-4}}


def cpu_seconds():
    used = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(each.ru_utime + each.ru_stime for each in used)


def timed(work):
    """(processor seconds, seconds)"""
    cpu, begin = cpu_seconds(), time.monotonic()
    work()
    return cpu_seconds() - cpu, time.monotonic() - begin


def alone(program, scene, seeds, folder):
    for seed in seeds:
        subprocess.run([program, "run", scene, "-o", folder / f"{seed}", "--threads", "1", "--resume", "--set", f"seed={seed}"], check=True,
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def measured(drumlin, steps, runs, folder):
    from drumlin.sweeping.report import Report

    scene, program = folder / "scene.toml", drumlin.program()
    scene.write_text(drumlin.toml_of({"format": "drumlin-scene-1"} | box(steps)), encoding="utf-8")
    calls = {"alone": lambda seeds, to: alone(program, scene, seeds, to),
             "sweep": lambda seeds, to: drumlin.sweep(scene, {"seed": list(seeds)}, to, "local:1", report=False)}
    for name, call in calls.items():
        call(range(1, 3), folder / f"{name}-first")  # loads what is loaded once
    spent = {name: [0.0, 0.0] for name in calls}
    for first in range(1, runs, BLOCK):
        for name, call in calls.items():
            taken = timed(functools.partial(call, range(first, first + BLOCK), folder / f"{name}-{first}"))
            spent[name] = [before + more for before, more in zip(spent[name], taken)]
    report = Report(folder, "A box of discs", False, [{"seed": seed} for seed in range(runs)])
    for number in range(runs):
        report.ended(number, drumlin.Outcome({"cpu_seconds": drumlin.study.Scalar(0.03)}))
    renewal = timed(lambda: report.renew("finished"))
    return {"steps": steps, "runs": runs, "ms_per_run_cpu": 1e3 * spent["alone"][0] / runs,
            **{f"{what}_above_sum": spent["sweep"][k] / spent["alone"][k] - 1 for k, what in enumerate(("cpu", "wall"))},
            "renewal_cpu_seconds": renewal[0]}


def main():
    build, record = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2])
    sys.path.insert(0, str(build / "python"))
    import drumlin  # of that build

    load, cases = os.getloadavg()[0], []
    for steps, runs in STEPS.items():
        with tempfile.TemporaryDirectory() as folder:
            cases.append(measured(drumlin, steps, runs, pathlib.Path(folder)))
            print(json.dumps(cases[-1]), flush=True)
    write(record, {"format": "drumlin-many-runs-1", "revision": drumlin.version().split("revision ")[1].split(",")[0],
                   "command": "TMPDIR=/dev/shm python3 tests/benchmarks/many_runs.py BUILD RECORD.json", **machine(), "load_before": load, "load_after": os.getloadavg()[0],
                   "cases": cases})


if __name__ == "__main__":
    main()
