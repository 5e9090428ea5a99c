"""How hard tyres press on the road beside their static load: dynamic load coefficient, extremes, and fourth-power road damage."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
HIGH_SHARE = 0.95
"""The share of the time that a load stays below its stated percentile."""


@dataclass(frozen=True)
class LoadStatistics:
    """A tyre's load over time beside its static load; all but the coefficient are shares of the static load or of its damage.

    Attributes
    ----------
    coefficient
        Dynamic load coefficient: standard deviation over static load.
    high, least
        The 95th percentile and the smallest load.
    road_stress
        Eisenmann's dynamic road stress factor 1 + 6 s^2 + 3 s^4 with s the coefficient: the mean fourth power of a normal load
        (J. Eisenmann, Strasse und Autobahn 4, 1975).
    fourth_power
        The mean fourth power of the load itself; a wheel off the road does no damage.
    """

    coefficient: float
    high: float
    least: float
    road_stress: float
    fourth_power: float


def load_statistics(dynamic: Array, static: float) -> LoadStatistics:
    """Return what a tyre's load amounts to.

    Parameters
    ----------
    dynamic
        The load less the static one `shape (n,)` [N].
    static
        The static load [N], above 0.
    """
    share = 1.0 + dynamic / static
    coefficient = float(share.std())
    return LoadStatistics(
        coefficient,
        float(np.quantile(share, HIGH_SHARE)),
        float(share.min()),
        road_stress_factor(coefficient),
        float(np.mean(np.maximum(share, 0.0) ** 4)),
    )


def road_stress_factor(coefficient: float) -> float:
    """Return Eisenmann's dynamic road stress factor of a dynamic load coefficient."""
    return 1.0 + 6.0 * coefficient**2 + 3.0 * coefficient**4
