"""`diagnose --fleet`: a folder of vehicles and their runs to one table and one page."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

from vehgen.commands.faults import STOPPED, UNUSABLE
from vehgen.commands.option_strings import split_list
from vehgen.commands.results import folder_named, tell_written
from vehgen.commands.terminal import print_json, print_table, say
from vehgen.errors import InputError
from vehgen.files import check_results

if TYPE_CHECKING:
    from vehgen.diagnose.fleet import Fleet


def add_fleet(parser: argparse.ArgumentParser, *instead_of: argparse.Action) -> None:
    """Add --fleet and --scheduler; with a fleet the arguments `instead_of` are not asked for."""

    class FleetAction(argparse.Action):
        """Take the folder of a fleet, whose run files stand in it: the arguments of one vehicle are then not required."""

        def __call__(self, parser: argparse.ArgumentParser, options: argparse.Namespace, values: Any, option: str | None = None) -> None:
            """Keep the folder, and require the other arguments no more."""
            setattr(options, self.dest, values)
            for action in instead_of:
                action.required = False

    told = "diagnose many vehicles: a folder with one subfolder for each, with its run files"
    parser.add_argument("--fleet", metavar="FOLDER", action=FleetAction, help=told)
    told = "let the Dask cluster at this address diagnose the vehicles of a fleet, or test places and fit candidates of one"
    parser.add_argument("--scheduler", metavar="ADDRESS", help=told)


def run_fleet(options: argparse.Namespace) -> int | None:
    """Diagnose a fleet, write its results, and print its table; returns an exit code where a vehicle failed or Ctrl-C ended it early."""
    from vehgen.commands.progress import Bars
    from vehgen.diagnose.fleet import diagnose_fleet
    from vehgen.report.diagnosis_files import diagnosis_files
    from vehgen.report.pages.fleet_page import FLEET_PAGE, write_fleet_page

    if options.vehicle is not None:
        raise InputError("--fleet takes the vehicles and runs of a folder; no vehicle file and no run files were expected beside it")
    folder = folder_named(options.out, f"{Path(options.fleet).absolute().name}_diagnosis")
    check_results([folder / FLEET_PAGE])
    with Bars(quiet=options.json) as bars:
        found = diagnose_fleet(
            options.fleet,
            folder,
            files_of=diagnosis_files,
            effects=split_list(options.effects) or None,
            library=options.library,
            everywhere=options.everywhere,
            scheduler=options.scheduler,
            progress=bars.tell,
        )
    files = [write_fleet_page(found, folder), folder / "fleet.csv", folder / "fleet.json"]
    if options.json:
        print_json({**found.to_dict(), "files": [str(path) for path in files]})
    else:
        _show_fleet(found)
        tell_written(files)
    if found.stopped:
        return STOPPED
    return UNUSABLE if any(row.status == "failed" for row in found.rows) else None


def _show_fleet(found: Fleet) -> None:
    rows = []
    for row in found.rows:
        gap = None if row.verdict is None else row.verdict.gap
        chi = ("", "") if gap is None else (f"{gap.before:.3f}", f"{gap.after:.3f}")
        rows.append((row.name, str(len(row.runs) or ""), row.status if row.verdict is None else row.verdict.verdict, row.found, *chi))
    columns = ("vehicle", "runs", "verdict", "what is missing, or what went wrong", "before", "after")
    print_table(f"{found.fleet}: chi before and after (1 is noise alone)", columns, rows, right=(1, 4, 5))
    say(", ".join(f"{count} {name}" for name, count in found.counts().items()), f"{len(rows)} vehicles: ")
