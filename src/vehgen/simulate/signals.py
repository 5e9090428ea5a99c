"""Forces and displacements over time."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from vehgen.simulate.run_file.entries import DisplacementHarmonic, ForceHarmonic

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Signal:
    """A force or displacement over time, harmonic or measured (linear between samples, constant outside).

    It acts `gain` times, so much later (`late` [s]), with a constant `offset` beside it.
    """

    harmonic: ForceHarmonic | DisplacementHarmonic | None = None
    time: Array | None = None
    values: Array | None = None
    gain: float = 1.0
    offset: float = 0.0
    late: float = 0.0

    def at(self, t: Array) -> Array:
        """Return its values at times t [s]."""
        own = t - self.late if self.late else t
        if self.harmonic is not None:
            item = self.harmonic
            return np.asarray(self.gain * item.amplitude * np.sin(2 * np.pi * item.frequency * own + item.phase) + self.offset)
        assert self.time is not None
        assert self.values is not None
        return np.asarray(self.gain * np.interp(own, self.time, self.values) + self.offset)

    def scaled(self, factor: float) -> Signal:
        """Return it as measured in another unit, so many times as large; a harmonic stays as it is."""
        return self if self.values is None else replace(self, values=self.values * factor)

    def with_errors(self, gain: float = 1.0, offset: float = 0.0, late: float = 0.0) -> Signal:
        """Return it with further errors."""
        return replace(self, gain=self.gain * gain, offset=self.offset + offset, late=self.late + late)
