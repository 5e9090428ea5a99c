"""A channel of a run as two curves: measured beside simulated, or before beside after."""

from __future__ import annotations

from dataclasses import dataclass

from vehgen.files.result_fields import Array1D


@dataclass(frozen=True, eq=False)
class ChannelCurves:
    """What one panel of a figure shows of a run's channel: two curves over `x`, frequency [Hz] or time [s], `shape (n,)` each.

    Raises ValueError for curves of different lengths, or of fewer than two points.
    """

    run: str
    channel: str
    quantity: str
    x: Array1D
    measured: Array1D
    simulated: Array1D

    def __post_init__(self) -> None:
        if not len(self.x) == len(self.measured) == len(self.simulated) >= 2:
            raise ValueError("two curves over one abscissa of two points or more were expected")
