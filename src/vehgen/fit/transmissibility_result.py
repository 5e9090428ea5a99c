"""Transmissibilities as a result: the ratio of every channel to a reference, the peaks that all share, and what a vehicle makes of both."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, ClassVar

import numpy as np
from pydantic import Field

from vehgen.files.result_fields import Array1D, Array2D, Number
from vehgen.files.results import Cell, Result, Table

MAX_RATIOS, MAX_BANDS = 200, 100
"""A file with more channels or bands is refused: no figure could show them."""


@dataclass(frozen=True)
class RatioBand:
    """A channel over the reference in a band.

    Attributes
    ----------
    low, high
        The band [Hz].
    coherence
        Mean over its lines.
    lines
        How many of its lines show common motion; only these are used.
    ratio, lower, upper
        Mean ratio and the limits that hold what the two do not share and, to 95 %, chance; undefined without such lines.
    model
        The vehicle's ratio over `ratio`, None without a vehicle.
    distance
        How far the vehicle's ratio lies outside of the measured interval, line by line, in standard errors (root of the mean square).
    limit
        A distance that the right vehicle exceeds in one comparison of a hundred, that of all bands and channels counting as one.
    """

    low: float
    high: float
    coherence: float
    lines: int
    ratio: Number
    lower: Number
    upper: Number
    model: Number | None = None
    distance: Number | None = None
    limit: Number | None = None

    @property
    def is_apart(self) -> bool:
        """Whether the vehicle's ratio lies outside of what was measured."""
        return self.distance is not None and self.limit is not None and bool(self.distance > self.limit)


@dataclass(frozen=True, eq=False)
class ChannelRatio:
    """A channel over the reference, line by line, all `shape (n,)`: see :class:`vehgen.measure.transmissibility.RatioEstimate`.

    `common` is 1 where the line shows common motion, else 0; `model_h1` and `model_h2` are what the vehicle would show, None without one.
    """

    channel: str
    unit: str
    h1: Array1D
    h2: Array1D
    lower: Array1D
    upper: Array1D
    phase: Array1D
    coherence: Array1D
    common: Array1D
    bands: Annotated[tuple[RatioBand, ...], Field(max_length=MAX_BANDS)]
    model_h1: Array1D | None = None
    model_h2: Array1D | None = None

    def __post_init__(self) -> None:
        arrays = (self.h1, self.h2, self.lower, self.upper, self.phase, self.coherence, self.common, self.model_h1, self.model_h2)
        if len({len(array) for array in arrays if array is not None}) != 1:
            raise ValueError("arrays of one length were expected")


@dataclass(frozen=True)
class Resonance:
    """A peak that all channels show at `frequency` [Hz], how far it rises in each [dB], and the vehicle's mode nearest to it.

    `coherence` is the best within the peak's width of the channel that shares least with the reference: where it is low, what shakes the
    channels differs, such as the two wheel tracks.
    """

    frequency: float
    prominence: tuple[float, ...]
    coherence: float
    mode: str | None = None
    mode_hz: float | None = None


@dataclass(frozen=True, eq=False)
class Transmissibility(Result):
    """What sensors in one vehicle tell of each other on a rough road.

    `frequency shape (n,)` [Hz]; `densities shape (n, n_channels)` PSDs of `channels`, the reference first, in the square of `units` per Hz;
    `ratios` of the other channels to it; `averages` how many independent averages of segments of `segment` s they are worth; `speeds`
    lowest, median and highest [m/s], None where unknown; `speed_scale` the factor on them at which the vehicle fits best; `vehicle` the one
    compared with, if any; `tells` and `cannot_tell` what may be concluded.
    """

    KIND: ClassVar[str] = "transmissibility"
    DRAWING: ClassVar[str] = "vehgen.report.plots.transmissibility_plot:plot_transmissibility"

    title: str
    channels: tuple[str, ...]
    units: tuple[str, ...]
    frequency: Array1D
    densities: Array2D
    ratios: Annotated[tuple[ChannelRatio, ...], Field(min_length=1, max_length=MAX_RATIOS)]
    resonances: tuple[Resonance, ...]
    averages: float
    segment: float
    duration: float
    speeds: tuple[float, float, float] | None
    speed_scale: float | None
    vehicle: str | None
    tells: tuple[str, ...]
    cannot_tell: tuple[str, ...]
    notes: tuple[str, ...]
    warnings: tuple[str, ...]

    def __post_init__(self) -> None:
        n = len(self.frequency)
        if self.densities.shape != (n, len(self.channels)) or len(self.units) != len(self.channels) or n < 2:
            raise ValueError("a density for every frequency and channel, and two lines or more, were expected")
        if [item.channel for item in self.ratios] != list(self.channels[1:]) or any(len(item.h1) != n for item in self.ratios):
            raise ValueError("a ratio for every channel but the first, of a number for every frequency, was expected")

    @property
    def reference(self) -> str:
        """The channel that all others are divided by."""
        return self.channels[0]

    @property
    def apart(self) -> tuple[tuple[str, RatioBand], ...]:
        """The channels and bands in which the vehicle's ratio lies outside of what was measured."""
        return tuple((item.channel, band) for item in self.ratios for band in item.bands if band.is_apart)

    def table(self) -> Table:
        """Return the bands of every channel, a row each."""
        columns = ("channel", "band [Hz]", "coherence", "ratio", "lower", "upper", "model/measured", "distance", "limit", "apart")
        rows: list[tuple[Cell, ...]] = []
        for item in self.ratios:
            for band in item.bands:
                numbers = (band.ratio, band.lower, band.upper, band.model, band.distance, band.limit)
                cells = [value if value is not None and np.isfinite(value) else None for value in numbers]
                compared = band.is_apart if band.distance is not None else None
                rows.append((item.channel, f"{band.low:g}-{band.high:g}", band.coherence, *cells, compared))
        return columns, rows
