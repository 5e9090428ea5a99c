"""Print the JSON Schema of the vehicle file (or, with --run, --effects or --export, of those files) for editors."""

from __future__ import annotations

import argparse

from vehgen.commands.terminal import print_json

EXAMPLE = "vehgen schema > vehicle.schema.json"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the command's arguments."""
    which = parser.add_mutually_exclusive_group()
    which.add_argument("--run", action="store_true", dest="run_file", help="the schema of the run file")
    which.add_argument("--effects", action="store_true", help="the schema of a file of your own effects")
    which.add_argument("--export", action="store_true", help="the schema of what `export --to json` writes")
    parser.add_argument("--json", action="store_true", help="accepted for uniformity: the output is JSON always")


def run(options: argparse.Namespace) -> None:
    """Print the schema."""
    if options.run_file:
        from vehgen.simulate.run_file import RunFile

        print_json({"$schema": "https://json-schema.org/draft/2020-12/schema", **RunFile.model_json_schema()})
        return
    if options.effects:
        from vehgen.effects.entry import effects_schema

        print_json(effects_schema())
        return
    if options.export:
        from vehgen.export import matrix_schema

        print_json(matrix_schema())
        return
    from vehgen.vehicle.schema import vehicle_schema

    print_json(vehicle_schema())
