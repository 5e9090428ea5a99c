"""Where in a recording the front wheel reached the hump.

The largest burst of energy marks the crossing; its onset is where the recording splits best into a quiet part and a loud one, by Akaike's
criterion for two variances (N. Maeda, Zisin 38, 1985, doi:10.4294/zisin1948.38.3_365), the picker of seismology.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from vehgen.errors import InputError

Array = NDArray[np.float64]
ENERGY_WINDOW_S = 0.3
"""Length of the running RMS [s]."""
QUIET_NEEDED = 1.0
"""Least quiet before the hump [s]."""
SMALLEST_CONTRAST = 4.0
"""Least ratio of the burst's running RMS to that of the quiet before."""
BEFORE_HUMP_S, AFTER_HUMP_S, UNSETTLED_SHARE = 3.0, 3.0, 0.6
"""Seconds searched before a crossing, seconds after it by which the vehicle has settled, share of the burst left if it has not, or that
is another pass."""


@dataclass(frozen=True)
class HumpEvent:
    """The onset and the loudest moment of a crossing [s] on the recording's clock, and how much louder it is than the quiet before."""

    onset: float
    loudest: float
    contrast: float
    warnings: tuple[str, ...] = ()


def find_hump(time: Array, upward: Array, crossing: float, name: str) -> HumpEvent:
    """Find the crossing of a hump.

    Parameters
    ----------
    time, upward
        Evenly sampled times [s] and upward acceleration [m/s^2], `shape (n,)`.
    crossing
        How long the crossing takes [s], first wheel on to last wheel off, by the vehicle's length and speed.
    name
        What errors call the recording.

    Raises
    ------
    InputError
        Where no hump stands out, or there is no quiet before it.
    """
    step = float(time[1] - time[0])
    width = max(round(ENERGY_WINDOW_S / step), 3)
    if len(time) < 4 * width:
        raise InputError(f"{name} lasts {time[-1] - time[0]:.2f} s, too short for a crossing")
    level = upward - np.median(upward)
    running = np.sqrt(np.convolve(level**2, np.ones(width) / width, mode="same"))
    loudest = int(np.argmax(running))
    peak = float(running[loudest])
    if peak < max(SMALLEST_CONTRAST * float(np.percentile(running, 25)), 1e-3):
        raise _no_hump(name, time[loudest], "hardly louder than the rest")
    first = max(0, loudest - round((crossing + BEFORE_HUMP_S) / step))
    split = first + _split(level[first : loudest + 1])
    onset = float(time[split])
    quiet = level[max(first, split - round(5.0 / step)) : max(split - round(0.1 / step), first + 1)]
    if len(quiet) * step < QUIET_NEEDED - 0.1:
        raise InputError(
            f"{name}: no {QUIET_NEEDED:g} s of quiet before {onset:.2f} s, where the loudest burst begins: start recording earlier, "
            "or cut what is not the crossing with from= and to="
        )
    contrast = peak / max(float(np.sqrt(np.mean(quiet**2))), 1e-12)
    if contrast < SMALLEST_CONTRAST:
        raise _no_hump(name, time[loudest], f"only {contrast:.1f} times as loud as the driving before")
    late = running[min(split + round((crossing + AFTER_HUMP_S) / step), len(running) - 1) : -width]
    if len(late) and float(np.median(late)) > UNSETTLED_SHARE * peak:
        raise _no_hump(name, time[loudest], "followed by no rest")
    running[np.abs(time - time[loudest]) < crossing + AFTER_HUMP_S] = 0
    other = int(np.argmax(running))
    again = f"{name}: {running[other] / peak:.0%} as loud at {time[other]:.2f} s as in the pass from {onset:.2f} s, which is taken"
    told = (f"{again}: cut what is not the crossing with from= and to=",) if running[other] > UNSETTLED_SHARE * peak else ()
    return HumpEvent(onset, float(time[loudest]), contrast, told)


def _no_hump(name: str, moment: float, why: str) -> InputError:
    return InputError(
        f"{name} shows no hump: its loudest moment, at {moment:.2f} s, is {why}. Record one pass over a known hump; of a drive over a "
        "rough road `vehgen transmissibility` compares two phones at two places"
    )


def expected_onset(upward: Array, step: float, contrast: float) -> float:
    """Return when the energy of a predicted crossing sets in [s], as :func:`find_hump` would find it in noise of such a contrast."""
    width = max(round(ENERGY_WINDOW_S / step), 3)
    running = np.sqrt(np.convolve(upward**2, np.ones(width) / width, mode="same"))
    loudest = int(np.argmax(running))
    return step * _split(upward[: loudest + 1], float(running[loudest]) / contrast)


def _split(values: Array, noise: float = 0.0) -> int:
    """Return the index that begins the second of the two parts whose variances, with that of `noise`, fit best."""
    n = len(values)
    edge = max(n // 50, 5)
    if n < 4 * edge:
        return 0
    k = np.arange(edge, n - edge)
    total = np.concatenate([[0.0], np.cumsum(values**2 + noise**2)])
    tiny = 1e-12 * max(total[-1] / n, 1e-30)
    before, after = total[k] / k + tiny, (total[-1] - total[k]) / (n - k) + tiny
    return int(k[np.argmin(k * np.log(before) + (n - k - 1) * np.log(after))])
