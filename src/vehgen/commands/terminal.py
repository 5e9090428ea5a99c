"""What the commands share: the vehicle argument, text and tables for people, JSON for programs, and streams that may be closed.

Names, titles and messages may come from a stranger's file: here, and only here, they become what a terminal shows.
"""

from __future__ import annotations

import argparse
import json
import os
import re
import sys
from collections.abc import Iterable, Sequence
from contextlib import suppress
from typing import TYPE_CHECKING, Any, TextIO

from vehgen.errors import escaped, printable
from vehgen.files.number_text import kilonewtons, on_terminal, thousands

MAX_LINE = 600
"""Characters of an error or a warning; the middle of a longer one is left out."""

if TYPE_CHECKING:
    from rich.console import Console

    from vehgen.vehicle import Vehicle


def add_vehicle(parser: argparse.ArgumentParser) -> None:
    """Add FILE, --set and --json."""
    parser.add_argument("file", metavar="FILE", help="a vehicle file, or the name of a bundled model (see `models`)")
    parser.add_argument("--set", metavar="NAME", dest="parameter_set", help="use a named parameter set of the file")
    add_json(parser)


def add_json(parser: argparse.ArgumentParser) -> None:
    """Add --json."""
    parser.add_argument("--json", action="store_true", help="print JSON for programs instead of tables")


def load(options: argparse.Namespace) -> tuple[Vehicle, dict[str, float]]:
    """Return the vehicle of the options, and the values of its free parameters."""
    from vehgen.vehicle import load_vehicle

    vehicle = load_vehicle(options.file)
    return vehicle, vehicle.values(options.parameter_set)


def print_json(data: Any) -> None:
    """Print JSON."""
    print(json.dumps(data, indent=2, allow_nan=False))


def one_line(text: str) -> str:
    """Return a message as one printable line of at most `MAX_LINE` characters."""
    line = escaped(re.sub(r"\s*[\r\n]\s*", " ", text.strip()).replace("\t", " "))
    if len(line) <= MAX_LINE:
        return line
    return f"{line[: MAX_LINE - 205]} ... {line[-200:]}"


def console(stderr: bool = False) -> Console:
    """Return a console that takes text as it is, without markup, and is as wide as its tables need where it is not a terminal."""
    from rich.console import Console

    found = Console(stderr=stderr, markup=False, emoji=False, highlight=False)
    return found if stderr or found.is_terminal else Console(width=120, markup=False, emoji=False, highlight=False)


def number_text(value: float, decimals: int = 1, sign: str = "") -> str:
    """Return a number with so many decimals as tables show it, thousands apart."""
    return on_terminal(thousands(value, decimals, sign))


def force_text(force: float) -> str:
    """Return a force [N] in kN as tables show it."""
    return on_terminal(kilonewtons(force))


def say(text: str, heading: str = "", style: str = "bold") -> None:
    """Print text, after a heading in a style of its own; where that is no terminal, without breaking its lines."""
    from rich.text import Text

    shown = console()
    shown.print(Text.assemble((printable(heading), style), printable(text)), soft_wrap=not shown.is_terminal)


def print_table(title: str, columns: Sequence[str], rows: Iterable[Sequence[str]], right: Sequence[int] = ()) -> None:
    """Print a table; `right` lists the columns that hold numbers."""
    from rich import box
    from rich.table import Table
    from rich.text import Text

    table = Table(box=box.SIMPLE_HEAD, pad_edge=False)
    for index, column in enumerate(columns):
        table.add_column(Text(printable(column)), justify="right" if index in right else "left")
    for row in rows:
        table.add_row(*(Text(printable(cell)) for cell in row))
    say("", title)
    console().print(table)


def warn(messages: Iterable[str]) -> None:
    """Print warnings on stderr, in a line each where that is no terminal."""
    from rich.text import Text

    shown = console(stderr=True)
    for message in messages:
        line = one_line(message)
        if shown.is_terminal:
            shown.print(Text.assemble(("warning: ", "bold yellow"), line))
        else:
            say_on_stderr(f"warning: {line}")


def say_on_stderr(line: str) -> None:
    """Print a line on stderr; where it is closed or full nothing is said, and the exit code must tell."""
    try:
        print(line, file=sys.stderr, flush=True)
    except (OSError, ValueError):
        silence(sys.stderr)


def silence(stream: TextIO) -> None:
    """Send what is still to be written nowhere, so that Python does not complain of it when it ends."""
    with suppress(OSError, ValueError):
        nowhere = os.open(os.devnull, os.O_WRONLY)
        try:
            os.dup2(nowhere, stream.fileno())
        finally:
            os.close(nowhere)
