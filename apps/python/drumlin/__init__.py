"""Drumlin in Python: read its files into numpy, step scenes, solve contact problems, calibrate laws, start its commands."""

try:
    from ._drumlin import version
except ModuleNotFoundError as missing:
    if missing.name != f"{__name__}._drumlin":
        raise
    raise ModuleNotFoundError("drumlin: its compiled part is missing; `cmake --build build --target programs` makes it", name=missing.name) from missing
from . import errors, plot
from .commands import command, compare, measure, program, run, solve_flow, sweep
from .contacts import ContactSolution, contact_residual, contact_solvers, solve_contacts
from .errors import DrumlinError, InputError, IoError, NotConvergedError
from .files import Arrays, Folder, read, value_of
from .laws import CalibratedLaw, Law, calibrate
from .scenes import Simulation, resolved, toml_of

__version__ = version().split()[0]
__all__ = ["Arrays", "CalibratedLaw", "ContactSolution", "DrumlinError", "Folder", "InputError", "IoError", "Law", "NotConvergedError", "Simulation",
           "calibrate", "command", "compare", "contact_residual", "contact_solvers", "errors", "measure", "plot", "program", "read", "resolved", "run",
           "solve_contacts", "solve_flow", "sweep", "toml_of", "value_of", "version"]
