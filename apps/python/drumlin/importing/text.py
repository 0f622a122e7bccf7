"""A text file of another program, line by line or many rows of numbers at once. Dumps are too large to be held whole."""

import gzip
import re
import warnings
import zlib

import numpy as np

from ..errors import InputError

PIECE, LONGEST_LINE = 1 << 18, 1 << 20  # bytes
BLANKS = " \t\r"
GZIP = b"\x1f\x8b"
FIELD = re.compile(r'(?:"((?:[^"]|"")*)"[ \t\r]*|([^,]*)),')  # of a line with a comma behind it
NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?", re.ASCII)


class CutOff(InputError):
    """A file that ends where there must be more, as a killed program leaves it."""


def refusal(file, line, key, what, allowed="", kind=InputError):
    """As the commands name what is wrong: file, line, key, what, what would be allowed."""
    place = f"{file}:{line}" if line else file
    return kind(f"{place}: {key + ': ' if key else ''}{what}{f' (allowed: {allowed})' if allowed else ''}")


def shown(value):
    """The shortest digits of a number."""
    return repr(float(value)).removesuffix(".0")


class Columns:
    """How a row becomes numbers: `names` of all its fields, of which those at the places `used` are read; fields between commas, or between blanks and
    commas (`spaced`: more fields may follow), or between blanks alone."""

    def __init__(self, names, used, between, comments):
        self.names, self.used, self.between, self.comments = names, used, between, comments
        self.kind = [(str(k), "f8" if k in used else "U1") for k in range(len(names))]

    def fields(self, line):
        if self.between == ",":
            return [quoted or plain.strip(BLANKS) for quoted, plain in FIELD.findall(line + ",")]
        return (line.replace(",", " ") if self.between == "spaced" else line).split()

    def is_row(self, line):
        line = line.strip(BLANKS)
        return line and not (self.comments and line.startswith("#"))

    def numbers(self, lines):
        """Numbers of rows, shape (rows, used). ValueError where one is none, or not one row of them in each line."""
        spaced = self.between == "spaced"
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of lines that are all blank
            table = np.loadtxt((line.replace(",", " ") for line in lines) if spaced else lines, self.kind, comments=None, ndmin=1,
                               delimiter="," if self.between == "," else None, quotechar='"' if self.between == "," else None,
                               usecols=range(len(self.kind)) if spaced else None)
        found = np.column_stack([table[str(k)] for k in self.used]) if self.used else np.empty((len(table), 0))
        if len(found) != len(lines) or not np.isfinite(found).all():
            raise ValueError
        return found


