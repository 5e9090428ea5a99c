"""Dry friction within a step: when the slip ends, what holds it then, and what acts at a sample.

A step knows two forces: the one that would stop an element's slip by its end, and the one that would keep the slip as it is, H. With L the
size of their difference, and everything counted along the slip, the slip lasts against its friction F for the share L/(F - H) of the step.
What follows is the holding force clipped to +-F: within, the element sticks; beyond, it slips back. The mean over both parts,
    F - max(F - H - L, 0) 2F/max(F - H, 2F),
is the force of the step, so that a slip that ends within a step costs no order of accuracy. Friction of unequal bounds is clipped about
their middle: there, H - middle stands for H. Where the element sticks, that mean is the force that stops the slip, H + L (Moreau,
doi:10.1007/978-3-7091-2624-0_1).
"""

from __future__ import annotations

from dataclasses import dataclass

from vehgen.codegen.program import Node, Program

SMALLEST_BOUND = 1e-12
"""A bound below half of this counts as that, so that nothing is divided by zero [N]."""
SLIPPING = 200.0
"""At a sample, an element slips where more than 1/SLIPPING of the bound would be needed to stop it within a step."""


def clip(program: Program, force: Node, bound: Node) -> Node:
    """Return a force, or the bound that it exceeds."""
    return program.apply("min", program.apply("max", force, program.negate(bound)), bound)


@dataclass(frozen=True)
class Slip:
    """An element that slips or sticks in a step.

    `holding` is the force that would keep the slip as it is, `lost` what stops the slip by the end of the step beyond it, `slip` the slip
    at the start of the step, of which only the sign counts. Friction is within `bound` of `middle`.
    """

    holding: Node
    lost: Node
    slip: Node
    bound: Node
    middle: Node


def mean_friction(program: Program, item: Slip) -> Node:
    """Return the mean friction of an element over a step."""
    side = program.subtract(program.multiply(program.number(2.0), program.apply("step", item.slip)), program.number(1.0))
    held = program.multiply(side, program.subtract(item.holding, item.middle))
    span = program.subtract(item.bound, held)
    within = program.subtract(item.bound, program.apply("abs", item.lost))
    missing = program.apply("max", program.subtract(within, held), program.number(0.0))
    width = program.apply("max", program.multiply(program.number(2.0), item.bound), program.number(SMALLEST_BOUND))
    share = program.divide(program.multiply(side, width), program.apply("max", span, width))
    most = program.add(item.middle, program.multiply(side, item.bound))
    return program.subtract(most, program.multiply(missing, share))


def friction_now(program: Program, holding: Node, stopping: Node, bound: Node) -> Node:
    """Return the friction at an instant: the holding force where the element sticks, its bound where it slips.

    Parameters
    ----------
    program
        Where it is written.
    holding
        The force that would keep the slip as it is.
    stopping
        What would stop the slip within a step, beyond `holding`.
    bound
        The bound F.
    """
    return clip(program, program.add(holding, program.multiply(program.number(SLIPPING), stopping)), bound)
