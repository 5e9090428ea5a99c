"""What effects are told of a diagnosis: where the place test points, what a fit leaves, where fits may begin."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from vehgen.fit.harmonic import find_line
from vehgen.fit.misfit import Misfit
from vehgen.fit.wheel_orders import find_rolling_radii

Array = NDArray[np.float64]
StartingPoint = tuple[Array, Array]
"""Where base parameters, in the unit cube, and the nuisances of runs begin."""


@dataclass(frozen=True)
class PlaceEvidence:
    """What tests of one unknown force at each place, and of leaving out each sensor or channel, found.

    `parts` are the axles, hinges, links and bodies where an unknown force explains what the model misses, `kinds` what these places are
    (suspension, tyre ...); `one_force` tells that one force at one of them leaves noise. `sensors` are the sensors and channels without
    which the model fits. `steady_lines` tells that runs show lines of what shakes the vehicle all the time.
    """

    parts: frozenset[str]
    kinds: frozenset[str]
    one_force: bool
    sensors: frozenset[str]
    steady_lines: bool = False


@dataclass(frozen=True)
class Origins:
    """Where the base parameters and nuisances may begin: as filed, as the place test leaves them, and as last fitted."""

    filed: StartingPoint
    placed: StartingPoint
    fitted: StartingPoint


class Residual:
    """What a fit leaves of the recordings, for effects whose starts are read from it.

    Parameters
    ----------
    misfit, x
        The fit.
    """

    def __init__(self, misfit: Misfit, x: Array) -> None:
        self._misfit, self._x = misfit, x
        self._lines: dict[tuple[float, float], list[tuple[float, float]]] = {}
        self._radii: dict[tuple[float, float], list[float]] = {}

    def spectral_lines(self, lowest: float, highest: float) -> list[tuple[float, float]]:
        """Return frequency [Hz] and drift of the strongest lines between two frequencies [Hz]; looked for once."""
        if (lowest, highest) not in self._lines:
            self._lines[lowest, highest] = find_line(self._misfit, self._x, lowest=lowest, highest=highest)
        return self._lines[lowest, highest]

    def rolling_radii(self, lowest: float, highest: float) -> list[float]:
        """Return the likeliest rolling radii [m] of a wheel that shakes the runs, between two; looked for once."""
        if (lowest, highest) not in self._radii:
            self._radii[lowest, highest] = find_rolling_radii(self._misfit, self._x, lowest, highest)
        return self._radii[lowest, highest]
