"""Statements as loops over lanes, long ones cut into several loops.

Beyond some length of a loop a compiler stops vectorising it. So a long list of assignments is
cut; what one loop computes and a later one needs goes through a scratch array.
"""

from __future__ import annotations

import re

MAX_OPERATIONS = 2500
"""Arithmetic operations in one loop."""
_IDENTIFIER = re.compile(r"[A-Za-z_]\w*")
_OPERATOR = re.compile(r" [-+<>] |[*/]|-(?=\w)")


def split_loop(assignments: list[str], stores: list[str], lanes: int) -> tuple[list[list[str]], int]:
    """Cut a loop's body into the bodies of several loops.

    Parameters
    ----------
    assignments
        Lines `name = expression`, each name assigned once, before it is used.
    stores
        Lines that write results to arrays; they all go into the last loop, after everything is read.
    lanes
        Individuals in a loop.

    Returns
    -------
    The bodies, and the number of scratch rows they need.
    """
    bodies: list[list[str]] = [[]]
    load = 0
    for line in assignments:
        cost = len(_OPERATOR.findall(line))
        if load + cost > MAX_OPERATIONS and bodies[-1]:
            bodies.append([])
            load = 0
        bodies[-1].append(line)
        load += cost
    if len(bodies) == 1:
        return [[*assignments, *stores]], 0
    bodies.append([])
    defined = {line.partition(" = ")[0]: place for place, body in enumerate(bodies) for line in body}
    needed: list[list[str]] = []
    for place, body in enumerate(bodies):
        text = body if place < len(bodies) - 1 else stores
        used = {name for line in text for name in _IDENTIFIER.findall(line.partition(" = ")[2])}
        needed.append(sorted(name for name in used if defined.get(name, place) < place))
    slots = {name: slot for slot, name in enumerate(sorted({name for names in needed for name in names}))}
    result = []
    for place, (body, names) in enumerate(zip(bodies, needed, strict=True)):
        reads = [f"{name} = work[SCRATCH + {slots[name] * lanes} + j]" for name in names]
        writes = [f"work[SCRATCH + {slot * lanes} + j] = {name}" for name, slot in slots.items() if defined[name] == place]
        result.append([*reads, *body, *writes, *(stores if place == len(bodies) - 1 else [])])
    return result, len(slots)
