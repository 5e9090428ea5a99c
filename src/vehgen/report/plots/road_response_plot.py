"""Responses to a rough road for the eye: a row for each kind of output, with amplitude, phase and PSD."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from vehgen.report.drawing.canvas import INK
from vehgen.report.figure_files import save_figure
from vehgen.report.plots.response_plot import curve_style, legend_beside, set_frequency_axes
from vehgen.simulate.road_response import RoadResponse

DECADES_SHOWN = 5
"""PSDs are drawn so far below their largest value."""

PHASES_SHOWN = (-900, 180)
"""Phases are drawn without jumps, in degrees, as far as this: what rear axles do comes ever more turns later."""


def save_road_response_figures(found: RoadResponse, folder: Path) -> list[Path]:
    """Draw and save the figure; returns its path in a list."""
    paths = road_response_figure_files(folder)
    save_figure(plot_road_response(found), paths[0])
    return paths


def road_response_figure_files(folder: Path) -> list[Path]:
    """Return the files that :func:`save_road_response_figures` writes."""
    return [folder / "response.png"]


def plot_road_response(found: RoadResponse) -> Figure:
    """Draw amplitude and phase over the road, and the PSD on it, of every output: a row a group."""
    groups = list(dict.fromkeys(item.group for item in found.outputs))
    figure = Figure(figsize=(13.0, 0.9 + 2.3 * len(groups)), layout="constrained")
    panels = figure.subplots(len(groups), 3, sharex=True, squeeze=False)
    for row, group in zip(panels, groups, strict=True):
        _plot_group(row.tolist(), found, group)
    for axes in panels[-1]:
        axes.set_xlabel("frequency [Hz]", color=INK)
    set_frequency_axes(figure)
    title = f"{found.title}: one road of class {found.roughness} (ISO 8608) under all wheels at {found.speed:g} m/s"
    figure.suptitle(title, x=0.01, ha="left", fontsize=11, color=INK, parse_math=False)
    return figure


def _plot_group(row: list[Axes], found: RoadResponse, group: str) -> None:
    amplitude, phase, psd = row
    members = [i for i, item in enumerate(found.outputs) if item.group == group]
    unit = found.outputs[members[0]].unit
    for count, i in enumerate(members):
        item = found.outputs[i]
        style = curve_style(count)
        amplitude.semilogy(found.frequency, found.amplitude[i], **style)
        phase.plot(found.frequency, np.degrees(np.unwrap(np.radians(found.phase[i]))), **style)
        psd.semilogy(found.frequency, found.psd[i], label=f" {item.name}: {item.rms:.3g} {unit} rms", **style)
    amplitude.set_ylabel(f"{group}\n|H| [{unit}/m]", color=INK, parse_math=False)
    phase.set_ylabel("phase [deg]", color=INK)
    phase.set_ylim(*PHASES_SHOWN)
    phase.set_yticks(range(PHASES_SHOWN[0], PHASES_SHOWN[1] + 1, 180))
    psd.set_ylabel(f"PSD [({unit})^2/Hz]", color=INK, parse_math=False)
    largest = float(found.psd[members].max())
    if largest > 0:
        psd.set_ylim(largest * 10.0**-DECADES_SHOWN, largest * 2.0)
    legend_beside(psd, rows=12)
