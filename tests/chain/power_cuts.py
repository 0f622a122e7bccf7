"""The power goes at any moment of a run: whatever of its unforced writes the disk lost, --resume goes on to the same bytes.

usage: power_cuts.py DRUMLIN FILE_CALLS_LIBRARY FOLDER_OF_THIS_TEST [--cuts COUNT] [--show]
  --cuts COUNT  about how many moments are tried, spread evenly (default: 0, after each call that changes a file or a folder)
  --show        lists every state of the disk with what --resume said

A small run is recorded call by call. After a cut a disk holds what was forced to it: the bytes of a file up to its last fsync, the names in a folder
up to the fsync of that folder. Of all later writes and names it may hold any, so that for each moment four states are laid out: none of the later ones,
all names without the bytes, all bytes without the names, and a half of both, drawn from a fixed seed.
"""

import argparse
import hashlib
import os
import pathlib
import random
import shutil
import subprocess
import tempfile

from command import has_address_sanitizer, require, require_whole_files, results_of_run
from failing import PATIENCE, SMALL

STATES = ("nothing later", "names without bytes", "bytes without names", "some of both")


class Disk:
    """Files and folders as the program sees them, and as they were last forced to the disk. Folders are dictionaries of names to inodes."""

    def __init__(self, root, inode):
        self.root = root
        self.seen, self.forced = {inode: {}}, {inode: {}}
        self.top = inode

    def place(self, path):
        """(folder, name) of a path below the root; None elsewhere."""
        if not path.startswith(self.root + "/"):
            return None
        folder, names = self.top, path[len(self.root) + 1:].split("/")
        for name in names[:-1]:
            folder = self.seen[folder][name]
        return folder, names[-1]

    def apply(self, line):
        """One call of the record; True if it changes what a cut could leave."""
        call, *words = line.split(" ")
        if call in ("create", "mkdir"):
            inode, place = words[0], self.place(words[1])
            if place is None:
                return False
            new = bytearray() if call == "create" else {}
            self.seen[inode], self.forced[inode] = new, type(new)()
            self.seen[place[0]][place[1]] = inode
        elif call in ("rename", "remove"):
            place = self.place(words[0])
            if place is None:
                return False
            inode = self.seen[place[0]].pop(place[1])
            if call == "rename":
                folder, name = self.place(words[1])
                self.seen[folder][name] = inode
        elif words[0] not in self.seen:
            return False
        elif call == "write":
            content, offset, new = self.seen[words[0]], int(words[1]), bytes.fromhex(words[2])
            content.extend(bytes(max(0, offset - len(content))))
            content[offset:offset + len(new)] = new
        elif call == "truncate":
            content, size = self.seen[words[0]], int(words[1])
            del content[size:]
            content.extend(bytes(size - len(content)))
        elif call == "sync":
            self.forced[words[0]] = self.seen[words[0]].copy()
        return True

    def lay_out(self, to, state, draw):
        """Writes what a cut leaves into the folder `to`."""
        def pick(which, inode):
            later = {"nothing later": False, "names without bytes": which == "names", "bytes without names": which == "bytes"}
            return (self.seen if later.get(state, draw.random() < 0.5) else self.forced)[inode]

        def write(inode, path):
            if isinstance(self.seen[inode], bytearray):
                path.write_bytes(pick("bytes", inode))
                return
            path.mkdir(exist_ok=True)
            if state == "some of both":
                names = dict(self.forced[inode])
                for name in sorted(set(self.seen[inode]) | set(names)):
                    if draw.random() < 0.5:
                        now = self.seen[inode].get(name)
                        names = {key: value for key, value in names.items() if key != name} | ({name: now} if now else {})
            else:
                names = pick("names", inode)
            for name in sorted(names):
                write(names[name], path / name)

        write(self.top, to)


def sum_of(folder):
    """Of all names and bytes below a folder."""
    found = hashlib.sha256()
    for path in sorted(folder.rglob("*")):
        content = path.read_bytes() if path.is_file() else b""
        found.update(f"{path.relative_to(folder)}\0{len(content)}\0{path.is_dir()}\0".encode() + content)
    return found.hexdigest()


class Cuts:
    def __init__(self, given, work):
        self.words = [str(given.executable.resolve()), "run", given.tests / "tiny-drum.toml", *SMALL, "-o"]
        self.show, self.disk_folder, self.tried = given.show, work / "disk", {}
        recorded = work / "recorded"
        recorded.mkdir()
        record = work / "calls"
        code, said = self.started(recorded / "run", LD_PRELOAD=str(given.library.resolve()), FILE_CALLS_TO=str(record))
        require(code == 0, f"recorded: exit code {code}\n{said}")
        self.expected = results_of_run(recorded / "run")
        self.lines = record.read_text(encoding="utf-8").splitlines()
        self.disk = Disk(str(recorded.resolve()), str(recorded.stat().st_ino))

    def started(self, run, *words, **environment):
        result = subprocess.run([*self.words, run, *words], capture_output=True, text=True, check=False, timeout=PATIENCE, env=os.environ | environment)
        return result.returncode, result.stdout + result.stderr

    def go_on(self, moment, line, state):
        """Resumes what a cut left, once for each state that differs from all before."""
        shutil.rmtree(self.disk_folder, ignore_errors=True)
        self.disk.lay_out(self.disk_folder, state, random.Random(moment))
        if state == "nothing later" and any("checkpoint.h5" in names for names in self.disk.forced.values() if isinstance(names, dict)):
            require((self.disk_folder / "run" / "checkpoint.h5").exists(), f"after call {moment}: a checkpoint was forced to the disk, and a cut loses it")
        what = f"after call {moment} of {len(self.lines)}, {' '.join(line.split(' ')[:3])[:120]}: {state}"
        left = sum_of(self.disk_folder)
        if left in self.tried:
            return
        run = self.disk_folder / "run"
        code, said = self.started(run, "--resume")
        self.tried[left] = code
        if self.show:
            print(f"{what}: {code} {said.splitlines()[-1:] if code else ''}", flush=True)
        require(code == 0, f"{what}: exit code {code}\n{said}")
        require(results_of_run(run) == self.expected, f"{what}: the resumed run left other bytes than the whole one")
        require_whole_files(run)

    def try_all(self, wanted):
        changes = 0
        every = max(1, len(self.lines) // wanted) if wanted else 1
        for moment, line in enumerate(self.lines, 1):
            if self.disk.apply(line):
                changes += 1
                if changes % every == 0 or moment == len(self.lines):
                    for state in STATES:
                        self.go_on(moment, line, state)
        require(changes > 50, f"only {changes} changes were recorded")
        print(f"{changes} calls that change the disk; {len(self.tried)} different states after a cut, each gone on with to the same bytes")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("executable", type=pathlib.Path)
    parser.add_argument("library", type=pathlib.Path)
    parser.add_argument("tests", type=pathlib.Path)
    parser.add_argument("--cuts", type=int, default=0)
    parser.add_argument("--show", action="store_true")
    given = parser.parse_args()
    if has_address_sanitizer(given.executable):
        print("the address sanitizer keeps these calls to itself: nothing tried")
        return
    with tempfile.TemporaryDirectory(prefix="drumlin-power-cuts-") as name:
        Cuts(given, pathlib.Path(name)).try_all(given.cuts)


if __name__ == "__main__":
    main()
