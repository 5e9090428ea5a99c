"""How a recording compares with a prediction: correlation at every lag, levels, and the share of the energy that is not explained."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from vehgen.fit.trial import Trial

Array = NDArray[np.float64]
REACH = 3.0
"""Clocks are looked for as far apart as this [s]."""
MOST_UNEXPLAINED = 2.0
"""A channel's unexplained share of energy counts as no more than this."""


@dataclass(frozen=True)
class Comparison:
    """A recording beside a prediction.

    `correlation` is that of every measured channel (second axis) with every predicted one, `shape (n_lags, n_channels, n_channels)`, from
    the recording early to the recording late by `dt` [s] a step; `levels` are the logarithms of measured over predicted RMS within the
    band, `shape (n_channels,)`.
    """

    correlation: Array
    levels: Array
    dt: float

    @property
    def own(self) -> Array:
        """The correlation of every channel with its own prediction, `shape (n_lags, n_channels)`."""
        return np.diagonal(self.correlation, axis1=1, axis2=2)

    @property
    def best(self) -> int:
        """The number of the lag at which all channels correlate best."""
        return int(self.own.mean(axis=1).argmax())

    @property
    def score(self) -> float:
        """The mean correlation at that lag."""
        return float(self.own.mean(axis=1).max())

    @property
    def lag(self) -> float:
        """That lag [s]: how late the recording is."""
        return self.seconds(self.own.mean(axis=1))

    def seconds(self, curve: Array) -> float:
        """Return the lag [s] at which a curve over the lags is highest, between its samples by a parabola."""
        at = int(curve.argmax())
        part = 0.0
        if 0 < at < len(curve) - 1:
            before, top, after = curve[at - 1 : at + 2]
            part = float((before - after) / (2 * (before - 2 * top + after))) if before - 2 * top + after < 0 else 0.0
        return (at + part - len(curve) // 2) * self.dt

    @property
    def unexplained(self) -> float:
        """The mean share of the channels' energy that the prediction leaves, at the best lag."""
        ratio = np.exp(-self.levels)
        share = np.minimum(1 + ratio**2 - 2 * ratio * self.own, MOST_UNEXPLAINED)
        return float(share.mean(axis=1).min())

    def within(self, lag: float) -> Array:
        """Return the correlation at lags up to `lag` [s] only."""
        middle, reach = len(self.correlation) // 2, int(lag / self.dt)
        return self.correlation[max(middle - reach, 0) : middle + reach + 1]


def compare(trial: Trial, predicted: Array, band: tuple[float, float], reach: float = REACH) -> Comparison:
    """Return a trial's recording beside predicted readings `shape (n_samples, n_channels)` within a band [Hz], at lags up to `reach`."""
    dt, n = trial.recording.dt, len(predicted)
    frequency = np.fft.rfftfreq(2 * n, dt)
    inside = ((frequency >= band[0]) & (frequency <= band[1]))[:, None]
    measured, model = (np.fft.rfft(item, 2 * n, axis=0) * inside for item in (trial.recording.values[:n], predicted))
    cross = np.fft.irfft(measured[:, :, None] * model[:, None, :].conj(), 2 * n, axis=0)
    own, other = (np.maximum(np.sqrt((np.fft.irfft(item, 2 * n, axis=0) ** 2).sum(axis=0)), 1e-300) for item in (measured, model))
    last = min(int(reach / dt), n - 1)
    return Comparison(np.asarray(cross[np.arange(-last, last + 1)] / np.outer(own, other)), np.log(own / other), dt)
