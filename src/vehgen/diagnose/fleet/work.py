"""One vehicle of a fleet as a piece of work that can travel: what a worker needs, does, and sends back."""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from vehgen.diagnose.pipeline import diagnose_trials
from vehgen.diagnose.result import Diagnosis
from vehgen.diagnose.verdict import Verdict
from vehgen.effects import effects_named
from vehgen.errors import InputError
from vehgen.fit.trial import Trial

FilesOf = Callable[[Diagnosis, Path, str | None], tuple[Diagnosis, dict[str, str]]]
"""Returns a diagnosis that names its vehicle file, and the texts of its files by name, from the folder they will stand in and what they
call the base vehicle. Workers import it, so that it must be a function of a module."""


@dataclass(frozen=True)
class FleetSettings:
    """How the vehicles of a fleet are diagnosed.

    `effects` are names; `libraries` the texts of files of own effects; `everywhere` tries every effect at every
    place.
    """

    effects: tuple[str, ...]
    libraries: tuple[str, ...]
    everywhere: bool
    files_of: FilesOf


@dataclass(frozen=True)
class FleetWork:
    """A vehicle of a fleet to be diagnosed; `folder` is where its files will stand, `extends` how these call its vehicle file."""

    name: str
    trials: tuple[Trial, ...]
    folder: Path
    extends: str
    fingerprint: str
    inputs: tuple[tuple[str, str], ...]
    settings: FleetSettings


@dataclass(frozen=True)
class FleetAnswer:
    """What a worker sends back: the verdict and the texts of all files by name, or what went wrong, in one line."""

    verdict: Verdict | None = None
    files: tuple[tuple[str, str], ...] = ()
    error: str | None = None


def diagnose_work(work: FleetWork) -> FleetAnswer:
    """Diagnose one vehicle; whatever goes wrong with it is told in the answer, so that it stops no other.

    Ctrl-C is passed on: half a diagnosis is none.
    """
    try:
        found = _diagnose(work)
        if found.stopped:
            raise KeyboardInterrupt
        found, files = work.settings.files_of(found, work.folder, work.extends)
    except InputError as error:
        return FleetAnswer(error=str(error))
    except Exception as error:  # a fault of one vehicle must not take the others' results with it
        return FleetAnswer(error=internal_fault(error))
    return FleetAnswer(found.verdict, tuple(files.items()))


def internal_fault(error: Exception) -> str:
    """Return what a row tells of an error that is no fault of the user, in one line."""
    return f"internal fault: {type(error).__name__}: {' '.join(str(error).split())} (please report it)"


def _diagnose(work: FleetWork) -> Diagnosis:
    settings = work.settings
    with tempfile.TemporaryDirectory(prefix="vehgen_effects_") as folder:
        paths = [Path(folder) / f"library{number}.yaml" for number in range(len(settings.libraries))]
        for path, text in zip(paths, settings.libraries, strict=True):
            path.write_text(text, encoding="utf-8")
        effects = effects_named(settings.effects, paths)
    return diagnose_trials(work.trials, effects, settings.everywhere)
