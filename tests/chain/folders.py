"""Result folders against damage, strangers and a second writer: every file is checked, what is not ours stays, one writes.

usage: folders.py DRUMLIN FOLDER_OF_THIS_TEST
"""

import shutil
import signal

from command import bytes_below, given, read_json, require, started, wait_until

SHORT = ["--set", "stages.1.turns=0.05", "--set", "stages.2.turns=0.05", "--set", "stages.2.snapshots=6",
         "--set", "output.checkpoint_every_s=0.05"]


def damaged(file):
    content = bytearray(file.read_bytes())
    content[len(content) // 2] ^= 1
    file.write_bytes(content)


def every_file_is_checked(drumlin, run):
    """A bit of any listed file: measure refuses the run, compare refuses the measured run, each by the file's name."""
    kept = bytes_below(run)
    checked = 0
    for name in sorted(kept):
        in_measured = name.startswith("measured/")
        if name.endswith(".png") or name in ("run.json",) and in_measured:
            continue
        damaged(run / name)
        if in_measured and name.rsplit("/", 1)[-1] not in ("measured.json", "profiles.csv", "maps.h5", "manifest.txt"):
            _, said = drumlin("measure", run, "--resume", code=2)
        elif in_measured:
            _, said = drumlin("compare", run, run, "-o", run.parent / "report", "--accept-unsteady", code=2)
        else:
            _, said = drumlin("measure", run, "--overwrite", code=2)
        require(name.rsplit("/", 1)[-1] in said and "drumlin accept" in said, f"{name}: {said}")
        (run / name).write_bytes(kept[name])
        checked += 1
    print(f"{checked} damaged files refused")


def missing_and_extra(drumlin, scene, run, folder):
    for name in ("000003.h5", "000006.h5"):
        file = run / "snapshots" / name
        content = file.read_bytes()
        file.unlink()
        for words in (["measure", run, "--overwrite"], ["plot", run], ["export", run, "--vtu"], ["history", run],
                      ["compare", run, run, "-o", folder / "report", "--accept-unsteady"],
                      ["calibrate", run, "-o", folder / "law.toml", "--accept-unsteady"],
                      ["measure", "--study", run, "-o", folder / "study"],
                      ["run", scene, "-o", run, *SHORT, "--resume"]):
            _, said = drumlin(*words, code=2)
            require(name in said and "is missing" in said, f"{words}: {said}")
        file.write_bytes(content)
    shutil.copy(run / "snapshots" / "000001.h5", run / "snapshots" / "000007.h5")
    _, said = drumlin("measure", run, "--overwrite", code=2)
    require("000007.h5: is not listed" in said, said)
    (run / "snapshots" / "000007.h5").unlink()
    (run / "manifest.txt").rename(folder / "kept.txt")
    for words in (["measure", run, "--overwrite"], ["plot", run], ["run", scene, "-o", run, *SHORT, "--overwrite"]):
        _, said = drumlin(*words, code=2)
        require("drumlin accept" in said, f"{words}: {said}")
    (folder / "kept.txt").rename(run / "manifest.txt")


def edits_are_told(drumlin, run, folder):
    edited = folder / "edited"
    shutil.copytree(run, edited)
    log = edited / "log.csv"
    log.write_text(log.read_text(encoding="utf-8").replace("sampled", "stirred"), encoding="utf-8")
    drumlin("measure", edited, "--overwrite", code=2)
    _, said = drumlin("info", edited, code=2)
    require("log.csv" in said and "drumlin accept" in said, said)
    drumlin("accept", edited, code=2)  # without a reason
    drumlin("accept", edited, "--reason", "two\nlines", code=2)
    drumlin("accept", folder, "--reason", "no result folder", code=2)
    text, _ = drumlin("accept", edited, "--reason", "another name of the stage")
    require("changed" in text and "log.csv" in text, text)
    text, _ = drumlin("accept", edited, "--reason", "again")
    require("as they were written" in text, text)
    _, said = drumlin("info", edited, code=2)
    require("as it was before" in said and "log.csv" not in said, said)  # what was measured is of the run before the edit
    drumlin("measure", edited, "--parts", "none", "--overwrite")
    text, _ = drumlin("info", edited)
    require(f"{edited}: of drumlin run, complete; " in text and "another name of the stage (log.csv)" in text and f"{edited}/measured: of drumlin measure" in text, text)
    edits = read_json(edited / "measured" / "measured.json")["provenance"]["accepted_edits"]
    require(len(edits) == 1 and "another name of the stage (log.csv)" in edits[0], f"{edits}")
    # What a version without manifests has left.
    for file in edited.rglob("manifest.txt"):
        file.unlink()
    drumlin("export", edited, "--vtu", code=2)
    drumlin("accept", edited, "--reason", "older than manifests")
    drumlin("export", edited, "--vtu", "--snapshots", "last")
    drumlin("measure", edited, "--parts", "none", "--resume")
    log.write_text(log.read_text(encoding="utf-8").replace("residual_max", "worst"), encoding="utf-8")
    drumlin("accept", edited, "--reason", "another name of a column")
    _, said = drumlin("report", edited, code=2)
    require("log.csv: residual_max: no such column (it has step, " in said and "Traceback" not in said, said)


def measured_belongs_to_its_run(drumlin, scene, run, folder):
    """What was measured of a run that has been replaced or edited since is refused, until it is measured anew or accepted by name."""
    def refused(changed):
        for words in (["compare", changed, changed, "-o", folder / "report", "--accept-unsteady"],
                      ["calibrate", changed, "-o", folder / "law.toml", "--accept-unsteady"],
                      ["measure", "--study", changed, "-o", folder / "study"], ["measure", changed, "--parts", "maps", "--resume"]):
            _, said = drumlin(*words, code=2)
            require("as it was before" in said and f"drumlin measure {changed} --overwrite" in said and f"drumlin accept {changed / 'measured'}" in said,
                    f"{words}: {said}")
        drumlin("plot", changed, "--overwrite")  # of the run alone

    changed = folder / "changed"
    shutil.copytree(run, changed)
    drumlin("measure", changed, "--parts", "maps", "--resume")
    log = changed / "log.csv"
    log.write_text(log.read_text(encoding="utf-8").replace("sampled", "stirred"), encoding="utf-8")
    drumlin("accept", changed, "--reason", "another name of the stage")
    refused(changed)
    text, _ = drumlin("accept", changed / "measured", "--reason", "names do not matter")
    require("of another state of the run" in text, text)
    drumlin("measure", changed, "--parts", "maps", "--resume")
    manifest = (changed / "measured" / "manifest.txt").read_text(encoding="utf-8")
    require("names do not matter (of another state of the run)" in manifest, manifest)

    # A whole run of the same files, each with its own manifest, takes the place of the first.
    other = folder / "other"
    drumlin("run", scene, "-o", other, *SHORT, "--set", "seed=3")
    shutil.copytree(changed / "measured", other / "measured")
    refused(other)
    drumlin("measure", other, "--parts", "none", "--overwrite")
    drumlin("measure", "--study", other, "-o", folder / "study")


def strangers_stay(drumlin, scene, run, folder):
    ours = folder / "ours"
    shutil.copytree(run, ours)
    (ours / "notes.txt").write_text("years of work\n", encoding="utf-8")
    (ours / "measured" / "notes.txt").write_text("years of work\n", encoding="utf-8")
    drumlin("measure", ours, "--parts", "none", "--overwrite")
    require((ours / "measured" / "notes.txt").exists() and not (ours / "measured" / "maps.h5").exists(), "measure: notes or old maps")
    drumlin("run", scene, "-o", ours, *SHORT, "--set", "seed=2", "--overwrite")
    require((ours / "notes.txt").exists() and (ours / "measured" / "notes.txt").exists(), "run --overwrite removed notes")
    require(not (ours / "measured" / "measured.json").exists() and not (ours / "replaced").exists(), "old results are left")
    drumlin("export", run, "--vtu", "-o", ours, "--overwrite", code=2)  # a run is no export


def old_results_wait(drumlin, scene, run, folder):
    """A run that replaces another is killed, then finished."""
    again = folder / "again"
    shutil.copytree(run, again)
    words = ["run", scene, "-o", again, *SHORT, "--set", "stages.2.turns=0.2"]
    process = started(drumlin.executable, *words, "--overwrite")
    wait_until(lambda: all((again / name).exists() for name in ("replaced/run.json", "run.json", "log.csv")), "new results", process)
    # The one that is at work is named; a second one does nothing.
    process.send_signal(signal.SIGSTOP)
    for second in (["--resume"], ["--overwrite"], []):
        _, said = drumlin(*words, *second, code=2)
        require(f"process {process.pid}, drumlin run, since" in said, f"{second}: {said}")
    process.kill()
    process.wait()
    drumlin("run", scene, "-o", again / "replaced", *SHORT, "--resume")  # finished, and whole
    drumlin("measure", again, code=2)
    drumlin(*words, "--resume")
    require(not (again / "replaced").exists() and not (again / ".lock").exists(), "old results or a lock are left")
    # Killed while it moved the old results aside.
    (again / "replaced" / "snapshots").mkdir(parents=True)
    for moved in ("manifest.txt", "snapshots/000001.h5", "run.json"):
        shutil.copy(again / moved, again / "replaced" / moved)
    (again / "snapshots" / "000001.h5").unlink()
    drumlin(*words, "--resume")
    drumlin(*words, "--resume")
    require(not (again / "replaced").exists(), "old results are left")


def main():
    with given() as (drumlin, tests, folder):
        scene, run = tests / "tiny-drum.toml", folder / "run"
        drumlin("run", scene, "-o", run, *SHORT)
        drumlin("measure", run, "--parts", "maps")
        every_file_is_checked(drumlin, run)
        missing_and_extra(drumlin, scene, run, folder)
        edits_are_told(drumlin, run, folder)
        measured_belongs_to_its_run(drumlin, scene, run, folder)
        strangers_stay(drumlin, scene, run, folder)
        old_results_wait(drumlin, scene, run, folder)
    print("folders: checked, accepted, untouched, locked")


if __name__ == "__main__":
    main()
