"""The page of all commands, from their parsers."""

from __future__ import annotations

import argparse
from types import ModuleType

from vehgen.commands import COMMANDS

HEAD = """\
# Commands

`vehgen COMMAND --help` says the same in a terminal. Every command takes `--debug`, which shows where an error was
raised. A command leaves with 0 when it is done, with 2 when its input cannot be used (one line says where and why),
with 130 when it was stopped. [What commands write](results.md) is left alone without `--force`.
"""


def commands_page() -> str:
    """Return the page in Markdown."""
    return "\n".join([HEAD, *(_section(command) for command in COMMANDS)])


def _section(command: ModuleType) -> str:
    name = getattr(command, "NAME", command.__name__.rpartition(".")[2])
    parser = argparse.ArgumentParser(prog=f"vehgen {name}", add_help=False)
    command.add_arguments(parser)
    summary = (command.__doc__ or "").strip().splitlines()[0]
    usage = " ".join(parser.format_usage().removeprefix("usage: ").split())
    rows = [_row(action) for action in parser._actions if action.help != argparse.SUPPRESS]
    table = ["| argument | meaning |", "|---|---|", *rows, ""] if rows else []
    return "\n".join([f"## {name}", "", summary, "", "```text", usage, "```", "", *table, "```sh", command.EXAMPLE, "```", ""])


def _row(action: argparse.Action) -> str:
    value = "" if action.nargs == 0 else _value(action)
    called = ", ".join(f"`{flag}{' ' + value if value else ''}`" for flag in action.option_strings) or f"`{value}`"
    needed = " (required)" if action.required and action.option_strings else ""
    meaning = (action.help or "") % {"default": action.default}
    return f"| {called.replace('|', chr(92) + '|')} | {meaning.replace('|', chr(92) + '|')}{needed} |"


def _value(action: argparse.Action) -> str:
    """Return what stands for an argument's value in its help."""
    if action.choices is not None and action.metavar is None:
        name = "{" + ",".join(map(str, action.choices)) + "}"
    else:
        name = " ".join(action.metavar) if isinstance(action.metavar, tuple) else action.metavar or action.dest.upper()
    return f"{name} ..." if action.nargs in ("*", "+") else name
