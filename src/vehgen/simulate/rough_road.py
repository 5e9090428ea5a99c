"""The spectra that a vehicle's channels should show on a rough road, as Hann segments at the speeds of a drive would measure them.

All axles meet one road, each later by its distance behind the first, so that the road's level cancels in ratios of channels but the delays
do not. The road has the shape of ISO 8608's classes: a displacement PSD that falls with the square of the frequency and rises with the
speed. A segment of T seconds sees lines blurred by the window: the spectra are convolved with the squared transform of the window, which
is the expectation of Welch's estimate of an autospectrum and of a cross-spectrum alike.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import scipy
from numpy.typing import NDArray

from vehgen.errors import InputError
from vehgen.mechanics import EquationsOfMotion, all_values
from vehgen.simulate.frequency_response import frequency_response

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
LINES_BETWEEN = 8
"""So many times finer than a segment's lines the spectra are computed before they are blurred."""
BLUR_LINES = 6
"""So many lines on either side reach into one: beyond, a Hann window passes less than 1e-6 of the power."""


def rough_road_spectra(
    model: EquationsOfMotion,
    frequency: Array,
    *,
    speeds: Array,
    segment: float | None = None,
    values: Mapping[str, float] | None = None,
    delays: Array | None = None,
) -> Complex:
    """Return the spectral matrix of a model's channels on a road of ISO 8608's shape, of arbitrary level.

    Parameters
    ----------
    model
        Equations of motion with their channels; force laws are not in it.
    frequency
        `shape (n,)` [Hz], above 0; with `segment` neighbouring lines of its transform.
    speeds
        Of the vehicle in equal shares of the time `shape (k,)` [m/s].
    segment
        Length of the Hann segments [s] by which the lines are blurred (default: they are not).
    values
        Parameters [SI] by name (default: the file's).
    delays
        How much later each channel was recorded than it happened `shape (n_channels,)` [s] (default: not at all).

    Returns
    -------
    `shape (n, n_channels, n_channels)`: entry (x, y) is the mean of conj(X) Y.

    Raises
    ------
    InputError
        For a vehicle without axles.
    """
    if not model.vehicle.axles:
        raise InputError(f"{model.vehicle.name} has no axles, so that no road moves it")
    known = all_values(model, values)
    late = np.zeros(len(model.channels)) if delays is None else delays
    if segment is None:
        return _spectra(model, known, frequency, speeds, late)
    step = 1 / (segment * LINES_BETWEEN)
    reach = BLUR_LINES * LINES_BETWEEN
    first, last = round(frequency[0] / step) - reach, round(frequency[-1] / step) + reach
    number = np.arange(first, last + 1)
    fine = _spectra(model, known, np.maximum(np.abs(number), 1) * step, speeds, late)
    fine[number < 0] = fine[number < 0].conj()  # spectra of real signals at negative frequencies
    blurred = scipy.signal.fftconvolve(fine, _blur(reach)[:, None, None], mode="valid", axes=0)
    return np.asarray(blurred[np.round(frequency / step).astype(int) - reach - first])


def _spectra(model: EquationsOfMotion, values: Mapping[str, float], frequency: Array, speeds: Array, delays: Array) -> Complex:
    """Return the spectral matrix at frequencies above 0, unblurred."""
    response = frequency_response(model, frequency, values=values).values[:, :, : len(model.vehicle.axles)]
    response = response * np.exp(-2j * np.pi * frequency[:, None] * delays)[:, :, None]
    offsets = model.wheel_offsets(values)
    total = np.zeros((len(frequency), response.shape[1], response.shape[1]), dtype=np.complex128)
    for speed in speeds:
        channels = (response @ np.exp(-2j * np.pi * frequency[:, None] * offsets / speed)[:, :, None])[:, :, 0]
        total += speed / frequency[:, None, None] ** 2 * channels.conj()[:, :, None] * channels[:, None, :]
    return np.asarray(total / len(speeds))


def _blur(reach: int) -> Array:
    """Return the squared transform of a Hann window at every LINES_BETWEEN-th of a line, `reach` on either side; its sum is 1."""
    window = scipy.signal.get_window("hann", 4096)
    power = np.abs(np.fft.fft(window, LINES_BETWEEN * len(window))) ** 2
    found = power[np.arange(-reach, reach + 1)]
    return np.asarray(found / found.sum())
