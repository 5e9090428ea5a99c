"""Every file that runs are made from: what a result names with its hash, so that it can be made again."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from vehgen.simulate.run_file.loading import Run
from vehgen.vehicle.loading import files_by_name


def files_read(runs: Sequence[Run], *, recordings: bool = True, inputs: bool = True, also: Sequence[Path] = ()) -> dict[str, Path]:
    """Return the files that runs are made from, by what a file in the first run's folder would call them.

    Parameters
    ----------
    runs
        At least one; one made in Python has no file of its own.
    recordings, inputs
        With what was recorded; with the tables of roads, speeds, forces and displacements. Run and vehicle files are always among them.
    also
        Further files that a result was made from.
    """
    found = list(also)
    for run in runs:
        if run.document.position is not None:
            found.append(Path(run.document.position.file))
        found += run.vehicle.files
        found += [run.folder / name for name in (_inputs(run) if inputs else [])]
        if recordings and run.file.recording is not None:
            found.append(run.folder / run.file.recording)
    return files_by_name(found, runs[0].folder)


def _inputs(run: Run) -> list[str]:
    """Return the tables that drive a run, as its file names them."""
    file = run.file
    tables: list[object] = [file.speed, *file.forces.values(), *file.displacements.values()]
    for road in file.road:
        tables += [road.profile, road.hump if road.hump is not None and road.hump.shape == "points" else None]
    return [name for table in tables if (name := getattr(table, "file", None)) is not None]
