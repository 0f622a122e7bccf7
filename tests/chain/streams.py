"""What a command prints arrives or is said to be lost; signals, lost parents and missing memory or threads end every command cleanly.

usage: streams.py DRUMLIN FOLDER_OF_THIS_TEST DATA
"""

import os
import pathlib
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time

from command import Drumlin, bytes_below, read_json, require

SHORT = ["--set", "stages.1.turns=0.02", "--set", "stages.2.turns=0.02", "--set", "stages.2.snapshots=4"]
# Steps that nobody waits for, for what must be stopped.
ENDLESS = ["--set", "stages.2.turns=1000"]
SIGNALS = {signal.SIGINT: 130, signal.SIGTERM: 143, signal.SIGHUP: 129}
PATIENCE = 120  # seconds for what takes less than one


def results(run):
    return {name: content for name, content in bytes_below(run).items() if name.endswith((".h5", ".csv", "scene.toml"))}


def by_shell(executable, words, streams):
    """Exit code of the command in a shell, with these redirections."""
    line = " ".join([str(executable), *map(str, words), streams])
    return subprocess.run(["/bin/bash", "-c", line], stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True, timeout=PATIENCE, check=False)


def unmasked():
    """A test that is started in the background, or by nohup, inherits signals that are ignored."""
    for number in SIGNALS:
        signal.signal(number, signal.SIG_DFL)


def started(command, **options):
    return subprocess.Popen(list(map(str, command)), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, preexec_fn=unmasked, **options)


def wait_until(condition, what):
    deadline = time.monotonic() + PATIENCE
    while not condition():
        require(time.monotonic() < deadline, f"not in time: {what}")
        time.sleep(0.002)


def check_lost_output(executable, scene, problem, run):
    """Output that cannot be written is code 74, that nobody reads ends the command by SIGPIPE; no abort, no message without need."""
    printing = [["scene", "show", scene], ["scene", "check", scene], ["scene", "keys"], ["solve-contacts", problem, "--json"],
                ["solve-contacts", problem], ["import", "--keys"], ["--help"], ["--version"], ["run", "--help"],
                ["hardcases", "stack-of-ten"], ["run", scene, "-o", run, *SHORT, "--resume"], ["measure", run, "--resume"]]
    for words in printing:
        for streams in (">/dev/full", ">&-", ">&- 2>&-"):
            result = by_shell(executable, words, streams)
            require(result.returncode == 74, f"{words} {streams}: exit code {result.returncode} instead of 74\n{result.stderr}")
            require("2>" in streams or "lost" in result.stderr, f"{words} {streams}: not said\n{result.stderr}")
        for streams in ("2>/dev/full", "2>&-", "<&-"):
            result = by_shell(executable, words, streams)
            require(result.returncode == 0, f"{words} {streams}: exit code {result.returncode}\n{result.stderr}")
        reader, writer = os.pipe()
        os.close(reader)
        result = subprocess.run(list(map(str, [executable, *words])), stdout=writer, stderr=subprocess.PIPE, text=True, check=False, timeout=PATIENCE)
        os.close(writer)
        require(result.returncode == -signal.SIGPIPE and not result.stderr, f"{words}: a gone reader gives {result.returncode}\n{result.stderr}")
    result = by_shell(executable, ["scene", "check", "nowhere.toml"], ">/dev/full")
    require(result.returncode == 2, f"a fault with nothing printed is {result.returncode}")
    print(f"{len(printing)} commands say what is lost")


def check_run_without_streams(executable, scene, folder, expected):
    """A run keeps its files apart from streams that are closed, and outlives readers that have gone."""
    for number, streams in enumerate(("2>&- >/dev/null", "0<&- 1>&- 2>&-", "2>/dev/full >/dev/null")):
        run = folder / f"streams-{number}"
        result = by_shell(executable, ["run", scene, "-o", run, *SHORT], streams)
        require(result.returncode == (74 if "1>&-" in streams else 0), f"run {streams}: exit code {result.returncode}")
        require(results(run) == expected, f"run {streams}: other files")
    run = folder / "no-reader"
    reader, writer = os.pipe()
    os.close(reader)
    result = subprocess.run([executable, "run", scene, "-o", run, *SHORT], stdout=writer, stderr=writer, check=False, timeout=PATIENCE)
    os.close(writer)
    require(result.returncode == -signal.SIGPIPE and results(run) == expected, f"a run without readers ended with {result.returncode}")
    require(read_json(run / "run.json")["status"] == "finished", "a run without readers was not finished")


