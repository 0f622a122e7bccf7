"""Runs that go on from others: prolonged as if the scene had been longer, and started from the grains of another run.

usage: going_on.py DRUMLIN FOLDER_OF_THIS_TEST
"""

import pathlib

from command import SHORT_RUN, given, read_json, require, results_of_run

LONGER = ["--set", "stages.2.turns=0.04", "--set", "stages.2.snapshots=8"]  # 0.08 s more, twice the snapshots


def snapshots(run):
    return {name: content for name, content in results_of_run(run).items() if name.startswith("snapshots/")}


def check_prolonged(drumlin, scene, there):
    """The snapshots are those of the longer scene, to the byte, whatever the number of threads."""
    drumlin("run", scene, "-o", there / "short", *SHORT_RUN)
    before = snapshots(there / "short")
    drumlin("run", there / "short" / "scene.toml", "-o", there / "short", "--extend", "0.08", "--threads", "2")
    drumlin("run", scene, "-o", there / "long", *SHORT_RUN[:2], *LONGER)
    require(len(before) == 4 and snapshots(there / "short") == snapshots(there / "long"), "a prolonged run is not the longer one")
    require(read_json(there / "short" / "run.json")["status"] == "finished", "status after --extend")
    drumlin("run", there / "none" / "scene.toml", "-o", there / "none", "--extend", "0.08", code=2)


def check_prolonged_where_the_step_was_adjusted(drumlin, scene, there):
    """At 7 rpm 0.01 turns are 85.7 steps of 1 ms: 86 shorter ones, and twice as many are read again by what measures them."""
    turn = ["--set", "stages.2.motions.0.speed_rpm=7", "--set", "stages.2.turns=0.01", "--set", "stages.2.snapshots=4"]
    drumlin("run", scene, "-o", there / "adjusted", *SHORT_RUN[:2], *turn)
    before = snapshots(there / "adjusted")
    drumlin("run", there / "adjusted" / "scene.toml", "-o", there / "adjusted", "--extend", "0.0857")
    require(len(snapshots(there / "adjusted")) == 2 * len(before) > 0, "snapshots of a prolonged run")
    said, _ = drumlin("scene", "check", there / "adjusted" / "scene.toml")
    require("172 steps" in said, f"a prolonged scene: {said}")
    drumlin("measure", there / "adjusted", "--parts", "none")


def scene_of(run, text, there):
    """The scene of a run with another run's grains in place of its own."""
    begin, end = text.index("[grains.generated]"), text.index("[[walls]]")
    path = there / "from.toml"
    path.write_text(f'{text[:begin]}[grains.from_run]\nrun = "{run}"\n\n{text[end:]}', encoding="utf-8")
    return path


def check_started(drumlin, scene, there):
    """A run that starts from another's grains says so, is checked before, and repeats from its own folder, without the other run."""
    started = scene_of("short", scene.read_text(encoding="utf-8"), there)
    said, _ = drumlin("scene", "check", started)
    require("350" in said, f"a scene from another run: {said}")
    drumlin("run", started, "-o", there / "second", *SHORT_RUN)
    chain = read_json(there / "second" / "run.json")["started_from"]
    require(chain["snapshot"] == "000008.h5" and pathlib.Path(chain["run"]).name == "short", f"started_from {chain}")
    (there / "short").rename(there / "gone")
    drumlin("run", there / "second" / "scene.toml", "-o", there / "third")
    require(snapshots(there / "second") == snapshots(there / "third"), "a started run does not repeat from its folder")
    drumlin("run", started, "-o", there / "fourth", *SHORT_RUN, code=2)


def main():
    with given() as (drumlin, tests, there):
        scene = tests / "tiny-drum.toml"
        check_prolonged(drumlin, scene, there)
        check_prolonged_where_the_step_was_adjusted(drumlin, scene, there)
        check_started(drumlin, scene, there)
    print("prolonged as if longer; started from another run, and repeated without it")


if __name__ == "__main__":
    main()
