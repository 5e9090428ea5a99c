"""Make cases, solve and score them, print tables: `python -m benchmarks.measured_world make|score|page`."""

from __future__ import annotations

import argparse
from pathlib import Path

from benchmarks.measured_world.make import make_set
from benchmarks.measured_world.sets import KINDS, SETS


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.measured_world", description=__doc__)
    commands = parser.add_subparsers(dest="command", required=True)
    make = commands.add_parser("make", help="write cases and their truth")
    make.add_argument("--set", choices=tuple(SETS), default="trial")
    make.add_argument("--seed", type=int, required=True)
    make.add_argument("--kind", choices=tuple(KINDS), required=True)
    make.add_argument("--count", type=int, required=True)
    make.add_argument("--recorder", choices=("mixed", "logger", "phones"), default="mixed", help="mixed: every third pair has phones")
    make.add_argument("--processes", type=int, default=1)
    make.add_argument("--out", type=Path, required=True)
    return parser


def main() -> None:
    """Run a command."""
    options = _parser().parse_args()
    if options.command == "make":
        make_set(options.set, options.seed, options.kind, options.count, options.out, options.recorder, options.processes)


if __name__ == "__main__":
    main()
