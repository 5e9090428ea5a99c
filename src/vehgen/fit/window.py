"""The window under which records are compared, and the spectral lines of what is seen through it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import scipy
from numpy.typing import NDArray

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
RAMP = 0.75
"""Length of the window's ramps [s]."""
AFTER_RELEASE = 0.1
"""The same at the start of a run whose initial state is stated [s], through a recorder: its low-pass has forgotten the rest before then."""


@dataclass(frozen=True)
class Window:
    """How a record is seen: it fades in within `fade_in` [s]; where it is `zeroed`, constants leave no lines.

    A sensor's zero is unknown. A rig has motions so slow that it would count among them, and a window that begins at full weight spreads
    it over all lines.
    """

    fade_in: float = RAMP
    zeroed: bool = False


@lru_cache(maxsize=64)
def taper(n_samples: int, dt: float, fade_in: float = RAMP) -> Array:
    """Return the window under which records are compared: cosine ramps of RAMP [s], or an eighth of a short record, at both ends.

    What the vehicle did before the record began is unknown, and so are its first and last moments; where they are stated, the record
    fades in within `fade_in` [s], or begins at full weight. Not to be written to.
    """
    begin, end = (scipy.signal.windows.tukey(n_samples, min(2 * ramp / (n_samples * dt), 0.25)) for ramp in (fade_in, RAMP))
    window = np.asarray(np.where(np.arange(n_samples) < n_samples // 2, begin, end), dtype=np.float64)
    window.setflags(write=False)
    return window


def seen_share(n_samples: int, dt: float, fade_in: float = RAMP) -> float:
    """Return the share of a record that :func:`taper` lets through: by so much less do its lines tell than as many independent ones."""
    return float(np.mean(taper(n_samples, dt, fade_in) ** 2))


def transform(values: Array, dt: float, inside: NDArray[np.bool_], late: Array | None = None, seen: Window = Window()) -> Complex:
    """Return spectral lines of tapered histories `shape (..., n_samples, n_channels)`, scaled so that |line|^2 is a one-sided PSD.

    `late shape (n_channels,)` [s] moves each channel's window so much earlier: lines turned by that delay are then those of the delayed
    channel under the window as it is.
    """
    windows, scale = _windows(values.shape[-2], dt, seen.fade_in, None if late is None else tuple(late.tolist()))
    if seen.zeroed:
        values = values - (values * windows).sum(axis=-2, keepdims=True) / windows.sum(axis=0)
    return np.asarray(np.fft.rfft(values * scale, axis=-2)[..., _stretch(inside), :])


def pulled_back(lines: Complex, n_samples: int, dt: float, numbers: NDArray[np.intp], seen: Window = Window()) -> Array:
    """Return histories g `shape (..., n_samples, n_channels)` by which sum(g v) is Re sum(lines* V), V what :func:`transform` makes of v.

    `numbers shape (n_lines,)` are those of the lines `shape (..., n_lines, n_channels)` among the spectrum's.
    """
    windows, scale = _windows(n_samples, dt, seen.fade_in, None)
    spectrum = np.zeros((*lines.shape[:-2], n_samples, lines.shape[-1]), dtype=np.complex128)
    spectrum[..., numbers, :] = lines
    found = np.fft.ifft(spectrum, axis=-2).real * n_samples * scale
    return np.asarray(found - windows * found.sum(axis=-2, keepdims=True) / windows.sum() if seen.zeroed else found)


@lru_cache(maxsize=64)
def _windows(n_samples: int, dt: float, fade_in: float, late: tuple[float, ...] | None) -> tuple[Array, Array]:
    """Return the windows of channels, `shape (n_samples, n_channels)` or, without delays, (n_samples, 1); and these scaled."""
    window = taper(n_samples, dt, fade_in)
    windows = window[:, None]
    if late is not None and any(late):
        moved = {item: _moved(window, item / dt) for item in dict.fromkeys(late)}
        windows = np.column_stack([moved[item] for item in late])
    return windows, windows * np.sqrt(2 * dt / (window @ window))


def _stretch(inside: NDArray[np.bool_]) -> NDArray[np.bool_] | slice:
    """Return the lines inside a band as a slice, where they lie side by side: it is cut out without a copy."""
    first, count = int(inside.argmax()), int(np.count_nonzero(inside))
    return slice(first, first + count) if inside[first : first + count].all() else inside


def _moved(window: Array, samples: float) -> Array:
    """Return a window so many samples earlier, between its samples linear; what came before the record counts nothing."""
    whole = min(max(math.floor(samples), -len(window)), len(window))
    nothing = np.zeros(abs(whole) + 1)
    around, first = np.concatenate([nothing, window, nothing]), len(nothing) + whole
    here, after = (around[start : start + len(window)] for start in (first, first + 1))
    return np.asarray(here + (samples - math.floor(samples)) * (after - here))


def flatten(white: Complex, first: int = 0) -> Array:
    """Return real and imaginary parts as residuals of unit variance; the axes before `first` are kept."""
    flat = white.reshape(*white.shape[:first], math.prod(white.shape[first:])) * np.sqrt(2)
    return np.concatenate([flat.real, flat.imag], axis=-1)
