"""Runs the tests of the Python package that stands in this folder of a build tree.

usage: run.py FOLDER_OF_THE_PACKAGE SOURCES [WORD_FOR_PYTEST...]
"""

import os
import pathlib
import signal
import sys

import pytest

if __name__ == "__main__":
    os.environ["DRUMLIN_PACKAGE"], os.environ["DRUMLIN_SOURCES"] = sys.argv[1:3]
    signal.signal(signal.SIGINT, signal.default_int_handler)  # as in anybody's interpreter: tests send it
    sys.exit(pytest.main(["-q", "-p", "no:cacheprovider", *sys.argv[3:], str(pathlib.Path(__file__).parent)]))
