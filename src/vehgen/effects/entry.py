"""Effects of one's own as entries of a YAML file: a force law, a quantity of runs or sensors, or a line of the spectrum."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from vehgen.effects.base import Effect
from vehgen.effects.entry_model import EffectsFile
from vehgen.effects.entry_reader import EntryReader
from vehgen.effects.registry import library
from vehgen.errors import InputError, shown
from vehgen.files.entry import read_entries


def effects_schema() -> dict[str, Any]:
    """Return the JSON Schema of a file of effects, for editors."""
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **EffectsFile.model_json_schema(), "title": "vehgen effects file"}


def extended_library(paths: Iterable[str | Path]) -> dict[str, Effect]:
    """Return all effects known, then those of files.

    Raises
    ------
    InputError
        As :func:`load_effects`, and for names that two files share.
    """
    known = library()
    for path in paths:
        known |= load_effects(path, known)
    return known


def load_effects(path: str | Path, taken: Mapping[str, Effect] | None = None) -> dict[str, Effect]:
    """Read and check a file of effects.

    Parameters
    ----------
    path
        The file.
    taken
        Effects whose names it may not use (default: all of the library).

    Raises
    ------
    InputError
        With file, line and column, what is wrong and what would be right.
    """
    file, document = read_entries(EffectsFile, path)
    known = library() if taken is None else taken
    found = {}
    for name, entry in file.effects.items():
        if name in known:
            raise InputError(f"an effect is named {shown(name)} already; choose another name", document.find(("effects", name), key=True))
        found[name] = EntryReader(document, name, entry).effect()
    return found
