"""How a kernel's loops read the drives: as values at a time, as means over a step, or as sums of the means over two steps."""

from __future__ import annotations

VALUES = "{array}[{k}, n, {i}]"
MEANS = "{half}*({array}[{k}, n, {i}] + {array}[{k}, n + 1, {i}])"
LATER_MEANS = "{half}*({array}[{k}, n, {i}] + {array}[{k}, after, {i}])"
"""Means over the step that begins, also at the very end, where the drives stay as they are."""
SUMS = "{half}*({array}[{k}, before, {i}] + {array}[{k}, after, {i}]) + share*{array}[{k}, n, {i}]"
"""Sums of the means over the step that ends and the one that begins; of the latter alone before the first step."""


def neighbours(zero: str, one: str) -> list[str]:
    """Return the lines that set what LATER_MEANS and SUMS read beside the drives."""
    return [
        "before = n - min(n, 1)",
        "after = min(n + 1, n_steps)",
        f"share = {zero}",
        "if 0 < n:",
        f"    share = {one}",
    ]


def read_drives(found: list[tuple[str, str, int, str]], width: int, numbers: tuple[str, str], lanes: int) -> tuple[list[str], list[str]]:
    """Return the lines that read drives, and the names of what all lanes share.

    A drive is the sum of what all lanes share and of each lane's own: where there is one set of drives, the latter stays 0, else the
    former does, and lanes beyond the last set take that one.

    Parameters
    ----------
    found
        Of each drive its name, the place of a lane's own value, its number among the drives and one of the patterns above.
    width
        Number of displacement inputs.
    numbers
        How 0 and 1/2 are written.
    lanes
        Individuals side by side.

    """
    if not found:
        return [], []
    zero, half = numbers
    names, shared, own = [], [], []
    for name, place, number, pattern in found:
        array, column = _source(number, width)
        names.append(name)
        shared.append(f"    {name} = {pattern.format(array=array, k=0, i=column, half=half)}")
        own.append(f"        {place} = {pattern.format(array=array, k='k', i=column, half=half)}")
    head = [f"{name} = {zero}" for name in names]
    return [*head, "if last == 0:", *shared, "else:", f"    for j in range({lanes}):", "        k = min(j, last)", *own], names


def _source(place: int, width: int) -> tuple[str, int]:
    """Return the array and the column of a drive: displacement inputs, then their rates, then forces."""
    return ("forces", place - 2 * width) if place >= 2 * width else (("inputs", "rates")[place // width], place % width)
