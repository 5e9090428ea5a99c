"""The picture of a recovered force: over travel, over rate, and in time, with the free-form law fitted to it."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from vehgen.diagnose.localise.free_form import Curve, FreeForm
from vehgen.diagnose.localise.recovered_force import RecoveredForce
from vehgen.report.drawing.canvas import INK
from vehgen.report.plots.comparison import SIMULATED

Array = NDArray[np.float64]
DOTS = "#8b98a3"
BAND_COLOUR = "#d3dae0"
INTERVAL = "#a9c8e6"
LAST = 0.03
"""The time panel shows what lies between the first and the last moment at which the force exceeds this share of its largest."""
TALL = 1.5
"""The time panel reaches to this multiple of the largest force, even where the band is wider."""
LONGEST_SHOWN_S = 4.0
"""It shows so much time at most, about the largest force [s]."""


def plot_force(law: FreeForm, run: str | None = None) -> Figure:
    """Plot a recovered force with its free-form law, three panels: over travel, over rate, in time.

    A dot is what a curve says at one instant plus what the law leaves of the recovered force then; in time, the grey band is that force's
    +-2 standard deviations.

    Parameters
    ----------
    law
        The fitted law.
    run
        Which run to show (default: the training run with the largest force).

    Raises
    ------
    KeyError
        For a run that is not the law's.
    """
    shown = _choose(law.runs, run)
    figure = Figure(figsize=(10.4, 3.5), layout="constrained")
    panels = figure.subplots(1, 3, width_ratios=(1, 1, 1.35))
    scale, unit = (1.0, "rad") if shown.angular else (1e3, "mm")
    word = "moment" if shown.angular else "force"
    named = {"body": "pitch" if shown.angular else "heave", "hinge": "angle"}.get(shown.place.kind, "travel")
    f, g, both = law.histories[shown.run]
    _panel(panels[0], law.travel, scale, shown.travel, f + shown.force - both, f"{named} [{unit}]")
    _panel(panels[1], law.rate, 1.0, shown.rate, g + shown.force - both, f"its rate [{shown.units[1]}]")
    low, high = (pick(axes.get_ylim()[i] for axes in panels[:2]) for i, pick in enumerate((min, max)))
    for axes in panels[:2]:
        axes.set_ylim(low, high)
    panels[0].set_ylabel(f"unknown {word} [{shown.units[2]}]", color=INK)
    _history(panels[2], shown, both)
    for axes in panels:
        axes.grid(color="#e3e7ea", lw=0.6)
        axes.set_axisbelow(True)
        axes.spines[["top", "right"]].set_visible(False)
    title = f"{shown.place.label}, run {shown.run}; positive resists a positive {named}"
    figure.suptitle(title, x=0.01, ha="left", fontsize=10, color=INK, parse_math=False)
    entries = [axes.get_legend_handles_labels() for axes in panels[1:]]
    handles, labels = ([item for entry in entries for item in entry[part]] for part in range(2))
    figure.legend(handles, labels, loc="outside lower center", ncols=len(labels), frameon=False, fontsize=8.5)
    return figure


def _choose(runs: tuple[RecoveredForce, ...], name: str | None) -> RecoveredForce:
    if name is not None:
        return {item.run: item for item in runs}[name]
    return max((item for item in runs if not item.validation), key=lambda item: float(np.abs(item.force).max()))


def _panel(axes: Axes, curve: Curve, scale: float, x: Array, dots: Array, label: str) -> None:
    """Draw the force over travel or rate, and its curve with the 90 % interval."""
    reach = 1.08 * np.concatenate([dots, curve.force])
    axes.set_ylim(float(reach.min()), float(reach.max()))
    axes.plot(scale * x, dots, ls="", marker="o", ms=2.6, mfc="none", mec=DOTS, mew=0.7, label="recovered, at an instant")
    axes.fill_between(scale * curve.x, curve.low, curve.high, color=INTERVAL, lw=0.0, alpha=0.75, label="90 % interval")
    axes.plot(scale * curve.x, curve.force, color=SIMULATED, lw=1.8, label="free-form law")
    axes.set_xlabel(label, color=INK)


def _history(axes: Axes, run: RecoveredForce, law: Array) -> None:
    size = float(np.abs(run.force).max())
    loud = np.flatnonzero(np.abs(run.force) > LAST * size)
    middle = float(run.time[int(np.argmax(np.abs(run.force)))])
    first, last = (float(run.time[i]) for i in (loud[0], loud[-1]))
    axes.fill_between(
        run.time, run.force - 2 * run.deviation, run.force + 2 * run.deviation, color=BAND_COLOUR, lw=0.0, label="±2 standard deviations"
    )
    axes.plot(run.time, run.force, color=INK, lw=1.0, label="recovered in time")
    axes.plot(run.time, law, color=SIMULATED, lw=1.3, ls=(0, (4, 1.5)), label="law, as the band shows it")
    axes.set_ylim(-TALL * size, TALL * size)
    axes.set_xlim(max(first, middle - LONGEST_SHOWN_S / 2), min(last, middle + LONGEST_SHOWN_S / 2))
    axes.set_xlabel("time [s]", color=INK)
