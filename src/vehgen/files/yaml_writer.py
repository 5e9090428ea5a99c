"""YAML files written for people: quoting, layout and comments of all that vehgen writes in YAML.

Innermost mappings stand on one line, all others in lines of `key: value`.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from vehgen.files.expressions import Expression
from vehgen.files.names import MAX_TEXT

_PLAIN_SCALAR = re.compile(r"[A-Za-z_][A-Za-z0-9_./-]*|-?\d[\d.]*(?:e[+-]?\d+)? [A-Za-z](?:[A-Za-z0-9^/ -]*[A-Za-z0-9])?", re.ASCII)
"""Words, paths and quantities such as `1.5 kg m^2`, which need no quotes."""
_WORDS = {"null", "true", "false", "yes", "no", "on", "off", "y", "n"}
"""What YAML, of one version or another, reads as something else than a text."""


@dataclass(frozen=True)
class Commented:
    """A value with a comment behind it, and lines of comments above its key."""

    value: Any
    behind: str = ""
    above: tuple[str, ...] = ()


class OneLine(dict[str, Any]):
    """A mapping that stands on one line, whatever it holds."""


def yaml_document(data: Mapping[str, Any], comments: Iterable[str] = ()) -> str:
    """Return a YAML file that reads back as its data, comments at its head.

    Parameters
    ----------
    data
        Mappings, lists, texts, numbers and expressions; values of mappings that stand in lines of their own may be :class:`Commented`.
    comments
        Lines for its head.
    """
    return "".join(f"{line}\n" for line in (*map(_comment, comments), *_block(data, "")))


def yaml_text(text: str) -> str:
    """Return a text as a YAML scalar on one line that every reader of YAML reads back as it is, whatever it holds."""
    if _PLAIN_SCALAR.fullmatch(text) and text.lower() not in _WORDS:
        return text
    if text.isprintable():
        return "'" + text.replace("'", "''") + "'"
    written = json.dumps(text, ensure_ascii=False)
    return "".join(character if character.isprintable() else _escape(character) for character in written)


def even_text(text: str) -> str:
    """Return free text with its white space evened out, cut to what a file may hold."""
    return " ".join(text.split())[:MAX_TEXT]


def _escape(character: str) -> str:
    code = ord(character)
    return f"\\u{code:04x}" if code < 0x10000 else f"\\U{code:08x}"


def _comment(text: str) -> str:
    """Return a comment on one line, whatever its text holds."""
    plain = " ".join(text.split())
    return f"# {''.join(character if character.isprintable() else '?' for character in plain)}"


def _block(data: Mapping[str, Any], indent: str) -> Iterator[str]:
    for key, item in data.items():
        entry = item if isinstance(item, Commented) else Commented(item)
        value, behind = entry.value, f"  {_comment(entry.behind)}" if entry.behind else ""
        yield from (f"{indent}{_comment(line)}" for line in entry.above)
        if _takes_lines(value):
            yield f"{indent}{yaml_text(key)}:{behind}"
            yield from _block(value, f"{indent}  ")
        else:
            yield f"{indent}{yaml_text(key)}: {_inline(value)}{behind}"


def _takes_lines(value: Any) -> bool:
    if not isinstance(value, Mapping) or isinstance(value, OneLine):
        return False
    return any(isinstance(item, Mapping | list | tuple | Commented) for item in value.values())


def _inline(value: Any) -> str:
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{yaml_text(key)}: {_inline(item)}" for key, item in value.items()) + "}"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(map(_inline, value)) + "]"
    if isinstance(value, str | Expression):
        return yaml_text(str(value))
    return json.dumps(value, allow_nan=False)