def whole_files(folder):
    """No part of a file below the folder; JSON files are whole."""
    for path in folder.rglob("*"):
        require(".part" not in path.name, f"{path} was left")
        if path.suffix == ".json" and path.is_file():
            read_json(path)
        if path.suffix == ".png":
            require(path.read_bytes().endswith(b"IEND\xaeB`\x82"), f"{path} is half a picture")


def check_signals(executable, scene, problem, run, folder):
    """Every command ends by a signal at any moment, with its code and without parts of files."""
    for number, code in SIGNALS.items():
        stopped = folder / f"stopped-{code}"
        process = started([executable, "run", scene, "-o", stopped, *ENDLESS, "--set", "output.checkpoint_every_s=0.01"])
        wait_until((stopped / "checkpoint.h5").exists, "a checkpoint")
        process.send_signal(number)
        require(process.wait(PATIENCE) == code, f"run: exit code {process.returncode} instead of {code}")
        require(read_json(stopped / "run.json")["status"] == "interrupted", f"run: status after {number.name}")
        whole_files(stopped)
    for name, words in {"measure": ["measure", "RUN"], "plot": ["plot", "RUN"], "export": ["export", "RUN", "--vtu"],
                        "cost": ["cost", scene, "--effects", "-o", "RUN/cost"], "scene": ["scene", "check", scene],
                        "hardcases": ["hardcases", "--fast"], "solve-contacts": ["solve-contacts", problem, "--tolerance", "1e-12"]}.items():
        copy = folder / f"signal-{name}"
        shutil.copytree(run, copy)
        words = [str(word).replace("RUN", str(copy)) for word in words]
        for step, (number, code) in enumerate(SIGNALS.items()):
            process = started([executable, *words, *(["--resume"] if step > 0 and copy.name in ("measure", "plot", "export") else [])])
            time.sleep(0.02 + 0.15 * step)
            process.send_signal(number)
            process.wait(PATIENCE)
            # Before main() has begun, the signal ends the process itself; after its end it comes too late.
            require(process.returncode in (code, -number, 0, 2, 3), f"{name}: exit code {process.returncode} instead of {code}")
            whole_files(copy)
            shutil.rmtree(copy / name, ignore_errors=True)
            shutil.rmtree(copy / "measured", ignore_errors=True)
    print("signals: clean ends")


def processes_of(folder):
    """Processes whose command line names the folder, but this one."""
    found = []
    for entry in pathlib.Path("/proc").iterdir():
        if entry.name.isdigit() and int(entry.name) != os.getpid():
            try:
                if str(folder).encode() in (entry / "cmdline").read_bytes():
                    found.append(int(entry.name))
            except OSError:
                pass
    return found


def check_children(executable, here, data, run, folder):
    """What a command has started ends with it, also at kill -9."""
    flow, drawn = folder / "flow", folder / "drawn"
    shutil.copytree(run, drawn)
    march = ["flow", here / "tiny-drum-flow.toml", "--rheology", data / "rheology" / "paper.toml", "-o", flow,
             "--set", "time.step_s=0.001", "--set", "time.steps=100000", "--set", "time.every=1"]
    for number, code in {signal.SIGKILL: -signal.SIGKILL, signal.SIGHUP: 129}.items():
        process = started([executable, *march, "--resume"])
        (flow / "checkpoint.h5").unlink(missing_ok=True)
        wait_until(lambda: (flow / "checkpoint.h5").exists() or process.poll() is not None, "a kept state")
        require(process.poll() is None and len(processes_of(flow)) >= 2, f"flow: ended with {process.returncode}")
        process.send_signal(number)
        require(process.wait(PATIENCE) == code, f"flow: exit code {process.returncode} instead of {code}")
        wait_until(lambda: not processes_of(flow), "the end of drumlin-flow")
        require((flow / "checkpoint.h5").exists(), "flow: no checkpoint")
    for number in (signal.SIGKILL, signal.SIGTERM):
        process = started([executable, "measure", drawn, "--parts", "none", "--resume"])
        wait_until(lambda: len(processes_of(drawn)) >= 2 or process.poll() is not None, "a script of figures")
        require(process.poll() is None, "measure ended before it drew")
        process.send_signal(number)
        require(process.wait(PATIENCE) == (143 if number == signal.SIGTERM else -number), f"measure: exit code {process.returncode}")
        wait_until(lambda: not processes_of(drawn), "the end of the script")
        if number == signal.SIGTERM:
            whole_files(drawn)
    print("children: gone with their parents")


def limited(kind, value):
    def limit():
        resource.setrlimit(kind, (value, value))
    return limit


