"""Tables of measured cases: what each miss could have told, and how many are named right of those that can be told."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from benchmarks.measured_world.page import table
from benchmarks.measured_world.telling.rule import Level, is_tellable, levels
from vehgen.effects import library

Data = dict[str, Any]
MISSED = ("too_weak", "no_missing_effect", "insufficient_data")
"""Outcomes of a scored case in which nothing was claimed. What was refused, told wrong or crashed is never excused."""


def is_listed(record: Data) -> bool:
    """Return whether a scored case hides an effect that the library had when it was scored; older records say where it had not."""
    return bool(record["effects"]) and bool(record["effects"][0].get("listed", record["effects"][0]["name"] in library()))


def missed(scored: Sequence[Data]) -> list[str]:
    """Return the cases in which an effect of the library was not seen."""
    return [item["case"] for item in scored if is_listed(item) and item["judged"] in MISSED]


def telling_page(measured: Sequence[Data], scored: Sequence[Data]) -> str:
    """Return the levels, a row for every measured case with an effect, and the rates."""
    known = levels(measured)
    hidden = [item for item in measured if item["hidden"] is not None]
    return "\n\n".join([level_table(measured, known), case_table(hidden, measured, known), rate_table(hidden, scored, known)]) + "\n"


def level_table(measured: Sequence[Data], known: dict[Level, float]) -> str:
    """Return the level of every vehicle and kind of law, and how many cases it is the largest of."""
    rows = []
    for (vehicle, line), level in sorted(known.items()):
        count = sum(item["hidden"] is None and item["vehicle"] == vehicle and "failed" not in item for item in measured)
        rows.append((vehicle, "a line" if line else "any other law", count, f"{level:.0f}"))
    return table(("vehicle", "law", "cases without an effect", "largest fall"), rows)


def case_table(hidden: Sequence[Data], measured: Sequence[Data], known: dict[Level, float]) -> str:
    """Return one row for every case with an effect: what its true law takes off, and what the same law takes off without the effect."""
    twins = {(item["set"].replace("twins", "effects"), item["case"]): item for item in measured if item["hidden"] is None}
    rows = []
    for item in hidden:
        what = f"{item['hidden']['name']} at {item['hidden']['place']}"
        first = (f"{item['set']} {item['case'][-3:]}", f"{what}, {item['vehicle']}, {item['recorder']}", item.get("judged", "-"))
        fit, bare = true_fit(item), true_fit(twins.get((item["set"], item["case"]), {"fits": []}))
        if fit is None:
            rows.append((*first, "-", "-", "-", "-", "not measured, counts as yes"))
            continue
        twin = "-" if bare is None else f"{bare['beyond_price']:.0f}"
        again = "-" if fit["validation_fall"] is None else f"{fit['validation_fall']:.0f}"
        told = "yes" if is_tellable(item, known) else "no"
        rows.append((*first, f"{item['chi']:.3f}", f"{fit['beyond_price']:.0f}", twin, again, told))
    header = ("case", "hidden", "outcome", "chi of the base", "fall", "without the effect", "fall on validation runs", "can be told")
    return table(header, rows)


def true_fit(record: Data) -> Data | None:
    """Return the fit of the law that is hidden in a case, or left out of a twin; None where there is none."""
    return next((item for item in record["fits"] if item["true"]), None)


def rate_table(hidden: Sequence[Data], scored: Sequence[Data], known: dict[Level, float]) -> str:
    """Return how many effects of the library are named right, of all and of those that can be told.

    Left out are only misses that were measured and cannot be told; every other case counts as one that can.
    """
    listed = [item for item in scored if is_listed(item)]
    right = sum(item["judged"].startswith("named right") for item in listed)
    among = sum(item["judged"] == "ambiguous, truth among them" for item in listed)
    excused = sum(item.get("judged") in MISSED and not is_tellable(item, known) for item in hidden)
    rows = []
    for name, count in (("of all", len(listed)), ("of those that can be told", len(listed) - excused)):
        rows.append((name, f"{right} of {count}", f"{100 * right / max(count, 1):.0f} %", f"{right + among} of {count}"))
    return table(("effects of the library", "named right", "share", "with those tied with another"), rows)
