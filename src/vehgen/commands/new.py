"""Write a commented file to begin with: a vehicle, or a run."""

from __future__ import annotations

import argparse
from importlib.resources import files

from vehgen.commands.results import file_named, tell_written
from vehgen.commands.terminal import say
from vehgen.files import check_results, write_text

EXAMPLE = "vehgen new my_truck.yaml"
STARTERS = {"truck": "build", "semitrailer": "build", "run": "simulate"}
"""What can be begun, and the command that comes next."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the command's arguments."""
    parser.add_argument("file", metavar="FILE", help="the file to write, e.g. my_truck.yaml")
    parser.add_argument("--kind", choices=tuple(STARTERS), default="truck", help="what it begins with (default: truck)")
    parser.add_argument("--force", action="store_true", help="write over files that vehgen did not write, or that were changed since")


def run(options: argparse.Namespace) -> None:
    """Write a starter file."""
    from vehgen.files.names import as_name

    path = file_named(options.file, "FILE")
    check_results([path])
    text = files("vehgen.commands").joinpath(f"starters/{options.kind}.yaml").read_text(encoding="utf-8")
    write_text(path, text.replace("name: NAME", f"name: {as_name(path.stem)}"))
    tell_written([path])
    say(f"next: edit it, then `vehgen {STARTERS[options.kind]} {path}`")
