"""What a command prints arrives or is said to be lost; missing memory, threads or room end it cleanly.

usage: streams.py DRUMLIN FOLDER_OF_THIS_TEST DATA
"""

import os
import resource
import shutil
import signal
import subprocess

from command import SHORT_RUN, bytes_below, given, has_address_sanitizer, read_json, require, require_whole_files

PATIENCE = 1200  # seconds for what takes less than one


def results(run):
    """What must not depend on where the output of a run goes: all but timings."""
    return {name: content for name, content in bytes_below(run).items() if name in ("log.csv", "scene.toml") or name.startswith("snapshots/")}


def by_shell(executable, words, streams):
    """Exit code of the command in a shell, with these redirections."""
    line = " ".join([str(executable), *map(str, words), streams])
    return subprocess.run(["/bin/bash", "-c", line], stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True, timeout=PATIENCE, check=False)


def without_reader(words, **streams):
    """The command with a pipe that nobody reads as its standard output, and as its standard error where `stderr` is True."""
    reader, writer = os.pipe()
    os.close(reader)
    stderr = writer if streams.get("stderr") else subprocess.PIPE
    result = subprocess.run(list(map(str, words)), stdout=writer, stderr=stderr, text=True, check=False, timeout=PATIENCE)
    os.close(writer)
    return result


def check_closed_streams(executable):
    """Streams that are closed or full; what every command says of them: contract.py."""
    for words in (["scene", "keys"], ["import", "--keys"], ["--help"], ["--version"], ["--commands"]):
        for streams in (">/dev/full", ">&-", ">&- 2>&-"):
            result = by_shell(executable, words, streams)
            require(result.returncode == 74, f"{words} {streams}: exit code {result.returncode} instead of 74\n{result.stderr}")
            require("2>" in streams or "lost" in result.stderr, f"{words} {streams}: not said\n{result.stderr}")
    for streams in ("2>/dev/full", "2>&-", "<&-"):
        result = by_shell(executable, ["scene", "keys"], streams)
        require(result.returncode == 0, f"scene keys {streams}: exit code {result.returncode}\n{result.stderr}")
    for streams in (">/dev/full", "2>/dev/full", "2>&-"):
        result = by_shell(executable, ["scene", "check", "nowhere.toml"], streams)
        require(result.returncode == 2, f"a missing file {streams}: exit code {result.returncode}")


def check_run_without_streams(executable, scene, folder, expected):
    """A run keeps its files apart from streams that are closed, and outlives readers that have gone."""
    for number, streams in enumerate(("2>&- >/dev/null", "0<&- 1>&- 2>&-", "2>/dev/full >/dev/null")):
        run = folder / f"streams-{number}"
        result = by_shell(executable, ["run", scene, "-o", run, *SHORT_RUN], streams)
        require(result.returncode == (74 if "1>&-" in streams else 0), f"run {streams}: exit code {result.returncode}")
        require(results(run) == expected, f"run {streams}: other files")
    run = folder / "no-reader"
    result = without_reader([executable, "run", scene, "-o", run, *SHORT_RUN], stderr=True)
    require(result.returncode == -signal.SIGPIPE and results(run) == expected, f"a run without readers ended with {result.returncode}")
    require(read_json(run / "run.json")["status"] == "finished", "a run without readers was not finished")


def limited(kind, value):
    return lambda: resource.setrlimit(kind, (value, value))


def ended(executable, words, limit=None, environment=None):
    return subprocess.run(list(map(str, [executable, *words])), preexec_fn=limit, env=environment, capture_output=True, text=True, check=False, timeout=PATIENCE)


