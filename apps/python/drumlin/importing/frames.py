"""The formats: for each table of a description, what reads its grains and its contacts. Each takes (files, the table) and gives frames (frame.py), in order
of time; `unused` and `cut_off` are then known."""

import functools

from . import lammps, tables

READERS = {
    "csv": (functools.partial(tables.Tables, known=tables.GRAINS), functools.partial(tables.Tables, known=tables.CONTACTS)),
    "lammps": (lammps.Grains, lammps.Contacts),
}
