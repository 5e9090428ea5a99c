"""The command line: one file a subcommand, each a few lines over the API."""

from __future__ import annotations

import argparse
import io
import sys
import warnings
from collections.abc import Sequence
from typing import TextIO

from vehgen.commands import (
    bench,
    build,
    calibrate,
    diagnose,
    effects,
    import_,
    laden,
    models,
    modes,
    module,
    schema,
    sensitivity,
    sensors,
    simulate,
    static,
    validate,
)
from vehgen.errors import InputError, ModelWarning
from vehgen.files import guarding_results, noting_reads

COMMANDS = (
    build,
    modes,
    static,
    simulate,
    import_,
    calibrate,
    validate,
    sensitivity,
    sensors,
    diagnose,
    effects,
    laden,
    module,
    models,
    schema,
    bench,
)


def make_parser() -> argparse.ArgumentParser:
    """Return the parser of `python -m vehgen`."""
    parser = argparse.ArgumentParser(
        prog="python -m vehgen",
        description="Declare a road vehicle in YAML; derive, compile and simulate its pitch-plane dynamics.",
        epilog="example: python -m vehgen build tractor5.yaml",
    )
    parser.add_argument("--version", action="store_true", help="print the version and leave")
    commands = parser.add_subparsers(dest="command", metavar="COMMAND")
    for command in COMMANDS:
        name = getattr(command, "NAME", command.__name__.rpartition(".")[2])
        summary = (command.__doc__ or "").strip().splitlines()[0]
        sub = commands.add_parser(
            name,
            help=summary,
            description=summary,
            epilog=f"example: {command.EXAMPLE}",
            formatter_class=argparse.RawDescriptionHelpFormatter,  # an example is copied from one line
        )
        command.add_arguments(sub)
        sub.set_defaults(run=command.run)
    return parser


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line; returns the exit code: 0 done, 2 the input cannot be used, 130 stopped."""
    parser = make_parser()
    options = parser.parse_args(arguments)
    if options.version:
        from vehgen import __version__

        print(__version__)
        return 0
    if options.command is None:
        parser.print_help()
        return 0
    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(errors="replace")  # a title in another script must not fail on a plain terminal
    warnings.simplefilter("always", ModelWarning)
    warnings.showwarning = _show_warning
    try:
        with noting_reads(), guarding_results(getattr(options, "force", False)):
            options.run(options)
    except InputError as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    except BrokenPipeError:
        sys.stderr.close()
        return 0
    except KeyboardInterrupt:
        print("stopped", file=sys.stderr)
        return 130
    return 0


def _show_warning(
    message: Warning | str, category: type[Warning], filename: str, lineno: int, file: TextIO | None = None, line: str | None = None
) -> None:
    if issubclass(category, ModelWarning):
        print(f"warning: {message}", file=sys.stderr)
