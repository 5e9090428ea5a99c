"""What a name, a heading of a table and free text in a file may be; the one place of these rules, which all file formats share.

Names end up in tables, file names, pages and programs that read them, so they hold nothing that could mean something there. Free text may
say anything that can be printed as it is.
"""

from __future__ import annotations

import hashlib
import unicodedata
from typing import Annotated

from pydantic import AfterValidator
from pydantic_core import PydanticCustomError

from vehgen.errors import BIDIRECTIONAL, shown

MAX_NAME = 64
MAX_COLUMN = 200
MAX_TEXT = 2000
NAME_RULE = f"letters, digits and the signs _ . - were expected, beginning with a letter, a digit or _, at most {MAX_NAME} in all"
_NAME_SIGNS = "_.-"
_UNPRINTABLE = {"Cc", "Cs", "Cn", "Zl", "Zp"}
_LINE_SIGNS = "\t\n\r"


def is_name(text: str) -> bool:
    """Whether a text may name something: letters and digits of any script and `_ . -`, no sign first, at most 64 characters."""
    return (
        0 < len(text) <= MAX_NAME
        and text[0] not in ".-"
        and all(_is_letter_or_digit(character) or character in _NAME_SIGNS for character in text)
        and unicodedata.normalize("NFKC", text) == text
    )


def is_identifier(text: str) -> bool:
    """Whether a text may stand in expressions: an ASCII letter, then ASCII letters, digits and underscores, at most 64 characters."""
    plain = text.replace("_", "a")
    return 0 < len(text) <= MAX_NAME and text.isascii() and plain.isalnum() and text[0].isalpha()


def as_name(text: str) -> str:
    """Return the nearest name to a text, such as that of a file: what may not stand in a name becomes an underscore."""
    plain = unicodedata.normalize("NFKC", text)
    found = "".join(character if _is_letter_or_digit(character) or character in _NAME_SIGNS else "_" for character in plain)
    found = found if found[:1] not in ("", ".", "-") else f"_{found}"
    return found[:MAX_NAME] if is_name(found[:MAX_NAME]) else "_"


def joined_name(*parts: str) -> str:
    """Return names joined by underscores; one that would be too long ends in a hash of the whole, so that it stays one of its own."""
    whole = "_".join(parts)
    if len(whole) <= MAX_NAME:
        return whole
    return f"{whole[: MAX_NAME - 9]}_{hashlib.sha256(whole.encode()).hexdigest()[:8]}"


def unprintable(text: str) -> str | None:
    """Return the first character that may stand in no text of a file, as U+XXXX; None where there is none.

    These are control characters (but for tabs and line ends), half and unassigned ones, the line ends of Unicode alone, and characters
    that change the direction of writing.
    """
    for character in text:
        if character in BIDIRECTIONAL or (unicodedata.category(character) in _UNPRINTABLE and character not in _LINE_SIGNS):
            return f"U+{ord(character):04X}"
    return None


def is_column(text: str) -> bool:
    """Whether a text may refer to a column of a table by its heading: one line of at most 200 printable characters."""
    return len(text) <= MAX_COLUMN and unprintable(text) is None and not set(_LINE_SIGNS) & set(text)


def check_name(text: str) -> str:
    """Return a name; raises a pydantic error for what is none."""
    if not is_name(text):
        raise _error(f"{shown(text)} cannot be a name: {NAME_RULE}")
    return text


def check_identifier(text: str) -> str:
    """Return a name that may stand in expressions; raises a pydantic error for what is none."""
    if not is_identifier(text):
        expected = f"a letter, then letters, digits and underscores were expected (of ASCII), at most {MAX_NAME} in all"
        raise _error(f"{shown(text)} cannot be a name: {expected}")
    return text


def check_column(text: str) -> str:
    """Return a heading of a table; raises a pydantic error for what is none."""
    if not is_column(text):
        raise _error(f"{shown(text)} cannot head a column: one line of at most {MAX_COLUMN} printable characters was expected")
    return text


def check_text(text: str) -> str:
    """Return free text; raises a pydantic error where it is too long or cannot be printed."""
    if len(text) > MAX_TEXT:
        raise _error(f"a text of {len(text)} characters is too long: at most {MAX_TEXT} were expected")
    if (found := unprintable(text)) is not None:
        raise _error(f"the character {found} is not allowed in a text")
    return text


def _error(reason: str) -> PydanticCustomError:
    return PydanticCustomError("name", "{reason}", {"reason": reason})


def _is_letter_or_digit(character: str) -> bool:
    return unicodedata.category(character)[0] == "L" or unicodedata.category(character) == "Nd"


Name = Annotated[str, AfterValidator(check_name)]
"""What something is called."""
Identifier = Annotated[str, AfterValidator(check_identifier)]
"""What something is called that expressions may name."""
Column = Annotated[str, AfterValidator(check_column)]
"""The heading of a column of a table that a user has."""
FreeText = Annotated[str, AfterValidator(check_text)]
"""A title, meaning, source or description."""
