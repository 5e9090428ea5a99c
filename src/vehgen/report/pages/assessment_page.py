"""The page of an assessed run: its tables by standard, and one figure."""

from __future__ import annotations

from importlib import resources
from pathlib import Path

from jinja2 import Environment, StrictUndefined
from markupsafe import Markup

from vehgen.assess import Assessment
from vehgen.assess.tables import NumberTable, assessment_tables
from vehgen.files import write_text
from vehgen.files.results import csv_text
from vehgen.report.figure_files import figure_svg, inline_svg, save_figure
from vehgen.report.plots.assessment_plot import plot_assessment


def write_assessment(found: Assessment, folder: Path) -> list[Path]:
    """Write the page, the table and the figure of an assessment; returns their paths."""
    page, table, picture = assessment_files(folder)
    figure = plot_assessment(found)
    write_text(page, assessment_page(found, assessment_tables(found), figure_svg(figure)))
    write_text(table, csv_text(found.table()))
    save_figure(figure, picture)
    return [page, table, picture]


def assessment_files(folder: Path) -> list[Path]:
    """Return the files that :func:`write_assessment` writes."""
    return [folder / "assessment.html", folder / "assessment.csv", folder / "assessment.png"]


def assessment_page(found: Assessment, tables: list[NumberTable], svg: str) -> str:
    """Return the page's text."""
    text = resources.files("vehgen.report").joinpath("templates/assessment.html.j2").read_text(encoding="utf-8")
    environment = Environment(autoescape=True, trim_blocks=True, lstrip_blocks=True, undefined=StrictUndefined)
    figure = Markup(inline_svg(svg, "assessment", "PSDs, shock response spectra, tyre loads and cycles"))
    return environment.from_string(text).render(found=found, tables=tables, figure=figure)
