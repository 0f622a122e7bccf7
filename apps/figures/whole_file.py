"""Files that appear whole or not at all, as replace_file() of the commands writes them: under another name, forced to the disk and renamed. Symbolic links
are replaced, never followed."""

import contextlib
import errno
import os
import pathlib
import secrets


class CannotWrite(OSError):
    """What the system refuses when a file is written: its text is one line that names the file."""

    def __init__(self, path, error):
        super().__init__(error.errno, f"cannot be written: {error.strerror or error}", str(path))

    def __str__(self):
        return f"{self.filename}: {self.strerror}"


@contextlib.contextmanager
def aside(path):
    """Gives a binary stream. When all is written, its file takes the place of `path`; an error leaves neither a part nor a change.
    CannotWrite where the system does not take it; errors of files that are read meanwhile stay what they are."""
    path = pathlib.Path(path)
    unfinished = path.with_name(f".drumlin-{os.getpid()}-{secrets.token_hex(8)}.part")
    try:
        if path.exists() and not (path.is_file() or path.is_dir()):
            raise OSError(errno.EINVAL, "is a device, a FIFO or a socket, not a file")
        # Its name, and with it the kind of picture, is that of `path`.
        with open(path, "xb", opener=lambda _, flags: os.open(unfinished, flags, 0o666)) as stream:
            yield stream
            stream.flush()
            os.fsync(stream.fileno())
        unfinished.replace(path)
        folder = os.open(path.parent, os.O_RDONLY | os.O_DIRECTORY)
        os.fsync(folder)
        os.close(folder)
    except OSError as error:
        # Those of a stream name no file, those of our own calls one of these.
        if error.filename is None or str(error.filename) in (str(path), str(path.parent), str(unfinished)):
            raise CannotWrite(path, error) from error
        raise
    finally:
        with contextlib.suppress(OSError):
            unfinished.unlink()


def write_text(path, text):
    with aside(path) as stream:
        stream.write(text.encode("utf-8"))
