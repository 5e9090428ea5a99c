"""Modes of one frequency: a basis of theirs that is always the same, and one line for all of them."""

from __future__ import annotations

import itertools
import re
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from vehgen.simulate.modes import Mode

Array = NDArray[np.float64]
SAME_FREQUENCY = 1e-9
"""Squares of frequencies nearer than this (relative) are one: their shapes may be mixed at will."""
SAME_MOTION = 1e-6
"""Modes whose frequencies and damping ratios are nearer than this (relative) are told together."""
_EQUALLY_LARGE = 1e-6


def settled_shapes(squares: Array, shapes: Array, M: Array) -> Array:
    """Return mode shapes whose mixture within one frequency does not depend on how they were computed.

    Of modes of one frequency the first is what comes nearest to the motion of a single coordinate (the first in order where several do
    alike), the next what comes nearest among what is left, and so on.

    Parameters
    ----------
    squares
        Ascending squares of angular frequencies, `shape (n,)`.
    shapes
        Their shapes, `shape (n, n)`, a column each, of unit modal mass.
    M
        The mass matrix, `shape (n, n)`.
    """
    found = shapes.copy()
    size = max(float(np.abs(squares).max(initial=0.0)), np.finfo(float).tiny)
    starts = [0, *(np.flatnonzero(np.diff(squares) > SAME_FREQUENCY * np.maximum(np.abs(squares[1:]), 1e-6 * size)) + 1), len(squares)]
    for low, high in itertools.pairwise(int(item) for item in starts):
        if high - low > 1:
            found[:, low:high] = _nearest_to_coordinates(shapes[:, low:high], M)
    return found


def _nearest_to_coordinates(shapes: Array, M: Array) -> Array:
    """Return another basis of the same space by pivoting on the coordinate that moves most within it."""
    parts = shapes.T @ M / np.sqrt(np.diag(M))
    directions = []
    for _ in range(shapes.shape[1]):
        share = (parts**2).sum(axis=0)
        chosen = int(np.flatnonzero(share >= (1 - _EQUALLY_LARGE) * share.max())[0])
        direction = parts[:, chosen] / np.sqrt(share[chosen])
        parts = parts - np.outer(direction, direction @ parts)
        directions.append(direction)
    return np.asarray(shapes @ np.array(directions).T, dtype=np.float64)


def scaled_to_peak(shape: Array) -> Array:
    """Return a shape whose largest entry, the first of several that are as large, is 1."""
    size = np.abs(shape)
    return np.asarray(shape / shape[np.flatnonzero(size >= (1 - _EQUALLY_LARGE) * size.max())[0]], dtype=np.float64)


def alike_modes(modes: Sequence[Mode]) -> Iterator[tuple[Mode, ...]]:
    """Yield modes in groups of neighbours that have one frequency and one damping ratio."""
    group: list[Mode] = []
    for mode in modes:
        if group and not _alike(group[0], mode):
            yield tuple(group)
            group = []
        group.append(mode)
    if group:
        yield tuple(group)


def group_name(group: Sequence[Mode]) -> str:
    """Return the name of a mode, or one for all of a group, as in `3 alike hops: axle5, axle6, axle7`."""
    if len(group) == 1:
        return group[0].name
    parts = sorted((_parts(mode.name) for mode in group), key=lambda part: (len(part[0]), part))
    owners, motions = zip(*parts, strict=True)
    listed = ", ".join(dict.fromkeys(owners if len(set(motions)) == 1 else (f"{a} {b}" for a, b in zip(owners, motions, strict=True))))
    return f"{len(group)} alike {f'{motions[0]}s' if len(set(motions)) == 1 else 'modes'}: {listed}"


def _parts(name: str) -> tuple[str, str]:
    """Return whose motion a mode mainly is, and which."""
    owner, _, motion = re.sub(r" \(\d+\)$", "", name).partition(" with ")[0].rpartition(" ")
    return owner, motion


def _alike(one: Mode, other: Mode) -> bool:
    pairs = ((one.undamped_hz, other.undamped_hz), (one.pole_hz, other.pole_hz), (one.damping_ratio, other.damping_ratio))
    return all(abs(a - b) <= SAME_MOTION * max(abs(a), abs(b)) for a, b in pairs)
