"""What a command has read: files that it must not write over, whatever it is told.

Every reader says :func:`note_read` of the file it opens, and run files say it of the files they name. The notes last as long as a command;
in a Python session nothing is noted, since there a file may well be read now and written later.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from contextvars import ContextVar
from pathlib import Path

_SEEN: ContextVar[set[str] | None] = ContextVar("files read by this command", default=None)


@contextmanager
def noting_reads() -> Iterator[None]:
    """Note what is read until the block ends; blocks within do not see what those around them read."""
    token = _SEEN.set(set())
    try:
        yield
    finally:
        _SEEN.reset(token)


@contextmanager
def collecting_reads() -> Iterator[set[str]]:
    """Collect the real paths of what is read until the block ends; a block around it sees them too."""
    outer, own = _SEEN.get(), set[str]()
    token = _SEEN.set(own)
    try:
        yield own
    finally:
        _SEEN.reset(token)
        if outer is not None:
            outer |= own


def note_read(path: str | Path) -> None:
    """Note that a file is read, or named as an input; it need not exist."""
    seen = _SEEN.get()
    if seen is not None:
        with suppress(ValueError):  # a name with a zero byte is no file's
            seen.add(os.path.realpath(path))


def was_read(path: str | Path) -> bool:
    """Whether a file is one that was noted: by its place, through symbolic links, or as another hard link of the same file."""
    seen = _SEEN.get()
    if not seen:
        return False
    return os.path.realpath(path) in seen or any(_same(path, other) for other in seen)


def _same(path: str | Path, other: str) -> bool:
    try:
        return os.path.samefile(path, other)
    except OSError:
        return False
