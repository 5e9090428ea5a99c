"""Moments as text, as loggers and receivers write them: a date with a time of day, or a time of day alone."""

from __future__ import annotations

from datetime import UTC, date, datetime, time


def moment(text: str) -> float:
    """Return a moment in seconds since 1970, in UTC where it names no zone; a time of day alone is one of 1970-01-01.

    Raises ValueError for what is no moment in the forms of ISO 8601.
    """
    try:
        found = datetime.fromisoformat(text)
    except ValueError:
        found = datetime.combine(date(1970, 1, 1), time.fromisoformat(text))
    try:
        return (found if found.tzinfo else found.replace(tzinfo=UTC)).timestamp()
    except OverflowError as error:
        raise ValueError(f"{text} is beyond what a calendar holds") from error


def is_moment(text: str) -> bool:
    """Whether a text is a date with a time of day, or a time of day: one with minutes."""
    try:
        moment(text)
    except ValueError:
        return False
    return ":" in text
