"""Figures of a calibration: fit, convergence, and what is known how well."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import LogLocator

from vehgen.calibrate.result import CalibrationSummary
from vehgen.report.drawing.canvas import INK
from vehgen.report.figure_files import save_figure
from vehgen.report.plots.comparison import HIGHEST_SHOWN_HZ, SIMULATED, plot_histories, plot_psds
from vehgen.report.plots.response_plot import COLOURS, STYLES

NOT_TOLD = "#7d8a94"
"""Colour of what the recordings do not tell by themselves."""
WIDEST = 100.0
"""Intervals are cut off beyond this [%]."""


def save_calibration_figures(outcome: CalibrationSummary, folder: Path) -> list[Path]:
    """Draw and save all figures of a calibration; returns their paths."""
    figures = [plot_calibration(outcome), plot_histories(outcome.histories, _labels(outcome)), plot_convergence(outcome)]
    if outcome.fits:
        figures.append(plot_intervals(outcome))
    paths = calibration_figure_files(folder)[: len(figures)]
    for path, figure in zip(paths, figures, strict=True):
        save_figure(figure, path)
    return paths


def calibration_figure_files(folder: Path) -> list[Path]:
    """Return the files that :func:`save_calibration_figures` writes, the last only where intervals are known."""
    return [folder / f"{what}.png" for what in ("psd", "histories", "convergence", "intervals")]


def plot_calibration(outcome: CalibrationSummary) -> Figure:
    """Plot the PSDs of every channel, measured beside simulated."""
    return plot_psds(outcome.psds, (outcome.band[0], HIGHEST_SHOWN_HZ), labels=_labels(outcome))


def _labels(outcome: CalibrationSummary) -> tuple[str, str]:
    """Return what measured and simulated curves are called, and at which speed and clock they were simulated."""
    return "measured", "simulated at the fitted speed and clock" if outcome.conditions else "simulated at the stated speed"


def plot_convergence(outcome: CalibrationSummary) -> Figure:
    """Plot the best objective after each generation, a line a step."""
    figure = Figure(figsize=(6.4, 3.4), layout="constrained")
    axes = figure.subplots()
    for i, (label, history) in enumerate(zip(outcome.steps, outcome.history, strict=True)):
        axes.semilogy(history, color=COLOURS[i % len(COLOURS)], linestyle=STYLES[i % len(STYLES)], lw=1.4, label=label)
    if outcome.fits and len(outcome.steps) == 1:
        axes.axhline(sum(outcome.objective.values()), color=INK, lw=1.0, ls=(0, (4, 2)), label="after the polish, at the fitted speeds")
    axes.yaxis.set_minor_locator(LogLocator(subs=(2.0, 5.0)))
    for set_formatter in (axes.yaxis.set_major_formatter, axes.yaxis.set_minor_formatter):
        set_formatter("{x:g}")
    axes.set_xlabel("generation", color=INK)
    axes.set_ylabel("objective of the best (Eq. 5)", color=INK)
    axes.grid(color="#e3e7ea", lw=0.6, which="both")
    axes.spines[["top", "right"]].set_visible(False)
    axes.legend(frameon=False, fontsize=9)
    return figure


def plot_intervals(outcome: CalibrationSummary) -> Figure:
    """Plot intervals over their values: modes and combinations that the recordings tell, beside single parameters.

    Hollow marks with grey bars are parameters that are known only if the fixed ones are.
    """
    told = [_Bar(mode.name, mode.undamped_hz, mode.interval) for mode in outcome.modes]
    told += [_Bar(name, item.value, item.interval) for name, item in outcome.combinations.items()]
    single = [
        _Bar(name, item.value, item.interval or (None if name in outcome.pivots else item.interval_given_pivots), item.interval is not None)
        for name, item in outcome.parameters.items()
    ]
    panels = {"natural frequencies and combinations": told, "parameters": single}
    shown = {title: bars for title, bars in panels.items() if any(bar.value > 0 for bar in bars)}
    rows = max((len(bars) for bars in shown.values()), default=1)
    figure = Figure(figsize=(5.2 * max(len(shown), 1), 1.5 + 0.2 * rows), layout="constrained")
    labels: dict[str, Line2D] = {}
    for axes, (title, bars) in zip(figure.subplots(1, max(len(shown), 1), squeeze=False)[0], shown.items(), strict=False):
        labels |= _draw_bars(axes, [bar for bar in bars if bar.value > 0], ", ".join(outcome.pivots))
        axes.set_title(title, fontsize=9.5, loc="left", color=INK)
    figure.legend(list(labels.values()), list(labels), loc="outside upper right", frameon=False, fontsize=8.5, ncols=len(labels) or 1)
    return figure


@dataclass(frozen=True)
class _Bar:
    """A quantity's value and interval; `is_told` where it does not hang on parameters held fixed."""

    name: str
    value: float
    interval: tuple[float, float] | None
    is_told: bool = True


def _beyond(bars: Sequence[_Bar], reach: float) -> list[tuple[int, int]]:
    """Return the rows of bars that go on beyond an axis of so many percent to each side, and to which side: -1 or 1."""
    ends = [(row, side, bar.interval[side > 0] / bar.value - 1) for row, bar in enumerate(bars) if bar.interval for side in (-1, 1)]
    return [(row, side) for row, side, share in ends if side * 100 * share > reach]


def _draw_bars(axes: Axes, bars: Sequence[_Bar], fixed: str) -> dict[str, Line2D]:
    """Draw a bar a row, in percent about its value; returns what to call the kinds of marks drawn."""
    found: dict[str, Line2D] = {}
    for row, bar in enumerate(bars):
        if bar.interval is None:
            marker, colour, label = ("s", NOT_TOLD, "not told by the recordings") if bar.is_told else ("x", "#b03030", "held fixed")
            (mark,) = axes.plot([0.0], [row], marker=marker, color=colour, mfc="white", ls="", ms=5)
            found.setdefault(label, mark)
            continue
        colour = SIMULATED if bar.is_told else NOT_TOLD
        (line,) = axes.plot([100 * (end / bar.value - 1) for end in bar.interval], [row, row], color=colour, lw=2.2)
        axes.plot([0.0], [row], marker="o", color=colour, mfc=colour if bar.is_told else "white", ls="", ms=4.5)
        found.setdefault("90 % interval" if bar.is_told else f"90 % interval if {fixed} were known", line)
    axes.set_yticks(range(len(bars)), [bar.name for bar in bars], fontsize=8.5, parse_math=False)
    axes.set_ylim(len(bars) - 0.4, -0.6)
    reach = min(max(abs(end) for end in axes.get_xlim()), WIDEST)
    axes.set_xlim(-reach, reach)
    for row, side in _beyond(bars, reach):
        colour = SIMULATED if bars[row].is_told else NOT_TOLD
        axes.plot([side * reach], [row], marker="<" if side < 0 else ">", color=colour, ms=6, clip_on=False)
    axes.set_xlabel("interval about the estimate [%]", color=INK)
    axes.grid(color="#e3e7ea", lw=0.6, axis="x")
    axes.spines[["top", "right"]].set_visible(False)
    return found
