"""The kinds of failure, with the texts of the commands."""


class DrumlinError(Exception):
    """What Drumlin refuses or fails at. Each kind has the `exit_code` of the commands."""


class InputError(DrumlinError, ValueError):
    """Wrong input: `problems` lists its faults, each with file, line, key, what is wrong and what would be allowed."""

    exit_code = 2
    problems = ()


class NotConvergedError(DrumlinError, RuntimeError):
    """A method did not converge, or no steady solution exists."""

    exit_code = 3
    problems = ()


class IoError(DrumlinError, OSError):
    """A file could not be read or written."""

    exit_code = 74
    problems = ()
