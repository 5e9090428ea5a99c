"""What a run recorded before its first wheel met the hump: noise, and the road that nobody measured."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from vehgen.fit.trial import Trial

Array = NDArray[np.float64]
SHORTEST_QUIET_S = 0.8
"""A lead-in shorter than this [s] tells nothing."""
LEAD_IN_MARGIN_S = 0.1
"""How long before the hump the lead-in ends [s]."""
STEADY = 3.0
"""The loudest quarter of a quiet lead-in is less than this many times as loud as the middling one."""


def lead_in(trial: Trial) -> Trial | None:
    """Return what a run recorded before its first wheel met the first hump, or None where that is too short or unknown."""
    if not trial.scenario.over_humps_alone:
        return None
    first = min(hump.at for hump in trial.scenario.humps) - trial.scenario.track.footprint
    time = trial.recording.time
    quiet = trial.scenario.speed.distance(time + LEAD_IN_MARGIN_S) < first
    count = int(quiet.sum())
    if count * trial.recording.dt < SHORTEST_QUIET_S or np.any(np.ptp(trial.recording.values[:count], axis=0) == 0.0):
        return None
    if not _steady(trial.recording.values[:count]):
        return None
    measurement = replace(trial.recording, time=time[:count], values=trial.recording.values[:count])
    return replace(trial, recording=measurement)


def _steady(values: Array) -> bool:
    """Return whether quarters of a stretch are about equally loud: one that holds the hump, of a run stated wrong, is not quiet."""
    quarters = np.array([np.std(part, axis=0) for part in np.array_split(values, 4)])
    return bool(np.all(quarters.max(axis=0) < STEADY * np.median(quarters, axis=0)))
