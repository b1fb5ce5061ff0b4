"""How far long work is."""

from __future__ import annotations

import sys
import time
from contextlib import contextmanager
from typing import Callable, Iterator, Optional, TextIO, Union

__all__ = ["Progress", "following"]

#: What callers may pass: whether to show progress (``None``: where somebody watches), or who is told.
Progress = Union[bool, Callable[[int, int], object], None]

#: Work that is done sooner needs no bar.
_PATIENCE = 1.5


@contextmanager
def following(progress: Progress, what: str) -> Iterator[Optional[Callable[[int, int], object]]]:
    """What is to be called with what is done and the total, if anything."""
    if callable(progress):
        yield progress
    elif progress or (progress is None and _is_watched()):
        bar = _Bar(what, sys.stderr, 0.0 if progress else _PATIENCE)
        try:
            yield bar
        finally:
            bar.close()
    else:
        yield None


def _is_watched() -> bool:
    return sys.stderr is not None and (sys.stderr.isatty() or "ipykernel" in sys.modules)


class _Bar:
    """One line that is written over and over."""

    def __init__(self, what: str, stream: TextIO, patience: float) -> None:
        self._what = what
        self._stream = stream
        self._started = time.monotonic()
        self._shown_at = self._started + patience - 0.2
        self._width = 0

    def __call__(self, done: int, total: int) -> None:
        now = time.monotonic()
        if now - self._shown_at < 0.2 or total == 0:
            return
        self._shown_at = now
        part = done / total
        gone = now - self._started
        left = f", {_duration(gone * (1 - part) / part)} left" if part > 0.01 else ""
        bar = "#" * int(24 * part)
        self._write(f"{self._what} [{bar:24}] {100 * part:3.0f} %, {_duration(gone)} gone{left}")

    def _write(self, line: str) -> None:
        self._stream.write("\r" + line.ljust(self._width))
        self._stream.flush()
        self._width = len(line)

    def close(self) -> None:
        """Takes the line away."""
        if self._width:
            self._write("")
            self._stream.write("\r")
            self._stream.flush()


def _duration(seconds: float) -> str:
    whole = round(seconds)
    return f"{seconds:.1f} s" if seconds < 10 else f"{whole} s" if whole < 100 else f"{whole // 60} min {whole % 60:02} s"
