"""Names and texts of a vehicle as identifiers and literals of other languages: nothing of them can become code there."""

from __future__ import annotations

import re
from collections.abc import Iterable

from vehgen.errors import escaped

MAX_IDENTIFIER = 63
"""Characters of an identifier that C99 and MATLAB tell apart."""
MATLAB_KEYWORDS = frozenset(
    [
        "break",
        "case",
        "catch",
        "classdef",
        "continue",
        "do",
        "else",
        "elseif",
        "end",
        "end_try_catch",
        "end_unwind_protect",
        "endfor",
        "endfunction",
        "endif",
        "endswitch",
        "endwhile",
        "for",
        "function",
        "global",
        "if",
        "otherwise",
        "parfor",
        "persistent",
        "return",
        "spmd",
        "switch",
        "try",
        "until",
        "unwind_protect",
        "unwind_protect_cleanup",
        "while",
    ]
)
"""Words of MATLAB and of GNU Octave that name nothing."""


def identifier(text: str, limit: int = MAX_IDENTIFIER) -> str:
    """Return the nearest identifier to a text: ASCII letters, digits and underscores, a letter first, no keyword of MATLAB."""
    plain = re.sub(r"[^A-Za-z0-9_]", "_", text)
    named = plain if plain[:1].isalpha() and plain not in MATLAB_KEYWORDS else f"v_{plain.lstrip('_')}"
    return named[:limit]


def is_matlab_identifier(text: str) -> bool:
    """Whether a text may name a function of MATLAB."""
    return identifier(text) == text


def distinct_identifiers(prefix: str, names: Iterable[str]) -> list[str]:
    """Return an identifier `PREFIX_NAME` for each name; those that would be alike are numbered."""
    found: list[str] = []
    for name in names:
        whole = f"{prefix}_" + re.sub(r"[^A-Za-z0-9_]", "_", name)
        candidate, count = whole[:MAX_IDENTIFIER], 1
        while candidate in found:
            count += 1
            candidate = f"{whole[: MAX_IDENTIFIER - len(str(count)) - 1]}_{count}"
        found.append(candidate)
    return found


def c_text(text: str) -> str:
    """Return a text as a string literal of C: printable ASCII, all else (and what trigraphs are made of) as octal bytes of UTF-8."""
    plain = set(range(0x20, 0x7F)) - set(b'"\\?')
    return '"' + "".join(chr(byte) if byte in plain else f"\\{byte:03o}" for byte in text.encode("utf-8", "replace")) + '"'


def matlab_text(text: str) -> str:
    """Return a text as a character vector of MATLAB, what does not print as it would be in a Python string."""
    return "'" + escaped(text).replace("'", "''") + "'"
