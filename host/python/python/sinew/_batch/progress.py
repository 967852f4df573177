"""How many recordings are done, on standard error."""

from __future__ import annotations

import sys
import time


class Progress:
    """A line that is written anew.

    Parameters
    ----------
    wanted : bool, optional
        By default where standard error is a terminal.
    """

    def __init__(self, wanted: bool | None) -> None:
        self.is_shown = sys.stderr.isatty() if wanted is None else wanted
        self._begun_s = time.monotonic()

    def show(self, done: int, of: int, left_s: float | None = None) -> None:
        """Write it; the remaining time is by default that of what was done so far."""
        if not self.is_shown or not done:
            return
        if left_s is None:
            left_s = (time.monotonic() - self._begun_s) / done * (of - done)
        print(f"\r{done} of {of}, {left_s:.0f} s left   ", end="", file=sys.stderr, flush=True)

    def end(self) -> None:
        """Take the line away."""
        if self.is_shown:
            print("\r" + " " * 50 + "\r", end="", file=sys.stderr, flush=True)
