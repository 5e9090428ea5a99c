"""What a mistake does to recordings after they were made: units, signs, exchanged columns, dead channels, shifted clocks and profiles."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from benchmarks.measured_world.cases import Fault, Recording
from benchmarks.measured_world.roads import Profile

Array = NDArray[np.float64]
Spoil = Callable[[Fault, list[Recording]], list[Recording]]


def each(change: Callable[[Array, Fault], Array]) -> Spoil:
    """Return what changes the values of the fault's channels in its runs."""

    def spoil(fault: Fault, recordings: list[Recording]) -> list[Recording]:
        found = []
        for recording in recordings:
            channels = dict(recording.channels)
            if recording.run.name in fault.runs:
                channels |= {name: change(channels[name], fault) for name in fault.items}
            found.append(replace(recording, channels=channels))
        return found

    return spoil


def clipped(values: Array, fault: Fault) -> Array:
    """Cut values at the share `size` of their largest."""
    limit = fault.size * np.max(np.abs(values))
    return np.clip(values, -limit, limit)


def dead(fault: Fault, recordings: list[Recording]) -> list[Recording]:
    """Leave nothing but the sensor's noise in a channel."""
    rng = np.random.default_rng(int(1e9 * fault.size))
    found = []
    for recording in recordings:
        name = fault.items[0]
        noise = recording.sigma[name] * rng.standard_normal(len(recording.t))
        found.append(replace(recording, channels={**recording.channels, name: noise}))
    return found


def exchanged(fault: Fault, recordings: list[Recording]) -> list[Recording]:
    """Exchange two channels, or all of two sensors."""
    one, other = fault.items
    pairs = [(one, other)] if "_" in one else [(f"{one}_{channel}", f"{other}_{channel}") for channel in ("az", "q")]
    found = []
    for recording in recordings:
        channels = dict(recording.channels)
        for a, b in pairs:
            channels[a], channels[b] = channels[b], channels[a]
        found.append(replace(recording, channels=channels))
    return found


def late(fault: Fault, recordings: list[Recording]) -> list[Recording]:
    """Shift the second sensor's channels against the first's by `size` seconds; the recordings become shorter by that."""
    found = []
    behind = fault.items[-1]
    for recording in recordings:
        n = round(fault.size / (recording.t[1] - recording.t[0]))
        channels = {name: values[:-n] if name.startswith(f"{behind}_") else values[n:] for name, values in recording.channels.items()}
        begin = recording.at - recording.run.speed * n * (recording.t[1] - recording.t[0])
        found.append(replace(recording, t=recording.t[: len(recording.t) - n], channels=channels, at=round(begin, 3)))
    return found


def moved(fault: Fault, recordings: list[Recording]) -> list[Recording]:
    """Shift measured profiles along the road by `size` metres."""
    found = []
    for recording in recordings:
        profile = recording.profile
        if profile is not None:
            profile = Profile(profile.distance + fault.size, profile.height)
        found.append(replace(recording, profile=profile))
    return found


def copied(fault: Fault, recordings: list[Recording]) -> list[Recording]:
    """Put a near-copy of one pass in the place of another: as saved again, with the last digits changed."""
    rng = np.random.default_rng(int(1e9 * fault.size))
    by_name = {recording.run.name: recording for recording in recordings}
    source = by_name[fault.runs[0]]
    shaken = {name: values + 0.05 * source.sigma[name] * rng.standard_normal(len(values)) for name, values in source.channels.items()}
    copy = replace(source, run=replace(source.run, name=fault.runs[1]), channels=shaken)
    return [copy if recording.run.name == fault.runs[1] else recording for recording in recordings]
