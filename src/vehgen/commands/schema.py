"""Print the JSON Schema of a file for editors: of the vehicle file, or with an option of another."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from typing import Any

from vehgen.commands.terminal import print_json

EXAMPLE = "vehgen schema > vehicle.schema.json"
DEFAULT = "vehicle"


def _vehicle() -> dict[str, Any]:
    from vehgen.mechanics.laws.schema import law_schema
    from vehgen.vehicle.schema import vehicle_schema

    return vehicle_schema(law_schema())


def _run_file() -> dict[str, Any]:
    from vehgen.simulate.run_file.schema import run_schema

    return run_schema()


def _cargo() -> dict[str, Any]:
    from vehgen.cargo.cargo_file import CargoFile
    from vehgen.files.schema import editor_schema

    return editor_schema(CargoFile, "vehgen cargo file")


def _frame() -> dict[str, Any]:
    from vehgen.cargo.frame_file import FrameFile
    from vehgen.files.schema import editor_schema

    return editor_schema(FrameFile, "vehgen frame file")


def _facts() -> dict[str, Any]:
    from vehgen.files.schema import editor_schema
    from vehgen.fit.prior_data import PriorDataFile

    return editor_schema(PriorDataFile, "vehgen facts file")


def _effects() -> dict[str, Any]:
    from vehgen.effects.entry import effects_schema

    return effects_schema()


def _export() -> dict[str, Any]:
    from vehgen.export import matrix_schema

    return matrix_schema()


SCHEMAS: dict[str, tuple[str, Callable[[], dict[str, Any]]]] = {
    DEFAULT: ("the vehicle file (the default)", _vehicle),
    "run": ("the run file", _run_file),
    "cargo": ("the cargo file of `laden`", _cargo),
    "frame": ("the frame file of `module`", _frame),
    "facts": ("the facts file of `calibrate --facts`", _facts),
    "effects": ("a file of your own effects", _effects),
    "export": ("what `export --to json` writes", _export),
}
"""The files that have a schema: what each is, and what returns its schema."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the command's arguments."""
    which = parser.add_mutually_exclusive_group()
    for name, (meaning, _) in SCHEMAS.items():
        which.add_argument(f"--{name}", action="store_const", dest="file", const=name, default=DEFAULT, help=f"the schema of {meaning}")
    parser.add_argument("--json", action="store_true", help="accepted for uniformity: the output is JSON always")


def run(options: argparse.Namespace) -> None:
    """Print the schema."""
    _, schema = SCHEMAS[options.file]
    print_json(schema())