def check_limits(executable, scene, problem, run, folder):
    """Memory, threads and sizes of files that the system does not give end a command with a message and 74."""
    mebibyte = 1 << 20

    def refused(words, limit, said):
        result = subprocess.run(list(map(str, [executable, *words])), preexec_fn=limit, capture_output=True, text=True, check=False, timeout=PATIENCE)
        require(result.returncode == 74, f"{words}: exit code {result.returncode} instead of 74\n{result.stderr}")
        require(any(word in result.stderr for word in said), f"{words}: not said why\n{result.stderr}")

    memory = limited(resource.RLIMIT_AS, 700 * mebibyte)
    refused(["run", scene, "-o", folder / "threads", *SHORT, "--threads", "256"], memory, ["threads cannot be started", "not enough memory"])
    refused(["solve-contacts", problem, "--threads", "256"], memory, ["threads cannot be started", "not enough memory"])
    refused(["scene", "check", scene, "--set", "grains.generated.count=1000000", "--set", "grains.generated.diameter_min_mm=0.02",
             "--set", "grains.generated.diameter_max_mm=0.02"], limited(resource.RLIMIT_AS, 150 * mebibyte), ["not enough memory"])
    for words in (["run", scene, "-o", folder / "many", "--threads", "257"], ["solve-contacts", problem, "--threads", "1024"],
                  ["cost", scene, "--effects", "--threads", "100000"]):
        result = subprocess.run(list(map(str, [executable, *words])), capture_output=True, text=True, check=False)
        require(result.returncode == 2 and "1 to 256" in result.stderr, f"{words}: {result.returncode}\n{result.stderr}")
    for size in (100, 5000, 30000):
        copy = folder / f"size-{size}"
        shutil.copytree(run, copy)
        refused(["measure", copy], limited(resource.RLIMIT_FSIZE, size), ["too large"])
        whole_files(copy)
    print("limits: said")


def check_python(executable, run, folder, root):
    """Figures are drawn by our modules alone: none of the current folder, none of PYTHONPATH."""
    strange = folder / "strange"
    strange.mkdir()
    for module in ("json", "csv", "style", "script", "sitecustomize", "usercustomize"):
        (strange / f"{module}.py").write_text(f"open({str(folder / 'executed')!r}, 'w').close()\nraise SystemExit('strange')\n", encoding="utf-8")
    copy = folder / "isolated"
    shutil.copytree(run, copy)
    environment = os.environ | {"PYTHONPATH": str(strange), "PYTHONHOME": str(strange), "PYTHONSTARTUP": str(strange / "json.py")}
    for words in (["measure", copy, "--parts", "none"], ["plot", copy]):
        result = subprocess.run(list(map(str, [executable, *words])), cwd=strange, env=environment, capture_output=True, text=True, check=False)
        require(result.returncode == 0 and not (folder / "executed").exists(), f"{words}: {result.returncode}\n{result.stderr}")
    # Every other start of Python in scripts of the repository.
    for script in ("reproduce", "check", ".ci/install", ".ci/run", "apps/paper_runs"):
        for line in (root / script).read_text(encoding="utf-8").splitlines():
            if "python3" in line and not line.lstrip().startswith(("python3-", "# ")):
                require("/usr/bin/python3 -I" in line, f"{script}: {line}")
    for listing in root.glob("tests/*/CMakeLists.txt"):
        require("${DRUMLIN_PYTHON}" not in listing.read_text(encoding="utf-8"), f"{listing}: starts Python that is not isolated")
    print("python: isolated")


def check_one_way_to_print(root):
    for path in sorted((root / "apps").rglob("*.cpp")):
        text = path.read_text(encoding="utf-8")
        if path.name != "standard_streams.cpp":
            for way in ("fmt::print", "std::cout", "std::cerr", "stdout", "stderr", "printf("):
                require(way not in text, f"{path.relative_to(root)} prints by {way}; apps/support/standard_streams.hpp is the way")


def main():
    executable, here, data = sys.argv[1], pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3])
    drumlin, root = Drumlin(executable), here.parents[1]
    scene, problem = here / "tiny-drum.toml", data / "problems" / "drum-300-mu-0.4-flow.h5"
    check_one_way_to_print(root)
    with tempfile.TemporaryDirectory(prefix="drumlin-streams-") as name:
        folder = pathlib.Path(name)
        run = folder / "run"
        drumlin("run", scene, "-o", run, *SHORT)
        expected = results(run)
        drumlin("measure", run, "--parts", "none")
        check_lost_output(executable, scene, problem, run)
        shutil.rmtree(run / "measured")
        check_run_without_streams(executable, scene, folder, expected)
        check_python(executable, run, folder, root)
        check_limits(executable, scene, problem, run, folder)
        check_signals(executable, scene, problem, run, folder)
        check_children(executable, here, data, run, folder)


if __name__ == "__main__":
    main()
