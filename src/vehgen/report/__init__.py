"""How is it shown? Drawings, figures, equations for reading, and pages."""

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
