"""What `import drumlin` gives, for editors and type checkers."""

from .commands import command as command
from .commands import compare as compare
from .commands import infer as infer
from .commands import make_pair as make_pair
from .commands import measure as measure
from .commands import program as program
from .commands import run as run
from .commands import score as score
from .commands import solve_flow as solve_flow
from .contacts import ContactSolution as ContactSolution
from .contacts import contact_residual as contact_residual
from .contacts import contact_solvers as contact_solvers
from .contacts import solve_contacts as solve_contacts
from .errors import DrumlinError as DrumlinError
from .errors import InputError as InputError
from .errors import Interrupted as Interrupted
from .errors import IoError as IoError
from .errors import Killed as Killed
from .errors import NotConvergedError as NotConvergedError
from .files import Arrays as Arrays
from .files import Folder as Folder
from .files import read as read
from .files import value_of as value_of
from .laws import CalibratedLaw as CalibratedLaw
from .laws import Law as Law
from .laws import calibrate as calibrate
from .library.table import LibraryLaw as LibraryLaw
from .library.table import law as law
from .plot import Picture as Picture
from .plot import show as show
from .scenes import Simulation as Simulation
from .scenes import resolved as resolved
from .scenes import toml_of as toml_of
from .sweeping.executors import Outcome as Outcome
from .sweeping.executors import run_all as run_all
from .sweeping.sweep import SweptRun as SweptRun
from .sweeping.sweep import sweep as sweep
from . import errors as errors
from . import plot as plot
from . import study as study

__version__: str

def version() -> str: ...
