"""Measured beside simulated: PSDs and time histories, a panel a channel."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import NullLocator

from vehgen.measure.curves import ChannelCurves
from vehgen.mechanics.quantities import QUANTITIES
from vehgen.report.drawing.canvas import INK

MEASURED = "#9aa7b1"
SIMULATED = "#0b5fa5"
REFERENCE_COLOUR = "#d55e00"
QUANTITY_UNITS = {name: unit.replace("^2", "²") for name, unit in QUANTITIES.items()}
HIGHEST_SHOWN_HZ = 25.0
"""Frequencies shown [Hz]."""
LABELS = ("measured", "simulated")
LOUD_OVER_MEDIAN, LOUD_SHARES = 5.0, (0.02, 0.2)
"""A history is loud at so many times its median, as most of a run over a hump is quiet, but between these shares of its peak."""
PSD_DECADES = 5
"""What lies further below the peak of a PSD is cut off."""


def plot_psds(
    curves: Sequence[ChannelCurves],
    band: tuple[float, float],
    reference: tuple[str, ChannelCurves] | None = None,
    labels: tuple[str, str] = LABELS,
) -> Figure:
    """Plot PSDs on a logarithmic scale, measured broad and grey, simulated thin and blue.

    Parameters
    ----------
    curves
        One a panel; `x` is frequency [Hz].
    band
        Frequencies shown [Hz].
    reference
        A further PSD for the panels of accelerations, with its name.
    labels
        What the two curves are called.
    """
    figure, panels = _grid(len(curves))
    for axes, curve in zip(panels, curves, strict=False):
        inside = (curve.x >= band[0]) & (curve.x <= band[1])
        axes.semilogy(curve.x[inside], curve.measured[inside], color=MEASURED, lw=2.4, label=labels[0])
        axes.semilogy(curve.x[inside], curve.simulated[inside], color=SIMULATED, lw=1.1, label=labels[1])
        top = max(curve.measured[inside].max(), curve.simulated[inside].max())
        if reference is not None and curve.quantity == "acceleration":
            top = max(top, float(np.nanmax(reference[1].measured)))
            axes.semilogy(reference[1].x, reference[1].measured, color=REFERENCE_COLOUR, lw=1.1, ls=(0, (4, 2)), label=reference[0])
        axes.set_ylim(top * 10.0**-PSD_DECADES, 3 * top)
        axes.yaxis.set_minor_locator(NullLocator())  # each tick costs time
        axes.set_xlim(*band)
        unit = QUANTITY_UNITS.get(curve.quantity, "")
        axes.set_ylabel(f"PSD [({unit})²/Hz]", color=INK)
        axes.set_xlabel("frequency [Hz]", color=INK)
        _finish(axes, curve)
    _legend(figure, panels)
    return figure


def plot_histories(curves: Sequence[ChannelCurves], labels: tuple[str, str] = LABELS) -> Figure:
    """Plot time histories; `x` is time [s]."""
    figure, panels = _grid(len(curves))
    for axes, curve in zip(panels, curves, strict=False):
        axes.plot(curve.x, curve.measured, color=MEASURED, lw=2.2, label=labels[0])
        axes.plot(curve.x, curve.simulated, color=SIMULATED, lw=0.9, label=labels[1])
        axes.set_xlim(*busy([item for item in curves if item.run == curve.run]))
        axes.set_ylabel(f"{curve.quantity.replace('_', ' ')} [{QUANTITY_UNITS.get(curve.quantity, '')}]", color=INK, parse_math=False)
        axes.set_xlabel("time [s]", color=INK)
        _finish(axes, curve)
    _legend(figure, panels)
    return figure


def busy(curves: Sequence[ChannelCurves]) -> tuple[float, float]:
    """Return the part of a run's time in which any channel shows more than its noise, half a second around it."""
    first, last = [], []
    for curve in curves:
        size = np.abs(curve.measured)
        low, high = (share * size.max(initial=0.0) for share in LOUD_SHARES)
        loud = np.flatnonzero(size > np.clip(LOUD_OVER_MEDIAN * np.median(size), low, high))
        ends = (loud[0], loud[-1]) if len(loud) else (0, -1)
        first.append(max(float(curve.x[0]), float(curve.x[ends[0]]) - 0.5))
        last.append(min(float(curve.x[-1]), float(curve.x[ends[1]]) + 0.5))
    return min(first), max(last)


def _grid(count: int) -> tuple[Figure, list[Axes]]:
    columns = 2 if count > 1 else 1
    rows = -(-count // columns)
    figure = Figure(figsize=(5.2 * columns, 0.5 + 2.5 * rows), layout="constrained")
    panels = list(figure.subplots(rows, columns, squeeze=False).ravel())
    for axes in panels[count:]:
        axes.set_visible(False)
    return figure, panels[:count]


def _finish(axes: Axes, curve: ChannelCurves) -> None:
    axes.set_title(f"{curve.run}: {curve.channel}", fontsize=9.5, loc="left", color=INK, parse_math=False)
    axes.grid(color="#e3e7ea", lw=0.6)
    axes.spines[["top", "right"]].set_visible(False)


def _legend(figure: Figure, panels: Sequence[Axes]) -> None:
    handles, labels = max((axes.get_legend_handles_labels() for axes in panels), key=lambda pair: len(pair[0]))
    figure.legend(handles, labels, loc="outside upper right", ncols=len(labels), frameon=False, fontsize=9)
