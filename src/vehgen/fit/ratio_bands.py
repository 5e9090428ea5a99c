"""A measured ratio of two channels, band by band, and how far a model's ratio lies outside of it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import scipy
from numpy.typing import NDArray

from vehgen.files.result_fields import rounded
from vehgen.fit.nuisances import Nuisances
from vehgen.fit.transmissibility_result import ChannelRatio, RatioBand
from vehgen.measure.transmissibility import NEIGHBOUR_INFLATION, RatioEstimate, model_ratio

Array = NDArray[np.float64]
GAIN_RATIO_SIGMA = Nuisances().gain * 2**0.5
"""Standard error of a ratio by the gains of both sensors."""
FALSE_ALARMS = 0.01
"""Of all comparisons of a right model."""


def compared_ratio(
    channel: str,
    unit: str,
    frequency: Array,
    estimate: RatioEstimate,
    bands: Sequence[tuple[float, float]],
    expected: NDArray[np.complex128] | None,
    number: int,
    n_comparisons: int,
) -> ChannelRatio:
    """Return a channel's ratio with its bands.

    Parameters
    ----------
    channel, unit
        Its name, and the ratio's unit.
    frequency
        Lines `shape (n,)` [Hz].
    estimate
        The measured ratio on these lines.
    bands
        Pairs (from, to) [Hz].
    expected
        A model's spectral matrix `shape (n, n_channels, n_channels)`, the reference first; None without one.
    number
        Which of its channels this is.
    n_comparisons
        How many bands of all channels are compared together.
    """
    model = None if expected is None else model_ratio(expected, 0, number)
    found = [_band(frequency, estimate, band, model, n_comparisons) for band in bands]
    return ChannelRatio(
        channel,
        unit,
        h1=rounded(estimate.h1),
        h2=rounded(estimate.h2),
        lower=rounded(estimate.lower),
        upper=rounded(estimate.upper),
        phase=rounded(estimate.phase),
        coherence=rounded(estimate.coherence),
        common=estimate.common.astype(np.float64),
        bands=tuple(found),
        model_h1=None if model is None else rounded(model[0]),
        model_h2=None if model is None else rounded(model[1]),
    )


def squares_outside(estimate: RatioEstimate, model: tuple[Array, Array], used: NDArray[np.bool_]) -> float:
    """Return the sum of squares, in standard errors, by which a model's H1 lies below the measured one, or its H2 above; 0 between the two.

    Of the lines `used shape (n,)`, as many as are independent. What both sensors' gains may be off is the same at all of them: the
    likeliest such factor is taken out, at its price.
    """
    below, above, error = (item[used] for item in (np.log(estimate.h1 / model[0]), np.log(model[1] / estimate.h2), estimate.error))

    def squares(gain: float) -> float:
        beyond = np.maximum(np.maximum(below - gain, above + gain), 0.0) / error
        return float((beyond**2).sum()) / NEIGHBOUR_INFLATION + (gain / GAIN_RATIO_SIGMA) ** 2

    most = max(float(np.abs(np.concatenate([below, above])).max(initial=0.0)), GAIN_RATIO_SIGMA)
    return float(scipy.optimize.minimize_scalar(squares, bounds=(-most, most), method="bounded").fun)


def _band(
    frequency: Array, estimate: RatioEstimate, band: tuple[float, float], model: tuple[Array, Array] | None, n_comparisons: int
) -> RatioBand:
    inside = (frequency >= band[0]) & (frequency < band[1])
    used = inside & estimate.common
    lines, coherence = int(used.sum()), float(estimate.coherence[inside].mean())
    if not lines:
        return RatioBand(*band, coherence, 0, ratio=np.nan, lower=np.nan, upper=np.nan)
    error = estimate.error[used]
    weight = 1 / error**2
    mean_error = np.sqrt(NEIGHBOUR_INFLATION / weight.sum())

    def mean(values: Array) -> float:
        return float((weight * np.log(values[used])).sum() / weight.sum())

    low, high = mean(estimate.h1), mean(estimate.h2)
    measured = RatioBand(
        *band,
        coherence,
        lines,
        ratio=float(np.exp((low + high) / 2)),
        lower=float(np.exp(low - 1.96 * mean_error)),
        upper=float(np.exp(high + 1.96 * mean_error)),
    )
    if model is None:
        return measured
    own = mean(np.sqrt(model[0] * model[1]))
    freedom = max(lines / NEIGHBOUR_INFLATION, 1.0)
    limit = float(np.sqrt(scipy.stats.chi2.isf(FALSE_ALARMS / n_comparisons, freedom) / freedom))
    distance = float(np.sqrt(squares_outside(estimate, model, used) * NEIGHBOUR_INFLATION / lines))
    return replace(measured, model=float(np.exp(own)) / measured.ratio, distance=distance, limit=limit)
