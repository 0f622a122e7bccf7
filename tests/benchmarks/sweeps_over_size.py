"""How sweeps grow with the packing: drums of 2,000 to 100,000 discs at the fill of the 6 rpm drum, settled and flowing, to a residual of 1e-2.

usage: python3 tests/benchmarks/sweeps_over_size.py BUILD RECORD.json [--keep FOLDER] [DISCS...]   (2000, 7183, 30000, 100000 unless told)
--keep: the scenes and runs stay there, in a folder for each size, for benchmarks that need a flow to begin with; those of this build and of
the same scene that are there already are taken as they are.

Each drum falls and turns by 0.17 of a turn at the Froude number of 6 rpm, roughly solved (3e-2, 150 sweeps at most). From there a run takes 300 steps of
1e-3 s at rest and another 300 of the flow to 1e-2, with the bounds on penetration and sinking that scenes have. The first 100 steps of each, in which what
the rough solution left dies out, are told apart. Counts depend on no machine; seconds are of this one.
"""

import pathlib
import re
import statistics
import subprocess
import sys
import tempfile

from drums import drum, rotation, solved_to, speed_rpm, stage, started_from
from records import content_of, machine, steps_of, write

SIZES = (2000, 7183, 30000, 100000)
STEPS, TRANSIENT = 300, 100


def scenes(discs):
    """Of the preparation, of the settled packing, of the flow."""
    start, solver = drum(discs)
    rpm = round(speed_rpm(discs), 3)
    settling, turning = round(7.2 / rpm, 1), rotation(rpm)
    both = stage("settle", f"duration_s = {settling}", "") + stage("approach", "turns = 0.17", turning)
    made = {"preparation": start + both + re.sub(r"max_sweeps = \d+", "max_sweeps = 150", solved_to("3e-2", solver))}
    for name, motion, time in (("settled", "", f"time_s = {settling}\n"), ("flowing", turning, "")):
        of_run = started_from("preparation", start, time)
        stages = stage(name, f"duration_s = {STEPS * 1e-3:g}", motion)
        made[name] = of_run + stages + re.sub(r"max_sweeps = \d+", "max_sweeps = 20000", solved_to("1e-2", solver))
    return made


def is_there(folder, revision, text):
    scene_file = folder.with_suffix(".toml")
    if not (folder / "run.json").exists() or not scene_file.exists() or scene_file.read_text(encoding="utf-8") != text:
        return False
    run = content_of(folder / "run.json")
    return run["status"] == "finished" and run["revision"] == revision


def counted(folder):
    run = content_of(folder / "run.json")
    sweeps = [int(row["sweeps"]) for row in steps_of(folder)]

    def told(some):
        some = sorted(some)
        return {"mean": statistics.mean(some), "median": statistics.median(some), "p90": some[int(0.9 * len(some))], "largest": some[-1]}

    return run, {
        "contacts_mean": run["cost"]["contacts_mean"],
        "sweeps_first_100_steps": told(sweeps[:TRANSIENT]),
        "sweeps_last_200_steps": told(sweeps[TRANSIENT:]),
        "cpu_seconds": run["cpu_seconds"],
        "solver_seconds": run["cost"]["solver_seconds"],
        "peak_memory_mb": run["peak_memory_mb"],
    }


def main():
    words, keep = sys.argv[3:], None
    if "--keep" in words:
        keep = pathlib.Path(words.pop(words.index("--keep") + 1))
        words.remove("--keep")
    build, record, sizes = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]), [int(word) for word in words] or list(SIZES)
    revision = subprocess.run([build / "drumlin", "--version"], check=True, capture_output=True, text=True).stdout.split("revision ")[1].split(",")[0]
    cases, run = [], {}
    for discs in sizes:
        with tempfile.TemporaryDirectory() as name:
            folder = keep / str(discs) if keep else pathlib.Path(name)
            folder.mkdir(parents=True, exist_ok=True)
            case = {"discs": discs}
            for what, text in scenes(discs).items():
                there = is_there(folder / what, revision, text)
                (folder / f"{what}.toml").write_text(text, encoding="utf-8")
                if not there:
                    ended = subprocess.run([build / "drumlin", "run", folder / f"{what}.toml", "-o", folder / what, "--overwrite"], stdout=subprocess.DEVNULL)
                    if ended.returncode == 2 and what == "settled":  # what the rough solution leaves overlaps too much to start from
                        case[what] = {"refused": True}
                        continue
                    ended.check_returncode()
                run, found = counted(folder / what)
                if what != "preparation":
                    case[what] = found
                    print(f"{discs} discs, {what}: {found['sweeps_last_200_steps']['mean']:.0f} sweeps a step", flush=True)
            cases.append(case)
    whole = {"format": "drumlin-sweeps-over-size-1", "revision": run["revision"], "command": "python3 tests/benchmarks/sweeps_over_size.py BUILD RECORD.json",
             **machine(), "tolerance": 1e-2, "steps": STEPS, "cases": cases}
    write(record, whole)


if __name__ == "__main__":
    main()
