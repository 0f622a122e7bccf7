"""Files that appear whole or not at all: made in memory or aside, and renamed."""

import contextlib
import os
import pathlib


@contextlib.contextmanager
def aside(path):
    """Gives a path to write to, with the suffix of `path`, whose place it takes when all is written; an error leaves neither a part nor a change."""
    path = pathlib.Path(path)
    unfinished = path.with_name(f".{path.stem}-{os.getpid()}.part{path.suffix}")
    try:
        yield unfinished
        os.replace(unfinished, path)
    finally:
        unfinished.unlink(missing_ok=True)
