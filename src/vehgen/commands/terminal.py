"""What the commands share: the vehicle argument, text and tables for people, JSON for programs.

Names, titles and messages may come from a stranger's file: here, and only here, they become what a terminal shows.
"""

from __future__ import annotations

import argparse
import json
import re
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

from vehgen.errors import escaped, printable

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


def say(text: str, heading: str = "", style: str = "bold") -> None:
    """Print text, after a heading in a style of its own."""
    from rich.text import Text

    console().print(Text.assemble((printable(heading), style), printable(text)))


def print_table(title: str, columns: Sequence[str], rows: Iterable[Sequence[str]], right: Sequence[int] = ()) -> None:
    """Print a table; `right` lists the columns that hold numbers."""
    from rich import box
    from rich.table import Table
    from rich.text import Text

    table = Table(title=Text(printable(title)), title_justify="left", title_style="bold", box=box.SIMPLE_HEAD, pad_edge=False)
    for index, column in enumerate(columns):
        table.add_column(Text(printable(column)), justify="right" if index in right else "left")
    for row in rows:
        table.add_row(*(Text(printable(cell)) for cell in row))
    console().print(table)


def warn(messages: Iterable[str]) -> None:
    """Print warnings beneath the tables."""
    for message in messages:
        say(message, "warning: ", "bold yellow")
