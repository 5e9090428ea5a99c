"""Where a table lacks rows that its others let expect."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

HOLE_SPACINGS = 10.0
"""A gap of so many times the median spacing is a hole."""
FEWEST_ROWS_WITH_HOLES = 20
"""A table of fewer rows was drawn, not measured: its straight lines are meant."""
MOST_HOLES = 0.1
"""Where so large a share of all gaps is wide, they are how the table was drawn: points in groups, say."""


def holes(places: NDArray[np.float64], low: float, high: float) -> NDArray[np.intp]:
    """Return the rows after which a hole begins, the widest first, of those that reach into `low` to `high`; `places` ascend."""
    if len(places) < FEWEST_ROWS_WITH_HOLES:
        return np.zeros(0, dtype=np.intp)
    gaps = np.diff(places)
    wide = gaps > HOLE_SPACINGS * float(np.median(gaps))
    if wide.mean() > MOST_HOLES:
        return np.zeros(0, dtype=np.intp)
    found = np.flatnonzero(wide & (places[1:] > low) & (places[:-1] < high))
    return np.asarray(found[np.argsort(-gaps[found], kind="stable")])
