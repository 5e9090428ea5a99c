"""Figures as files are those of matplotlib's own `savefig`, and the figure is left as it was."""

from __future__ import annotations

import io
from pathlib import Path

import matplotlib as mpl
import pytest
from matplotlib.figure import Figure

from vehgen.report.figure_files import figure_svg, save_figure

NO_DATES = {"png": {}, "svg": {"metadata": {"Date": None}}, "pdf": {"metadata": {"CreationDate": None}}}


def figure() -> Figure:
    """Two panels beside each other, laid out around their labels."""
    made = Figure(figsize=(5.0, 2.5), layout="constrained")
    for axes in made.subplots(1, 2):
        axes.semilogy([1.0, 2.0, 3.0], [1.0, 100.0, 3.0], label="line")
        axes.set_ylabel("a label that needs its place")
    made.legend(loc="outside upper right")
    return made


@pytest.mark.parametrize("kind", NO_DATES)
def test_a_figure_is_drawn_as_by_matplotlib_itself(kind: str, tmp_path: Path) -> None:
    expected, drawn = io.BytesIO(), figure()
    with mpl.rc_context({"svg.hashsalt": "vehgen", "svg.fonttype": "path"}):
        figure().savefig(expected, format=kind, dpi=150, **NO_DATES[kind])
    canvas, dpi = drawn.canvas, drawn.dpi
    path = tmp_path / f"figure.{kind}"
    save_figure(drawn, path)
    assert path.read_bytes() == expected.getvalue()
    assert (drawn.canvas, drawn.dpi) == (canvas, dpi)
    if kind == "svg":
        assert figure_svg(figure()).encode() == expected.getvalue()