class TextFile:
    """The lines of a file of any size, numbered from 1, of text or of text in gzip; `number` is that of the line read last. Refused: a missing file, zstd, UTF-16."""

    def __init__(self, path):
        self.path, self.number = path, 0
        self._lines, self._next, self._rest, self._ended, self._unended = [], 0, b"", False, False
        try:
            self._stream = open(path, "rb", buffering=0)
        except FileNotFoundError as error:
            raise refusal(path, 0, "", "no such file") from error
        start = self._stream.read(4)
        if start[:2] == GZIP:
            self._stream.close()
            self._stream = gzip.open(path, "rb")
            start = self._piece(4)
        if start == b"\x28\xb5\x2f\xfd":
            raise refusal(path, 0, "", "is compressed (zstd)", "text or gzip: unzstd it first")
        if start[:2] in (b"\xff\xfe", b"\xfe\xff") or start == b"\0\0\xfe\xff":
            raise refusal(path, 0, "", "is text in UTF-16 or UTF-32", "UTF-8")
        self._rest = start.removeprefix(b"\xef\xbb\xbf")

    def _piece(self, size):
        try:
            return self._stream.read(size)
        except (EOFError, zlib.error, gzip.BadGzipFile) as error:
            kind = CutOff if isinstance(error, EOFError) else InputError
            raise refusal(self.path, self.number + len(self._lines) - self._next, "", "the compressed file is cut off or damaged", "a whole file",
                          kind) from error

    @property
    def unended(self):
        """Whether the last line read lacks its end."""
        return self._unended and self._next == len(self._lines)

    def refuse(self, key, what, allowed="", kind=InputError):
        raise refusal(self.path, self.number, key, what, allowed, kind)

    def _fill(self):
        if self._ended:
            return
        whole, end = b"", b""
        while not end:
            if len(self._rest) > LONGEST_LINE:
                self.number += 1
                self.refuse("", "is longer than 1 MiB", "lines of text")
            piece = self._piece(PIECE)
            if not piece:
                self._ended, whole, end, self._rest, self._unended = True, self._rest, self._rest, b"", bool(self._rest)
                break
            whole, end, self._rest = (self._rest + piece).rpartition(b"\n")
        self._lines, self._next = whole.decode("utf-8", "replace").split("\n") if end else [], 0

    def take(self, most):
        """Up to `most` of the next lines; none at the end."""
        if self._next == len(self._lines):
            self._fill()
        lines = self._lines[self._next:self._next + most]
        self._next, self.number = self._next + len(lines), self.number + len(lines)
        return lines

    def next_line(self, comments=False):
        """The next line that is not blank, nor a comment with `comments`, without blanks at its ends; None at the end."""
        while lines := self.take(1):
            line = lines[0].strip(BLANKS)
            if line and not (comments and line.startswith("#")):
                return line
        return None

    def line_below(self, item):
        line = self.next_line()
        if line is None:
            self.refuse(item, "ends within a frame", kind=CutOff)
        return line

    def whole_number_below(self, item):
        line = self.line_below(item)
        value = self.number_from(line, item)
        if not 0 <= value <= 1e15:
            self.refuse(item, "is out of range", "0 to 1e15")
        if value != int(value):
            self.refuse(item, f"is {line}", "a whole number")
        return value

    def number_from(self, text, key):
        text = text.strip(BLANKS)
        value = float(text) if NUMBER.fullmatch(text) else np.inf
        if not np.isfinite(value):
            self.refuse(key, f'"{text}" is no number', "a finite number")
        return value

    def rows(self, columns, most=PIECE):
        """(number of the line of each row, numbers (rows, used)) of up to `most` of the next rows; None at the end. What is no row is refused when it is
        the next one."""
        while lines := self.take(most):
            at = np.arange(self.number - len(lines) + 1, self.number + 1)
            try:
                return at, columns.numbers(lines)
            except ValueError:
                of_rows = [k for k, line in enumerate(lines) if columns.is_row(line)]
            if not of_rows:
                continue
            at, rows = at[of_rows], [lines[k] for k in of_rows]
            try:
                return at, columns.numbers(rows)
            except ValueError:
                good = np.array(self._good_rows(columns, at.tolist(), rows))
                return at[:len(good)], good
        return None

    def _good_rows(self, columns, at, rows):
        """The rows before the first that is none: the file goes on with that one."""
        good, end = [], self.number
        try:
            for self.number, row in zip(at, rows):
                fields = columns.fields(row)
                if len(fields) < len(columns.names) or (len(fields) > len(columns.names) and columns.between != "spaced"):
                    self.refuse("", f"holds {len(fields)} fields", f"{len(columns.names)}, as many as there are names")
                good.append([self.number_from(fields[k], columns.names[k]) for k in columns.used])
            self.number = end
        except InputError:
            if not good:
                raise
            self.number -= 1
        finally:
            self._next -= end - self.number
        return good

    @staticmethod
    def joined(parts, columns):
        """(number of the line of each row, the numbers of each used column) of what rows() gave."""
        if not parts:
            return np.zeros(0, int), [np.zeros(0) for _ in columns.used]
        return np.concatenate([at for at, _ in parts]), [np.concatenate([numbers[:, k] for _, numbers in parts]) for k in range(len(columns.used))]

    def lines_before(self, mark):
        """How many of the next lines come before one that begins with `mark`, or before the end of what was read; 0 at either."""
        if self._next == len(self._lines):
            self._fill()
        return next((k for k, line in enumerate(self._lines[self._next:]) if line.startswith(mark)), len(self._lines) - self._next)

    def so_many_rows(self, columns, most, refuse_end):
        """As joined(), of the next `most` rows; refuse_end(how many are missing, most) where the file has fewer."""
        parts, left = [], most
        while left:
            part = self.rows(columns, left)
            if part is None:
                refuse_end(left, most)
            parts.append(part)
            left -= len(part[0])
        return self.joined(parts, columns)
