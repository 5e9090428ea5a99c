"""Sensitivity indices over frequency, as the source paper's Fig. 5: a row a channel, a column a kind of parameter."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from matplotlib.figure import Figure

from vehgen.calibrate.sensitivity import SensitivityIndices
from vehgen.errors import InputError, shown
from vehgen.files.names import NAME_RULE, is_name
from vehgen.report.drawing.canvas import INK
from vehgen.report.figure_files import save_figure
from vehgen.report.plots.comparison import HIGHEST_SHOWN_HZ
from vehgen.report.plots.response_plot import COLOURS, STYLES

SENSITIVITY_DECADES = 6
"""What lies further below the largest index of a panel is cut off."""


def save_sensitivity_figures(found: SensitivityIndices, folder: Path) -> list[Path]:
    """Draw and save one figure a channel; returns their paths."""
    paths = sensitivity_figure_files(found.channels, folder)
    for j, path in enumerate(paths):
        save_figure(plot_sensitivities(found, j), path)
    return paths


def sensitivity_figure_files(channels: Iterable[str], folder: Path) -> list[Path]:
    """Return the files that :func:`save_sensitivity_figures` writes.

    Raises
    ------
    InputError
        For channels whose names can be no part of a file's, as a result's file from a stranger may have them.
    """
    names = list(channels)
    for name in names:
        if not is_name(name):
            raise InputError(f"the channel {shown(name)} cannot name a figure's file: {NAME_RULE}")
    return [folder / f"sensitivity_{name}.png" for name in names]


def plot_first_channel(found: SensitivityIndices) -> Figure:
    """Plot the first channel's indices."""
    return plot_sensitivities(found, 0)


def plot_sensitivities(found: SensitivityIndices, channel: int) -> Figure:
    """Plot a channel's indices times the squared parameter: the PSD of its change when the parameter doubles, to first order."""
    groups: dict[str, list[str]] = {}
    for name, kind in zip(found.names, found.kinds, strict=True):
        groups.setdefault(kind, []).append(name)
    rows = -(-len(groups) // 2)
    figure = Figure(figsize=(10.4, 0.5 + 2.6 * rows), layout="constrained")
    panels = list(figure.subplots(rows, 2, squeeze=False).ravel())
    inside = (found.frequency > 0) & (found.frequency <= HIGHEST_SHOWN_HZ)
    for axes, (kind, names) in zip(panels, groups.items(), strict=False):
        top = 0.0
        for count, name in enumerate(names):
            index = found.index[found.names.index(name), channel, inside] * found.values[found.names.index(name)] ** 2
            top = max(top, float(index.max()))
            style = STYLES[(count + count // len(COLOURS)) % len(STYLES)]
            axes.semilogy(found.frequency[inside], index, color=COLOURS[count % len(COLOURS)], linestyle=style, lw=1.2, label=name)
        if top > 0:
            axes.set_ylim(top * 10.0**-SENSITIVITY_DECADES, 3 * top)
        axes.set_xlim(0, HIGHEST_SHOWN_HZ)
        axes.set_title(kind, fontsize=9.5, loc="left", color=INK)
        axes.set_xlabel("frequency [Hz]", color=INK)
        axes.set_ylabel("index × parameter²", color=INK)
        axes.grid(color="#e3e7ea", lw=0.6)
        axes.spines[["top", "right"]].set_visible(False)
        axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False, fontsize=8.5)
    for axes in panels[len(groups) :]:
        axes.set_visible(False)
    figure.suptitle(f"sensitivity of {found.channels[channel]}", x=0.01, ha="left", fontsize=11, color=INK, parse_math=False)
    return figure
