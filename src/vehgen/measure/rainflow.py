"""Rainflow counting of ASTM E1049-85 (2017), 5.4.4: the cycles and half cycles in a history of load or travel."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def turning_points(values: Array) -> Array:
    """Return a history's first and last values and all its peaks and valleys between, `shape (k,)`."""
    moved = np.ones(len(values), dtype=np.bool_)
    moved[1:] = np.diff(values) != 0
    kept = values[moved]
    if len(kept) < 3:
        return kept
    steps = np.diff(kept)
    return np.asarray(kept[np.concatenate([[True], steps[1:] * steps[:-1] < 0, [True]])])


def rainflow_cycles(values: Array) -> tuple[Array, Array]:
    """Count the cycles of a history.

    Parameters
    ----------
    values
        `shape (n,)`; between its turning points it may have any samples.

    Returns
    -------
    Ranges (peak less valley) and counts (1 a cycle, 0.5 half of one), `shape (k,)` each, in the order in which they close.
    """
    ranges: list[float] = []
    counts: list[float] = []
    points: list[float] = []
    for value in turning_points(values).tolist():
        points.append(value)
        while len(points) >= 3:
            last, before = abs(points[-1] - points[-2]), abs(points[-2] - points[-3])
            if last < before:
                break
            ranges.append(before)
            if len(points) == 3:  # the older range holds the start: half a cycle
                counts.append(0.5)
                del points[0]
            else:
                counts.append(1.0)
                del points[-3:-1]
    ranges += np.abs(np.diff(points)).tolist()
    counts += [0.5] * (len(ranges) - len(counts))
    return np.array(ranges, dtype=np.float64), np.array(counts, dtype=np.float64)


def equivalent_range(ranges: Array, counts: Array, duration: float, slope: float) -> float:
    """Return the constant range that, once a second, does the same damage by Miner's rule for an S-N line of a slope.

    Parameters
    ----------
    ranges, counts
        Of :func:`rainflow_cycles`.
    duration
        Of the history [s].
    slope
        m in N S^m = constant: 3 for welds, 5 for smooth steel.
    """
    largest = float(ranges.max(initial=0.0))
    if largest == 0.0:
        return 0.0
    return largest * float((np.sum(counts * (ranges / largest) ** slope) / duration) ** (1.0 / slope))


def exceedances(ranges: Array, counts: Array, levels: Array) -> Array:
    """Return how many cycles have a range of at least each level, `shape (len(levels),)`."""
    order = np.argsort(ranges)
    above = np.concatenate([np.cumsum(counts[order][::-1])[::-1], [0.0]])
    return np.asarray(above[np.searchsorted(ranges[order], levels, side="left")])
