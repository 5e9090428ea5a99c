"""Figures of a validation, as the source paper's Figs. 16 to 18: PSDs and band RMS, measured beside simulated."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from vehgen.calibrate.validation import Validation
from vehgen.measure.curves import ChannelCurves
from vehgen.report.drawing.canvas import INK
from vehgen.report.figure_files import save_figure
from vehgen.report.plots.comparison import HIGHEST_SHOWN_HZ, MEASURED, QUANTITY_UNITS, SIMULATED, plot_histories, plot_psds


def save_validation_figures(validation: Validation, folder: Path) -> list[Path]:
    """Draw and save PSDs, histories and band RMS; returns their paths."""
    histories = plot_histories([item.histories for item in validation.channels])
    paths = validation_figure_files(folder)
    for path, figure in zip(paths, (plot_validation(validation), histories, plot_band_rms(validation)), strict=True):
        save_figure(figure, path)
    return paths


def validation_figure_files(folder: Path) -> list[Path]:
    """Return the files that :func:`save_validation_figures` writes."""
    return [folder / f"validation_{what}.png" for what in ("psd", "histories", "bands")]


def plot_validation(validation: Validation) -> Figure:
    """Plot the PSDs of every channel, measured beside simulated, with the reference spectrum where there is one."""
    reference = None
    if (known := validation.reference) is not None:
        reference = known.name, ChannelCurves("", known.name, "acceleration", known.frequency, known.psd, known.psd)
    return plot_psds([item.psds for item in validation.channels], (0.3, HIGHEST_SHOWN_HZ), reference)


def plot_band_rms(validation: Validation) -> Figure:
    """Plot the band RMS of every channel as pairs of bars, the relative error in percent above each."""
    count = len(validation.channels)
    columns = 2 if count > 1 else 1
    rows = -(-count // columns)
    figure = Figure(figsize=(5.2 * columns, 0.5 + 2.5 * rows), layout="constrained")
    panels = list(figure.subplots(rows, columns, squeeze=False).ravel())
    place = np.arange(len(validation.bands))
    for axes, item in zip(panels, validation.channels, strict=False):
        axes.bar(place - 0.2, item.measured_rms, 0.38, color=MEASURED, label="measured")
        axes.bar(place + 0.2, item.simulated_rms, 0.38, color=SIMULATED, label="simulated")
        top = max(item.measured_rms.max(), item.simulated_rms.max())
        pairs = zip(item.measured_rms, item.simulated_rms, item.errors, item.audible, strict=True)
        for x, (measured, simulated, error, audible) in enumerate(pairs):
            text = (f"{number:+d} %" if (number := round(100 * error)) else "0 %") if audible else "noise"
            axes.text(x, max(measured, simulated) + 0.02 * top, text, ha="center", fontsize=8.5, color=INK)
        axes.set_ylim(0, 1.15 * top)
        axes.set_xticks(place, [f"{low:g}-{high:g}" for low, high in validation.bands])
        axes.set_xlabel("band [Hz]", color=INK)
        axes.set_ylabel(f"rms [{QUANTITY_UNITS.get(item.quantity, '')}]", color=INK)
        axes.set_title(f"{item.run}: {item.channel}", fontsize=9.5, loc="left", color=INK, parse_math=False)
        axes.spines[["top", "right"]].set_visible(False)
    for axes in panels[count:]:
        axes.set_visible(False)
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper right", ncols=2, frameon=False, fontsize=9)
    return figure
