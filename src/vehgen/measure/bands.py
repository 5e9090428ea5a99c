"""RMS values in frequency bands and their relative errors (Wu & Li 2023, Eqs. 31 and 32, doi:10.3390/s23249691)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from vehgen.errors import InputError

Array = NDArray[np.float64]
TWO_AXLE_BANDS = ((0.1, 2.0), (2.0, 5.0), (5.0, 8.0), (8.0, 12.0), (12.0, 15.0), (15.0, 20.0), (20.0, 50.0))
"""Bands of the paper for two-axle vehicles [Hz]; it compares them up to 15 Hz."""
ARTICULATED_BANDS = ((2.0, 5.0), (5.0, 8.0), (8.0, 12.0), (12.0, 15.0), (15.0, 20.0))
"""Bands of the paper for articulated vehicles [Hz], within the 2-20 Hz that it compares."""


def band_rms(frequency: Array, density: Array, bands: Sequence[tuple[float, float]]) -> Array:
    """Return the RMS within bands: the root of the trapezoidal integral of the PSD, linear between its samples.

    Eq. 31 of the paper prints the integral without its root; the unit of an RMS wants it.

    Parameters
    ----------
    frequency
        `shape (n,)` [Hz], evenly spaced and ascending.
    density
        `shape (..., n)` [unit^2/Hz].
    bands
        Pairs (from, to) [Hz] within the frequencies.

    Returns
    -------
    `shape (..., len(bands))` [unit].
    """
    step = np.diff(frequency)
    pieces = (density[..., 1:] + density[..., :-1]) * step / 2
    integral = np.concatenate([np.zeros((*density.shape[:-1], 1)), np.cumsum(pieces, axis=-1)], axis=-1)
    found = []
    for low, high in bands:
        if not frequency[0] <= low < high <= frequency[-1] + 1e-9:
            raise InputError(f"the band {low:g}-{high:g} Hz is not within the PSD's {frequency[0]:g}-{frequency[-1]:g} Hz")
        found.append(_integral_to(frequency, density, integral, high) - _integral_to(frequency, density, integral, low))
    return np.asarray(np.sqrt(np.maximum(np.stack(found, axis=-1), 0.0)))


def _integral_to(frequency: Array, density: Array, integral: Array, end: float) -> Array:
    i = min(int(np.searchsorted(frequency, end, side="right")) - 1, len(frequency) - 2)
    part = min(end, float(frequency[-1])) - frequency[i]
    slope = (density[..., i + 1] - density[..., i]) / (frequency[i + 1] - frequency[i])
    return np.asarray(integral[..., i] + part * (density[..., i] + slope * part / 2))


def relative_errors(simulated: Array, measured: Array) -> Array:
    """Return (simulated - measured)/measured, as Eq. 32; NaN where nothing was measured."""
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(np.where(measured > 0, (simulated - measured) / measured, np.nan))
