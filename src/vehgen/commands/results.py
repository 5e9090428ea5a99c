"""What commands that write files share: `--out` and `--force`, the names of results, and the lines that say what was written."""

from __future__ import annotations

import argparse
import os
import unicodedata
from collections.abc import Iterable
from pathlib import Path

from vehgen.commands.terminal import say
from vehgen.errors import InputError, shown


def add_out(parser: argparse.ArgumentParser, metavar: str, meaning: str, required: bool = False) -> None:
    """Add --out and --force.

    Parameters
    ----------
    metavar
        What `--out` names: FILE, DIR, ...
    meaning
        Its help.
    """
    parser.add_argument("--out", metavar=metavar, required=required, help=meaning)
    parser.add_argument("--force", action="store_true", help="write over files that vehgen did not write, or that were changed since")


def file_named(text: str, option: str = "--out") -> Path:
    """Return the file that an option names.

    Raises
    ------
    InputError
        For an empty name, one with control characters, `-`, and one that ends as a folder's does.
    """
    path = _named(text, option)
    if text.endswith(("/", os.sep)):
        raise InputError(f"{option} names a file to write; found {shown(text)}, a folder")
    return path


def folder_named(text: str | None, default: str | Path) -> Path:
    """Return the folder that --out names, or the default.

    Raises
    ------
    InputError
        For an empty name, one with control characters, and `-`.
    """
    return Path(default) if text is None else _named(text, "--out")


def tell_written(paths: Iterable[Path]) -> None:
    """Print a line for every file that was written."""
    for path in paths:
        say(f"wrote {path}")


def _named(text: str, option: str) -> Path:
    if not text or any(unicodedata.category(sign) == "Cc" for sign in text):
        raise InputError(f"{option} wants a name; found {shown(text)}")
    if text == "-":
        raise InputError(f"{option} wants a name; results are not written to standard output (a file of this name is ./-)")
    return Path(text)
