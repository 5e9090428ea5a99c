"""How many sweeps elements with friction need that push each other: links through light bodies, several hinges of a road train."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import sympy as sp
from numpy.typing import NDArray

from vehgen.codegen.nonlinear_element import NonlinearElement
from vehgen.mechanics.equations_of_motion import EquationsOfMotion

FEWEST_SWEEPS, MOST_SWEEPS = 3, 12
ERROR_LEFT = 0.012
"""After so many sweeps the force of a link may be off by this share of its bound, for all other forces' begin."""
HINGES_LEFT = 0.3
"""The same for all elements, in forces that move their own ends alike: one hinge and five axles have 0.15, two hinges and nine 2.0."""
MORE_SWEEPS = 4
"""Where FEWEST_SWEEPS are too few: every other sweep is damped, and at a sample a small slip counts much."""


def sweeps_of(model: EquationsOfMotion, joints: Sequence[NonlinearElement]) -> int:
    """Return how many sweeps a step takes, by the masses between the elements and their bounds, at the vehicle file's values.

    In a short step a force of one element moves the ends of others by G = J M^-1 J^T. Sweeps shrink errors by G off its diagonal over its
    diagonal, counted in forces that move their own ends alike; those of links, which are held to more, in their bounds where none is
    zero. Axles under one heavy body need no more than FEWEST_SWEEPS.

    Parameters
    ----------
    model
        Whose masses count.
    joints
        The elements with laws; only those with friction are looked at.
    """
    rubbing = [joint for joint in joints if joint.friction]
    links = [i for i, joint in enumerate(rubbing) if joint.element.kind == "link"]
    if len(rubbing) < 2:
        return FEWEST_SWEEPS
    values = model.values()
    entries = [joint.element.row.get(i, sp.S.Zero) for joint in rubbing for i in range(model.n_dof)]
    J: NDArray[np.float64] = np.reshape(model.evaluate_list(entries, values), (len(rubbing), model.n_dof))
    bounds = np.array(model.evaluate_list([sp.Add(*(step.friction for step in joint.steps)) for joint in rubbing], values))
    G = J @ np.linalg.solve(model.numeric(values).M, J.T)
    own = np.sqrt(np.diag(G))
    alike = np.abs(G) / np.outer(own, own) - np.eye(len(G))
    if np.linalg.matrix_power(alike, FEWEST_SWEEPS).sum(axis=1).max() > HINGES_LEFT:
        return MOST_SWEEPS
    if not links:
        return FEWEST_SWEEPS
    sizes = bounds * own if (bounds > 0).all() else np.ones(len(G))
    shrink = alike * sizes / sizes[:, None]
    left = shrink
    for count in range(1, MOST_SWEEPS):
        if left[links].sum(axis=1).max() <= ERROR_LEFT:
            return FEWEST_SWEEPS if count <= FEWEST_SWEEPS else min(count + MORE_SWEEPS, MOST_SWEEPS)
        left = left @ shrink
    return MOST_SWEEPS
