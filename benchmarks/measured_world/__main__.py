"""Make cases, solve and score them, print tables: `python -m benchmarks.measured_world make|score|page|glance|tellable|told`."""

from __future__ import annotations

import argparse
import json
import warnings
from pathlib import Path

from benchmarks.measured_world.make import make_set
from benchmarks.measured_world.page import page, read
from benchmarks.measured_world.rigs.sets import KIND as RIGS
from benchmarks.measured_world.score import score_set
from benchmarks.measured_world.sets import KINDS, SETS


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.measured_world", description=__doc__)
    commands = parser.add_subparsers(dest="command", required=True)
    make = commands.add_parser("make", help="write cases and their truth")
    make.add_argument("--set", choices=tuple(SETS), default="trial")
    make.add_argument("--seed", type=int, required=True)
    make.add_argument("--kind", choices=(*KINDS, RIGS), required=True)
    make.add_argument("--count", type=int, required=True)
    make.add_argument(
        "--recorder",
        choices=("mixed", "logger", "phones"),
        default="mixed",
        help="mixed: a third has phones; rigs have recorders of their own",
    )
    make.add_argument("--without", action="store_true", help="leave the drawn effects out: twins of the cases with them")
    make.add_argument("--processes", type=int, default=1)
    make.add_argument("--out", type=Path, required=True)
    score = commands.add_parser("score", help="solve cases and compare with the truth; goes on where it stopped")
    score.add_argument("folder", type=Path, help="what `make` wrote")
    score.add_argument("--out", type=Path, required=True, help="a file of JSON lines that grows case by case")
    score.add_argument("--processes", type=int, default=2)
    score.add_argument("--limit", type=int, help="at most so many cases")
    score.add_argument("--timeout", type=float, default=3600.0, help="seconds a case may take")
    score.add_argument("--settings", type=json.loads, default={}, help="more arguments of calibrations, as JSON")
    show = commands.add_parser("page", help="print the tables of scored cases")
    show.add_argument("results", type=Path, nargs="+")
    short = commands.add_parser("glance", help="print one row for every set of scored effects")
    short.add_argument("results", type=Path, nargs="+")
    short.add_argument("--kinds", action="store_true", help="print one row for each thing hidden instead")
    short.add_argument("--misses", action="store_true", help="print the intervals that miss the truth instead")
    tell = commands.add_parser("tellable", help="fit the true law at its true place: could the recordings tell it?")
    tell.add_argument("folder", type=Path, help="what `make` wrote")
    tell.add_argument("--out", type=Path, required=True, help="a file of JSON lines that grows case by case")
    tell.add_argument("--cases", nargs="+", help="names of cases (default: all)")
    tell.add_argument("--scored", type=Path, nargs="+", default=[], help="what `score` wrote of them: outcomes are kept beside")
    tell.add_argument("--missed", action="store_true", help="only cases that --scored says were not seen")
    tell.add_argument("--steps", action="store_true", help="also say at which step the diagnosis loses what is hidden")
    tell.add_argument("--twins-of", type=Path, help="the cases with their effects, where `folder` was made --without them")
    told = commands.add_parser("told", help="print what `tellable` found")
    told.add_argument("measured", type=Path, nargs="+")
    told.add_argument("--scored", type=Path, nargs="+", required=True)
    return parser


def _tell(options: argparse.Namespace) -> None:
    """Measure cases by their true laws."""
    from benchmarks.measured_world.telling.measure import measure_set
    from benchmarks.measured_world.telling.table import missed

    scored = read(options.scored)
    names = options.cases or sorted(path.name for path in (options.folder / "truth").iterdir())
    names = [name for name in names if name in missed(scored)] if options.missed else names
    warnings.simplefilter("ignore")
    judged = {item["case"]: item["judged"] for item in scored}
    measure_set(options.folder, options.out, names, options.twins_of, judged, options.steps)


def main() -> None:
    """Run a command."""
    options = _parser().parse_args()
    if options.command == "make":
        make_set(options.set, options.seed, options.kind, options.count, options.out, options.recorder, options.processes, options.without)
    elif options.command == "score":
        score_set(options.folder, options.out, options.processes, options.limit, options.timeout, options.settings)
    elif options.command == "tellable":
        _tell(options)
    elif options.command == "glance":
        from benchmarks.measured_world.telling.glance import glance, kinds, misses

        print((misses if options.misses else kinds if options.kinds else glance)(options.results))
    elif options.command == "told":
        from benchmarks.measured_world.telling.table import telling_page

        print(telling_page(read(options.measured), read(options.scored)), end="")
    else:
        print(page(read(options.results)), end="")


if __name__ == "__main__":
    main()
