"""The page of an assessed run: its tables by standard, and one figure."""

from __future__ import annotations

from pathlib import Path

from matplotlib.figure import Figure

from vehgen.assess import Assessment
from vehgen.assess.tables import NumberTable, assessment_tables
from vehgen.files import write_text
from vehgen.files.results import csv_text
from vehgen.report.curve_values import inline_figure
from vehgen.report.figure_files import save_figure
from vehgen.report.pages.assets import page_environment, template_text
from vehgen.report.plots.assessment_plot import plot_assessment


def write_assessment(found: Assessment, folder: Path) -> list[Path]:
    """Write the page, the table and the figure of an assessment; returns their paths."""
    page, table, picture = assessment_files(folder)
    figure = plot_assessment(found)
    write_text(page, assessment_page(found, assessment_tables(found), figure))
    write_text(table, csv_text(found.table()))
    save_figure(figure, picture)
    return [page, table, picture]


def assessment_files(folder: Path) -> list[Path]:
    """Return the files that :func:`write_assessment` writes."""
    return [folder / "assessment.html", folder / "assessment.csv", folder / "assessment.png"]


def assessment_page(found: Assessment, tables: list[NumberTable], figure: Figure) -> str:
    """Return the page's text."""
    text = template_text("assessment.html.j2")
    environment = page_environment()
    drawn = inline_figure(figure, "assessment", "PSDs, shock response spectra, tyre loads and cycles")
    return environment.from_string(text).render(found=found, tables=tables, figure=drawn)
