"""Run the whole study: `python -m benchmarks.paper_study [--quick | --first]`; writes figures, results.json and docs/paper.md's tables."""

from __future__ import annotations

import argparse
import json
import os
import platform
import tempfile
from pathlib import Path

from benchmarks.pages import ROOT, fill
from benchmarks.paper_study import figures
from benchmarks.paper_study.fits import GENERATIONS, fit_all
from benchmarks.paper_study.judging import judge
from benchmarks.paper_study.printed import printed_vehicles
from benchmarks.paper_study.recordings import RIGS, Rig, cruise_run, hump_run
from benchmarks.paper_study.roads import RandomRoad
from benchmarks.paper_study.sensitivity import sensitivities
from benchmarks.paper_study.tables import (
    Case,
    band_table,
    cost_table,
    data,
    frequency_table,
    printed_table,
    sensitivity_table,
    summary_table,
)
from benchmarks.paper_study.truth import drawn
from vehgen.files import write_text

UNSEEN_DURATION = 60.0
"""Of the drive over the unseen road [s]."""


def make_case(rig: Rig, number: int, generations: int, folder: Path) -> Case:
    """Draw true vehicle `number`, record it, calibrate by every method and judge."""
    truth = drawn(rig.kind, number)
    road = RandomRoad("A", 100 + number, -60.0, 60.0)
    name = f"{rig.kind}{number}"
    runs = [hump_run(folder, f"{name}_{speed:g}", rig, truth, speed, 10 * number + i, road) for i, speed in enumerate(rig.humps)]
    unseen = cruise_run(folder, f"{name}_b", rig, truth, "B", UNSEEN_DURATION, 200 + number)
    fits = fit_all(rig, runs, truth, generations, seed=number)
    return Case(rig, truth, fits, judge(rig, fits, truth, unseen))


def main() -> None:
    """Run everything."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true", help="one vehicle and 30 generations; writes to build/paper_study, not to docs")
    parser.add_argument("--vehicles", type=int, default=3, metavar="N", help="true vehicles of each kind (default 3)")
    parser.add_argument("--first", action="store_true", help="the first vehicle alone: renews figures and tables but for the summary")
    options = parser.parse_args()
    images = ROOT / "build" / "paper_study" if options.quick else ROOT / "docs" / "images" / "paper"
    images.mkdir(parents=True, exist_ok=True)
    count, generations = (1 if options.quick or options.first else options.vehicles), 30 if options.quick else GENERATIONS
    cases: dict[str, list[Case]] = {}
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for kind, rig in RIGS.items():
            cases[kind] = []
            for number in range(1, count + 1):
                cases[kind].append(make_case(rig, number, generations, folder))
                print(
                    f"{kind} {number}\n{cost_table(cases[kind][-1:])}\n{frequency_table(cases[kind][-1])}\n{band_table(cases[kind][-1])}\n"
                )
        felt = sensitivities(folder)
    machine = f"Python {platform.python_version()}, {os.cpu_count()} cores of one {platform.machine()} machine"
    blocks = {"machine": f"Times: {machine}; kernels compiled beforehand."}
    blocks |= {f"{kind} cost": cost_table(found) for kind, found in cases.items()}
    printed = {kind: printed_vehicles(rig) for kind, rig in RIGS.items()}
    figures.save(figures.plot_frequencies({kind: found[0].judged for kind, found in cases.items()}), images, "frequencies")
    for kind, rig in RIGS.items():
        first = cases[kind][0]
        figures.save(figures.plot_fits(first.fits), images, f"{kind}_fits")
        figures.save(figures.plot_unseen(rig, first.judged), images, f"{kind}_unseen")
        figures.save(figures.plot_bands(rig, first.judged), images, f"{kind}_bands")
    figures.save(figures.plot_printed(printed), images, "printed")
    figures.save(figures.plot_sensitivities(felt), images, "sensitivity")
    for kind, found in cases.items():
        blocks |= {
            f"{kind} frequencies": frequency_table(found[0]),
            f"{kind} bands": band_table(found[0]),
            f"{kind} printed": printed_table(kind, printed[kind]),
        }
    blocks["sensitivity"] = sensitivity_table(felt)
    if not options.first:
        blocks |= {f"{kind} summary": summary_table(found) for kind, found in cases.items()}
        results = {"machine": machine, **{kind: data(found) for kind, found in cases.items()}}
        write_text(images / "results.json", json.dumps(results, indent=1))
    print("\n\n".join(f"{name}\n{block}" for name, block in blocks.items()))
    if not options.quick:
        fill(ROOT / "docs" / "paper.md", blocks)


if __name__ == "__main__":
    main()
