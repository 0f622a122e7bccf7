"""Files that appear whole or not at all, as replace_file() of the commands writes them: under a name that cannot be guessed,
forced to the disk and renamed. Symbolic links are replaced, never followed."""

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


def name_aside():
    """As the commands know it: what a kill leaves under such a name, the next call removes."""
    return f".drumlin-{secrets.token_hex(16)}.part"


@contextlib.contextmanager
def aside(path):
    """Gives a binary stream. When all is written, its file takes the place of `path`; an error leaves neither a part nor a change.
    CannotWrite where the system does not take it; errors of files that are read meanwhile stay what they are."""
    path = pathlib.Path(path)
    if path.exists() and not (path.is_file() or path.is_dir()):
        raise CannotWrite(path, OSError(errno.EINVAL, "is a device, a FIFO or a socket, not a file"))
    try:
        with _aside(path) as stream:
            yield stream
    except FileExistsError:  # somebody guessed the name aside, which is no fault of the disk
        raise
    except OSError as error:
        # Those of a stream name no file, those of our own calls the name aside or the folder.
        if error.filename is None or str(error.filename) in (str(path), str(path.parent)) or ".drumlin-" in str(error.filename):
            raise CannotWrite(path, error) from error
        raise


@contextlib.contextmanager
def _aside(path):
    folder, unfinished = os.open(path.parent, os.O_RDONLY | os.O_DIRECTORY), name_aside()

    def opener(*_):
        return os.open(unfinished, os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_NOFOLLOW | os.O_CLOEXEC, 0o666, dir_fd=folder)

    try:
        stream = open(path, "wb", opener=opener)  # its name, and with it the kind of picture, is that of `path`
        try:
            with stream:
                yield stream
                stream.flush()
                os.fsync(stream.fileno())
            os.replace(unfinished, path.name, src_dir_fd=folder, dst_dir_fd=folder)
            os.fsync(folder)
        finally:
            with contextlib.suppress(FileNotFoundError):
                os.unlink(unfinished, dir_fd=folder)
    finally:
        os.close(folder)


def write_text(path, text):
    with aside(path) as stream:
        stream.write(text.encode("utf-8"))
