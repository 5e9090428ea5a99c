"""How is it shown? Drawings, figures, equations for reading, and pages."""

from typing import TYPE_CHECKING

from vehgen.late_imports import import_late

if TYPE_CHECKING:
    from vehgen.report.building import build
    from vehgen.report.drawing.mode_shapes import draw_modes
    from vehgen.report.drawing.vehicle import draw_vehicle
    from vehgen.report.equations.latex import equations_latex
    from vehgen.report.equations.writing import equations_mathml, equations_text
    from vehgen.report.figure_files import figure_format, figure_svg, save_figure
    from vehgen.report.pages.build_page import build_files, write_build_folder
    from vehgen.report.plots.response_plot import plot_response
    from vehgen.report.redraw import read_result, report

__all__ = [
    "build",
    "build_files",
    "draw_modes",
    "draw_vehicle",
    "equations_latex",
    "equations_mathml",
    "equations_text",
    "figure_format",
    "figure_svg",
    "plot_response",
    "read_result",
    "report",
    "save_figure",
    "write_build_folder",
]

import_late(
    __name__,
    {
        "vehgen.report.building": ("build",),
        "vehgen.report.drawing.mode_shapes": ("draw_modes",),
        "vehgen.report.drawing.vehicle": ("draw_vehicle",),
        "vehgen.report.equations.latex": ("equations_latex",),
        "vehgen.report.equations.writing": (
            "equations_mathml",
            "equations_text",
        ),
        "vehgen.report.figure_files": (
            "figure_format",
            "figure_svg",
            "save_figure",
        ),
        "vehgen.report.pages.build_page": (
            "build_files",
            "write_build_folder",
        ),
        "vehgen.report.plots.response_plot": ("plot_response",),
        "vehgen.report.redraw": (
            "read_result",
            "report",
        ),
    },
)
