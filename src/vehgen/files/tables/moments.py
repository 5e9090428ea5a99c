"""Moments as text, as loggers and receivers write them: a date with a time of day, or a time of day alone."""

from __future__ import annotations

import re
from datetime import UTC, datetime

OF_DAY, DATED, ZONED = "a time of day", "a date and time", "a date and time with its zone"
"""The forms of a moment: 12:00:00.25, 2024-05-01T12:00:00.25, 2024-05-01T12:00:00.25Z."""
_OF_DAY = re.compile(r"(\d{1,2}):(\d{2}):(\d{2}(?:[.,]\d+)?)", re.ASCII)
_DATED = re.compile(r"\d{4}-\d{2}-\d{2}[T ]\d{2}:\d{2}(?::\d{2}(?:[.,]\d+)?)?(Z|[+-]\d{2}(?::?\d{2})?)?", re.ASCII)


def form_of(text: str) -> str | None:
    """Return the form of a moment; None for a text that has none of them, as 05:12.3 may be minutes and seconds."""
    if _OF_DAY.fullmatch(text):
        return OF_DAY
    found = _DATED.fullmatch(text)
    return None if found is None else ZONED if found[1] else DATED


def moment(text: str) -> float:
    """Return a date and time in seconds since 1970, in UTC where it names no zone; raises ValueError for what is none."""
    try:
        found = datetime.fromisoformat(text)
        return (found if found.tzinfo else found.replace(tzinfo=UTC)).timestamp()
    except OverflowError as error:
        raise ValueError(f"{text} is beyond what a calendar holds") from error


def seconds(text: str, form: str) -> float:
    """Return a moment of a form [s]: since midnight, or since 1970; raises ValueError for what is none, or has another form."""
    if form_of(text) != form:
        raise ValueError(f"{text} is not {form}")
    found = _OF_DAY.fullmatch(text)
    if found is None:
        return moment(text)
    hours, minutes, rest = int(found[1]), int(found[2]), float(found[3].replace(",", "."))
    if hours > 23 or minutes > 59 or rest >= 60:
        raise ValueError(f"{text} is no time of day")
    return 3600.0 * hours + 60.0 * minutes + rest
