"""An experimenter's care that no tyre leaves the road: lower humps, slower drives over rough roads."""

from __future__ import annotations

from dataclasses import replace

from benchmarks.measured_world.cases import Case, Run
from benchmarks.measured_world.hump import Hump
from benchmarks.measured_world.world import drive_past, motion_of

LOWEST = 0.0
"""Share of its static load that every tyre keeps on the true road."""
SLOWER = 0.8
TRIES = 8


def gentle(case: Case) -> Case:
    """Return a case whose humps are lower by one common factor, and whose roads are driven slower, until every tyre keeps LOWEST."""
    for _ in range(TRIES):
        loads = {run.name: _lowest_load(case, run) for run in case.runs}
        lifted = [run for run in case.runs if loads[run.name] < LOWEST]
        if not lifted:
            return case
        humps = [loads[run.name] for run in lifted if run.road is None]
        factor = 0.97 * (1.0 - LOWEST) / (1.0 - min(humps)) if humps else 1.0
        runs = tuple(_lower(run, factor) if run.road is None else run for run in case.runs)
        case = replace(case, runs=tuple(_slower(run) if run in lifted and run.road is not None else run for run in runs))
    return case


def _lowest_load(case: Case, run: Run) -> float:
    return motion_of(case, run, drive_past(case, run)).unloaded


def _lower(run: Run, factor: float) -> Run:
    assert run.stated_hump is not None
    assert run.hump is not None
    height = max(round(run.stated_hump.height * factor, 3), 0.002)
    changed: dict[str, Hump] = {
        "stated_hump": replace(run.stated_hump, height=height),
        "hump": replace(run.hump, height=run.hump.height * height / run.stated_hump.height),
    }
    return replace(run, **changed)


def _slower(run: Run) -> Run:
    speed = round(run.speed * SLOWER, 1)
    return replace(run, speed=speed, true_speed=run.true_speed * speed / run.speed)
