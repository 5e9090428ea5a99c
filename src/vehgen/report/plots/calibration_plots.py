"""Figures of a calibration: fit, convergence, and what is known how well."""

from __future__ import annotations

from pathlib import Path

from matplotlib.figure import Figure

from vehgen.calibrate.result import CalibrationSummary
from vehgen.report.drawing.canvas import INK
from vehgen.report.figure_files import save_figure
from vehgen.report.plots.comparison import HIGHEST_SHOWN_HZ, SIMULATED, plot_histories, plot_psds
from vehgen.report.plots.response_plot import COLOURS, STYLES

WIDEST = 100.0
"""Intervals are cut off beyond this [%]."""


def save_calibration_figures(outcome: CalibrationSummary, folder: Path) -> list[Path]:
    """Draw and save all figures of a calibration; returns their paths."""
    figures = [plot_calibration(outcome), plot_histories(outcome.histories), plot_convergence(outcome)]
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
    return plot_psds(outcome.psds, (outcome.band[0], HIGHEST_SHOWN_HZ))


def plot_convergence(outcome: CalibrationSummary) -> Figure:
    """Plot the best objective after each generation, a line a step."""
    figure = Figure(figsize=(6.4, 3.4), layout="constrained")
    axes = figure.subplots()
    for i, (label, history) in enumerate(zip(outcome.steps, outcome.history, strict=True)):
        axes.semilogy(history, color=COLOURS[i % len(COLOURS)], linestyle=STYLES[i % len(STYLES)], lw=1.4, label=label)
    axes.set_xlabel("generation", color=INK)
    axes.set_ylabel("objective of the best individual (Eq. 5)", color=INK)
    axes.grid(color="#e3e7ea", lw=0.6, which="both")
    axes.spines[["top", "right"]].set_visible(False)
    axes.legend(frameon=False, fontsize=9)
    return figure


def plot_intervals(outcome: CalibrationSummary) -> Figure:
    """Plot every parameter's interval over its value; hollow marks with grey bars are known only if the fixed parameters are."""
    items = {name: item for name, item in outcome.parameters.items() if item.value > 0}
    figure = Figure(figsize=(7.2, 1.3 + 0.2 * len(items)), layout="constrained")
    axes = figure.subplots()
    shown: set[str] = set()
    for row, (name, item) in enumerate(items.items()):
        told = item.interval is not None
        interval = item.interval or item.interval_given_pivots
        if interval is None or name in outcome.pivots:
            axes.plot([0.0], [row], marker="x", color="#b03030", ls="", ms=5, label=_once("held fixed", shown))
            continue
        colour = SIMULATED if told else "#7d8a94"
        label = "90 % interval" if told else f"90 % interval if {', '.join(outcome.pivots)} were known"
        ends = [100 * (end / item.value - 1) for end in interval]
        axes.plot(ends, [row, row], color=colour, lw=2.2, label=_once(label, shown))
        axes.plot([0.0], [row], marker="o", color=colour, mfc=colour if told else "white", ls="", ms=4.5)
    axes.set_yticks(range(len(items)), list(items), fontsize=8.5, parse_math=False)
    axes.set_ylim(len(items) - 0.4, -0.6)
    reach = min(max(abs(end) for end in axes.get_xlim()), WIDEST)
    axes.set_xlim(-reach, reach)
    axes.set_xlabel("interval about the estimate [%]", color=INK)
    axes.grid(color="#e3e7ea", lw=0.6, axis="x")
    axes.spines[["top", "right"]].set_visible(False)
    figure.legend(loc="outside upper right", frameon=False, fontsize=8.5, ncols=2)
    return figure


def _once(label: str, shown: set[str]) -> str:
    if label in shown:
        return "_nolegend_"
    shown.add(label)
    return label
