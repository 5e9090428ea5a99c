"""What the site shows of docstrings: names that carry a role, such as a function's, as plain code."""

from __future__ import annotations

import re
from typing import Any

import griffe

ROLE = re.compile(r":\w+:`~?([^`]*)`")


class DocstringRoles(griffe.Extension):
    """Leaves the roles of names out of all docstrings."""

    def on_object(self, *, obj: griffe.Object, **arguments: Any) -> None:
        """Rewrite an object's docstring."""
        if obj.docstring is not None:
            obj.docstring.value = ROLE.sub(r"`\1`", obj.docstring.value)
