"""What headings of columns say: a name, and often the unit in brackets."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

from vehgen.errors import InputError, Position, did_you_mean, shown
from vehgen.files.units import GRAVITIES, read_unit

_BRACKETED = re.compile(r"(.*?\S)\s*(?:\[([^\[\]]*)\]|\(([^()]*)\))", re.DOTALL)
_SUPERSCRIPTS = str.maketrans({"²": "^2", "³": "^3", "°": "deg", "·": " ", "⋅": " "})
_BARE_POWER = re.compile(r"(?<=[A-Za-z])([23])(?![0-9A-Za-z])")
_OTHER_SPELLINGS = {
    "sec": "s",
    "Nm": "N m",
    "kNm": "kN m",
    "kph": "km/h",
    "deg/sec": "deg/s",
    "m/sec": "m/s",
    "degrees": "deg",
    "lbs": "lb",
}
_NO_UNIT = ("", "-", "1")
_UNITS_AND_WORDS = ("in", "min")
"""Inches and minutes, or what came in and the least of something."""


class MissingColumnError(InputError):
    """A table has no column of a name: `column`."""

    def __init__(self, message: str, position: Position | None = None, column: str = "") -> None:
        super().__init__(message, position)
        self.column = column


def spelled(text: str) -> str:
    """Return a unit as vehgen spells it: `m/s²` and `m/s2` are m/s^2, `°/s` is deg/s."""
    plain = text.strip()
    return _OTHER_SPELLINGS.get(plain, _BARE_POWER.sub(r"^\1", plain.translate(_SUPERSCRIPTS)))


def is_unit(text: str) -> bool:
    """Whether a text is a unit as vehgen or others spell it."""
    plain = spelled(text)
    try:
        found = read_unit(plain)
    except InputError:
        return False
    return plain in GRAVITIES or (found is not None and found[2] == len(plain))


def declared_unit(text: str | None) -> str | None:
    """Return the unit that a file gives to a column; None where it gives none."""
    plain = spelled(text or "")
    return None if plain in _NO_UNIT else plain


def name_and_unit(heading: str) -> tuple[str, str | None]:
    """Split a heading such as `az [m/s²]` or `# t (s)` into name and unit; round brackets without a unit belong to the name."""
    plain = heading.strip().lstrip("# ")
    found = _BRACKETED.fullmatch(plain)
    if found is None or (found.group(2) is None and not is_unit(found.group(3))):
        return plain, None
    return found.group(1), declared_unit(found.group(2) if found.group(2) is not None else found.group(3))


def may_be_word(heading: str) -> bool:
    """Whether what looks like a heading's unit may be a word of its name: `(in)`; in square brackets a unit stands, and nothing else."""
    found = _BRACKETED.fullmatch(heading.strip())
    return found is not None and found.group(2) is None and found.group(3).strip() in _UNITS_AND_WORDS


def check_cells(where: Path | str, line: int, row: Sequence[str | float], headings: int) -> None:
    """Raise InputError for a row of a table that has cells beyond its headings; empty ones count for nothing."""
    if any(str(cell).strip() for cell in row[headings:]):
        halved = "; where each number is in two of them for its decimal comma, separate columns by semicolons"
        said = f"{len(row)} cells below {headings} headings{halved if len(row) == 2 * headings else ''}"
        raise InputError(said, Position(where, line, headings + 1))


def find_heading(path: Path, headings: Sequence[str], name: str, line: int = 1) -> int:
    """Return the index of the column with a heading, or with one that is the name and a unit in brackets.

    Raises
    ------
    MissingColumnError
        For a column that there is not, with the nearest names.
    InputError
        For one that there is twice.
    """
    known = list(headings) if name in headings else [name_and_unit(item)[0] for item in headings]
    if name not in known:
        raise MissingColumnError(f"no column {shown(name)}; {did_you_mean(name, known)}", Position(path, line, 1), name)
    index = known.index(name)
    if known.count(name) > 1:
        second = known.index(name, index + 1)
        raise InputError(f"two columns are named {shown(name)}; each needs a name of its own", Position(path, line, second + 1))
    return index
