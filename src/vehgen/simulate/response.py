"""What a simulation of a run gives: its channels over time, in the units of their columns."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from vehgen.errors import InputError, did_you_mean, shown
from vehgen.files import write_text
from vehgen.files.result_fields import Array1D, Array3D
from vehgen.files.results import Cell, Result, Table, csv_text

Array = NDArray[np.float64]


@dataclass(frozen=True)
class ResponseChannel:
    """What one column of a response is."""

    name: str
    quantity: str
    unit: str


@dataclass(frozen=True, eq=False)
class Response(Result):
    """What came out: `time shape (n_samples,)` [s], `values shape (n_individuals, n_samples, n_channels)` in the channels' units.

    `warnings` says what makes the answer doubtful.
    """

    KIND: ClassVar[str] = "response"
    DRAWING: ClassVar[str] = "vehgen.report.plots.result_plots:plot_simulation"

    time: Array1D
    values: Array3D
    channels: tuple[ResponseChannel, ...]
    warnings: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        if self.values.shape[1:] != (len(self.time), len(self.channels)):
            raise ValueError("a value for every sample and channel was expected")

    def channel(self, name: str) -> Array:
        """Return one channel, `shape (n_individuals, n_samples)`; raises InputError for a name that is none."""
        names = [item.name for item in self.channels]
        if name not in names:
            raise InputError(f"no channel {shown(name)}; {did_you_mean(name, names)}")
        return np.asarray(self.values[:, :, names.index(name)])

    def table(self) -> Table:
        """Return the first individual's response, a row a sample."""
        rows: list[tuple[Cell, ...]] = [(float(t), *row) for t, row in zip(self.time, self.values[0].tolist(), strict=True)]
        return ("t", *(channel.name for channel in self.channels)), rows


def write_csv(path: Path, response: Response) -> None:
    """Write the first individual's response: a column t [s] and one per channel, in its unit."""
    write_text(path, csv_text(response.table()))
