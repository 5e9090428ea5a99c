"""Figures of a calibration: fit, convergence, and what is known how well."""

from __future__ import annotations

from pathlib import Path

from matplotlib.figure import Figure

from vehgen.calibrate.summary import CalibrationSummary
from vehgen.measure import record_psd
from vehgen.report.drawing.canvas import INK
from vehgen.report.figure_files import save_figure
from vehgen.report.plots.comparison import HIGHEST_SHOWN_HZ, SIMULATED, Curve, plot_histories, plot_psds
from vehgen.report.plots.response_plot import COLOURS, STYLES

WIDEST = 100.0
"""Intervals are cut off beyond this [%]."""


def save_calibration_figures(outcome: CalibrationSummary, folder: Path) -> list[Path]:
    """Draw and save all figures of a calibration; returns their paths."""
    densities, histories = _curves(outcome)
    figures = [
        plot_psds(densities, (outcome.calibration.settings.band[0], HIGHEST_SHOWN_HZ)),
        plot_histories(histories),
        plot_convergence(outcome),
    ]
    if any(item.given is not None for item in outcome.parameters):
        figures.append(plot_intervals(outcome))
    paths = calibration_figure_files(folder)[: len(figures)]
    for path, figure in zip(paths, figures, strict=True):
        save_figure(figure, path)
    return paths


def calibration_figure_files(folder: Path) -> list[Path]:
    """Return the files that :func:`save_calibration_figures` writes, the last only where intervals are known."""
    return [folder / f"{what}.png" for what in ("psd", "histories", "convergence", "intervals")]


def _curves(outcome: CalibrationSummary) -> tuple[list[Curve], list[Curve]]:
    calibration = outcome.calibration
    delays: dict[str, float] = {}
    if calibration.steps[-1].fits:
        fit = calibration.steps[-1].fits[0]
        names = fit.misfit.nuisances.names
        if "delay" in names:
            rows = fit.misfit.split(fit.x)[1][:, names.index("delay")] * fit.misfit.nuisances.delay
            delays = {trial.name: float(row) for trial, row in zip(fit.misfit.problem.trials, rows, strict=True)}
    densities, histories = [], []
    for trial in calibration.problem.trials:
        scenario = trial.scenario.adjusted(delays.get(trial.name, 0.0))
        simulated = calibration.problem.respond(calibration.array[None], trial, scenario)[0][0]
        for i, channel in enumerate(trial.recording.channels):
            pair = (trial.recording.values[:, i], simulated[:, i])
            frequency = record_psd(pair[0], trial.recording.dt)[0]
            density = [record_psd(item, trial.recording.dt)[1] for item in pair]
            histories.append(Curve(trial.name, channel.name, channel.quantity, trial.recording.time, *pair))
            densities.append(Curve(trial.name, channel.name, channel.quantity, frequency, density[0], density[1]))
    return densities, histories


def plot_convergence(outcome: CalibrationSummary) -> Figure:
    """Plot the best objective after each generation, a line a step."""
    figure = Figure(figsize=(6.4, 3.4), layout="constrained")
    axes = figure.subplots()
    for i, step in enumerate(outcome.calibration.steps):
        axes.semilogy(step.state.history, color=COLOURS[i], linestyle=STYLES[i], lw=1.4, label=step.step.label)
    axes.set_xlabel("generation", color=INK)
    axes.set_ylabel("objective of the best individual (Eq. 5)", color=INK)
    axes.grid(color="#e3e7ea", lw=0.6, which="both")
    axes.spines[["top", "right"]].set_visible(False)
    axes.legend(frameon=False, fontsize=9)
    return figure


def plot_intervals(outcome: CalibrationSummary) -> Figure:
    """Plot every parameter's interval over its value; hollow marks with grey bars are known only if the fixed parameters are."""
    items = [item for item in outcome.parameters if item.estimate.value > 0]
    figure = Figure(figsize=(7.2, 1.3 + 0.2 * len(items)), layout="constrained")
    axes = figure.subplots()
    shown: set[str] = set()
    pivots = [outcome.structure.space.names[i] for i in outcome.structure.fixed_parameters]
    for row, item in enumerate(items):
        estimate = item.estimate
        told = estimate.low is not None
        source = estimate if told else item.given
        if source is None or source.low is None or source.high is None or item.estimate.name in pivots:
            axes.plot([0.0], [row], marker="x", color="#b03030", ls="", ms=5, label=_once("held fixed", shown))
            continue
        colour = SIMULATED if told else "#7d8a94"
        label = "90 % interval" if told else f"90 % interval if {', '.join(pivots)} were known"
        ends = [100 * (source.low / estimate.value - 1), 100 * (source.high / estimate.value - 1)]
        axes.plot(ends, [row, row], color=colour, lw=2.2, label=_once(label, shown))
        axes.plot([0.0], [row], marker="o", color=colour, mfc=colour if told else "white", ls="", ms=4.5)
    axes.set_yticks(range(len(items)), [item.estimate.name for item in items], fontsize=8.5)
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
