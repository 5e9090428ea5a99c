"""Errors meant for users: one line that says where, what is wrong and what would be right."""

from __future__ import annotations

import difflib
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class Position:
    """A place in a file; `line` and `column` count from 1."""

    file: Path | str
    line: int
    column: int

    def __str__(self) -> str:
        return f"{self.file}:{self.line}:{self.column}"


class InputError(Exception):
    """What the user gave cannot be used.

    The command line prints it as one line and exits with code 2; from Python it is raised as it is.

    Parameters
    ----------
    message
        What is wrong and what would be right, in one sentence or two.
    position
        Where in a file, when it came from one.

    """

    def __init__(self, message: str, position: Position | None = None) -> None:
        self.message = message
        self.position = position
        super().__init__(f"{position}: {message}" if position else message)


class ModelWarning(UserWarning):
    """The input can be used, but its answer deserves doubt."""


class CacheWarning(UserWarning):
    """The answer stands, but it takes longer than it need: compiled code cannot be kept or used."""


def did_you_mean(word: str, known: Iterable[str]) -> str:
    """Say which known names are nearest to `word`, or list what is allowed."""
    known = list(known)
    near = difflib.get_close_matches(word, known, n=3, cutoff=0.6)
    if near:
        return "did you mean " + " or ".join(repr(name) for name in near) + "?"
    if not known:
        return "none is declared"
    listed = ", ".join(sorted(known)[:20]) + (", ..." if len(known) > 20 else "")
    return f"known: {listed}"
