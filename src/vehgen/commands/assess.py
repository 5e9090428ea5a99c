"""Tell what a run means to people, roads and cargo: ride, tyre loads, vibration, shock and fatigue by their standards."""

from __future__ import annotations

import argparse
from pathlib import Path

from vehgen.commands.results import add_out, folder_named, tell_written
from vehgen.commands.terminal import add_json, print_json, print_table, say, warn
from vehgen.files import check_results, write_text

EXAMPLE = "vehgen assess run.yaml --out assessment"
ARGUMENT_OPTIONS = {"weighting": "--weighting", "slope": "--slope", "start": "--from", "run": "RUN"}
ASSESSED_CURVES = ("frequency", "density", "maximax", "levels", "cumulative")
"""What assessment.json holds of places and cycles and --json leaves out."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the command's arguments."""
    parser.add_argument("run_file", metavar="RUN", help="a run file")
    parser.add_argument("--recorded", action="store_true", help="assess the run's recording instead of its simulation")
    parser.add_argument(
        "--weighting", default="Wk", metavar="NAME", help="of vertical accelerations: Wk (ISO 2631-1, default) or Wb (ISO 2631-4)"
    )
    parser.add_argument("--slope", type=float, default=5.0, metavar="M", help="slope of the S-N line for equivalent ranges (default 5)")
    parser.add_argument("--from", type=float, default=0.0, dest="start", metavar="S", help="leave out the first S seconds (default 0)")
    add_out(parser, "DIR", "folder for the page, table, figure and JSON (default: RUN_assessment)")
    add_json(parser)


def run(options: argparse.Namespace) -> None:
    """Assess a run, and write the page, the table, the figure and the result."""
    from vehgen.assess import assess
    from vehgen.assess.tables import assessment_tables
    from vehgen.files.results import json_text
    from vehgen.report.pages.assessment_page import assessment_files, write_assessment
    from vehgen.simulate import load_run

    run_ = load_run(options.run_file)
    folder = folder_named(options.out, f"{Path(options.run_file).stem}_assessment")
    files = [folder / "assessment.json"]
    check_results([*files, *assessment_files(folder)])
    found = assess(run_, recorded=options.recorded, weighting=options.weighting, slope=options.slope, start=options.start)
    write_text(files[0], json_text(found))
    files += write_assessment(found, folder)
    if options.json:
        print_json({**_without_curves(found.to_dict()), "files": [str(path) for path in files]})
        return
    say(f"{found.title}: {found.source}, {found.duration:.4g} s at {found.rate:.4g} samples a second")
    for table in assessment_tables(found):
        print_table(table.title, table.columns, table.rows, right=range(1, len(table.columns)))
        say(table.source)
    warn(found.notes)
    tell_written(files)


def _without_curves(data: dict[str, object]) -> dict[str, object]:
    """Return an assessment's data without the curves of its places."""
    found = dict(data)
    for name in ("transport", "shock", "cycles"):
        items = found[name]
        assert isinstance(items, list)
        left_out = [key for key in ASSESSED_CURVES if not (name == "transport" and key == "levels")]
        found[name] = [{key: value for key, value in item.items() if key not in left_out} for item in items]
    return found
