"""What went wrong, and where? The one error that users see: a line that says where, what is wrong, what would be right, and near names.

What it quotes of a file is a stranger's text: it is cut to a few words and escaped, so that it can neither fill nor command a terminal.
"""

from __future__ import annotations

import difflib
import re
import unicodedata
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

MAX_SHOWN = 60
"""So many characters of a stranger's text are quoted at most."""
MAX_MESSAGE = 2000
BIDIRECTIONAL = frozenset("\u061c\u200e\u200f\u202a\u202b\u202c\u202d\u202e\u2066\u2067\u2068\u2069")
"""Characters that change the direction of the text after them, and so can make a line read as something else."""


def escaped(text: str, keep: str = "") -> str:
    """Return a text with every character written as in a Python string that is no space, does not print as itself and is not in `keep`."""
    return "".join(
        character if character.isprintable() or character in keep or unicodedata.category(character) == "Zs" else ascii(character)[1:-1]
        for character in text
    )


def printable(text: str) -> str:
    """Return an escaped text in which line ends and tabs stand."""
    return escaped(text, keep="\n\t")


def shortened(text: str, limit: int = MAX_SHOWN) -> str:
    """Return an escaped text, cut where it is longer than `limit` characters."""
    plain = escaped(text[: limit + 1])
    return plain if len(text) <= limit and len(plain) <= limit else f"{plain[: limit - 3]}..."


def shown(text: object, limit: int = MAX_SHOWN) -> str:
    """Return what a file holds in quotes, escaped, cut where it is longer than `limit` characters."""
    quoted = repr(text[: limit + 1] if isinstance(text, str) else text)
    if len(quoted) <= limit + 2:
        return quoted
    return f"{quoted[: limit - 2]}...{quoted[-1]}"


def trail_text(names: Sequence[str]) -> str:
    """Return names that follow one another, joined by arrows; of a long trail the first and the last few."""
    cut = [*names[:4], "...", *names[-3:]] if len(names) > 8 else names
    return " -> ".join(shortened(name) for name in cut)


@dataclass(frozen=True)
class Position:
    """A place in a file, `line` and `column` counting from 1; of an argument in Python its path in place of the file, and 0."""

    file: Path | str
    line: int = 0
    column: int = 0

    @property
    def is_argument(self) -> bool:
        """Whether it is the path of an argument, such as `Vehicle.bodies.cab.mass`."""
        return self.line == 0

    def __str__(self) -> str:
        return str(self.file) if self.is_argument else f"{self.file}:{self.line}:{self.column}"


class InputError(Exception):
    """What the user gave cannot be used.

    The command line prints it as one line and exits with code 2; from Python it is raised as it is.

    Parameters
    ----------
    message
        What is wrong and what would be right, in one sentence or two.
    position
        Where in a file, or in which argument.
    """

    def __init__(self, message: str, position: Position | None = None) -> None:
        self.message = shortened(re.sub(r"\s*[\r\n]\s*", " ", message.strip()), MAX_MESSAGE)
        self.position = position
        super().__init__(f"{escaped(str(position))}: {self.message}" if position else self.message)


class ArgumentError(InputError):
    """An argument of a function cannot be used.

    Parameters
    ----------
    message
        What is wrong and what would be right. Arguments stand in it in backquotes.
    names
        Those arguments: the command line writes its options in their places.
    """

    def __init__(self, message: str, *names: str) -> None:
        self.names = names
        super().__init__(message)


class ModelWarning(UserWarning):
    """The input can be used, but its answer deserves doubt."""


class CacheWarning(UserWarning):
    """The answer stands, but it takes longer than it need: compiled code cannot be kept or used."""


def nearest_names(word: str, known: Iterable[str], most: int, likeness: float = 0.6) -> list[str]:
    """Return up to `most` of the known names that are near to `word`, the nearest first; small and capital letters count as alike.

    `likeness` is difflib's ratio from which on a name is near, 1 for the same name.
    """
    folded: dict[str, list[str]] = {}
    for name in known:
        folded.setdefault(name.casefold(), []).append(name)
    near = difflib.get_close_matches(word[:MAX_MESSAGE].casefold(), folded, n=most, cutoff=likeness)
    return [name for match in near for name in folded[match]][:most]


def did_you_mean(word: str, known: Iterable[str]) -> str:
    """Say which known names are nearest to `word`, or list what is allowed."""
    known = list(known)
    if near := nearest_names(word, known, 3):
        return "did you mean " + " or ".join(shown(name) for name in near) + "?"
    if not known:
        return "none is declared"
    listed = ", ".join(shortened(name) for name in sorted(known)[:20]) + (", ..." if len(known) > 20 else "")
    return f"known: {listed}"
