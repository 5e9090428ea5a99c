"""Sensitivity indices over frequency, as the source paper's Fig. 5: a row a channel, a column a kind of parameter."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from matplotlib.figure import Figure

from vehgen.calibrate.sensitivity import SensitivityIndices
from vehgen.files.units import DAMPING, LENGTH, MASS, STIFFNESS
from vehgen.report.drawing.canvas import INK
from vehgen.report.figure_files import save_figure
from vehgen.report.plots.comparison import HIGHEST_SHOWN_HZ
from vehgen.report.plots.response_plot import COLOURS, STYLES
from vehgen.vehicle import Vehicle

SENSITIVITY_DECADES = 6
"""What lies further below the largest index of a panel is cut off."""


def save_sensitivity_figures(found: SensitivityIndices, vehicle: Vehicle, folder: Path) -> list[Path]:
    """Draw and save one figure a channel; returns their paths."""
    paths = sensitivity_figure_files(found.channels, folder)
    groups = group_parameters(found.names, vehicle)
    for j, path in enumerate(paths):
        save_figure(plot_sensitivities(found, j, groups), path)
    return paths


def sensitivity_figure_files(channels: Iterable[str], folder: Path) -> list[Path]:
    """Return the files that :func:`save_sensitivity_figures` writes."""
    return [folder / f"sensitivity_{channel}.png" for channel in channels]


def group_parameters(names: tuple[str, ...], vehicle: Vehicle) -> dict[str, list[str]]:
    """Return the parameters by kind: masses, suspension stiffnesses, tyre stiffnesses, dampings, distances, others."""
    tyres = {name for axle in vehicle.axles.values() for name in axle.tyre.k.names}
    kinds = {MASS: "masses", STIFFNESS: "suspension and link stiffnesses", DAMPING: "dampings", LENGTH: "distances"}
    found: dict[str, list[str]] = {}
    for name in names:
        kind = "tyre stiffnesses" if name in tyres else kinds.get(vehicle.dimensions[name], "inertias and others")
        found.setdefault(kind, []).append(name)
    return found


def plot_sensitivities(found: SensitivityIndices, channel: int, groups: dict[str, list[str]]) -> Figure:
    """Plot a channel's indices times the squared parameter: the PSD of its change when the parameter doubles, to first order."""
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
