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


def widest(places: NDArray[np.float64], found: NDArray[np.intp], unit: str, rows: str) -> str:
    """Say where the first of some holes is, as :func:`holes` found them, and what `rows` of the table let expect, both in `unit`."""
    begin, end = places[found[0] : found[0] + 2]
    others = f" ({len(found)} such holes in all)" if len(found) > 1 else ""
    spacing = float(np.median(np.diff(places)))
    return f"has a hole from {begin:.4g} to {end:.4g} {unit}, its {rows} being {spacing:.3g} {unit} apart{others}"
