"""How is it called? The command line: one file a subcommand, each a few lines over the API."""

from __future__ import annotations

import argparse
import ast
import inspect
import io
import shlex
import sys
from collections.abc import Mapping, Sequence
from contextlib import suppress
from types import ModuleType

from vehgen.commands import (
    assess,
    bench,
    build,
    calibrate,
    completion,
    diagnose,
    effects,
    export,
    import_,
    laden,
    models,
    modes,
    module,
    new,
    report,
    response,
    schema,
    sensitivity,
    sensors,
    simulate,
    static,
    transmissibility,
    validate,
)
from vehgen.commands.faults import OneLineParser, end_of, show_warnings
from vehgen.errors import ArgumentError, InputError, shortened
from vehgen.files import guarding_results, noting_reads

COMMANDS = (
    new,
    build,
    modes,
    static,
    simulate,
    assess,
    response,
    import_,
    transmissibility,
    calibrate,
    validate,
    sensitivity,
    sensors,
    diagnose,
    effects,
    laden,
    module,
    export,
    report,
    models,
    schema,
    completion,
    bench,
)


def make_parser() -> OneLineParser:
    """Return the parser of `vehgen`."""
    parser = OneLineParser(
        prog="vehgen",
        description="Declare a road vehicle in YAML; derive, compile and simulate its pitch-plane dynamics.",
        epilog="example: vehgen build tractor5.yaml",
    )
    parser.add_argument("--version", action="store_true", help="print the version and leave")
    _add_debug(parser)
    commands = parser.add_subparsers(dest="command", metavar="COMMAND")
    for command in COMMANDS:
        name = getattr(command, "NAME", command.__name__.rpartition(".")[2])
        summary = _summary(command)
        sub = commands.add_parser(
            name,
            help=summary,
            description=summary,
            epilog=f"example: {command.EXAMPLE}",
            formatter_class=argparse.RawDescriptionHelpFormatter,  # an example is copied from one line
        )
        command.add_arguments(sub)
        _add_debug(sub)
        sub.set_defaults(run=command.run, parser=sub, argument_options=getattr(command, "ARGUMENT_OPTIONS", {}))
    return parser


def _add_debug(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--debug", action="store_true", default=argparse.SUPPRESS, help="show where an error was raised")


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line; returns the exit code: 0 done, 2 the input cannot be used, 130 stopped."""
    words = list(sys.argv[1:] if arguments is None else arguments)
    return end_of(lambda: _run(words), debug="--debug" in words)


def _run(words: list[str]) -> int | None:
    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(errors="replace")  # a title in another script must not fail on a plain terminal
    for word in words:
        if word.startswith("--") and word.endswith("=--"):  # argparse of Python 3.11 would take the value for the end of the options
            raise InputError(f"{shortened(word.removesuffix('=--'))} wants a value; found '--'")
    parser = make_parser()
    options = parser.parse(words)
    options.command_line = shlex.join(["vehgen", *words])
    if options.version:
        from vehgen import __version__

        print(__version__)
    elif options.command is None:
        parser.print_help()
    else:
        show_warnings()
        with noting_reads(), guarding_results(getattr(options, "force", False)):
            try:
                code: int | None = options.run(options)
                return code
            except ArgumentError as error:
                raise InputError(in_options(error, options.argument_options), error.position) from error
    return None


def in_options(error: ArgumentError, options: Mapping[str, str]) -> str:
    """Return an error's message with options in the places of the arguments it names: `speed_error` becomes --speed-error.

    Parameters
    ----------
    error
        An error of the API.
    options
        The options that are not called as their arguments.
    """
    message = error.message
    for name in error.names:
        message = message.replace(f"`{name}`", options.get(name, f"--{name.replace('_', '-')}"))
    return message


def _summary(command: ModuleType) -> str:
    """Return the first line of a command's docstring, from its source where `python -OO` left it out."""
    text = command.__doc__
    if text is None:
        with suppress(OSError):
            text = ast.get_docstring(ast.parse(inspect.getsource(command)))
    return (text or command.__name__.rpartition(".")[2]).strip().splitlines()[0]
