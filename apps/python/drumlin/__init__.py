"""Drumlin in Python: read its files into numpy, step scenes, solve contact problems, calibrate laws, start its commands, set many runs side by side.

>>> import drumlin
>>> run = drumlin.run("drum-smoke", "RUN")
>>> drumlin.show(run)
"""

import importlib

# The compiled part is loaded by what needs it; __init__.pyi says the same to editors and type checkers.
_HOMES = {"_drumlin": ["version"], "commands": ["command", "compare", "infer", "make_pair", "measure", "program", "run", "score", "solve_flow"],
          "contacts": ["ContactSolution", "contact_residual", "contact_solvers", "solve_contacts"],
          "errors": ["DrumlinError", "InputError", "Interrupted", "IoError", "Killed", "NotConvergedError"],
          "sweeping.executors": ["Outcome", "run_all"], "files": ["Arrays", "Folder", "read", "value_of"],
          "laws": ["CalibratedLaw", "Law", "calibrate"], "library.table": ["LibraryLaw", "law"], "scenes": ["Simulation", "resolved", "toml_of"],
          "sweeping.sweep": ["SweptRun", "sweep"], "plot": ["Picture", "show"], "study": []}
__all__ = sorted(["errors", "plot", "study"] + [name for names in _HOMES.values() for name in names])


def _module(home):
    try:
        return importlib.import_module(f"{__name__}.{home}")
    except ModuleNotFoundError as missing:
        if missing.name != f"{__name__}._drumlin":
            raise
        raise ModuleNotFoundError("drumlin: its compiled part is missing; `cmake --build build --target programs` makes it", name=missing.name) from missing


def __getattr__(name):
    if name == "__version__":
        return __getattr__("version")().split()[0]
    for home, names in _HOMES.items():
        if name == home or name in names:
            module = _module(home)
            return module if name == home else getattr(module, name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__():
    return __all__
