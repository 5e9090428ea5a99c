"""The truck spectra of ASTM D4169, to draw beside a measured PSD.

The breakpoints were recalled and checked only through the overall RMS that goes with them; take them from the standard itself before
you test a package with them.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from vehgen.files.units import STANDARD_GRAVITY

Array = NDArray[np.float64]
NOTE = "breakpoints recalled, checked through their rms only"


@dataclass(frozen=True)
class Spectrum:
    """A spectrum of straight lines between breakpoints on log-log paper: `frequency` [Hz], `density` [g^2/Hz]."""

    name: str
    frequency: Array
    density: Array

    def at(self, frequency: Array) -> Array:
        """Return the density [(m/s^2)^2/Hz] at frequencies [Hz]; NaN outside the breakpoints."""
        with np.errstate(divide="ignore"):
            logs = np.interp(np.log(frequency), np.log(self.frequency), np.log(self.density), left=np.nan, right=np.nan)
        return np.asarray(np.exp(logs) * STANDARD_GRAVITY**2)

    @property
    def rms(self) -> float:
        """Overall RMS [g]."""
        return self.rms_within(float(self.frequency[0]), float(self.frequency[-1]))

    def rms_within(self, low: float, high: float) -> float:
        """Return the RMS [g] between two frequencies [Hz]; each line of slope m on log-log paper integrates in closed form."""
        inside = self.frequency[(self.frequency > low) & (self.frequency < high)]
        f = np.unique(np.clip(np.concatenate([[low], inside, [high]]), self.frequency[0], self.frequency[-1]))
        if len(f) < 2:
            return 0.0
        d = self.at(f) / STANDARD_GRAVITY**2
        slope = np.diff(np.log(d)) / np.diff(np.log(f))
        flat = np.abs(slope + 1) < 1e-9
        safe = np.where(flat, 0.0, slope)
        areas = np.where(flat, d[:-1] * f[:-1] * np.log(f[1:] / f[:-1]), (d[1:] * f[1:] - d[:-1] * f[:-1]) / (safe + 1))
        return float(np.sqrt(areas.sum()))


def _spectrum(name: str, points: Mapping[int, float], factor: float = 1.0) -> Spectrum:
    return Spectrum(name, np.array(list(points), dtype=np.float64), factor * np.array(list(points.values())))


_LEVEL_2 = {1: 5e-5, 4: 0.01, 16: 0.01, 40: 0.001, 80: 0.001, 200: 1e-5}
_MEDIUM = {
    1: 0.00072, 3: 0.018, 4: 0.018, 6: 0.00072, 12: 0.00072, 16: 0.0036,
    25: 0.0036, 30: 0.00072, 40: 0.0036, 80: 0.0036, 100: 0.00036, 200: 1.8e-5,
}  # fmt: skip

SPECTRA = {
    "level I": _spectrum("ASTM D4169 truck, level I", _LEVEL_2, 2.0),
    "level II": _spectrum("ASTM D4169 truck, level II", _LEVEL_2),
    "level III": _spectrum("ASTM D4169 truck, level III", _LEVEL_2, 0.5),
    "2016 medium": _spectrum("ASTM D4169-16 truck, medium", _MEDIUM),
    "2016 low": _spectrum("ASTM D4169-16 truck, low (medium scaled to 0.40 g rms)", _MEDIUM, (0.40 / 0.54) ** 2),
    "2016 high": _spectrum("ASTM D4169-16 truck, high (medium scaled to 0.70 g rms)", _MEDIUM, (0.70 / 0.54) ** 2),
}
"""The spectra by name; the low and high levels of 2016 are the medium one scaled to their overall RMS."""
