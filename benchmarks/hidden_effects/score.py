"""Scores of the hidden cases: names, places, false alarms, abstentions, gaps, intervals, time."""

from __future__ import annotations

import statistics
from collections.abc import Callable, Sequence
from typing import Any

Record = dict[str, Any]
SAME_PLACE = {"all": ("all tyres", "all runs")}
"""The generator's words for places, and the diagnosis's."""
SAME_NUMBER: dict[str, dict[str, tuple[str, Callable[[float], float]]]] = {
    "sensor_gain": {"error": ("gain", lambda value: 1 + value)},
    "speed_error": {"error": ("scale", lambda value: 1 + value)},
    "sensor_tilt": {"angle": ("tilt", lambda value: value)},
    "sensor_delay": {"time": ("delay", lambda value: value)},
    "hinge_friction": {"moment": ("force", lambda value: value)},
    "cargo_module": {"damping": ("damping_ratio", lambda value: value)},
    "suspended_cab": {"damping": ("damping_ratio", lambda value: value)},
    "frame_bending": {"damping": ("damping_ratio", lambda value: value)},
}
"""The generator's parameters under the names that the library gives them; all others have one name."""
NAMED = ("named", "ambiguous")
KINDS = ("listed", "null", "weak", "two", "outside")


def right_name(record: Record, number: int = 0, most: int = 3) -> bool:
    """Return whether a true effect is named, alone or in a tie of at most `most`."""
    found = [effect["name"] for effect in record.get("effects", [])]
    return record["verdict"] in NAMED and len(found) <= most and record["truth"][number]["name"] in found


def needless(record: Record) -> bool:
    """Return whether a second effect is named where one was hidden: not as a tie, but beside the first."""
    effects = record.get("effects", [])
    ties = effects[0]["alternatives"] if effects else []
    beside = [effect for effect in effects[1:] if f"{effect['name']} at {effect['place']}" not in ties]
    return len(record["truth"]) == 1 and bool(beside)


def right_place(record: Record) -> bool:
    """Return whether the true place is named, alone or in a tie, or is among the smallest hypotheses that pass the place test."""
    truth = record["truth"][0]["place"]
    allowed = {truth, *SAME_PLACE.get(truth, ())}
    named = [effect["place"] for effect in record.get("effects", [])]
    passed = [label.partition(" ")[2].partition(" (")[0] for label in record.get("passed", [])]
    return any(place in allowed for place in named or passed)


def covered(record: Record) -> list[bool]:
    """Return, for parameters that both sides know, whether the interval holds the truth.

    Of a tie of one effect at several places the one at the true place counts: one sensor late is another one early.
    """
    truth = record["truth"][0]
    same = [effect for effect in record.get("effects", []) if effect["name"] == truth["name"]]
    there = [effect for effect in same if effect["place"] in (truth["place"], *SAME_PLACE.get(truth["place"], ()))]
    known = {}
    for name, value in truth["values"].items():
        other, read = SAME_NUMBER.get(truth["name"], {}).get(name, (name, lambda value: value))
        known[other] = read(value)
    return [
        item["interval"][0] <= known[name] <= item["interval"][1]
        for effect in there or same
        for name, item in effect["parameters"].items()
        if name in known and item["interval"]
    ]


def score(records: Sequence[Record]) -> dict[str, Any]:
    """Return the scores of a set."""
    kinds = {kind: [item for item in records if item["kind"] == kind] for kind in KINDS}
    listed = kinds["listed"]
    named = [item for item in listed if right_name(item) and not needless(item)]
    hits = [hit for item in named for hit in covered(item)]
    both = [item for item in kinds["two"] if right_name(item, 0) and right_name(item, 1)]
    one = [item for item in kinds["two"] if right_name(item, 0) or right_name(item, 1)]
    times = {name: [item["seconds"] for item in records if item["vehicle"] == name] for name in ("sedan2", "tractor5")}
    found: dict[str, Any] = {
        "one effect of the library: named right": (len(named), len(listed)),
        "one effect of the library: place right": (sum(right_place(item) for item in listed), len(listed)),
        "one effect of the library: named wrong": (
            sum(item["verdict"] in NAMED and not right_name(item) for item in listed),
            len(listed),
        ),
        "one effect of the library: a needless second one named beside it": (sum(needless(item) for item in listed), len(listed)),
        "nothing hidden: falsely named": (sum(item["verdict"] in NAMED for item in kinds["null"]), len(kinds["null"])),
        "too weak to see: falsely named": (
            sum(item["verdict"] in NAMED and not right_name(item) for item in kinds["weak"]),
            len(kinds["weak"]),
        ),
        "outside the library: called so": (sum(item["verdict"] == "not_in_library" for item in kinds["outside"]), len(kinds["outside"])),
        "two effects: both named": (len(both), len(kinds["two"])),
        "two effects: at least one named": (len(one), len(kinds["two"])),
        "intervals that hold the truth": (sum(hits), len(hits)),
        "median chi before, where named right": _median([item["gap"]["before"] for item in named]),
        "median chi after, on validation runs": _median([untouched(item) for item in named]),
    }
    for name, seconds in times.items():
        found[f"median seconds, {name}"] = _median(seconds)
        found[f"longest seconds, {name}"] = max(seconds, default=None)
    return found


def untouched(record: Record) -> float:
    """Return the chi after on the validation runs, the root of the mean of their squares."""
    squares = [run["after"] ** 2 for run in record["gap"]["runs"] if run["untouched"]]
    return (sum(squares) / len(squares)) ** 0.5 if squares else float("nan")


def _median(values: Sequence[float]) -> float | None:
    return statistics.median(values) if values else None


def table(scores: dict[str, Any]) -> str:
    """Return the scores as a Markdown table."""
    rows = ["| what | result |", "|---|---|"]
    for name, value in scores.items():
        text = f"{value[0]} of {value[1]}" if isinstance(value, tuple) else f"{value:.3g}" if value is not None else ""
        rows.append(f"| {name} | {text} |")
    return "\n".join(rows)
