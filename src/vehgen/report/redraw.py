"""Draw the page or the figures of a result again from its JSON file."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from vehgen.calibrate.result import CalibrationSummary
from vehgen.calibrate.sensitivity import SensitivityIndices
from vehgen.calibrate.validation import Validation
from vehgen.diagnose.result import Diagnosis
from vehgen.errors import InputError
from vehgen.files.results import Result, kind_of, read_json
from vehgen.report.pages.build_page import redraw_build
from vehgen.report.pages.diagnosis_page import write_diagnosis_page
from vehgen.report.plots.calibration_plots import save_calibration_figures
from vehgen.report.plots.sensitivity_plots import save_sensitivity_figures
from vehgen.report.plots.validation_plots import save_validation_figures
from vehgen.simulate.build import Build

RESULTS: dict[str, type[Result]] = {item.KIND: item for item in (Diagnosis, CalibrationSummary, Validation, SensitivityIndices, Build)}
"""What can be drawn again."""


def read_result(path: Path) -> Result:
    """Return the result that a JSON file holds.

    Raises
    ------
    InputError
        For a file that is damaged, or of no result with a page.
    """
    data = read_json(path)
    return RESULTS[kind_of(data, str(path), tuple(RESULTS))].from_dict(data, str(path))


def redraw(path: Path, folder: Path) -> list[Path]:
    """Write the page or figures of a result's JSON file into a folder, as the command that made it did; returns the files.

    Raises
    ------
    InputError
        For a file that is damaged, or whose numbers no figure can show.
    """
    result = read_result(path)
    try:
        with np.errstate(over="raise"):
            return _draw(result, folder, str(path))
    except (ArithmeticError, LookupError, ValueError) as error:
        said = " ".join(str(error).split())[:200] or type(error).__name__
        raise InputError(f"{path}: its numbers cannot be drawn: {said}") from error


def _draw(result: Result, folder: Path, source: str) -> list[Path]:
    if isinstance(result, Diagnosis):
        page = folder / "report.html"
        write_diagnosis_page(result, page)
        return [page]
    if isinstance(result, CalibrationSummary):
        return save_calibration_figures(result, folder)
    if isinstance(result, Validation):
        return save_validation_figures(result, folder)
    if isinstance(result, SensitivityIndices):
        return save_sensitivity_figures(result, folder)
    assert isinstance(result, Build)
    return redraw_build(result, folder, source)
