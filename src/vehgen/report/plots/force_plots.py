"""The picture of a recovered force: over travel, over rate, and in time, with the free-form law fitted to it."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from vehgen.diagnose.evidence import ForceEvidence, LawCurve
from vehgen.report.drawing.canvas import INK
from vehgen.report.plots.comparison import SIMULATED

DOTS = "#8b98a3"
BAND_COLOUR = "#d3dae0"
INTERVAL = "#a9c8e6"
LAST = 0.03
"""The time panel shows what lies between the first and the last moment at which the force exceeds this share of its largest."""
TALL = 1.5
"""The time panel reaches to this multiple of the largest force, even where the band is wider."""
LONGEST_SHOWN_S = 4.0
"""It shows so much time at most, about the largest force [s]."""


def plot_force(force: ForceEvidence) -> Figure:
    """Plot a recovered force with its free-form law, three panels: over travel, over rate, in time.

    A dot is what a curve says at one instant plus what the law leaves of the recovered force then; in time, the grey band is that force's
    +-2 standard deviations.
    """
    figure = Figure(figsize=(10.4, 3.5), layout="constrained")
    panels = figure.subplots(1, 3, width_ratios=(1, 1, 1.35))
    scale, unit = (1.0, "rad") if force.angular else (1e3, "mm")
    word = "moment" if force.angular else "force"
    motion = {"body": "pitch" if force.angular else "heave", "hinge": "angle"}.get(force.kind, "travel")
    _panel(panels[0], force.travel, scale, f"{motion} [{unit}]")
    _panel(panels[1], force.rate, 1.0, f"its rate [{force.units[1]}]")
    low, high = (pick(axes.get_ylim()[i] for axes in panels[:2]) for i, pick in enumerate((min, max)))
    for axes in panels[:2]:
        axes.set_ylim(low, high)
    panels[0].set_ylabel(f"unknown {word} [{force.units[2]}]", color=INK, parse_math=False)
    _history(panels[2], force)
    for axes in panels:
        axes.grid(color="#e3e7ea", lw=0.6)
        axes.set_axisbelow(True)
        axes.spines[["top", "right"]].set_visible(False)
    title = f"{force.place}, run {force.run}; positive resists a positive {motion}"
    figure.suptitle(title, x=0.01, ha="left", fontsize=10, color=INK, parse_math=False)
    entries = [axes.get_legend_handles_labels() for axes in panels[1:]]
    handles, labels = ([item for entry in entries for item in entry[part]] for part in range(2))
    figure.legend(handles, labels, loc="outside lower center", ncols=len(labels), frameon=False, fontsize=8.5)
    return figure


def _panel(axes: Axes, curve: LawCurve, scale: float, label: str) -> None:
    """Draw the force over travel or rate, and its curve with the 90 % interval."""
    reach = 1.08 * np.concatenate([curve.dots, curve.force])
    axes.set_ylim(float(reach.min()), float(reach.max()))
    dots, label_of_dots = (scale * curve.dots_x, curve.dots), "recovered, at an instant"
    axes.plot(*dots, ls="", marker="o", ms=2.6, mfc="none", mec=DOTS, mew=0.7, label=label_of_dots)
    axes.fill_between(scale * curve.x, curve.low, curve.high, color=INTERVAL, lw=0.0, alpha=0.75, label="90 % interval")
    axes.plot(scale * curve.x, curve.force, color=SIMULATED, lw=1.8, label="free-form law")
    axes.set_xlabel(label, color=INK, parse_math=False)


def _history(axes: Axes, shown: ForceEvidence) -> None:
    size = float(np.abs(shown.force).max())
    loud = np.flatnonzero(np.abs(shown.force) > LAST * size)
    middle = float(shown.time[int(np.argmax(np.abs(shown.force)))])
    first, last = (float(shown.time[i]) for i in (loud[0], loud[-1]))
    low, high = shown.force - 2 * shown.deviation, shown.force + 2 * shown.deviation
    axes.fill_between(shown.time, low, high, color=BAND_COLOUR, lw=0.0, label="±2 standard deviations")
    axes.plot(shown.time, shown.force, color=INK, lw=1.0, label="recovered in time")
    axes.plot(shown.time, shown.law, color=SIMULATED, lw=1.3, ls=(0, (4, 1.5)), label="law, as the band shows it")
    axes.set_ylim(-TALL * size, TALL * size)
    axes.set_xlim(max(first, middle - LONGEST_SHOWN_S / 2), min(last, middle + LONGEST_SHOWN_S / 2))
    axes.set_xlabel("time [s]", color=INK)
