"""The formats of an export: what each is called, its suffix, and what writes it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from vehgen.export.data_files import write_json, write_npz
from vehgen.export.source import ExportSource


@dataclass(frozen=True)
class Format:
    """A format: what it is for in a few words, the suffix of its file (none for a folder), and what writes it.

    `write` returns the bytes of every file by its name; those of a folder stand in it.
    """

    meaning: str
    suffix: str
    write: Callable[[ExportSource], dict[str, bytes]]


EXPORT_FORMATS: dict[str, Format] = {
    "json": Format("matrices, names, units, parameters, static loads and force laws, with a schema", ".json", write_json),
    "npz": Format("the same as NumPy arrays", ".npz", write_npz),
}
"""Every format by the name that it is asked for."""
