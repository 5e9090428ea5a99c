"""Figures of a diagnosis: places, what each step closes, and the gap run by run."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from vehgen.diagnose.evidence import PlaceEvidence
from vehgen.diagnose.result import Diagnosis
from vehgen.diagnose.verdict import Verdict
from vehgen.report.drawing.canvas import INK
from vehgen.report.plots.comparison import MEASURED, REFERENCE_COLOUR, SIMULATED

MAX_PLACES = 16
"""So many places are drawn at most."""
Pair = tuple[str, float, float]
"""A label with two numbers."""


def plot_places(places: Sequence[PlaceEvidence]) -> Figure:
    """Plot the chi that an unknown force at each place leaves; those that pass are blue."""
    shown = sorted(places, key=lambda item: item.chi)[:MAX_PLACES]
    figure = Figure(figsize=(7.5, 0.9 + 0.26 * len(shown)), layout="constrained")
    axes = figure.subplots()
    axes.barh(range(len(shown)), [item.chi for item in shown], color=[SIMULATED if item.passes else "#c3ccd3" for item in shown])
    axes.axvline(1.0, color=INK, lw=0.9, ls=(0, (4, 2)))
    for row, item in enumerate(shown):
        axes.text(max(item.chi, 1.0) * 1.03, row, f"{item.chi:.2f}", va="center", fontsize=8.5, color=INK)
    labels = [f"{item.label}{', 2 unknowns' if item.unknowns == 2 and item.is_force else ''}" for item in shown]
    axes.set_yticks(range(len(shown)), labels, fontsize=8.5, parse_math=False)
    axes.set_ylim(len(shown) - 0.4, -0.6)
    axes.set_xscale("log")
    axes.set_xlim(0.8, max(item.chi for item in shown) * 1.6)
    axes.set_xlabel("chi that remains (1: noise alone, dashed)", color=INK)
    axes.spines[["top", "right"]].set_visible(False)
    return figure


def plot_waterfall(diagnosis: Diagnosis) -> Figure:
    """Plot the chi that each step leaves, on the runs for fitting and on validation runs: from the file's parameters to the noise."""
    figure = Figure(figsize=(7.5, 3.0), layout="constrained")
    pairs = [(step.label, step.training, step.validation) for step in diagnosis.evidence.steps]
    _bars(figure.subplots(), pairs, ("runs for fitting", "validation runs"))
    figure.legend(loc="outside upper right", ncols=3, frameon=False, fontsize=9)
    return figure


def plot_run_gaps(verdict: Verdict) -> Figure:
    """Plot every run's chi before and after the effects were added."""
    figure = Figure(figsize=(7.5, 3.0), layout="constrained")
    pairs = [(f"{run.run}\n({'checking' if run.validation else 'fitting'})", run.before, run.after) for run in verdict.gap.runs]
    _bars(figure.subplots(), pairs, ("before", "after"))
    figure.legend(loc="outside upper right", ncols=3, frameon=False, fontsize=9)
    return figure


def _bars(axes: Axes, pairs: Sequence[Pair], labels: tuple[str, str]) -> None:
    """Draw pairs of bars on a logarithmic scale of chi, with the noise floor."""
    place = np.arange(len(pairs))
    for side, colour, label, column in ((-0.2, MEASURED, labels[0], 1), (0.2, SIMULATED, labels[1], 2)):
        chis = [float(pair[column]) for pair in pairs]
        axes.bar(place + side, chis, 0.38, color=colour, label=label)
        for x, chi in zip(place + side, chis, strict=True):
            axes.text(x, max(chi, 1.0) * 1.05, f"{chi:.2f}", ha="center", va="bottom", fontsize=8, color=INK)
    axes.axhline(1.0, color=REFERENCE_COLOUR, lw=1.1, ls=(0, (4, 2)), label="noise floor")
    axes.set_yscale("log")
    axes.set_ylim(0.7, 2.0 * max(value for pair in pairs for value in pair[1:] if np.isfinite(value)))
    axes.set_xticks(place, [pair[0] for pair in pairs], fontsize=8.5, parse_math=False)
    axes.set_ylabel("chi", color=INK)
    axes.spines[["top", "right"]].set_visible(False)
