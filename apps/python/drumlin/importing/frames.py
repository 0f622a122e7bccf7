"""The formats: what a file of each looks like, and what reads its grains and its contacts. Each reader takes (files, the table of the description) and gives
frames (frame.py), in order of time; `unused` and `cut_off` are then known."""

import dataclasses
import functools
import gzip
import re
import typing
import zlib

import h5py

from . import gsd_files, h5md_files, lammps, mercury, tables, vtk_files, vtkhdf_files, xyz_files, yade
from .text import GZIP, refusal

SOURCES = ("csv", "lammps", "files")  # tables of a description; the last one holds files of any format
HEAD = 4096  # bytes that tell a format
HDF5 = rb"\A\x89HDF\r\n"
NUMBER = rb"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"


def _numbers(*counts):
    return "|".join(rf"\A\s*{NUMBER.decode()}(?:[ \t]+{NUMBER.decode()}){{{count - 1}}}[ \t\r]*(?:\n|\Z)" for count in counts).encode()


@dataclasses.dataclass
class Format:
    """A row of docs/formats/import.md."""

    name: str
    begins: bytes  # pattern of the first bytes of its files
    grains: typing.Callable
    contacts: typing.Callable = None
    group: str = ""  # at the root of its files of HDF5


FORMATS = (
    Format("lammps", rb"\A\s*ITEM: ", lammps.Grains, lammps.Contacts),
    Format("mercury", _numbers(6, 8), mercury.Data),
    Format("mercury-fstat", rb"\A# *" + NUMBER + rb" +" + NUMBER + rb"[ \r]*\n# ", None, mercury.Contacts),
    Format("yade", rb"\A#format ", yade.Text),
    Format("gsd", rb"\A\xdf\x65\xdf\x65\xdf\x65\xdf\x65", gsd_files.Grains, gsd_files.Contacts),
    Format("vtkhdf", HDF5, vtkhdf_files.Grains, vtkhdf_files.Contacts, "VTKHDF"),
    Format("h5md", HDF5, h5md_files.Grains, group="h5md"),
    Format("xyz", rb"\A\s*\d+[ \t\r]*\n[^\n]*Properties=", xyz_files.Grains),
    Format("vtk", rb"\A(?:# vtk DataFile|\s*<\?xml|\s*<VTKFile)", vtk_files.Grains, vtk_files.Contacts),
    Format("csv", rb"\A(?:\s*#[^\n]*\n|\s*\n)*[ \t\"]*[A-Za-z_][^\n]*,", functools.partial(tables.Tables, known=tables.GRAINS),
           functools.partial(tables.Tables, known=tables.CONTACTS)),
)


def _head(path):
    try:
        with open(path, "rb") as stream:
            head = stream.read(HEAD)
    except FileNotFoundError as error:
        raise refusal(path, 0, "", "no such file") from error
    if head[:2] == GZIP:
        try:
            with gzip.open(path, "rb") as stream:
                head = stream.read(HEAD)
        except (EOFError, OSError, zlib.error) as error:
            raise refusal(path, 0, "", "the compressed file is cut off or damaged", "a whole file") from error
    return head


def _has_group(path, group):
    """Also where the file is damaged, which its reader says."""
    try:
        with h5py.File(path, "r") as file:
            return group in file
    except OSError:
        return True


def format_of(path, expected=None):
    """By the first bytes of a file, and of HDF5 by the groups in it; `expected`: of one that is damaged."""
    head = _head(path)
    for one in (*filter(None, [expected]), *FORMATS):
        if re.search(one.begins, head) and (not one.group or _has_group(path, one.group)):
            return one
    raise refusal(path, 0, "", "is of no format that is known by its first bytes", ", ".join(one.name for one in FORMATS))


def format_of_files(kind, files, of):
    """That of the files of a table of the description, all of which have the same; `of`: whether grains or contacts are read from them."""
    first = next(one for one in FORMATS if one.name == kind) if kind != SOURCES[-1] else format_of(files[0])
    for file in files if kind == SOURCES[-1] else ():
        one = format_of(file, first)
        if one is not first:
            raise refusal(file, 0, "", f"is of the format {one.name}, {files[0]} of {first.name}", "files of one format")
    if not getattr(first, of):
        raise refusal(files[0], 0, of, f"there are none in files of the format {first.name}", ", ".join(one.name for one in FORMATS if getattr(one, of)))
    return first
