"""The figure of a fleet: how far every vehicle's model is from what was measured, before and after what was found."""

from __future__ import annotations

from matplotlib.figure import Figure

from vehgen.diagnose.fleet import Fleet
from vehgen.report.drawing.canvas import INK
from vehgen.report.plots.comparison import MEASURED, REFERENCE_COLOUR, SIMULATED

MAX_VEHICLES = 60
"""So many vehicles are drawn at most, those with the largest chi."""


def plot_fleet(fleet: Fleet) -> Figure:
    """Plot chi of every diagnosed vehicle, before and after the effects that were found; the largest first."""
    gaps = [(row.name, row.verdict.gap) for row in fleet.rows if row.verdict is not None]
    shown = sorted(gaps, key=lambda item: -item[1].before)[:MAX_VEHICLES]
    figure = Figure(figsize=(7.5, 1.2 + 0.26 * len(shown)), layout="constrained")
    axes = figure.subplots()
    for row, (_, gap) in enumerate(shown):
        axes.plot([gap.after, gap.before], [row, row], color="#c3ccd3", lw=1.5, zorder=1)
    axes.scatter([gap.before for _, gap in shown], range(len(shown)), color=MEASURED, s=30, label="before")
    axes.scatter([gap.after for _, gap in shown], range(len(shown)), color=SIMULATED, s=30, label="after")
    axes.axvline(1.0, color=REFERENCE_COLOUR, lw=1.1, ls=(0, (4, 2)), label="noise floor")
    axes.set_yticks(range(len(shown)), [name for name, _ in shown], fontsize=8.5, parse_math=False)
    axes.set_ylim(len(shown) - 0.4, -0.6)
    axes.set_xscale("log")
    axes.set_xlabel("chi (1: noise alone)", color=INK)
    axes.spines[["top", "right"]].set_visible(False)
    figure.legend(loc="outside upper right", ncols=3, frameon=False, fontsize=9)
    return figure
