"""Show me: drawings, figures, equations for reading, and the page."""

from vehgen.report.drawing import draw_vehicle
from vehgen.report.equations import equations_mathml, equations_text
from vehgen.report.files import figure_format, figure_svg, save_figure
from vehgen.report.latex import equations_latex
from vehgen.report.mode_shapes import draw_modes
from vehgen.report.page import build_files, write_build_folder
from vehgen.report.response_plot import plot_response

__all__ = [
    "build_files",
    "draw_modes",
    "draw_vehicle",
    "equations_latex",
    "equations_mathml",
    "equations_text",
    "figure_format",
    "figure_svg",
    "plot_response",
    "save_figure",
    "write_build_folder",
]
