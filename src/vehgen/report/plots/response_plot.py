"""A response over time, one panel for each kind of quantity."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from vehgen.report.drawing.canvas import INK

COLOURS = ("#0b5fa5", "#d55e00", "#1b9e77", "#7b3294", "#555555", "#b8860b")
STYLES = ("-", (0, (5, 1.5)), (0, (6, 1.5, 1, 1.5)), (0, (1.5, 1)))
"""Colours differ in lightness too; the line style differs as well, for those who print in grey."""


def curve_style(number: int) -> dict[str, Any]:
    """Return colour, line style and width of one of many curves: after all line styles they come again, thicker, so that grey tells all."""
    return {
        "color": COLOURS[number % len(COLOURS)],
        "linestyle": STYLES[number % len(STYLES)],
        "lw": 1.1 + 0.9 * (number // len(STYLES) % 3),
    }


def legend_beside(axes: Axes, rows: int) -> None:
    """Put the legend of named curves to the right of their axes, in columns of at most so many rows; names are plain text."""
    count = len(axes.get_legend_handles_labels()[1])
    legend = axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False, fontsize=8.5, ncols=-(-count // rows))
    for text in legend.get_texts():
        text.set_parse_math(False)


def set_frequency_axes(figure: Figure) -> None:
    """Give all panels a logarithmic axis of frequencies and a faint grid."""
    for axes in figure.axes:
        axes.set_xscale("log")
        axes.grid(color="#e3e7ea", lw=0.6)
        axes.set_axisbelow(True)
        axes.spines[["top", "right"]].set_visible(False)
        axes.margins(x=0)


def plot_response(
    time: NDArray[np.float64], channels: Sequence[tuple[str, str, str]], values: NDArray[np.float64], title: str = ""
) -> Figure:
    """Plot channels (name, quantity, unit) with `values shape (n_samples, n_channels)` over `time shape (n_samples,)` [s].

    Raises
    ------
    ValueError
        When the shapes do not belong together.
    """
    if values.shape != (needed := (len(time), len(channels))):
        raise ValueError(f"values have the shape {values.shape}; that many times and channels need {needed}")
    kinds = list(dict.fromkeys((quantity, unit) for _, quantity, unit in channels))
    figure = Figure(figsize=(10.0, 0.9 + 2.0 * max(len(kinds), 1)), layout="constrained")
    panels = figure.subplots(max(len(kinds), 1), 1, sharex=True, squeeze=False)[:, 0]
    for axes, (quantity, unit) in zip(panels, kinds, strict=False):
        members = [i for i, channel in enumerate(channels) if channel[1:] == (quantity, unit)]
        for count, i in enumerate(members):
            style = STYLES[(count + count // len(COLOURS)) % len(STYLES)]
            axes.plot(time, values[:, i], color=COLOURS[count % len(COLOURS)], linestyle=style, lw=1.1, label=_label(channels[i][0]))
        axes.axhline(0.0, color="#c3ccd3", lw=0.7, zorder=0)
        axes.set_ylabel(f"{quantity.replace('_', ' ')}\n[{unit}]", color=INK, parse_math=False)
        axes.grid(color="#e3e7ea", lw=0.6)
        axes.spines[["top", "right"]].set_visible(False)
        legend_beside(axes, rows=10)
        axes.margins(x=0)
    panels[-1].set_xlabel("time [s]", color=INK)
    figure.align_ylabels()
    if title:
        figure.suptitle(title, x=0.01, ha="left", fontsize=11, color=INK, parse_math=False)
    return figure


def _label(name: str) -> str:
    """Return a channel's name for the legend, which would leave out one that begins with an underscore."""
    return f" {name}" if name.startswith("_") else name
