"""Vehicle files that extend another: written by programs, read by people."""

from __future__ import annotations

import json
import os
import re
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

from vehgen.files.names import MAX_TEXT
from vehgen.files.units import NONE
from vehgen.vehicle.loading import bundled_models
from vehgen.vehicle.model import Vehicle

_PLAIN_SCALAR = re.compile(r"[A-Za-z_][A-Za-z0-9_./-]*|-?\d[\d.]*(?:e[+-]?\d+)? [A-Za-z](?:[A-Za-z0-9^/ -]*[A-Za-z0-9])?", re.ASCII)
"""Words, paths and quantities such as `1.5 kg m^2`, which need no quotes."""
_WORDS = {"null", "true", "false", "yes", "no", "on", "off", "y", "n"}
"""What YAML, of one version or another, reads as something else than a text."""


def yaml_text(text: str) -> str:
    """Return a text as a YAML scalar on one line that every reader of YAML reads back as it is, whatever it holds."""
    if _PLAIN_SCALAR.fullmatch(text) and text.lower() not in _WORDS:
        return text
    if text.isprintable():
        return "'" + text.replace("'", "''") + "'"
    written = json.dumps(text, ensure_ascii=False)
    return "".join(character if character.isprintable() else _escape(character) for character in written)


def _escape(character: str) -> str:
    code = ord(character)
    return f"\\u{code:04x}" if code < 0x10000 else f"\\U{code:08x}"


def yaml_title(text: str) -> str:
    """Return free text as a YAML scalar, its white space evened out, cut to what a file may hold."""
    return yaml_text(" ".join(text.split())[:MAX_TEXT])


def yaml_document(data: Mapping[str, Any]) -> str:
    """Return mappings, lists, texts and numbers as a YAML file that reads back as they are; innermost mappings stand on one line."""
    return "".join(f"{line}\n" for line in _block(data, ""))


def _block(data: Mapping[str, Any], indent: str) -> Iterator[str]:
    for key, value in data.items():
        if isinstance(value, Mapping) and any(isinstance(item, Mapping | list | tuple) for item in value.values()):
            yield f"{indent}{yaml_text(key)}:"
            yield from _block(value, f"{indent}  ")
        else:
            yield f"{indent}{yaml_text(key)}: {_inline(value)}"


def _inline(value: Any) -> str:
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{yaml_text(key)}: {_inline(item)}" for key, item in value.items()) + "}"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(map(_inline, value)) + "]"
    if isinstance(value, str):
        return yaml_text(value)
    return json.dumps(value, allow_nan=False)


def quantity(vehicle: Vehicle, name: str, value: float) -> str:
    """Return a parameter's value with its SI unit, as a vehicle file writes it; the number reads back exactly."""
    dimension = vehicle.dimensions[name]
    return f"{float(value)!r}" if dimension == NONE else f"{float(value)!r} {dimension}"


def base_reference(vehicle: Vehicle, folder: Path) -> str:
    """Return what `extends:` must say in a file in `folder`: a bundled model's name, or a path relative to the folder."""
    if not vehicle.files:
        return vehicle.name
    path = vehicle.files[0].resolve()
    if any(path == model.resolve() for model in bundled_models().values()):
        return path.name
    return Path(os.path.relpath(path, folder.resolve())).as_posix()


def plain_data(vehicle: Vehicle) -> dict[str, Any]:
    """Return the plain data of a vehicle's file, with all that it extends; none for a vehicle that was not read from a file or text."""
    return {} if vehicle._document is None else dict(vehicle._document.plain())


def variant_text(
    vehicle: Vehicle,
    folder: Path,
    name: str,
    title: str,
    values: Mapping[str, float],
    comments: Iterable[str] = (),
    notes: Mapping[str, str] | None = None,
) -> str:
    """Return a vehicle file that extends a vehicle with other parameter values.

    Parameters
    ----------
    vehicle
        The vehicle to extend, read from a file.
    folder
        Where the file will stand.
    name, title
        Its own.
    values
        New values [SI] of free parameters.
    comments
        Lines for its head.
    notes
        A comment after a parameter's line, by name.
    """
    lines = [f"# {' '.join(comment.split())}" for comment in comments]
    lines += [
        f"extends: {yaml_text(base_reference(vehicle, folder))}",
        f"name: {yaml_text(name)}",
        f"title: {yaml_title(title)}",
        "parameters:",
    ]
    for parameter, value in values.items():
        note = (notes or {}).get(parameter, "")
        lines.append(f"  {parameter}: {{value: {quantity(vehicle, parameter, value)}}}{f'  # {note}' if note else ''}")
    return "\n".join(lines) + "\n"
