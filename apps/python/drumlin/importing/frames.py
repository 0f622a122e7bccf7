"""The formats: what a file of each looks like, and what reads its grains and its contacts. Each reader takes (files, the table of the description) and gives
frames (frame.py), in order of time; `unused` and `cut_off` are then known."""

import dataclasses
import functools
import gzip
import re
import typing
import zlib

from . import gsd_files, lammps, mercury, tables, vtk_files, vtkhdf_files, yade
from .text import GZIP, refusal

SOURCES = ("csv", "lammps", "files")  # tables of a description; the last one holds files of any format
HEAD = 4096  # bytes that tell a format
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


FORMATS = (
    Format("lammps", rb"\A\s*ITEM: ", lammps.Grains, lammps.Contacts),
    Format("mercury", _numbers(6, 8), mercury.Data),
    Format("mercury-fstat", rb"\A# *" + NUMBER + rb" +" + NUMBER + rb"[ \r]*\n# ", None, mercury.Contacts),
    Format("yade", rb"\A#format ", yade.Text),
    Format("gsd", rb"\A\xdf\x65\xdf\x65\xdf\x65\xdf\x65", gsd_files.Grains, gsd_files.Contacts),
    Format("vtkhdf", rb"\A\x89HDF\r\n", vtkhdf_files.Grains, vtkhdf_files.Contacts),
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


def format_of(path):
    """By the first bytes of a file."""
    head = _head(path)
    for one in FORMATS:
        if re.search(one.begins, head):
            return one
    raise refusal(path, 0, "", "is of no format that is known by its first bytes", ", ".join(one.name for one in FORMATS))


def reader_of(kind, files):
    """The format of the files of a table of the description, all of which have the same."""
    if kind != SOURCES[-1]:
        return next(one for one in FORMATS if one.name == kind)
    found = [format_of(file) for file in files]
    for file, one in zip(files, found):
        if one is not found[0]:
            raise refusal(file, 0, "", f"is of the format {one.name}, {files[0]} of {found[0].name}", "files of one format")
    return found[0]
