"""Installs a wheel into a bare Debian without a compiler, computes and measures a small drum there, and records size and seconds.

usage: bare.py WHEEL ROOT [RECORD]    as root. ROOT: made by debootstrap if it is no folder yet, with Python, pip and what the wheel depends on, which
                                      elsewhere PyPI gives; RECORD: data/cost/wheel.json
"""

import json
import os
import pathlib
import re
import resource
import shutil
import subprocess
import sys
import time

HERE = pathlib.Path(__file__).resolve().parent
PACKAGES = ["python3", "python3-pip", *(f"python3-{name}" for name in ("numpy", "scipy", "h5py", "matplotlib", "jinja2"))]
COMPILERS = ["cc", "gcc", "g++", "c++", "clang", "cmake", "ninja", "make"]


def in_root(root, words, exit_code=0):
    """What a command in the root printed, and what it took."""
    start, before = time.perf_counter(), resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run(["unshare", "-m", "sh", "-c", 'mount --rbind /proc "$0/proc"; exec chroot "$0" "$@"', root, *words], capture_output=True, text=True,
                          check=False, env={"PATH": "/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin", "HOME": "/root", "LC_ALL": "C.UTF-8"})
    if done.returncode != exit_code:
        sys.exit(f"{' '.join(words)}: exit code {done.returncode}, not {exit_code}\n{done.stdout}{done.stderr}")
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    took = {"command": " ".join(words), "wall_seconds": round(time.perf_counter() - start, 1),
            "processor_seconds": round(after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, 1)}
    return done.stdout + done.stderr, took


def make_root(root):
    subprocess.run(["debootstrap", "--variant=minbase", f"--include={','.join(PACKAGES)}", "bookworm", root], check=True)
    # Debian's numpy and scipy depend on compilers, which those of PyPI do not.
    in_root(root, ["dpkg", "--purge", "--force-depends", "g++", "gcc", "g++-12", "gcc-12"])


def require_bare(root):
    found = [name for name in COMPILERS for folder in ("usr/bin", "usr/local/bin") if (root / folder / name).exists()]
    if found:
        sys.exit(f"{root}: is not bare, it has {', '.join(found)}")


def main():
    wheel, root = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    if not root.is_dir():
        make_root(root)
    require_bare(root)
    subprocess.run([sys.executable, HERE / "portable.py", wheel], check=True)
    in_root(root, ["pip", "uninstall", "-y", "--break-system-packages", "drumlin"])
    shutil.rmtree(root / "tmp/RUN", ignore_errors=True)
    shutil.copy(wheel, root / "tmp")
    _, install = in_root(root, ["pip", "install", "--no-index", "--no-deps", "--break-system-packages", f"/tmp/{wheel.name}"])
    _, run = in_root(root, ["drumlin", "run", "drum-smoke", "-o", "/tmp/RUN"])
    _, measure = in_root(root, ["drumlin", "measure", "/tmp/RUN"])
    in_root(root, ["drumlin", "plot", "/tmp/RUN"])
    if not list((root / "tmp/RUN").rglob("*.png")):
        sys.exit("no picture was drawn")
    in_root(root, ["python3", "-c", "import drumlin; assert drumlin.read('/tmp/RUN').snapshots"])
    said, _ = in_root(root, ["drumlin", "flow", "incline-flow", "--rheology", "paper", "-o", "/tmp/FLOW"], exit_code=2)
    if "libdeal.ii-dev" not in said:
        sys.exit(f"drumlin flow does not say what to install: {said}")
    version, _ = in_root(root, ["drumlin", "--version"])
    record = {"format": "drumlin-wheel-cost-1", "revision": re.search(r"revision ([\w.+-]+)", version)[1], "wheel": wheel.name,
              "megabytes": round(wheel.stat().st_size / 1e6, 2), "of": "a bare Debian 12 without a compiler (debootstrap, minbase)",
              "machine": re.search(r"model name\s*: (.*)", pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8"))[1], "processors": os.cpu_count(),
              "at_work": round(os.getloadavg()[0], 1), "calls": [install, run, measure]}
    text = json.dumps(record, indent=1) + "\n"
    print(text, end="")
    if len(sys.argv) > 3:
        pathlib.Path(sys.argv[3]).write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
