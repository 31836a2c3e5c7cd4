"""A progress bar on the standard error."""
from __future__ import annotations

import sys
import time
from typing import Optional

WIDTH = 30  # characters of the bar
SECONDS = 0.2  # between two pictures


class Progress:
    """unit: what is counted. total, done: how many there are, and how many an earlier run has done. shown: None shows
    the bar only on a terminal."""

    def __init__(self, unit: str, total: int, done: int, shown: Optional[bool] = None):
        self._unit = unit
        self._total = total
        self._done = self._done_before = done
        self._shown = sys.stderr.isatty() if shown is None else shown
        self._begin = time.monotonic()
        self._end: Optional[float] = None
        self._last = 0.0

    def begin(self) -> None:
        """The workers are there: the time counts from now on."""
        self._begin = time.monotonic()

    @property
    def rate(self) -> float:
        """Per second, from `begin` to `close`."""
        end = time.monotonic() if self._end is None else self._end
        return (self._done - self._done_before) / max(end - self._begin, 1e-9)

    def add(self, count: int, workers: int) -> None:
        self._done += count
        now = time.monotonic()
        if self._shown and (now - self._last > SECONDS or self._done == self._total):
            self._last = now
            self._write(self._line(workers))

    def line(self, text: str) -> None:
        """Writes a line above the bar."""
        if self._shown:
            self._write("")
        print(text, file=sys.stderr, flush=True)

    def close(self) -> None:
        self._end = time.monotonic()
        if self._shown:
            print(file=sys.stderr)

    def _line(self, workers: int) -> str:
        share = self._done / self._total if self._total else 1.0
        bar = ("#" * int(WIDTH * share)).ljust(WIDTH)
        left = (self._total - self._done) / self.rate if self.rate else 0.0
        return (f"[{bar}] {100 * share:3.0f} %, {self.rate:,.0f} {self._unit}/s, {duration(left)} left, {workers} "
                f"worker{'' if workers == 1 else 's'}")

    @staticmethod
    def _write(line: str) -> None:
        print("\r\x1b[K" + line, end="", file=sys.stderr, flush=True)


def duration(seconds: float) -> str:
    """1:02:03, or 2:03 below an hour."""
    minutes, second = divmod(int(seconds + 0.5), 60)
    hours, minute = divmod(minutes, 60)
    return f"{hours}:{minute:02}:{second:02}" if hours else f"{minute}:{second:02}"
