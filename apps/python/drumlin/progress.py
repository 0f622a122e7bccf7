"""How far a long call has come, on standard error: a bar of tqdm where it is installed, else one line."""

import sys
import time


class Progress:
    """Shown where `shown` is True, or None and standard error is a terminal. At its end it says where the results are."""

    def __init__(self, what, total=None, shown=None, results=None):
        self._what, self._total, self._results, self._start, self._last, self._bar = what, total, results, time.monotonic(), 0.0, None
        self.shown = sys.stderr is not None and sys.stderr.isatty() if shown is None else shown
        if self.shown:
            try:
                from tqdm import tqdm  # pylint: disable=import-outside-toplevel  # where it is installed

                self._bar = tqdm(total=total, desc=what,
                                 bar_format="{desc}: {percentage:3.0f}%|{bar}| {elapsed}<{remaining}" if total else "{desc}: {elapsed}")
            except ModuleNotFoundError:
                pass

    def __enter__(self):
        return self

    def __exit__(self, kind, *_):
        if not self.shown:
            return
        self.to(self._total if kind is None else None, last=True)
        if self._bar is not None:
            self._bar.close()
        if self._results is not None and (kind is None or issubclass(kind, KeyboardInterrupt)):
            print("results:" if kind is None else "interrupted; what is there:", self._results, file=sys.stderr)

    def to(self, done=None, last=False):
        """So much of the total is done; None: as much as before."""
        now = time.monotonic()
        if not self.shown or not (last or now - self._last > 0.2):
            return
        self._last = now
        if self._bar is not None:
            self._bar.n = self._bar.n if done is None else done
            self._bar.refresh()
            return
        share = f" {100 * done / self._total:.0f} %" if done is not None and self._total else ""
        print(f"\r{self._what}:{share} {now - self._start:.0f} s ", end="\n" if last else "", file=sys.stderr, flush=True)
