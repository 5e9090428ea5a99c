"""Draw the page or the figures of a result again from its JSON file."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np

from vehgen.assess import Assessment
from vehgen.calibrate import CalibrationSummary, SensitivityIndices, SensorAdvice, Validation
from vehgen.diagnose import Diagnosis
from vehgen.diagnose.fleet import Fleet
from vehgen.diagnose.verdict import Verdict
from vehgen.errors import ArgumentError, InputError
from vehgen.files.results import Result, kind_of, read_json
from vehgen.fit.transmissibility_result import Transmissibility
from vehgen.mechanics import StaticLoads
from vehgen.phones import PhoneImport
from vehgen.report.pages.assessment_page import write_assessment
from vehgen.report.pages.build_page import redraw_build
from vehgen.report.pages.diagnosis_page import write_diagnosis_page
from vehgen.report.pages.fleet_page import write_fleet_page
from vehgen.report.plots.calibration_plots import save_calibration_figures
from vehgen.report.plots.road_response_plot import save_road_response_figures
from vehgen.report.plots.sensitivity_plots import save_sensitivity_figures
from vehgen.report.plots.transmissibility_plot import save_transmissibility_figures
from vehgen.report.plots.validation_plots import save_validation_figures
from vehgen.simulate import FrequencyResponse, Modes, Response, RoadResponse, StateSpace
from vehgen.simulate.build import Build

PAGES = (Diagnosis, Fleet, CalibrationSummary, Validation, SensitivityIndices, Transmissibility, RoadResponse, Assessment, Build)
"""Results with a page or several figures."""
SINGLE_FIGURES = (Modes, StaticLoads, Response, StateSpace, FrequencyResponse, SensorAdvice, PhoneImport, Verdict)
"""Results with one figure."""
RESULTS: dict[str, type[Result]] = {item.KIND: item for item in (*PAGES, *SINGLE_FIGURES)}
"""What a file can hold the result of."""


def read_result(path: str | os.PathLike[str]) -> Result:
    """Return the result that a JSON file holds: what a command wrote, or the JSON of a result's `to_dict()`.

    Raises
    ------
    InputError
        For a file that is damaged, or of no result of vehgen.
    """
    data = read_json(Path(path))
    return RESULTS[kind_of(data, str(path), tuple(RESULTS))].from_dict(data, str(path))


def report(result: Result | str | os.PathLike[str], folder: str | os.PathLike[str]) -> list[Path]:
    """Write the page or figures of a result into a folder, as the command that made it does.

    Parameters
    ----------
    result
        A diagnosis, fleet, calibration, validation, sensitivity, transmissibility, road response, assessment or build, or its JSON file.
    folder
        Where they go.

    Returns
    -------
    The files written.

    Raises
    ------
    InputError
        For a file that is damaged, numbers that no figure can show, and a result of one figure: that is drawn by `plot()`.
    """
    source = "the result" if isinstance(result, Result) else str(result)
    found = result if isinstance(result, Result) else read_result(result)
    if not isinstance(found, PAGES):
        kinds = ", ".join(item.KIND for item in PAGES)
        raise ArgumentError(f"{source} is of a {found.KIND}, which has no page (plot() draws it); results with pages: {kinds}", "result")
    try:
        with np.errstate(over="raise"):
            return _draw(found, Path(folder), source)
    except (ArithmeticError, LookupError, ValueError) as error:
        said = " ".join(str(error).split())[:200] or type(error).__name__
        raise InputError(f"{source}: its numbers cannot be drawn: {said}") from error


def _draw(result: Result, folder: Path, source: str) -> list[Path]:
    if isinstance(result, Diagnosis):
        page = folder / "report.html"
        write_diagnosis_page(result, page)
        return [page]
    if isinstance(result, Fleet):
        return [write_fleet_page(result, folder)]
    if isinstance(result, CalibrationSummary):
        return save_calibration_figures(result, folder)
    if isinstance(result, Validation):
        return save_validation_figures(result, folder)
    if isinstance(result, SensitivityIndices):
        return save_sensitivity_figures(result, folder)
    if isinstance(result, Transmissibility):
        return save_transmissibility_figures(result, folder)
    if isinstance(result, RoadResponse):
        return save_road_response_figures(result, folder)
    if isinstance(result, Assessment):
        return write_assessment(result, folder)
    assert isinstance(result, Build)
    return redraw_build(result, folder, source)
