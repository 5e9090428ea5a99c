"""Dry friction within a step: when the slip ends, what holds it then, and what acts at a sample.

A step knows two forces: the one that would stop an element's slip by its end, and the one that would keep the slip as it is. A slip s lasts
against its friction F sign(s) for the share (stopping - holding)/(F sign(s) - holding) of the step. What follows is the holding force
clipped to +-F: within, the element sticks; beyond, it slips back. The mean over both parts is the force of the step, so that a slip that
ends within a step costs no order of accuracy. Friction of unequal bounds is clipped about their middle: there, holding - middle stands for
the holding force. Where the element sticks, that mean is the force that stops the slip (Moreau,
doi:10.1007/978-3-7091-2624-0_1).
"""

from __future__ import annotations

from vehgen.codegen.program import Node, Program

SMALLEST_SQUARE = 1e-30
"""Friction forces whose difference has a smaller square are equal [N^2]."""
SLIPPING = 200.0
"""At a sample, an element slips where more than 1/SLIPPING of the bound would be needed to stop it within a step."""


def clip(program: Program, force: Node, bound: Node) -> Node:
    """Return a force, or the bound that it exceeds."""
    return program.apply("min", program.apply("max", force, program.negate(bound)), bound)


def mean_friction(program: Program, holding: Node, lost: Node, slip: Node, bound: Node) -> Node:
    """Return the mean friction over a step.

    Parameters
    ----------
    program
        Where it is written.
    holding
        The force that would keep the slip as it is.
    lost
        What stops the slip by the end of the step, beyond `holding`.
    slip
        The slip at the start of the step; only its sign counts.
    bound
        The bound F.
    """
    first = program.multiply(bound, program.apply("sign", slip))
    after, span = clip(program, holding, bound), program.subtract(first, holding)
    size = program.apply("max", program.multiply(span, span), program.number(SMALLEST_SQUARE))
    share = program.divide(program.multiply(lost, span), size)
    share = program.apply("min", program.apply("max", share, program.number(0.0)), program.number(1.0))
    return program.add(after, program.multiply(share, program.subtract(first, after)))


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
