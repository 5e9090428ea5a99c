"""How much of a road reaches bodies, axles and tyres, for the eye: a panel for each kind of output."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import NullFormatter, StrMethodFormatter

from vehgen.report.drawing.canvas import INK
from vehgen.report.plots.response_plot import curve_style, legend_beside, set_frequency_axes
from vehgen.simulate.road_amplitudes import RoadAmplitude, RoadAmplitudes

FREQUENCY_TICKS_HZ = (0.2, 0.5, 1, 2, 5, 10, 20, 30)
AMPLITUDE_RANGE = 1e-3
"""Curves are drawn at most so far below the largest of their panel."""
SHOWN_UNITS = {"N/m": (1e-6, "kN/mm")}
"""What units are shown as, with the factor."""


def shown_amplitude(item: RoadAmplitude) -> tuple[float, str]:
    """Return the factor and the unit that amplitudes are shown in."""
    return SHOWN_UNITS.get(item.unit, (1.0, item.unit))


def plot_road_amplitudes(found: RoadAmplitudes) -> Figure:
    """Draw |H| of every output over frequency, its peak marked: a panel a group."""
    groups = found.groups()
    figure = Figure(figsize=(10.0, 0.9 + 2.3 * len(groups)), layout="constrained")
    panels = figure.subplots(len(groups), 1, sharex=True, squeeze=False)[:, 0]
    for axes, (group, items) in zip(panels, groups.items(), strict=True):
        factor, unit = shown_amplitude(items[0])
        for count, item in enumerate(items):
            style = curve_style(count)
            axes.semilogy(found.frequency, factor * item.amplitude, label=f" {item.name}", **style)
            if item.peak is not None:
                axes.plot(item.peak[0], factor * item.peak[1], "o", color=style["color"], ms=4, label="_peak")
        axes.set_ylabel(f"{group}\n|H| [{unit}]", color=INK, parse_math=False)
        heights = factor * np.concatenate([[*item.amplitude, *(item.peak or ())[1:]] for item in items])
        if (largest := float(heights.max())) > 0:
            axes.set_ylim(max(largest * AMPLITUDE_RANGE, float(heights.min()) / 2.0), largest * 2.0)
        axes.yaxis.set_major_formatter(StrMethodFormatter("{x:g}"))
        axes.yaxis.set_minor_formatter(NullFormatter())
        legend_beside(axes, rows=10)
    set_frequency_axes(figure)
    panels[-1].set_xticks(FREQUENCY_TICKS_HZ, [f"{tick:g}" for tick in FREQUENCY_TICKS_HZ])
    panels[-1].set_xlim(found.frequency[0], found.frequency[-1])
    panels[-1].xaxis.set_minor_formatter(NullFormatter())
    panels[-1].set_xlabel("frequency [Hz]", color=INK)
    figure.align_ylabels()
    figure.suptitle(f"one road under all wheels at {found.speed:g} m/s", x=0.01, ha="left", fontsize=11, color=INK)
    return figure
