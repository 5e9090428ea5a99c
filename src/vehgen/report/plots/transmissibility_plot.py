"""Transmissibilities for the eye: the channels' spectra with the peaks that all share, and every ratio with its limits and the model's."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from vehgen.fit.transmissibility_result import ChannelRatio, Transmissibility
from vehgen.report.drawing.canvas import INK
from vehgen.report.figure_files import save_figure
from vehgen.report.plots.response_plot import COLOURS, STYLES

LIMITS_COLOUR, MODEL_COLOUR, APART_COLOUR = "#b9c7d3", "#a63603", "#f6e3d3"
MAX_RATIOS_SHOWN = 8
"""More channels make no figure that one reads; the others stand in the JSON file."""


def save_transmissibility_figures(found: Transmissibility, folder: Path) -> list[Path]:
    """Draw and save the figure; returns its path in a list."""
    paths = transmissibility_figure_files(folder)
    save_figure(plot_transmissibility(found), paths[0])
    return paths


def transmissibility_figure_files(folder: Path) -> list[Path]:
    """Return the files that :func:`save_transmissibility_figures` writes."""
    return [folder / "transmissibility.png"]


def plot_transmissibility(found: Transmissibility) -> Figure:
    """Draw the spectra above, then a row a ratio: its magnitude at the left, its coherence at the right."""
    shown = found.ratios[:MAX_RATIOS_SHOWN]
    figure = Figure(figsize=(10.5, 2.9 + 2.5 * len(shown)), layout="constrained")
    grid = figure.add_gridspec(1 + len(shown), 2, width_ratios=(3, 1))
    spectra = figure.add_subplot(grid[0, :])
    _plot_spectra(spectra, found)
    for row, item in enumerate(shown, start=1):
        ratio = figure.add_subplot(grid[row, 0], sharex=spectra)
        _plot_ratio(ratio, found, item)
        coherence = figure.add_subplot(grid[row, 1])
        coherence.xaxis.set_major_locator(MaxNLocator(4))
        coherence.plot(found.frequency, item.coherence, color=INK, lw=1.0)
        coherence.set_ylim(0.0, 1.03)
        coherence.set_ylabel("coherence [-]", color=INK)
        if row == 1:
            ratio.legend(loc="best", fontsize=8, frameon=False)
        if row == len(shown):
            for axes in (ratio, coherence):
                axes.set_xlabel("frequency [Hz]", color=INK)
    for axes in figure.axes:
        axes.grid(color="#e3e7ea", lw=0.6)
        axes.set_axisbelow(True)
        axes.spines[["top", "right"]].set_visible(False)
        axes.margins(x=0)
    figure.suptitle(found.title, x=0.01, ha="left", fontsize=11, color=INK, parse_math=False)
    return figure


def _plot_spectra(axes: Axes, found: Transmissibility) -> None:
    for i, (name, density) in enumerate(zip(found.channels, found.densities.T, strict=True)):
        style = {"color": COLOURS[i % len(COLOURS)], "linestyle": STYLES[i % len(STYLES)]}
        axes.semilogy(found.frequency, density / density.mean(), lw=1.1, label=f" {name}", **style)
    for i, peak in enumerate(found.resonances):
        label = "peak that all share" if i == 0 else None
        axes.axvline(peak.frequency, color="#555555", lw=0.9, ls=(0, (4, 2, 1, 2)), label=label)
        axes.annotate(f" {peak.frequency:.1f}", (peak.frequency, 1.0), xycoords=("data", "axes fraction"), va="top", fontsize=8, color=INK)
    axes.set_ylabel("PSD over its mean [-]", color=INK)
    for text in axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False, fontsize=8.5).get_texts():
        text.set_parse_math(False)


def _plot_ratio(axes: Axes, found: Transmissibility, item: ChannelRatio) -> None:
    common = item.common > 0
    lower, upper, middle = (np.where(common, values, np.nan) for values in (item.lower, item.upper, np.sqrt(item.h1 * item.h2)))
    for band in item.bands:
        if band.is_apart:
            axes.axvspan(band.low, band.high, color=APART_COLOUR, lw=0)
            place = ((band.low + band.high) / 2, 0.99)
            text = f"apart\n{band.distance:.1f} s.e."
            axes.annotate(text, place, xycoords=("data", "axes fraction"), ha="center", va="top", fontsize=7.5, color=INK)
    axes.fill_between(found.frequency, lower, upper, color=LIMITS_COLOUR, lw=0, label="measured, 95 % limits")
    axes.semilogy(found.frequency, middle, color=INK, lw=1.0, label="measured")
    if item.model_h1 is not None and item.model_h2 is not None:
        model = np.sqrt(item.model_h1 * item.model_h2)
        axes.semilogy(found.frequency, model, color=MODEL_COLOUR, lw=1.3, ls=(0, (5, 1.5)), label="model")
    axes.set_yscale("log")
    axes.margins(y=0.2)
    axes.set_ylabel(f"{item.channel} / {found.reference}\n[{item.unit}]", color=INK, parse_math=False)
