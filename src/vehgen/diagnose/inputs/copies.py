"""Near-copies of one pass, given as separate runs: their difference is less than the noise of two passes would make."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from vehgen.diagnose.inputs.fault import MeasurementFault
from vehgen.fit.band import CALIBRATION_BAND_HZ
from vehgen.fit.noise import Noise
from vehgen.fit.trial import Trial

Array = NDArray[np.float64]
OWN_NOISE = 0.2
"""Two passes differ by the noise of both; a copy differs by less than this share of its power."""
SHIFT_STEP = 0.05
"""Clocks are tried at this share of a sample."""


def find_copies(
    trials: Sequence[Trial], noises: Mapping[str, Noise], band: tuple[float, float] = CALIBRATION_BAND_HZ
) -> Iterator[MeasurementFault]:
    """Yield pairs of runs that record one pass, given their noise."""
    for one, other in combinations(trials, 2):
        if one.channels != other.channels or abs(one.recording.dt / other.recording.dt - 1) > 1e-6:
            continue
        if _pushed_differently(one, other):
            continue
        expected = noises[one.name].sigma ** 2 + noises[other.name].sigma ** 2
        if _difference(one, other, expected, band) < OWN_NOISE:
            yield MeasurementFault(
                "copy",
                (one.name, other.name),
                (),
                f"{one.name} and {other.name} record one pass: they differ by less than the noise of two passes would",
                "leave one of them out: a copy can neither teach nor check",
            )


def _pushed_differently(one: Trial, other: Trial) -> bool:
    """Return whether two rigs that moved alike recorded forces of their own: a drive repeats its motion, a copy repeats the force, too."""
    pairs = [(a.values, b.values) for a, b in zip(one.scenario.forces, other.scenario.forces, strict=False)]
    measured = [(a, b) for a, b in pairs if a is not None and b is not None]
    return any(len(a) != len(b) or not np.array_equal(a, b) for a, b in measured)


def _difference(one: Trial, other: Trial, expected: Array, band: tuple[float, float]) -> float:
    """Return the power of the difference of two recordings over that of their noise, at the clock at which they agree best."""
    n = min(len(one.recording.time), len(other.recording.time))
    dt = one.recording.dt
    frequency = np.fft.rfftfreq(n, dt)
    inside = (frequency >= band[0]) & (frequency <= band[1])
    a, b = (np.fft.rfft(item.recording.values[:n], axis=0)[inside] for item in (one, other))
    power = expected * n * inside.sum()
    weight = 1 / np.maximum(expected, 1e-300)
    lines = np.zeros(len(frequency), dtype=np.complex128)
    lines[inside] = (a * b.conj() * weight).sum(axis=1)
    at = int(np.fft.irfft(lines, n).argmax())
    at = at - n if at > n // 2 else at
    least = np.inf
    for shift in at + np.arange(-1.0, 1.0 + SHIFT_STEP, SHIFT_STEP):
        turned = b * np.exp(-2j * np.pi * frequency[inside] * shift * dt)[:, None]
        least = min(least, float(np.mean((np.abs(a - turned) ** 2).sum(axis=0) / np.maximum(power, 1e-300))))
    return least
