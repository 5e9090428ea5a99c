"""Effects of one's own as entries of a YAML file: a force law, a quantity of runs or sensors, or a line of the spectrum."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from vehgen.effects.base import Effect
from vehgen.effects.entry_model import EffectsFile
from vehgen.effects.entry_reader import EntryReader
from vehgen.effects.registry import library
from vehgen.errors import ArgumentError, InputError, did_you_mean, shown
from vehgen.files.entry import read_entries
from vehgen.files.schema import editor_schema


def effects_schema() -> dict[str, Any]:
    """Return the JSON Schema of a file of effects, for editors."""
    return editor_schema(EffectsFile, "vehgen effects file")


def effects(files: Iterable[str | os.PathLike[str]] | str | os.PathLike[str] = ()) -> dict[str, Effect]:
    """Return all effects known, then those of files, by name.

    Raises
    ------
    InputError
        As :func:`load_effects`, and for names that two files share.
    """
    known = library()
    for path in [files] if isinstance(files, str | os.PathLike) else files:
        known |= load_effects(path, known)
    return known


def effects_named(
    names: Sequence[str | Effect] | None, files: Iterable[str | os.PathLike[str]] | str | os.PathLike[str] = ()
) -> list[Effect]:
    """Return the effects that an argument means: all of the library and of files, or those given by name or themselves.

    Raises
    ------
    InputError
        For a name that no effect has.
    """
    known = effects(files)
    if names is None:
        return list(known.values())
    if isinstance(names, str | Effect):
        raise ArgumentError("`effects`: a list of effects or of their names was expected", "effects")
    chosen: list[Effect] = []
    for item in names:
        if not isinstance(item, Effect) and item not in known:
            raise ArgumentError(f"`effects`: no effect {shown(item)}; {did_you_mean(str(item), known)}", "effects")
        effect = item if isinstance(item, Effect) else known[item]
        if effect not in chosen:
            chosen.append(effect)
    return chosen


def load_effects(path: str | os.PathLike[str], taken: Mapping[str, Effect] | None = None) -> dict[str, Effect]:
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
    file, document = read_entries(EffectsFile, Path(path))
    known = library() if taken is None else taken
    found = {}
    for name, entry in file.effects.items():
        if name in known:
            raise InputError(f"an effect is named {shown(name)} already; choose another name", document.find(("effects", name), key=True))
        found[name] = replace(EntryReader(document, name, entry).effect(), file=os.fspath(path))
    return found