def check_limits(executable, scene, problem, run, folder):
    """Memory, threads and sizes of files that the system does not give end a command with a message and 74."""
    mebibyte = 1 << 20

    def refused(words, limit, said):
        result = ended(executable, words, limit)
        require(result.returncode == 74, f"{words}: exit code {result.returncode} instead of 74\n{result.stderr}")
        require(any(word in result.stderr for word in said) and "Traceback" not in result.stderr, f"{words}: not said why\n{result.stderr}")

    if not has_address_sanitizer(executable):
        few = limited(resource.RLIMIT_AS, 700 * mebibyte)
        for words in (["run", scene, "-o", folder / "threads", *SHORT_RUN], ["solve-contacts", problem]):
            refused([*words, "--threads", "256"], few, ["threads cannot be started", "not enough memory"])
        diameters = [f"grains.generated.diameter_{which}_mm=0.05" for which in ("min", "max")]
        refused(["scene", "check", scene, "--set", "grains.generated.count=3000000", "--set", diameters[0], "--set", diameters[1]],
                limited(resource.RLIMIT_AS, 150 * mebibyte), ["not enough memory"])
    for words in (["run", scene, "-o", folder / "many", "--threads", "257"], ["solve-contacts", problem, "--threads", "1024"],
                  ["cost", scene, "--effects", "--threads", "100000"]):
        result = ended(executable, words)
        require(result.returncode == 2 and "1 to 256" in result.stderr, f"{words}: {result.returncode}\n{result.stderr}")
    copy = folder / "no-room"
    shutil.copytree(run, copy)
    for words, room, said in ((["measure", copy, "--parts", "none"], 1000, "too large"),
                              (["plot", copy], 20000, "speed.png: cannot be written: File too large")):
        refused(words, limited(resource.RLIMIT_FSIZE, room), [said])
        require_whole_files(copy)
    require(not (copy / "plots").exists(), "a part of the figures was left")
    print("limits: said")


def check_flow_without_path(executable, data, scene, folder):
    """MPI begins without a daemon along PATH, and the command says what is wrong."""
    taken = folder / "taken"
    taken.mkdir()
    (taken / "theirs").touch()
    flow = ["flow", scene.parent / "tiny-drum-flow.toml", "--rheology", data / "rheology" / "paper.toml", "-o", taken]
    for path in ({}, {"PATH": ""}):
        environment = {name: value for name, value in os.environ.items() if name != "PATH"} | path
        result = ended(executable, flow, environment=environment)
        require(result.returncode == 2 and "taken" in result.stderr, f"flow without PATH: {result.returncode}\n{result.stderr}")


def check_starts_of_python(root):
    for script in ("reproduce", "check", ".ci/install", ".ci/run", "apps/paper_runs"):
        for line in (root / script).read_text(encoding="utf-8").splitlines():
            if "python3" in line and not line.lstrip().startswith(("python3-", "# ")):
                require("/usr/bin/python3 -I" in line, f"{script}: {line}")
    for listing in root.glob("tests/*/CMakeLists.txt"):
        require("${DRUMLIN_PYTHON}" not in listing.read_text(encoding="utf-8"), f"{listing}: starts Python that is not isolated")


def check_one_way_to_print(root):
    for path in sorted((root / "apps").rglob("*.cpp")):
        text = path.read_text(encoding="utf-8")
        if path.name != "standard_streams.cpp" and "examples" not in path.parts:  # those are programs of users
            for way in ("fmt::print", "std::cout", "std::cerr", "stdout", "stderr", "printf("):
                require(way not in text, f"{path.relative_to(root)} prints by {way}; apps/process/standard_streams.hpp is the way")


def main():
    with given() as (drumlin, here, data, folder):
        executable, root, run = drumlin.executable, here.parents[1], folder / "run"
        scene, problem = here / "tiny-drum.toml", data / "problems" / "drum-300-mu-0.4-flow.h5"
        check_one_way_to_print(root)
        check_starts_of_python(root)
        drumlin("run", scene, "-o", run, *SHORT_RUN)
        expected = results(run)
        check_closed_streams(executable)
        check_run_without_streams(executable, scene, folder, expected)
        check_limits(executable, scene, problem, run, folder)
        check_flow_without_path(executable, data, scene, folder)


if __name__ == "__main__":
    main()
