"""The kinds of failure, with the texts of the commands."""


class DrumlinError(Exception):
    """What Drumlin refuses or fails at."""


class InputError(DrumlinError, ValueError):
    """Wrong input: `problems` lists its faults, each with file, line, key, what is wrong and what would be allowed. Exit code 2 of the commands."""

    problems = ()


class NotConvergedError(DrumlinError, RuntimeError):
    """A method did not converge, or no steady solution exists. Exit code 3 of the commands."""

    problems = ()


class IoError(DrumlinError, OSError):
    """A file could not be read or written. Exit code 74 of the commands."""

    problems = ()
