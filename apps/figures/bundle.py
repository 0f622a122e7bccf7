"""What a report of a fault needs of a run, in one small file: scene, log, run.json, manifest, versions. A long log keeps its head and its last lines.

usage: bundle.py RUN FILE.tar.gz VERSION
"""

import importlib.metadata
import io
import pathlib
import platform
import sys
import tarfile

import whole_file

NAMES = ("scene.toml", "run.json", "manifest.txt", "log.csv", "energy.csv")
LINES = 1000  # of a log, at its end
PACKAGES = ("numpy", "scipy", "h5py", "matplotlib")


def shortened(text):
    lines = text.splitlines(keepends=True)
    return text if len(lines) <= LINES + 20 else "".join([*lines[:20], "...\n", *lines[-LINES:]])


def versions(program):
    lines = [program, platform.platform(), f"Python {platform.python_version()}"]
    for package in PACKAGES:
        try:
            lines.append(f"{package} {importlib.metadata.version(package)}")
        except importlib.metadata.PackageNotFoundError:
            lines.append(f"{package} is missing")
    return "\n".join(lines) + "\n"


def main():
    run, bundle, program = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), sys.argv[3]
    texts = {name: shortened((run / name).read_text(encoding="utf-8", errors="replace")) for name in NAMES if (run / name).is_file()}
    texts["versions.txt"] = versions(program)
    with whole_file.aside(bundle) as stream, tarfile.open(fileobj=stream, mode="w:gz") as archive:
        for name, text in texts.items():
            content = text.encode("utf-8")
            entry = tarfile.TarInfo(f"{bundle.name.removesuffix('.gz').removesuffix('.tar')}/{name}")
            entry.size = len(content)
            archive.addfile(entry, io.BytesIO(content))


if __name__ == "__main__":
    main()
