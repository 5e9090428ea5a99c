"""Draw the page or the figures of a result again, from the JSON file that a command wrote."""

from __future__ import annotations

import argparse
from pathlib import Path

from vehgen.commands.results import add_out, folder_named, tell_written
from vehgen.commands.terminal import add_json, print_json

EXAMPLE = "vehgen report diagnosis/diagnosis.json --out again"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the command's arguments."""
    kinds = "diagnose, calibrate, validate, sensitivity, transmissibility, assess, response or build"
    parser.add_argument("file", metavar="FILE", type=Path, help=f"a JSON file of {kinds}")
    add_out(parser, "DIR", "folder for the page or figures (default: beside the file)")
    add_json(parser)


def run(options: argparse.Namespace) -> None:
    """Read a result and draw it."""
    from vehgen.report import report

    files = report(options.file, folder_named(options.out, options.file.parent))
    if options.json:
        print_json({"files": [str(path) for path in files]})
        return
    tell_written(files)
