"""Find which effect a vehicle's model lacks: where, what, how sure, and what to measure next."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from vehgen.commands.faults import STOPPED
from vehgen.commands.fleet import add_fleet, run_fleet
from vehgen.commands.option_strings import split_list
from vehgen.commands.results import add_out, folder_named, tell_written
from vehgen.commands.terminal import add_json, print_json, print_table, say
from vehgen.files import check_results, write_text

if TYPE_CHECKING:
    from vehgen.diagnose import Diagnosis

EXAMPLE = "vehgen diagnose tractor5.yaml hump_2ms.yaml hump_3ms.yaml high_2.5ms.yaml --out diagnosis"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the command's arguments."""
    vehicle = parser.add_argument("vehicle", metavar="VEHICLE", help="a vehicle file whose `range`s say what may be refitted, within 35 %%")
    runs = parser.add_argument(
        "runs", metavar="RUN", nargs="+", help="run files with recordings; three or more, at two hump heights or speeds"
    )
    add_fleet(parser, vehicle, runs)
    parser.add_argument("--effects", metavar="A,B", help="try these effects only (default: the whole library)")
    parser.add_argument("--library", metavar="FILE", action="append", default=[], help="a file of your own effects; may be repeated")
    parser.add_argument("--everywhere", action="store_true", help="try every effect at every place, whatever the place test says")
    add_out(parser, "DIR", "folder for report and files (default: VEHICLE_diagnosis)")
    add_json(parser)


def run(options: argparse.Namespace) -> int | None:
    """Diagnose, write the report and the vehicle file, and print the verdict; returns an exit code where Ctrl-C ended it early."""
    if options.fleet is not None:
        return run_fleet(options)
    import os
    from dataclasses import replace

    from vehgen.commands.progress import Bars
    from vehgen.diagnose import diagnose
    from vehgen.diagnose.writing import files_named_so
    from vehgen.effects import effects_named
    from vehgen.fit.trial import load_trials
    from vehgen.report.diagnosis_files import DIAGNOSIS_PAGE, result_files
    from vehgen.report.pages.diagnosis_page import write_diagnosis_page
    from vehgen.vehicle import load_vehicle

    chosen = effects_named(split_list(options.effects) or None, options.library)
    vehicle = load_vehicle(options.vehicle)
    trials = load_trials(options.runs, vehicle)
    folder = folder_named(options.out, f"{Path(options.vehicle).stem}_diagnosis")
    check_results([folder / "diagnosis.json", folder / DIAGNOSIS_PAGE, *files_named_so(vehicle.name, folder)])
    with Bars(quiet=options.json) as bars:
        found = diagnose(
            vehicle,
            trials,
            effects=chosen,
            everywhere=options.everywhere,
            workers=os.cpu_count() or 1,
            scheduler=options.scheduler,
            progress=bars.tell,
        )
    if found.evidence.origin is not None:
        origin = replace(found.evidence.origin, command=options.command_line)
        found = replace(found, evidence=replace(found.evidence, origin=origin))
    found, texts = result_files(found, folder)
    for name, text in texts.items():
        write_text(folder / name, text)
    if not options.json:
        _show(found)
    write_diagnosis_page(found, folder / DIAGNOSIS_PAGE)
    files = [folder / name for name in (*texts, DIAGNOSIS_PAGE)]
    if options.json:
        print_json({**found.verdict.to_dict(), "files": [str(path) for path in files]})
    else:
        tell_written(files)
    return STOPPED if found.stopped else None


def _show(found: Diagnosis) -> None:
    from vehgen.files.number_text import interval_words

    verdict = found.verdict
    say("", heading=f"{verdict.reason}.")
    effect_rows = [
        (
            effect.name,
            effect.place,
            name,
            f"{item.value:.4g} {item.unit}",
            "" if item.interval is None else interval_words(item.interval),
        )
        for effect in verdict.effects
        for name, item in effect.parameters.items()
    ]
    if effect_rows:
        print_table("what is missing", ("effect", "place", "parameter", "value", "90 % interval"), effect_rows, right=(3,))
    columns = ("run", "used for", "before", "after") if verdict.effects else ("run", "used for", "chi")
    rows = [
        (run.run, "checking" if run.validation else "fitting", f"{run.before:.3f}", f"{run.after:.3f}")[: len(columns)]
        for run in verdict.gap.runs
    ]
    print_table("chi (1 is noise alone)", columns, rows, right=(2, 3)[: len(columns) - 2])
    for cure in dict.fromkeys(fault.cure for fault in verdict.faults):
        say(f"put right: {cure}")
    for note in verdict.notes:
        say(f"note: {note}")
    if verdict.next_experiment:
        say(f"measure next: {verdict.next_experiment}")
