"""What the site makes of docstrings: numpy's form as this project writes it, in the form that the site's reader of docstrings knows."""

from __future__ import annotations

import re
from typing import Any

import griffe

ROLE = re.compile(r":\w+:`~?([^`]*)`")
SECTION = re.compile(r"^(\w[\w ]*)\n-+\n(.*?)(?=^\w[\w ]*\n-+\n|\Z)", re.MULTILINE | re.DOTALL)
TOGETHER = re.compile(r"^(\w+(?:, \w+)+)\n((?:    .*\n?|\n)+)", re.MULTILINE)


class Docstrings(griffe.Extension):
    """Rewrites all docstrings before they are read."""

    def on_object(self, *, obj: griffe.Object, **arguments: Any) -> None:
        """Rewrite an object's docstring."""
        if obj.docstring is not None:
            returned = str(obj.returns) if isinstance(obj, griffe.Function) and obj.returns is not None else None
            obj.docstring.value = rewritten(obj.docstring.value, returned)


def rewritten(text: str, returned: str | None = None) -> str:
    """Return a docstring without roles, each parameter by itself, and the type of what is returned before its words.

    Parameters
    ----------
    text
        The docstring, its indentation removed.
    returned
        The type that its function returns.
    """

    def section(match: re.Match[str]) -> str:
        title, body = match[1], match[2]
        if title == "Returns" and returned is not None and not re.search(r"^ ", body, re.MULTILINE):
            body = f"{returned}\n" + re.sub(r"^(?=.)", "    ", body, flags=re.MULTILINE)
        if title in ("Parameters", "Attributes"):
            body = TOGETHER.sub(lambda names: "".join(f"{name}\n{names[2].rstrip()}\n" for name in names[1].split(", ")), body)
        return f"{title}\n{'-' * len(title)}\n{body}"

    return SECTION.sub(section, ROLE.sub(r"`\1`", text))
