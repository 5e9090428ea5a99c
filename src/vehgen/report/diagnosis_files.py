"""The files of a diagnosis: its result, its report, and the vehicle with what was found."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from vehgen.diagnose import Diagnosis
from vehgen.diagnose.writing import effect_file, file_name
from vehgen.files.results import json_text
from vehgen.report.pages.diagnosis_page import diagnosis_page

DIAGNOSIS_PAGE = "report.html"


def diagnosis_files(found: Diagnosis, folder: Path, extends: str | None = None) -> tuple[Diagnosis, dict[str, str]]:
    """Return what :func:`result_files` does, and the report with its figures, which takes seconds."""
    found, texts = result_files(found, folder, extends)
    return found, {**texts, DIAGNOSIS_PAGE: diagnosis_page(found)}


def result_files(found: Diagnosis, folder: Path, extends: str | None = None) -> tuple[Diagnosis, dict[str, str]]:
    """Return a diagnosis that names its vehicle file, and the texts of its result and of that file by their names.

    Parameters
    ----------
    found
        A diagnosis with its fitted models.
    folder
        Where the files will stand; nothing is written.
    extends
        What the vehicle file calls the base vehicle (default: as it is found from the folder on this machine).

    Raises
    ------
    InputError
        For a diagnosis that was read from a file.
    """
    vehicles: dict[str, str] = {}
    if found.chosen:
        base = found.detection.problem
        name = file_name(base.trials[0].run.vehicle.name, found.chosen[-1])
        vehicles[f"{name}.yaml"] = effect_file(found.chosen[-1], base, found.verdict, folder, name, extends)
        found = replace(found, verdict=replace(found.verdict, vehicle_file=str(folder / f"{name}.yaml")))
    return found, {"diagnosis.json": json_text(found), **vehicles}
