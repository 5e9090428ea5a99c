"""Resonances that several sensors show: peaks of their spectra at one frequency.

A motion of the whole vehicle stands out in every channel that it moves; what shakes one sensor alone stands out in one. A peak counts where
it rises above its surroundings by more than errors of the spectrum (1/sqrt(averages), relative) make of any one pair of its lines in one
spectrum of twenty. Lines have many neighbours, so that single channels of mere noise often have such a peak; what is told of is one that
all channels have at one frequency.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import NDArray

Array = NDArray[np.float64]
CHANCE = 0.05
"""Share of spectra in which errors alone set one line or more so far above one neighbour."""
WIDTH_LINES = 2.0
"""Peaks of two channels that are no more lines apart are one: the width of a Hann window's main lobe."""


@dataclass(frozen=True)
class SharedPeak:
    """A peak: its `frequency` [Hz], the mean over channels, and how far it rises above its surroundings in each [dB], in their order."""

    frequency: float
    prominence: tuple[float, ...]


def shared_peaks(frequency: Array, densities: Array, averages: float) -> tuple[SharedPeak, ...]:
    """Return the peaks that all channels show, by ascending frequency.

    Parameters
    ----------
    frequency
        `shape (n,)` [Hz], evenly spaced.
    densities
        PSDs of like quantities, accelerations for instance, `shape (n, n_channels)`.
    averages
        How many independent averages they are worth.
    """
    if len(frequency) < 3:
        return ()
    least = float(scipy.stats.norm.isf(CHANCE / len(frequency)) * np.sqrt(2 / averages))
    level = np.log(np.maximum(densities, np.finfo(float).tiny))
    found = []
    for column in level.T:
        places, properties = scipy.signal.find_peaks(column, prominence=least)
        found.append((frequency[places], properties["prominences"]))
    reach = WIDTH_LINES * float(frequency[1] - frequency[0]) * (1 + 1e-9)
    shared = []
    for own, rise in zip(*found[0], strict=True):
        at, rises = [float(own)], [float(rise)]
        for places, prominences in found[1:]:
            near = np.flatnonzero(np.abs(places - own) <= reach)
            if not len(near):
                break
            best = near[np.argmax(prominences[near])]
            at.append(float(places[best]))
            rises.append(float(prominences[best]))
        else:
            shared.append(SharedPeak(float(np.mean(at)), tuple(float(10 / np.log(10)) * item for item in rises)))
    return tuple(shared)
