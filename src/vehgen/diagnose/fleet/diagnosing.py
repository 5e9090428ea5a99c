"""The diagnoses of a fleet: what is kept is taken, the rest goes wherever there is room, and every result is written as it comes."""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Iterable, Iterator, Sequence
from contextlib import closing, contextmanager
from dataclasses import asdict, dataclass, field
from pathlib import Path

from vehgen.diagnose.fleet.layout import LoadedVehicle, load_fleet_vehicle, vehicle_folders, writable
from vehgen.diagnose.fleet.result import NAMED_COLUMNS, Fleet, FleetRow
from vehgen.diagnose.fleet.work import FilesOf, FleetAnswer, FleetSettings, FleetWork, diagnose_work, internal_fault
from vehgen.diagnose.select.search import DiagnosisProgress
from vehgen.diagnose.writing import files_named_so
from vehgen.effects import effects_named
from vehgen.errors import ArgumentError, InputError
from vehgen.files import check_results, write_text
from vehgen.files.document import MAX_DOCUMENT_BYTES
from vehgen.files.provenance import versions
from vehgen.files.reading import read_text
from vehgen.files.results import MAX_RESULT_BYTES, csv_text, json_text
from vehgen.fit.parallel import Lost, Runner, runner_at
from vehgen.fit.processes import ProcessRunner
from vehgen.vehicle.writing import base_reference

FLEET_FILE, FLEET_TABLE = "fleet.json", "fleet.csv"
"""The results of all vehicles: what is kept for the next start, and the same as a table."""


def diagnose_fleet(
    fleet: str | os.PathLike[str],
    out: str | os.PathLike[str],
    *,
    files_of: FilesOf,
    effects: Sequence[str] | None = None,
    library: Iterable[str | os.PathLike[str]] = (),
    everywhere: bool = False,
    scheduler: str | None = None,
    processes: int | None = None,
    progress: DiagnosisProgress | None = None,
) -> Fleet:
    """Find what the model of every vehicle of a fleet lacks.

    Parameters
    ----------
    fleet
        A folder with a subfolder for every vehicle (see :mod:`vehgen.diagnose.fleet.layout`).
    out
        A folder outside of it for the results: a subfolder for every vehicle, and `fleet.json`, which is written again after each. Started
        again, a vehicle that is finished there is not diagnosed again unless its inputs, the settings or the version changed.
    files_of
        Makes the files of a diagnosis.
    effects, library, everywhere
        As those of :func:`vehgen.diagnose.diagnose`; effects by name.
    scheduler
        Address of a Dask cluster (default: processes on this machine). Its machines need vehgen, and no common folder.
    processes
        So many at once on this machine (default: one per core). They need `if __name__ == "__main__":` around a script's work.
    progress
        Called whenever a vehicle is done.

    Returns
    -------
    A row for every vehicle; what went wrong with one stands in its row. After Ctrl-C what was finished until then.

    Raises
    ------
    InputError
        For folders and settings that cannot be used, and a cluster that does not answer.
    """
    folder, target = Path(fleet), Path(out).absolute()
    if target.resolve().is_relative_to(folder.resolve()):
        raise ArgumentError(f"`out`: a folder outside of {folder} was expected; found {target}", "out")
    paths = [Path(path) for path in library]
    chosen = tuple(effect.name for effect in effects_named(effects, paths))
    texts = tuple(read_text(path, MAX_DOCUMENT_BYTES) for path in paths)
    settings = FleetSettings(chosen, texts, everywhere, files_of)
    folders = vehicle_folders(folder)
    names = [writable(path.name) for path in folders]
    check_results([target / FLEET_FILE, target / FLEET_TABLE])
    state = _State(writable(folder.resolve().name), target, settings, progress, {name: FleetRow(name) for name in names})
    try:
        with _runner(scheduler, processes) as runner, closing(runner.as_completed(diagnose_work, state.works(folders))) as answers:
            for work, answer in answers:
                state.take(work, answer)
    except KeyboardInterrupt:
        return state.write(stopped=True)
    return state.write()


@contextmanager
def _runner(scheduler: str | None, processes: int | None) -> Iterator[Runner]:
    if scheduler is None:
        with ProcessRunner(processes) as own:
            yield own
        return
    with runner_at(scheduler) as runner:
        yield runner


