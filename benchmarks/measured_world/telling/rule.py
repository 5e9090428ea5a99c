"""When a hidden effect counts as one that its recordings can tell, and the levels that a fall must exceed.

The rule was written down before any case with an effect was measured. Levels come from vehicles without an effect alone: sealed healthy
ones, and twins, which are cases with an effect made again without it. They are the largest of the records given,
so that more records can only raise them, and excuse more misses.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from vehgen.effects import library
from vehgen.effects.kinds import LineEffect

Data = dict[str, Any]
FITTED = 4
"""So many laws of the largest first-order gain are fitted to a vehicle without an effect; of a twin the law left out, too."""
BESIDE = 3
"""So many are fitted beside the true law of a case with an effect: what else would explain it as well."""
Level = tuple[str, bool]
"""A vehicle, and whether the law is a line of the spectrum, which has numbers of its own in every run."""


def level_of(record: Data, fit: Data) -> Level:
    """Return to which level a fit belongs."""
    return record["vehicle"], isinstance(library()[fit["name"]], LineEffect)


def levels(records: Sequence[Data]) -> dict[Level, float]:
    """Return the largest fall, its numbers paid for, that any law reaches where nothing is hidden: below it a fall means nothing."""
    found: dict[Level, float] = {}
    for record in records:
        for fit in record["fits"] if record["hidden"] is None else ():
            level = level_of(record, fit)
            found[level] = max(found.get(level, 0.0), float(fit["beyond_price"]))
    return found


def is_tellable(record: Data, known: dict[Level, float]) -> bool:
    """Return whether the true law at its true place falls by more than its level, and beats the base on validation runs.

    Asking more of the validation runs would excuse more misses; nothing of the law is fitted to them. A case without a fit of the true law
    counts as one that can be told: what was not measured excuses nothing.
    """
    fit = next((item for item in record["fits"] if item["true"]), None)
    if fit is None:
        return True
    seen_again = fit["validation_fall"] is None or fit["validation_fall"] > 0
    return bool(fit["beyond_price"] > known.get(level_of(record, fit), 0.0) and seen_again)
