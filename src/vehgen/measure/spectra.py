"""Power spectral densities in one convention.

Every PSD of vehgen is one-sided and scaled so that its integral over frequency is the mean square of the signal (Parseval's theorem).
A short transient, such as the crossing of a hump, is taken as one record without a window (`record_psd`): its zeros before and after need
none. A long stationary signal, such as a rough road, is averaged by Welch's method with Hann windows (`welch_psd`; P. D. Welch, IEEE Trans.
Audio Electroacoust. 15(2), 1967, doi:10.1109/TAU.1967.1161901).
"""

from __future__ import annotations

import numpy as np
import scipy
from numpy.typing import NDArray

from vehgen.errors import InputError

Array = NDArray[np.float64]


def record_psd(values: Array, dt: float, axis: int = -1) -> tuple[Array, Array]:
    """Return the PSD of one whole record.

    Parameters
    ----------
    values
        Samples along `axis`, n of them.
    dt
        Spacing of the samples [s].

    Returns
    -------
    frequency `shape (n // 2 + 1,)` [Hz] and the PSD [unit^2/Hz], that axis replaced by frequency: 2 dt/n |FFT|^2, without the factor 2 at 0
    and at the Nyquist frequency.
    """
    n = values.shape[axis]
    transform = np.fft.rfft(values, axis=axis)
    density = (transform.real**2 + transform.imag**2) * (2 * dt / n)
    edges = [0] if n % 2 else [0, density.shape[axis] - 1]
    index: list[slice | list[int]] = [slice(None)] * density.ndim
    index[axis] = edges
    density[tuple(index)] /= 2
    return np.asarray(np.fft.rfftfreq(n, dt), dtype=np.float64), np.asarray(density)


def welch_psd(values: Array, dt: float, segment: float = 4.0, axis: int = -1) -> tuple[Array, Array]:
    """Return the PSD averaged over half-overlapping Hann segments, the mean of each removed.

    Parameters
    ----------
    values
        Samples along `axis`.
    dt
        Spacing of the samples [s].
    segment
        Length of a segment [s]; a shorter signal is one segment.

    Raises
    ------
    InputError
        For fewer than 8 samples.
    """
    n = values.shape[axis]
    if n < 8:
        raise InputError(f"a PSD needs at least 8 samples, found {n}")
    length = min(n, max(8, round(segment / dt)))
    frequency, density = scipy.signal.welch(values, fs=1 / dt, window="hann", nperseg=length, detrend="constant", axis=axis)
    return np.asarray(frequency), np.asarray(density)
