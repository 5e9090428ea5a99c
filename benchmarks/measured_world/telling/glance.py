"""Scored sets at a glance: a row for each set of effects or for each thing hidden, and what the intervals of the numbers named hold."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from pathlib import Path
from typing import Any

from benchmarks.measured_world.page import read, table
from benchmarks.measured_world.telling.table import is_listed

Data = dict[str, Any]
RIGHT, TIED = "named right", "ambiguous, truth among them"
WRONG = ("named wrong", "ambiguous, wrong", "named right, elsewhere", "measurement_fault")
"""Causes told that are not there; a mistake of measuring is none of the generator's."""
OF_THE_WHOLE_EXPORT = ("engine_harmonic_frequency", "engine_harmonic_drift")
"""The truth states these for the start and the length of a phone's export, of which an import keeps a part."""
FAULT_RIGHT = ("fault named right, place too", "fault named right", "refused, fault told")
FAULT_WRONG = ("another fault named", "named as a false effect")
UNTOLD = ("no_missing_effect", "too_weak", "insufficient_data")
"""A gap of which nothing is claimed."""


def intervals(record: Data) -> list[tuple[str, float, float, float]]:
    """Return name, low, high and truth of the numbers of an effect named right, of those that the generator states by the same name."""
    if record["judged"] != RIGHT:
        return []
    truth, told = record["effects"][0], record["answer"]["effects"][0]
    other = OF_THE_WHOLE_EXPORT if record["recorder"] == "phones" else ()
    found = []
    for name, item in told["parameters"].items():
        right, interval, number = truth["values"].get(name), item["interval"], f"{truth['name']}_{name}"
        if right is not None and interval is not None and number not in other:
            found.append((number, interval[0], interval[1], right))
    return found


def glance(paths: Sequence[Path]) -> str:
    """Return a table of scored sets, a row for each file of records and one for all of them."""
    sets = {path.stem: [record for record in read([path]) if record["kind"] == "effects"] for path in paths}
    listed = [*sets.items(), ("all", [record for records in sets.values() for record in records])]
    header = ("set", "of the library", "named right", "right one tied", "a wrong cause", "none claimed", "other")
    outside = ("outside it", "told so", "a wrong cause", "none claimed", "other", "intervals that hold")
    return table((*header, *outside), ([name, *_row(records)] for name, records in listed))


def _row(records: Sequence[Data]) -> list[str]:
    inside = [record["judged"] for record in records if is_listed(record)]
    others = [record["judged"] for record in records if not is_listed(record)]
    held = [low <= truth <= high for record in records for _, low, high, truth in intervals(record)]
    first = [_count(inside, (RIGHT,)), _count(inside, (TIED,)), _count(inside, WRONG), _count(inside, UNTOLD)]
    second = [_count(others, ("not_in_library",)), _count(others, (*WRONG, RIGHT, TIED)), _count(others, UNTOLD)]
    counts = [len(inside), *first, len(inside) - sum(first), len(others), *second, len(others) - sum(second)]
    return [*map(str, counts), f"{sum(held)} of {len(held)}"]


def kinds(paths: Sequence[Path]) -> str:
    """Return a table of scored effects, mistakes and healthy vehicles, a row for each thing that was hidden."""
    judged: dict[str, list[str]] = {}
    for record in read(paths):
        if record["kind"] in ("effects", "faults", "healthy"):
            hidden = record["effects"][0]["name"] if record["effects"] else (record["fault"] or {"kind": "nothing"})["kind"]
            judged.setdefault(hidden, []).append(record["judged"])
    header = ("hidden", "cases", "told right", "right one tied", "a wrong cause", "none claimed", "other")
    return table(header, ([name, *_outcomes(name, judged[name])] for name in sorted(judged)))


def _outcomes(hidden: str, judged: Sequence[str]) -> list[str]:
    right = ("no_missing_effect",) if hidden == "nothing" else (RIGHT, *FAULT_RIGHT)
    counts = [_count(judged, outcomes) for outcomes in (right, (TIED,), (*WRONG, *FAULT_WRONG), set(UNTOLD) - set(right))]
    return [*map(str, (len(judged), *counts, len(judged) - sum(counts)))]


def _count(judged: Iterable[str], outcomes: Collection[str]) -> int:
    return sum(item in outcomes for item in judged)


def misses(paths: Sequence[Path]) -> str:
    """Return the intervals that miss the truth, a line each."""
    rows = []
    for record in read(paths):
        if record["kind"] == "effects":
            rows += [
                (record["case"], name, f"{low:.5g}", f"{high:.5g}", f"{truth:.5g}")
                for name, low, high, truth in intervals(record)
                if not low <= truth <= high
            ]
    return table(("case", "number", "low", "high", "truth"), rows)
