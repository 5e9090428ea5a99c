"""List the effects that a diagnosis can name."""

from __future__ import annotations

import argparse

from vehgen.commands.terminal import add_json, print_json, print_table

EXAMPLE = "vehgen effects"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the command's arguments."""
    parser.add_argument("--library", metavar="FILE", action="append", default=[], help="a file of your own effects; may be repeated")
    add_json(parser)


def run(options: argparse.Namespace) -> None:
    """Print the library."""
    from vehgen.effects import effects

    known = effects(options.library)
    if options.json:
        print_json(
            [
                {
                    "name": effect.name,
                    "title": effect.title,
                    "equation": effect.equation,
                    "attaches": effect.attaches,
                    "is_global": effect.is_global,
                    "meaning": effect.meaning,
                    "signature": effect.signature,
                    "source": effect.source,
                    "parameters": [
                        {"name": item.name, "unit": item.unit, "searched": item.searched, "meaning": item.meaning}
                        for item in effect.parameters
                    ],
                }
                for effect in known.values()
            ]
        )
        return
    print_table(
        "effects", ("name", "lives at", "what it is"), [(effect.name, effect.attaches, effect.meaning) for effect in known.values()]
    )
