"""Write a commented file to begin with: a vehicle, or a run."""

from __future__ import annotations

import argparse
from importlib.resources import files

from vehgen.commands.results import add_out, file_named, tell_written
from vehgen.commands.terminal import say
from vehgen.files import check_results, write_text

EXAMPLE = "vehgen new truck --out my_truck.yaml"
STARTERS = {"truck": "build", "semitrailer": "build", "run": "simulate"}
"""What can be begun, and the command that comes next."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the command's arguments."""
    parser.add_argument("kind", nargs="?", choices=tuple(STARTERS), default="truck", help="what it begins with (default: truck)")
    add_out(parser, "FILE", "the file to write (default: my_KIND.yaml)")


def run(options: argparse.Namespace) -> None:
    """Write a starter file."""
    from vehgen.files.names import as_name

    path = file_named(f"my_{options.kind}.yaml" if options.out is None else options.out)
    check_results([path])
    text = files("vehgen.commands").joinpath(f"starters/{options.kind}.yaml").read_text(encoding="utf-8")
    write_text(path, text.replace("name: NAME", f"name: {as_name(path.stem)}"))
    tell_written([path])
    say(f"next: edit it, then `vehgen {STARTERS[options.kind]} {path}`")
