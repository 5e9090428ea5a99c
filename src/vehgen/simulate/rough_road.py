"""The spectra that a vehicle's channels should show on a rough road, as Hann segments at the speeds of a drive would measure them.

All axles meet one road, each later by its distance behind the first, so that the road's level cancels in ratios of channels but the delays
do not. The road has the shape of ISO 8608's classes: a displacement PSD that falls with the square of the frequency and rises with the
speed. A segment of T seconds sees lines blurred by the window: the spectra are convolved with the squared transform of the window, which
is the expectation of Welch's estimate of an autospectrum and of a cross-spectrum alike.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import scipy.signal
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
    model: EquationsOfMotion, frequency: Array, *, segment: float, speeds: Array, values: Mapping[str, float] | None = None
) -> Complex:
    """Return the spectral matrix of a model's channels on a road of ISO 8608's shape, of arbitrary level.

    Parameters
    ----------
    model
        Equations of motion with their channels; force laws are not in it.
    frequency
        Lines of the segments `shape (n,)` [Hz], neighbours of one another, above 0.
    segment
        Length of the segments [s].
    speeds
        Of the vehicle in equal shares of the time `shape (k,)` [m/s].
    values
        Parameters [SI] by name (default: the file's).

    Returns
    -------
    `shape (n, n_channels, n_channels)`: entry (x, y) is the mean of conj(X) Y.

    Raises
    ------
    InputError
        For a vehicle without axles.
    """
    n_axles = len(model.vehicle.axles)
    if not n_axles:
        raise InputError(f"{model.vehicle.name} has no axles, so that no road moves it")
    step = 1 / (segment * LINES_BETWEEN)
    reach = BLUR_LINES * LINES_BETWEEN
    first, last = round(frequency[0] / step) - reach, round(frequency[-1] / step) + reach
    number = np.arange(first, last + 1)
    fine = np.maximum(np.abs(number), 1) * step
    known = all_values(model, values)
    response = frequency_response(model, fine, values=known).values[:, :, :n_axles]
    offsets = model.wheel_offsets(known)
    total = np.zeros((len(fine), response.shape[1], response.shape[1]), dtype=np.complex128)
    for speed in speeds:
        channels = (response @ np.exp(-2j * np.pi * fine[:, None] * offsets / speed)[:, :, None])[:, :, 0]
        total += speed / fine[:, None, None] ** 2 * channels.conj()[:, :, None] * channels[:, None, :]
    total[number < 0] = total[number < 0].conj()  # spectra of real signals at negative frequencies
    blurred = scipy.signal.fftconvolve(total, _blur(reach)[:, None, None], mode="valid", axes=0)
    at = np.round(frequency / step).astype(int) - reach - first
    return np.asarray(blurred[at] / len(speeds))


def _blur(reach: int) -> Array:
    """Return the squared transform of a Hann window at every LINES_BETWEEN-th of a line, `reach` on either side; its sum is 1."""
    window = scipy.signal.get_window("hann", 4096)
    power = np.abs(np.fft.fft(window, LINES_BETWEEN * len(window))) ** 2
    found = power[np.arange(-reach, reach + 1)]
    return np.asarray(found / found.sum())
