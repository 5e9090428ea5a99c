"""What a diagnosis was made from: files with their hashes, versions, date, and the vehicle's data."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import UTC, datetime
from pathlib import Path

from vehgen.diagnose.evidence import Origin
from vehgen.files.provenance import file_hashes, versions
from vehgen.fit.trial import Trial
from vehgen.simulate.run_file.files_read import files_read
from vehgen.vehicle.writing import plain_data


def origin_of(trials: Sequence[Trial], libraries: Sequence[str] = ()) -> Origin:
    """Return the origin of a diagnosis of these runs, with files of own effects, without the command that asked for it."""
    vehicle = trials[0].run.vehicle
    return Origin(
        command="",
        made_on=datetime.now(UTC).isoformat(sep=" ", timespec="seconds"),
        inputs=file_hashes(files_read([trial.run for trial in trials], also=[Path(name) for name in libraries])),
        versions=versions(),
        vehicle=plain_data(vehicle),
        values=vehicle.values(),
    )
