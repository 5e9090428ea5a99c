"""Which drives a kernel reads: as values at a time, as means over a step, or as sums of the means over two steps."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

VALUES, MEANS, SUMS = 0, 1, 2
"""Values; means over the step that begins, at the very end the value; sums of the means over the step that ends and the one that begins,
of the latter alone before the first step."""


@dataclass(frozen=True)
class DriveReads:
    """What is read of inputs, rates and forces for a step, and for a sample twice.

    `columns` says of each of these three, for each of the three arrays, the first column that is read, the one after the last, the place of
    the first among all that is read, and the pattern: VALUES, MEANS or SUMS. `step_row` and `sample_row` are how many numbers a step and a
    sample read, `n_inputs` how many displacement inputs there are. `ends`: a step ends
    in the state of its sample, and reads sums; else it begins there.
    """

    columns: tuple[tuple[tuple[int, int, int, int], ...], ...]
    step_row: int
    sample_row: int
    n_inputs: int
    ends: bool

    def place(self, group: int, number: int) -> int:
        """Return the place of a drive among all that is read; drives are numbered inputs first, then rates, then forces."""
        array = _array(number, self.n_inputs)
        first, _, before, _ = self.columns[group][array]
        return before + number - array * self.n_inputs - first

    def array(self) -> NDArray[np.int64]:
        """Return the columns as the loop over time takes them, `shape (3, 3, 4)`."""
        return np.array(self.columns, dtype=np.int64)


def drive_reads(numbers: Sequence[Sequence[int]], n_inputs: int, sums: bool) -> DriveReads:
    """Return what is read where these drives are used: in a step, at a sample as values, and at a sample as means.

    Parameters
    ----------
    numbers
        Of each of the three the numbers of the drives.
    n_inputs
        Number of displacement inputs.
    sums
        Whether a step reads sums instead of means.
    """
    columns, before, ends = [], 0, []
    for used, pattern in zip(numbers, (SUMS if sums else MEANS, VALUES, MEANS), strict=True):
        found = []
        for array in range(3):
            own = [number - array * n_inputs for number in used if _array(number, n_inputs) == array]
            start, end = (min(own), max(own) + 1) if own else (0, 0)
            found.append((start, end, before, pattern))
            before += end - start
        columns.append(tuple(found))
        ends.append(before)
    return DriveReads(tuple(columns), ends[0], ends[2] - ends[0], n_inputs, sums)


def _array(number: int, n_inputs: int) -> int:
    return min(number // n_inputs, 2) if n_inputs else 2
