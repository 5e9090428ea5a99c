"""Figures of a diagnosis: places, what each step closes."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from vehgen.diagnose.pipeline import Diagnosis
from vehgen.diagnose.place_test import PlaceResult
from vehgen.identify.trial import Trial
from vehgen.measure import record_psd
from vehgen.report.canvas import INK
from vehgen.report.comparison import MEASURED, REFERENCE, SIMULATED, Curve

MOST = 16
"""So many places are drawn at most."""


def plot_places(results: tuple[PlaceResult, ...], passed: tuple[PlaceResult, ...]) -> Figure:
    """Plot the chi that an unknown force at each place leaves; those that pass are blue."""
    shown = sorted(results, key=lambda item: item.chi)[:MOST]
    figure = Figure(figsize=(7.5, 0.9 + 0.26 * len(shown)), layout="constrained")
    axes = figure.subplots()
    names = {item.place.label for item in passed}
    colours = [SIMULATED if item.place.label in names else "#c3ccd3" for item in shown]
    axes.barh(range(len(shown)), [item.chi for item in shown], color=colours)
    axes.axvline(1.0, color=INK, lw=0.9, ls=(0, (4, 2)))
    for row, item in enumerate(shown):
        axes.text(item.chi * 1.03, row, f"{item.chi:.2f}", va="center", fontsize=8.5, color=INK)
    axes.set_yticks(range(len(shown)), [item.place.label for item in shown], fontsize=8.5)
    axes.set_ylim(len(shown) - 0.4, -0.6)
    axes.set_xscale("log")
    axes.set_xlim(0.8, max(item.chi for item in shown) * 1.6)
    axes.set_xlabel("chi that remains (1: noise alone, dashed)", color=INK)
    axes.spines[["top", "right"]].set_visible(False)
    return figure


def _loudest(trials: tuple[Trial, ...]) -> int:
    """Return the number of the loudest hump run, or of the loudest run where there is no hump."""
    humps = [any(entry.hump is not None for entry in trial.run.file.road) for trial in trials]
    return max(range(len(trials)), key=lambda t: (humps[t], float(np.mean(trials[t].measurement.values ** 2))))


def plot_waterfall(diagnosis: Diagnosis) -> Figure:
    """Plot chi of every run: before, after the effect was added, and the noise floor."""
    runs = diagnosis.verdict.gap.runs
    figure = Figure(figsize=(7.5, 3.0), layout="constrained")
    axes = figure.subplots()
    place = np.arange(len(runs))
    axes.bar(place - 0.2, [run["before"] for run in runs], 0.38, color=MEASURED, label="recalibrated base")
    axes.bar(place + 0.2, [run["after"] for run in runs], 0.38, color=SIMULATED, label="with the effect")
    axes.axhline(1.0, color=REFERENCE, lw=1.1, ls=(0, (4, 2)), label="noise floor")
    axes.set_yscale("log")
    axes.set_ylim(0.7, 2.0 * max(run["before"] for run in runs))
    axes.set_xticks(place, [f"{run['run']}{' (untouched)' if run['untouched'] else ''}" for run in runs], fontsize=8.5)
    axes.set_ylabel("chi", color=INK)
    axes.spines[["top", "right"]].set_visible(False)
    figure.legend(loc="outside upper right", ncols=3, frameon=False, fontsize=9)
    return figure


def curves(diagnosis: Diagnosis) -> tuple[list[Curve], list[Curve]]:
    """Return PSDs and histories of the residual before (as measured) and after (as simulated), of the loudest training run's channels."""
    if not diagnosis.chosen:
        return [], []
    base, after = diagnosis.detection.base.polished, diagnosis.chosen[-1].polished
    loudest = _loudest(base.misfit.problem.trials)
    trial = base.misfit.problem.trials[loudest]
    old, new = (trial.measurement.values - fit.misfit.simulate(fit.x)[loudest] for fit in (base, after))
    densities, histories = [], []
    for i, channel in enumerate(trial.measurement.channels):
        frequency, before = record_psd(old[:, i], trial.measurement.dt)
        later = record_psd(new[:, i], trial.measurement.dt)[1]
        densities.append(Curve(trial.name, channel.name, channel.quantity, frequency, before, later))
        histories.append(Curve(trial.name, channel.name, channel.quantity, trial.measurement.time, old[:, i], new[:, i]))
    return densities, histories