@dataclass
class _State:
    """The rows so far, and those of former starts."""

    fleet: str
    target: Path
    settings: FleetSettings
    progress: DiagnosisProgress | None
    rows: dict[str, FleetRow]
    kept: dict[str, FleetRow] = field(default_factory=dict)

    def works(self, folders: Sequence[Path]) -> Iterator[FleetWork]:
        """Yield the vehicles that must be diagnosed; those that are kept or cannot be read become rows before the first of them.

        Each is read twice, so that faults are told at once and no more vehicles are in memory than are diagnosed.
        """
        self.kept = _kept(self.target / FLEET_FILE)
        unfinished = [folder for folder in folders if self.waiting(folder) is not None]
        for folder in unfinished:
            work = self.waiting(folder)
            if work is not None:
                yield work

    def waiting(self, folder: Path) -> FleetWork | None:
        """Return a vehicle that must be diagnosed; one that is kept or cannot be read becomes a row, and None is returned."""
        try:
            work = self.work(folder)
        except InputError as error:
            self.fail(writable(folder.name), str(error))
            return None
        except Exception as error:  # a fault of one vehicle must not take the others' results with it
            self.fail(writable(folder.name), internal_fault(error))
            return None
        former = self.kept.get(work.name)
        if former is not None and former.fingerprint == work.fingerprint and (work.folder / "diagnosis.json").is_file():
            self.note(former)
            return None
        return work

    def work(self, folder: Path) -> FleetWork:
        """Read a vehicle; raises InputError where that, or writing its results, is not possible."""
        loaded = load_fleet_vehicle(folder)
        own = self.target / folder.name
        check_results([own / "diagnosis.json", own / "report.html", *files_named_so(loaded.vehicle.name, own)])
        extends = base_reference(loaded.vehicle, own)
        return FleetWork(folder.name, loaded.trials, own, extends, self.fingerprint(loaded, extends), loaded.inputs, self.settings)

    def take(self, work: FleetWork, answer: FleetAnswer | Lost) -> None:
        """Write what a worker sent, and note its row."""
        runs = tuple(trial.name for trial in work.trials)
        if isinstance(answer, Lost) or answer.verdict is None:
            told = answer.reason if isinstance(answer, Lost) else answer.error
            self.fail(work.name, told or "", runs)
            return
        try:
            for name, text in answer.files:
                write_text(work.folder / name, text)
        except InputError as error:
            self.fail(work.name, str(error), runs)
            return
        self.note(FleetRow(work.name, "finished", runs, answer.verdict, None, work.fingerprint, work.inputs))

    def fail(self, name: str, error: str, runs: tuple[str, ...] = ()) -> None:
        """Note what went wrong with a vehicle."""
        self.note(FleetRow(name, "failed", runs, error=writable(error)))

    def note(self, row: FleetRow) -> None:
        """Note a vehicle's row, and keep it for the next start."""
        self.rows[row.name] = row
        self.write()
        if self.progress is not None:
            done = sum(item.status != "waiting" for item in self.rows.values())
            self.progress("vehicles", done, len(self.rows), f"{row.name}: {row.found}")

    def write(self, stopped: bool = False) -> Fleet:
        """Write all rows and return them. What is kept of vehicles that were not reached stays in the file."""
        found = Fleet(self.fleet, tuple(self.rows.values()), versions(), stopped)
        rows = [self.kept.get(row.name, row) if row.status == "waiting" else row for row in found.rows]
        write_text(self.target / FLEET_FILE, json_text(Fleet(found.fleet, tuple(rows), found.made_by, stopped)))
        write_text(self.target / FLEET_TABLE, csv_text(found.table(), NAMED_COLUMNS))
        return found

    def fingerprint(self, loaded: LoadedVehicle, extends: str) -> str:
        """Return a hash of all that a vehicle's files depend on: inputs, settings, versions, and what they call the base vehicle."""
        settings = {key: value for key, value in asdict(self.settings).items() if key != "files_of"}
        data = json.dumps([loaded.inputs, settings, versions(), extends], sort_keys=True)
        return hashlib.sha256(data.encode()).hexdigest()


def _kept(path: Path) -> dict[str, FleetRow]:
    """Return the finished rows of former starts; none where there is no file, or one that cannot be used."""
    try:
        data = json.loads(read_text(path, MAX_RESULT_BYTES, "the JSON file of a result", state=True))
        rows = Fleet.from_dict(data, str(path)).rows
    except (InputError, ValueError, RecursionError):
        return {}
    return {row.name: row for row in rows if row.status == "finished"}
