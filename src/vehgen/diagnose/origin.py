"""What a diagnosis was made from: files with their hashes, versions, date, and the vehicle's data."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import UTC, datetime
from pathlib import Path

from vehgen.diagnose.evidence import Origin
from vehgen.files.provenance import file_hashes, versions
from vehgen.fit.trial import Trial
from vehgen.vehicle.writing import plain_data


def origin_of(trials: Sequence[Trial]) -> Origin:
    """Return the origin of a diagnosis of these runs, without the command that asked for it."""
    vehicle = trials[0].run.vehicle
    paths = [*vehicle.files, *(path for trial in trials for path in _files(trial))]
    return Origin(
        command="",
        made_on=datetime.now(UTC).isoformat(sep=" ", timespec="seconds"),
        inputs=file_hashes(dict.fromkeys(paths)),
        versions=versions(),
        vehicle=plain_data(vehicle),
        values=vehicle.values(),
    )


def _files(trial: Trial) -> list[Path]:
    """Return the files of a run: its own, its recording and its measured roads."""
    run = trial.run
    named = [run.file.recording, *(entry.profile.file for entry in run.file.road if entry.profile is not None)]
    own = run.document.position.file if run.document.position else None
    return [*([own] if isinstance(own, Path) else []), *(run.folder / name for name in named if name)]
