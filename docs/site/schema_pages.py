"""The page of all keys of all files, and the schemas themselves, from `vehgen schema`."""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import Any

from vehgen.commands.schema import SCHEMAS

HEAD = """\
# All keys of all files

Made from the JSON Schemas that `vehgen schema` prints; each can be had here, too. [How an editor uses
them](editors.md). What the keys mean is told, with examples, in [the vehicle file](vehicle-file.md), [the run
file](run-file.md), [cargo](cargo.md), [calibration](calibrate.md) and [effects](effects.md#your-own-effect).
"""


def schema_files() -> dict[str, str]:
    """Return the schemas by their paths on the site."""
    return {f"schemas/{name}.schema.json": json.dumps(make(), indent=2) + "\n" for name, (_, make) in SCHEMAS.items()}


def schemas_page() -> str:
    """Return the page in Markdown."""
    lines = [HEAD]
    for name, (meaning, make) in SCHEMAS.items():
        lines += [f"## {name}", "", f"{_sentence(meaning)}: [{name}.schema.json](schemas/{name}.schema.json).", ""]
        schema = make()
        lines += _table(schema)
        for title, definition in schema.get("$defs", {}).items():
            lines += [f"### {name}: {title}", "", _text(definition.get("description", "")), "", *_table(definition)]
    return "\n".join(lines)


def _table(schema: dict[str, Any]) -> Iterator[str]:
    properties = schema.get("properties", {})
    others = schema.get("additionalProperties")
    if not properties and not others:
        return
    yield from ("| key | takes | meaning |", "|---|---|---|")
    for key, item in properties.items():
        needed = " (required)" if key in schema.get("required", ()) else ""
        default = f" (default: `{_text(json.dumps(item['default']))}`)" if item.get("default") not in (None, [], {}) else ""
        yield f"| `{key}`{needed} | {_takes(item)}{default} | {_text(item.get('description', ''))} |"
    if isinstance(others, dict):
        yield f"| any name | {_takes(others)} | |"
    yield ""


def _takes(item: dict[str, Any]) -> str:
    """Return in words what a key takes."""
    if "$ref" in item:
        return str(item["$ref"]).rpartition("/")[2]
    if "enum" in item:
        return ", ".join(f"`{_text(json.dumps(value))}`" for value in item["enum"]).replace('"', "")
    if "const" in item:
        return f"`{item['const']}`"
    for union in ("anyOf", "oneOf"):
        if union in item:
            return " or ".join(dict.fromkeys(_takes(other) for other in item[union] if other != {"type": "null"}))
    if item.get("type") == "array":
        kinds = item.get("prefixItems") or [item.get("items", {})]
        return "list of " + ", ".join(dict.fromkeys(_takes(kind) for kind in kinds))
    if item.get("type") == "object":
        inner = item.get("additionalProperties")
        names = ", ".join(f"`{key}`" for key in item.get("properties", {}))
        return f"mapping of {names}" if names else f"mapping of names to {_takes(inner)}" if isinstance(inner, dict) else "mapping"
    kind = item.get("type", "anything")
    if item.get("description") and kind == ["string", "number"]:
        return "quantity or expression"
    return " or ".join(kind) if isinstance(kind, list) else str(kind)


def _sentence(text: str) -> str:
    return text[0].upper() + text[1:]


def _text(text: str) -> str:
    return " ".join(text.split()).replace("|", "\\|")
