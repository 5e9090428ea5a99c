"""A compiled decimating FIR filter for the responses of populations, kept and loaded as kernels are.

Every sample is a sum over many kept steps. Split into its phases, the signal is read in order: each tap adds one shifted stretch to all
samples at once, which is what vector instructions are made for.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from vehgen.codegen.cache import compile_loops

Array = NDArray[np.float64]
MANY_NUMBERS = 5_000_000
"""Numbers below which one core is as quick as several."""
TAPS_AT_ONCE = 4
"""Taps that are added to the samples in one pass."""
_SIGNATURE_OF_PHASES = "void(f8[:, :, ::1], f8[:, :, ::1], i8, f8[:, :, ::1])"


def filter_phases(fine: Array, weights: Array, last: int, found: Array) -> None:
    """Set found[a, i, c] to the sum over phases p and shifts q of weights[c, p, q] fine[a, (i + q - last) ratio - p, c]."""
    n_fine, n_samples = fine.shape[1], found.shape[1]
    ratio, n_shifts = weights.shape[1], weights.shape[2]
    phase = np.empty(n_samples + n_shifts)
    total = np.empty(n_samples)
    for a in range(fine.shape[0]):
        for c in range(fine.shape[2]):
            for i in range(n_samples):
                total[i] = 0.0
            for p in range(ratio):
                for m in range(n_samples + n_shifts):
                    r = (m - last) * ratio - p
                    phase[m] = fine[a, r, c] if 0 <= r < n_fine else 0.0
                for q in range(0, n_shifts, 4):
                    w0, w1 = weights[c, p, q], weights[c, p, q + 1]
                    w2, w3 = weights[c, p, q + 2], weights[c, p, q + 3]
                    s0, s1 = phase[q : q + n_samples], phase[q + 1 : q + 1 + n_samples]
                    s2, s3 = phase[q + 2 : q + 2 + n_samples], phase[q + 3 : q + 3 + n_samples]
                    for i in range(n_samples):  # over slices that begin at 0: an index that might be negative is no vector's
                        total[i] += w0 * s0[i] + w1 * s1[i] + w2 * s2[i] + w3 * s3[i]
            for i in range(n_samples):  # assigned as a whole, its errors would take most of the time to compile
                found[a, i, c] = total[i]


@dataclass(frozen=True)
class Phases:
    """Filters split into the phases of what they decimate, as :func:`filter_phases` reads them.

    `weights shape (n_channels, ratio, n_shifts)`; `last` is the number of the last shift.
    """

    weights: Array
    last: int

    @classmethod
    def of(cls, filters: Sequence[tuple[int, Array]], ratio: int) -> Phases:
        """Return the phases of filters, each the number of its first tap (below 0: it looks ahead) and its taps.

        `ratio` is how many of the signals' numbers there are a sample.
        """
        lowest = min(first // ratio for first, _ in filters)
        last = max((first + len(taps) - 1) // ratio for first, taps in filters)
        n_shifts = -(-(last - lowest + 1) // TAPS_AT_ONCE) * TAPS_AT_ONCE
        weights = np.zeros((len(filters), ratio, n_shifts))
        for channel, (first, taps) in enumerate(filters):
            shift, phase = np.divmod(first + np.arange(len(taps)), ratio)
            weights[channel, phase, last - shift] = taps
        return cls(weights, last)


def decimate(fine: Array, phases: Phases, count: int, threads: int | None = None) -> Array:
    """Return filtered and decimated signals that rest before their beginning, and after their end.

    Parameters
    ----------
    fine
        `shape (n, n_fine, n_channels)`.
    phases
        Every channel's filter.
    count
        How many samples are wanted.
    threads
        How many cores to use (default: all).

    Returns
    -------
    `shape (n, count, n_channels)`.
    """
    fine = np.ascontiguousarray(fine)
    found = np.empty((len(fine), count, len(phases.weights)))
    workers = min(threads or os.cpu_count() or 1, len(fine)) if fine.size > MANY_NUMBERS and len(fine) > 1 else 1
    bounds = np.linspace(0, len(fine), workers + 1).astype(int).tolist()
    run = compile_loops(filter_phases, _SIGNATURE_OF_PHASES)

    def part(number: int) -> None:
        piece = slice(bounds[number], bounds[number + 1])
        run(fine[piece], phases.weights, phases.last, found[piece])

    if workers > 1:
        with ThreadPoolExecutor(workers) as pool:
            list(pool.map(part, range(workers)))
    else:
        part(0)
    return found
