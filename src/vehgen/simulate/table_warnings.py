"""What makes a table of speeds, forces or displacements doubtful: it does not cover the run, has a hole, or its times are in ms."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from vehgen.files.tables import read_columns
from vehgen.mechanics.equations_of_motion import EquationsOfMotion
from vehgen.road import SpeedHistory
from vehgen.simulate.holes import FEWEST_ROWS_WITH_HOLES, holes, widest
from vehgen.simulate.run_file import Run
from vehgen.simulate.run_file.entries import DisplacementEntry, ForceEntry, SpeedFile
from vehgen.simulate.run_scenario import ground_links
from vehgen.simulate.scenario import Scenario

Array = NDArray[np.float64]
UNCOVERED_SHARE = 0.01
"""A table that leaves out so little of the run covers it."""
TIMES_LONGER_IN_MS = 50.0
"""A table that lasts so many times as long as the run may be in ms, ..."""
LEAST_SPACING_IN_MS = 1.0
"""... where its rows are so far apart [ms] at least, ..."""
LEAST_COVERED_IN_MS = 0.5
"""... and it then covers so large a share of the run."""
AT_REST = 1e-3
"""A force or a stroke that begins or ends at so small a share of its largest rests there."""


@dataclass(frozen=True)
class _Table:
    """A table of a run: what it is called, its entry, its times [s] and values, and whether it may rest at 0 beyond its ends."""

    name: str
    entry: SpeedFile | ForceEntry | DisplacementEntry
    time: Array
    values: Array
    may_rest: bool


def doubtful_tables(run: Run, model: EquationsOfMotion, scenario: Scenario) -> Iterator[str]:
    """Warn of tables of speeds, forces and displacements that end or begin within the run, have a hole, or seem to be in ms."""
    for table in _tables(run, model, scenario):
        if _seems_in_ms(table, run, scenario):
            yield (
                f"{table.name} lasts {np.ptp(table.time):.4g} s, {np.ptp(table.time) / scenario.duration:.3g} times as long as the run: "
                "is its time in ms? State `time_unit: ms`, or `time_unit: s` if it is not"
            )
        else:
            yield from _uncovered(table, scenario)
            yield from _holes(table, scenario)


def _tables(run: Run, model: EquationsOfMotion, scenario: Scenario) -> Iterator[_Table]:
    """Yield the tables of a run that have two rows and more; one of a single row states a constant."""
    file = run.file
    if isinstance(scenario.speed, SpeedHistory) and isinstance(file.speed, SpeedFile):
        yield _Table(f"the table of the speed ({file.speed.file})", file.speed, scenario.speed.time, scenario.speed.speed, False)
    for (name, force), signal in zip(file.forces.items(), scenario.forces, strict=True):
        if signal.time is not None and signal.values is not None and len(signal.time) > 1:
            yield _Table(f"the table of the force {name} ({force.file})", force, signal.time, signal.values, True)
    for link, moving in zip(ground_links(model), scenario.ground, strict=True):
        if moving is not None and moving.time is not None and moving.values is not None and len(moving.time) > 1:
            entry = file.displacements[link]
            yield _Table(f"the table of the displacement {link} ({entry.file})", entry, moving.time, moving.values, True)


def _seems_in_ms(table: _Table, run: Run, scenario: Scenario) -> bool:
    """Whether a table whose unit of time nobody states lasts so long that it may be in ms."""
    length, spacing = np.ptp(table.time), float(np.median(np.diff(table.time)))
    if table.entry.time_unit is not None or length < TIMES_LONGER_IN_MS * scenario.duration:
        return False
    if spacing < LEAST_SPACING_IN_MS or length / 1000 < LEAST_COVERED_IN_MS * scenario.duration:
        return False
    assert table.entry.file is not None
    return read_columns(Path(run.folder) / table.entry.file, (table.entry.time,)).units[0] is None


def _uncovered(table: _Table, scenario: Scenario) -> Iterator[str]:
    first, last, end = float(table.time[0]), float(table.time[-1]), scenario.duration
    spacing = float(np.median(np.diff(table.time)))
    was_drawn = len(table.time) < FEWEST_ROWS_WITH_HOLES
    spared = max(min(spacing, UNCOVERED_SHARE * end) if was_drawn else spacing, scenario.dt * scenario.decimation)
    rests = np.abs(table.values[[0, -1]]) <= AT_REST * np.abs(table.values).max() if table.may_rest else (False, False)
    late, early = first > spared and not rests[0], last < end - spared and not rests[1]
    held = [f"its first value is held before {first:.4g} s"] if late else []
    held += [f"its last value is held after {last:.4g} s"] if early else []
    if held:
        yield f"{table.name} covers {first:.4g} to {last:.4g} s, the run lasts from 0 to {end:.4g} s: {' and '.join(held)}"


def _holes(table: _Table, scenario: Scenario) -> Iterator[str]:
    found = holes(table.time, 0.0, scenario.duration)
    if found.size:
        yield f"{table.name} {widest(table.time, found, 's', 'rows')}: a straight line bridges it"
