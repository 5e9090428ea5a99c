"""Figures of a diagnosis: places, what each step closes."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from vehgen.diagnose.localise.unknown_force import PlaceResult
from vehgen.diagnose.pipeline import Diagnosis
from vehgen.fit.trial import Trial
from vehgen.measure import record_psd
from vehgen.report.drawing.canvas import INK
from vehgen.report.plots.comparison import MEASURED, REFERENCE_COLOUR, SIMULATED, Curve

MAX_PLACES = 16
"""So many places are drawn at most."""


def plot_places(results: tuple[PlaceResult, ...], passed: tuple[PlaceResult, ...]) -> Figure:
    """Plot the chi that an unknown force at each place leaves; those that pass are blue."""
    shown = sorted(results, key=lambda item: item.chi)[:MAX_PLACES]
    figure = Figure(figsize=(7.5, 0.9 + 0.26 * len(shown)), layout="constrained")
    axes = figure.subplots()
    names = {item.place.label for item in passed}
    colours = [SIMULATED if item.place.label in names else "#c3ccd3" for item in shown]
    axes.barh(range(len(shown)), [item.chi for item in shown], color=colours)
    axes.axvline(1.0, color=INK, lw=0.9, ls=(0, (4, 2)))
    for row, item in enumerate(shown):
        axes.text(item.chi * 1.03, row, f"{item.chi:.2f}", va="center", fontsize=8.5, color=INK)
    labels = [f"{item.place.label}{', 2 unknowns' if item.unknowns == 2 and item.place.rows else ''}" for item in shown]
    axes.set_yticks(range(len(shown)), labels, fontsize=8.5)
    axes.set_ylim(len(shown) - 0.4, -0.6)
    axes.set_xscale("log")
    axes.set_xlim(0.8, max(item.chi for item in shown) * 1.6)
    axes.set_xlabel("chi that remains (1: noise alone, dashed)", color=INK)
    axes.spines[["top", "right"]].set_visible(False)
    return figure


def _loudest(trials: tuple[Trial, ...]) -> int:
    """Return the number of the loudest hump run, or of the loudest run where there is no hump."""
    humps = [any(entry.hump is not None for entry in trial.run.file.road) for trial in trials]
    return max(range(len(trials)), key=lambda t: (humps[t], float(np.mean(trials[t].recording.values ** 2))))


def plot_waterfall(diagnosis: Diagnosis) -> Figure:
    """Plot the chi that each step leaves, on the runs for fitting and on the untouched ones: from the file's parameters to the noise."""
    detection, base = diagnosis.detection, diagnosis.detection.base
    steps = [("as filed", detection.as_filed, detection.as_filed_validation), ("recalibrated", base.training, base.validation)]
    steps += [(f"+ {fit.last.effect.name}\nat {fit.last.place}", fit.training, fit.validation) for fit in diagnosis.chosen]
    figure = Figure(figsize=(7.5, 3.0), layout="constrained")
    axes = figure.subplots()
    place = np.arange(len(steps))
    for side, colour, label, column in ((-0.2, MEASURED, "runs for fitting", 1), (0.2, SIMULATED, "untouched runs", 2)):
        chis = [float(np.sqrt(float(step[column]))) for step in steps]
        axes.bar(place + side, chis, 0.38, color=colour, label=label)
        for x, chi in zip(place + side, chis, strict=True):
            axes.text(x, chi * 1.05, f"{chi:.2f}", ha="center", va="bottom", fontsize=8, color=INK)
    axes.axhline(1.0, color=REFERENCE_COLOUR, lw=1.1, ls=(0, (4, 2)), label="noise floor")
    axes.set_yscale("log")
    axes.set_ylim(0.7, 2.0 * max(float(np.sqrt(float(value))) for step in steps for value in step[1:] if np.isfinite(float(value))))
    axes.set_xticks(place, [str(step[0]) for step in steps], fontsize=8.5)
    axes.set_ylabel("chi", color=INK)
    axes.spines[["top", "right"]].set_visible(False)
    figure.legend(loc="outside upper right", ncols=3, frameon=False, fontsize=9)
    return figure


def curves(diagnosis: Diagnosis) -> tuple[list[Curve], list[Curve]]:
    """Return PSDs and histories of the residual before (as measured) and after (as simulated), of the loudest untouched run's channels."""
    old, new = diagnosis.detection.base.validation_fit, diagnosis.chosen[-1].validation_fit if diagnosis.chosen else None
    if old is None or new is None:
        return [], []
    trials = old.misfit.problem.trials
    loudest = _loudest(trials)
    trial = trials[loudest]
    before, after = (trial.recording.values - fit.misfit.simulate(fit.x)[loudest] for fit in (old, new))
    densities, histories = [], []
    for i, channel in enumerate(trial.recording.channels):
        frequency, earlier = record_psd(before[:, i], trial.recording.dt)
        later = record_psd(after[:, i], trial.recording.dt)[1]
        densities.append(Curve(trial.name, channel.name, channel.quantity, frequency, earlier, later))
        histories.append(Curve(trial.name, channel.name, channel.quantity, trial.recording.time, before[:, i], after[:, i]))
    return densities, histories
