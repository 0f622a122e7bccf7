"""The kinds of failure, with the texts of the commands."""


class DrumlinError(Exception):
    """What Drumlin refuses or fails at. Each kind has the `exit_code` of the commands.

    >>> try:
    ...     drumlin.run("scene.toml", "RUN")
    ... except drumlin.InputError as error:
    ...     print(error.problems)
    """


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


class Interrupted(DrumlinError):
    """A job ended because the call of run_all that it belongs to was interrupted; the same call goes on."""

    exit_code = 130


class Killed(DrumlinError):
    """A command was ended from outside, by a signal; a run goes on from its last checkpoint."""

    exit_code = 137
