"""A signal to ./reproduce reaches the command that is at work; both end at once, with 128 + signal.

usage: reproduce.py ROOT_OF_THE_SOURCE
"""

import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time

from command import require

PATIENCE = 1200  # s, a machine that is very slow included

INSTALL = ".ci/install"
STUB = "#!/bin/bash\nexit 0\n"
# As a command that takes long: it leaves its result to a handler of the signal, and would go on for minutes.
SLOW = """#!/bin/bash
for name in INT TERM HUP; do trap "echo $name > '{told}'; exit 1" $name; done
echo > '{begun}'
for k in {{1..3000}}; do sleep 0.1; done
"""


# What compiles the other programs beside the particles.
COMPILER = """#!/bin/bash
[[ "$*" == *programs* ]] || exit 0
echo $$ > '{compiling}.new' && mv '{compiling}.new' '{compiling}'  # whole or not at all: the signal may come at any time
for k in {{1..3000}}; do sleep 0.1; done
"""


def stub(path, text=STUB):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")
    path.chmod(0o755)


def interrupted(root, slow, number):
    """`slow` is the command of the tree `root` that is at work when the signal comes."""
    begun, told = root / "begun", root / "told"
    kept = (root / slow).read_text(encoding="utf-8")
    stub(root / slow, SLOW.format(begun=begun, told=told))
    process = subprocess.Popen([root / "reproduce", "--smoke", "-o", root / "results"], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                               text=True, env={"PATH": f"{root / 'bin'}:/usr/bin:/bin"}, start_new_session=True)
    try:
        end = time.monotonic() + PATIENCE
        while not begun.exists():
            require(process.poll() is None and time.monotonic() < end, f"{slow} was not started")
            time.sleep(0.01)
        process.send_signal(number)  # to this process alone, as a supervisor or `kill` does
        _, said = process.communicate(timeout=PATIENCE)
    finally:
        process.kill()
    require(process.returncode == 128 + number, f"{slow}: {number.name} ends reproduce with {process.returncode}\n{said}")
    names = {"INT": "TERM"} if slow == INSTALL else {}  # it stays in the group of the script, where INT is ignored
    name = number.name[3:]
    require(told.exists() and told.read_text(encoding="utf-8").strip() == names.get(name, name), f"{slow}: {number.name} did not reach it")
    require("the same command goes on from here" in said, f"{slow}: {said}")
    begun.unlink()
    told.unlink()
    stub(root / slow, kept)


def main():
    signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell that runs us in the background has it ignored, and so would what we start
    source = pathlib.Path(sys.argv[1])
    with tempfile.TemporaryDirectory(prefix="drumlin-reproduce-") as name:
        root = pathlib.Path(name)
        (root / ".ci").mkdir()
        shutil.copy(source / "reproduce", root)
        shutil.copy(source / ".ci" / "environment", root / ".ci")
        commands = (INSTALL, "bin/cmake", "build/drumlin")
        for command in commands:
            stub(root / command)
        for command in commands:
            for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
                interrupted(root, command, number)
        compiling = root / "compiling"
        stub(root / "bin/cmake", COMPILER.format(compiling=compiling))
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            interrupted(root, "build/drumlin", number)
            require(not compiling.exists() or not pathlib.Path("/proc", compiling.read_text().strip()).exists(), f"{number.name} leaves a compiler at work")
            compiling.unlink(missing_ok=True)
        # A compiler that fails ends the call, once the particles are there.
        stub(root / "bin/cmake", '#!/bin/bash\n[[ "$*" != *programs* ]] || { echo no memory; exit 1; }\n')
        result = subprocess.run([root / "reproduce", "--smoke", "-o", root / "results"], capture_output=True, text=True, check=False,
                                env={"PATH": f"{root / 'bin'}:/usr/bin:/bin"})
        require(result.returncode == 1 and "no memory" in result.stderr and '"particle run" failed' in result.stderr, f"{result}")
    print("reproduce: signals reach what is at work")


if __name__ == "__main__":
    main()
