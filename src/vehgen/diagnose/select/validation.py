"""What validation runs say of an effect: the share of their gap that it closes, or the squares that it takes off where they show none."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from vehgen.diagnose import thresholds as limit
from vehgen.diagnose.fits.model_fit import ModelFit

Array = NDArray[np.float64]
BLOCK_LINES = 10
"""Spectral lines in a block of the bootstrap."""


def validation_gain(base: ModelFit, fit: ModelFit) -> float | None:
    """Return the share of the excess on validation runs that a fit closes; None where those runs show no gap, or were not simulated."""
    if not (np.isfinite(fit.validation) and base.validation > limit.NOISE_FLOOR**2):
        return None
    return float(1 - max(fit.validation - 1, 0.0) / (base.validation - 1))


def gain_interval(
    base: ModelFit, fit: ModelFit, validation_runs: Sequence[str], draws: int = 400, seed: int = 7
) -> tuple[float, float] | None:
    """Return the 90 % interval of :func:`validation_gain`, by a bootstrap over blocks of spectral lines; None where that is None.

    Blocks of BLOCK_LINES neighbouring lines of all channels are drawn with replacement (Kuensch 1989, doi:10.1214/aos/1176347265).
    """
    if validation_gain(base, fit) is None:
        return None
    old, new, count = _drawn_blocks(base, fit, validation_runs, draws, seed)
    least = 0.1 * (base.validation - 1)  # a draw may miss the lines that hold the gap
    shares = 1 - np.maximum(new / count - 1, 0.0) / np.maximum(old / count - 1, least)
    low, high = np.percentile(shares, [5, 95])
    return float(low), float(high)


def _drawn_blocks(base: ModelFit, fit: ModelFit, runs: Sequence[str], draws: int, seed: int) -> Array:
    """Return sums of squares of runs before and after, and how many squares they add up, of blocks drawn anew: `shape (3, draws)`."""
    parts = []
    for name in runs:
        before, after = base.spectra[name], fit.spectra[name]
        for lines in np.array_split(np.arange(len(before)), max(1, len(before) // BLOCK_LINES)):
            parts.append((before[lines].sum(), after[lines].sum(), before[lines].size))
    blocks = np.array(parts)
    random = np.random.Generator(np.random.PCG64(seed))
    return np.asarray(blocks[random.integers(len(blocks), size=(draws, len(blocks)))].sum(axis=1).T)


def validation_fall(base: ModelFit, fit: ModelFit) -> float:
    """Return by how much -2 ln of the likelihood of the validation runs and of their errors falls; minus infinity without any."""
    old, new = base.validation_fit, fit.validation_fit
    return -np.inf if old is None or new is None else old.loss - new.loss


def seen_again(base: ModelFit, fit: ModelFit, validation_runs: Sequence[str], draws: int = 400, seed: int = 7) -> bool:
    """Return whether validation runs speak for what a fit adds.

    Where they show a gap, the interval of what it closes is above 0. Where they do not, as chi hardly tells a few hundred in squares that
    one law takes off many thousand lines, their squares fall by VALIDATION_FALL, and surely fall.
    """
    interval = gain_interval(base, fit, validation_runs, draws, seed)
    if interval is not None:
        return interval[0] > 0
    if not validation_runs or not np.isfinite(fit.validation):
        return False
    fall = 2 * sum(float((base.spectra[name] - fit.spectra[name]).sum()) for name in validation_runs)
    return fall >= limit.VALIDATION_FALL and surely_falls(base, fit, validation_runs, draws, seed)


def surely_falls(base: ModelFit, fit: ModelFit, validation_runs: Sequence[str], draws: int = 400, seed: int = 7) -> bool:
    """Return whether the squares of the validation runs fall in 95 of 100 draws of blocks of their lines."""
    old, new, _ = _drawn_blocks(base, fit, validation_runs, draws, seed)
    return float(np.percentile(old - new, 5)) > 0
