"""Make a set of cases: what the experimenter has in one folder each, the truth of all in another."""

from __future__ import annotations

import os
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from functools import partial
from multiprocessing import get_context
from pathlib import Path
from typing import Any

from benchmarks.measured_world.cases import Case
from benchmarks.measured_world.exports import write_exports
from benchmarks.measured_world.faults import spoilt
from benchmarks.measured_world.files import copy_vehicle, truth, write_json, write_recording
from benchmarks.measured_world.modes import invariants, natural_modes
from benchmarks.measured_world.rigs import files as rig_files
from benchmarks.measured_world.rigs.sets import KIND as RIGS
from benchmarks.measured_world.rigs.sets import draw_rig
from benchmarks.measured_world.sets import SETS, draw_case
from benchmarks.measured_world.unseen import write_unseen
from benchmarks.measured_world.world import record_run


def write_case(case: Case, out: Path) -> None:
    """Write out/cases/NAME and out/truth/NAME: the truth last, so that a case that has one is whole."""
    folder, sealed = out / "cases" / case.name, out / "truth" / case.name
    copy_vehicle(case, folder)
    if case.phones:
        facts, sigma = write_exports(case, folder)
    else:
        recordings = spoilt(case, [record_run(case, run) for run in case.runs])
        for recording in recordings:
            write_recording(case, recording, folder)
        facts = {recording.run.name: recording.facts for recording in recordings}
        sigma = {recording.run.name: recording.sigma for recording in recordings}
    more: dict[str, Any] = {"noise": sigma}
    if case.effects:
        more["strength"] = case.strength
    if case.kind == "coverage":
        write_unseen(case, sealed / "unseen")
        more |= {"modes": natural_modes(case.vehicle, case.parameters), "invariants": invariants(case.vehicle, case.parameters)}
    write_json(sealed / "truth.json", truth(case, facts, more))


def _make(set_name: str, seed: int, kind: str, recorder: str, out: Path, without: bool, number: int) -> str:
    if kind == RIGS:
        rig = draw_rig(SETS[set_name], seed, number)
        if not (out / "truth" / rig.name / "truth.json").is_file():
            rig_files.write_case(rig, out)
        return rig.name
    case = draw_case(set_name, seed, kind, number, recorder)
    case = replace(case, effects=(), strength=None) if without else case
    if not (out / "truth" / case.name / "truth.json").is_file():
        write_case(case, out)
    return case.name


def make_set(
    set_name: str, seed: int, kind: str, count: int, out: Path, recorder: str = "mixed", processes: int = 1, without: bool = False
) -> None:
    """Write `count` cases of a kind; those that are there already stay as they are.

    `without` their effects they are twins of those with them.
    """
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    work = partial(_make, set_name, seed, kind, recorder, out, without)
    if processes == 1:
        for number in range(count):
            print(work(number), flush=True)
        return
    with ProcessPoolExecutor(processes, mp_context=get_context("spawn")) as pool:
        for name in pool.map(work, range(count)):
            print(name, flush=True)
