"""Whittle's likelihood of spectral lines with its derivatives, compiled, kept and loaded as kernels are.

A search of the likeliest noise asks for it hundreds of times, each time for the inverses of some thousand small matrices: by calls of
LAPACK that took a tenth of a calibration.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vehgen.codegen.cache import compile_loops

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
_SIGNATURE_OF_LINES = "f8(c16[:, ::1], f8[:, ::1], f8[::1], c16[:, :, ::1], c16[:, :, ::1], f8[::1], f8[::1])"


def sum_lines(lines: Complex, scale: Array, level: Array, gain: Complex, forced: Complex, by_level: Array, by_scale: Array) -> float:
    """Return the sum of 2 (ln det S + R* S^-1 R) over lines R, and set its derivatives by ln(level) and ln(scale).

    S = diag(d) (1 + B B*) diag(d) with B = diag(1/d) (sqrt(level) gain, forced). The lower Cholesky factor L of 1 + B B* takes in one
    column of B after the other by rotations, which lose nothing however loud the road is.
    """
    n, channels = lines.shape
    roads, width = gain.shape[2], gain.shape[2] + forced.shape[2]
    b, low = np.zeros((channels, width), np.complex128), np.zeros((channels, channels), np.complex128)
    inverse, white = np.zeros((channels, channels), np.complex128), np.zeros(channels, np.complex128)  # of L; L^-1 R
    column = np.zeros(channels, np.complex128)
    loss = 0.0
    by_scale[:] = 0.0
    for m in range(n):
        root = np.sqrt(level[m])
        for i in range(channels):
            low[i, : i + 1] = 0.0
            low[i, i] = 1.0
        for a in range(width):
            for i in range(channels):
                b[i, a] = (gain[m, i, a] * root if a < roads else forced[m, i, a - roads]) * (1 / scale[m, i])
                column[i] = b[i, a]
            for k in range(channels):
                length = np.sqrt(low[k, k].real ** 2 + column[k].real ** 2 + column[k].imag ** 2)
                cosine, sine = low[k, k].real / length, column[k] * (1 / length)
                low[k, k] = length
                for i in range(k + 1, channels):
                    own = low[i, k]
                    low[i, k] = cosine * own + np.conj(sine) * column[i]
                    column[i] = cosine * column[i] - sine * own
        for i in range(channels):
            share = 1 / low[i, i].real
            inverse[i, i] = share
            white[i] = lines[m, i] * (1 / scale[m, i])
            for j in range(i):
                white[i] -= low[i, j] * white[j]
                total = 0.0j
                for k in range(j, i):
                    total -= low[i, k] * inverse[k, j]
                inverse[i, j] = total * share
            white[i] *= share
            loss += 2 * (2 * np.log(low[i, i].real * scale[m, i]) + white[i].real ** 2 + white[i].imag ** 2)
        for j in range(channels):
            total = 0.0j
            for i in range(j, channels):
                total += np.conj(inverse[i, j]) * white[i]
                by_scale[j] += 4 * (inverse[i, j].real ** 2 + inverse[i, j].imag ** 2)
            by_scale[j] -= 4 * (total.real**2 + total.imag**2)
        change = 0.0
        for a in range(roads):
            along = 0.0j
            for i in range(channels):
                total = 0.0j
                for k in range(i + 1):
                    total += inverse[i, k] * b[k, a]
                change += total.real**2 + total.imag**2
                along += np.conj(white[i]) * total
            change -= along.real**2 + along.imag**2
        by_level[m] = 2 * change
    return loss


def loss_and_slopes(lines: Complex, scale: Array, level: Array, gain: Complex, forced: Complex) -> tuple[float, Array, Array]:
    """Return -2 ln of Whittle's likelihood of spectral lines, less a constant, and its derivatives.

    Parameters
    ----------
    lines
        `shape (n, n_channels)`.
    scale
        Root of the density of what each channel has for itself, d, `shape (n, n_channels)`.
    level
        The road's level at each line, `shape (n,)`.
    gain, forced
        What a road of level 1, and errors of forces, make of the channels: the density of lines is diag(d^2) + level gain gain* + forced
        forced*. `shape (n, n_channels, n_axles)` and `(n, n_channels, n_forces)`.

    Returns
    -------
    The loss; its derivatives by ln(level), line by line, `shape (n,)`; and by ln(d), a factor of each channel, `shape (n_channels,)`.
    """
    by_level, by_scale = np.empty(len(lines)), np.empty(lines.shape[1])
    arrays = (np.ascontiguousarray(item) for item in (lines, scale, level, gain, forced))
    return float(compile_loops(sum_lines, _SIGNATURE_OF_LINES)(*arrays, by_level, by_scale)), by_level, by_scale
