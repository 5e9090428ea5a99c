"""Spectral lines that several runs show in what the base leaves: an engine's, at one frequency, or a wheel's, as its speed has it.

Such a line shakes the vehicle before the hump as well, where it passes for noise, and hides itself. What the base leaves tells it from
noise and from what roads excite: it stands out from the lines around it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
import scipy
from numpy.typing import NDArray

from vehgen.diagnose.fits.model_fit import ModelFit
from vehgen.fit.trial import Trial

Array = NDArray[np.float64]
LINES_AROUND = 31
"""So many lines have the median that a steady one stands out from: an engine that wanders by 2 % lies on ten."""
OF_MEDIAN, OF_NOISE = 50.0, 25.0
"""A steady line has so many times the power of that median, and of noise; of 6 healthy vehicles and 13 with an effect of an independent
world only a frame that bends, hardly damped, had both."""
LIKE = 0.04
"""Lines of two runs are one where their frequencies, or these over the runs' speeds, differ by this share at most."""


def steady_lines(base: ModelFit) -> dict[str, tuple[float, ...]]:
    """Return the frequencies [Hz] of steady lines by run; empty where no two runs over humps show one.

    What two of these show at one frequency is in runs over other roads, too.
    """
    found: dict[str, Array] = {}
    speeds: dict[str, float] = {}
    elsewhere: list[str] = []
    for part in base.parts:
        for number, trial in enumerate(part.misfit.problem.trials):
            if trial.scenario.over_humps_alone:
                found[trial.name] = _standing_out(part.misfit.frequency(number), base.spectra[trial.name])
                speeds[trial.name] = trial.scenario.top_speed
            else:
                elsewhere.append(trial.name)
    shared = _shared(found, speeds)
    alike = [f for run, own in shared.items() for f in own if _is_among(f, [g for other in shared if other != run for g in shared[other]])]
    return {**shared, **dict.fromkeys(elsewhere, tuple(dict.fromkeys(alike)))} if alike else shared


def without_lines(trials: Sequence[Trial], lines: Mapping[str, tuple[float, ...]]) -> tuple[Trial, ...]:
    """Return trials that know which lines are no noise."""
    return tuple(replace(trial, lines=lines.get(trial.name, ())) for trial in trials)


def _standing_out(frequency: Array, power: Array) -> Array:
    """Return the frequencies [Hz] of lines, of whitened power `shape (n, n_channels)`, that stand out in any channel."""
    around = scipy.ndimage.median_filter(power, size=(LINES_AROUND, 1), mode="nearest")
    return np.asarray(frequency[((power > OF_MEDIAN * around) & (power > OF_NOISE)).any(axis=1)])


def _shared(found: Mapping[str, Array], speeds: Mapping[str, float]) -> dict[str, tuple[float, ...]]:
    """Return of every run the lines that another run has, too."""
    shared: dict[str, tuple[float, ...]] = {}
    for run, own in found.items():
        others = [item for other, lines in found.items() if other != run for item in lines]
        orders = [item / speeds[other] for other, lines in found.items() if other != run and speeds[other] > 0 for item in lines]
        order = own / speeds[run] if speeds[run] > 0 else np.zeros(len(own))
        kept = tuple(float(f) for f, turns in zip(own, order, strict=True) if _is_among(f, others) or _is_among(turns, orders))
        if kept:
            shared[run] = kept
    return shared


def _is_among(value: float, others: Sequence[float]) -> bool:
    return any(abs(value - other) <= LIKE * other for other in others)
