"""Runs a script as `python3 -I` does, with the script's own folder, that of the figures and the package that they lie in, and nothing else, added to
what it may import from.
SIGINT, SIGTERM and SIGHUP stop it once, as Ctrl-C does, so that it leaves no part of a file.
A file that the system does not give or take ends it with one line, "FILE: why", and exit code 74; missing memory or a missing module likewise; an error
that has an exit code (drumlin.errors, result_files.DoesNotFit) with its text and that.

usage: python3 -I -B isolated.py SCRIPT [WORD...]
"""

import os
import pathlib
import runpy
import signal
import sys

STOPPING = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
NO_FILE, INTERRUPTED = 74, 130  # exit codes of the commands


def stop(*_):
    for number in STOPPING:
        signal.signal(number, signal.SIG_IGN)
    raise KeyboardInterrupt


def load_matplotlib(folder):
    """Matplotlib reads a matplotlibrc of the folder it is loaded in, else the one that this variable names, else one of the user: it finds none."""
    os.environ["MATPLOTLIBRC"] = os.devnull
    here = os.open(".", os.O_RDONLY)
    os.chdir(folder)
    import matplotlib  # pylint: disable=import-outside-toplevel,unused-import
    os.fchdir(here)
    os.close(here)


if __name__ == "__main__":
    for each in STOPPING:
        if signal.getsignal(each) != signal.SIG_IGN:  # nohup
            signal.signal(each, stop)
    os.environ.setdefault("MPLBACKEND", "Agg")  # pictures are files: no display is asked for
    script, figures = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(__file__).resolve().parent
    sys.path[:0] = [str(script.parent), str(figures)]
    # Before packages of the system, which may be another version of it; of a build tree it consists of links.
    packages = next((k for k, path in enumerate(sys.path) if path.endswith("-packages")), len(sys.path))
    sys.path.insert(packages, str(pathlib.Path(__file__).absolute().parents[2]))
    sys.argv = sys.argv[1:]
    sys.stderr.reconfigure(encoding="utf-8", errors="surrogateescape")  # names of files are bytes
    try:
        if script.parent == figures:  # pages draw nothing
            load_matplotlib(script.parent)
        runpy.run_path(str(script), run_name="__main__")
    except MemoryError:
        print("not enough memory", file=sys.stderr)
        sys.exit(NO_FILE)
    except ImportError as error:
        print(f"Python could not load a module: {error}", file=sys.stderr)
        sys.exit(NO_FILE)
    except KeyboardInterrupt:
        sys.exit(INTERRUPTED)
    except (ValueError, OSError, RuntimeError) as error:
        if hasattr(error, "exit_code"):
            print(error, file=sys.stderr)
            sys.exit(error.exit_code)
        if getattr(error, "filename", None) is None or error.strerror is None:
            raise
        print(f"{error.filename}: {error.strerror}", file=sys.stderr)
        sys.exit(NO_FILE)
