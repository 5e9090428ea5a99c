"""Scores of the hidden cases: names, places, false alarms, abstentions, gaps."""

from __future__ import annotations

import statistics
from collections.abc import Sequence
from typing import Any

SAME_PLACE = {"all": ("all tyres", "all runs")}
"""The generator's words for places, and the diagnosis's."""


def right_name(record: dict[str, Any], most: int = 3) -> bool:
    """Return whether the true effect is named, alone or in a tie of at most `most`."""
    found = [effect["name"] for effect in record.get("effects", [])]
    return record["verdict"] in ("named", "ambiguous") and len(found) <= most and record["truth"][0]["name"] in found


def right_place(record: dict[str, Any]) -> bool:
    """Return whether the true place is named, alone or in a tie."""
    truth = record["truth"][0]["place"]
    allowed = {truth, *SAME_PLACE.get(truth, ())}
    return any(effect["place"] in allowed for effect in record.get("effects", [])) or any(
        truth in item["place"] for item in record.get("places", [])
    )


def covered(record: dict[str, Any]) -> list[bool]:
    """Return, for parameters that both sides call alike, whether the interval holds the truth."""
    truth = record["truth"][0]
    found = []
    for effect in record.get("effects", []):
        if effect["name"] == truth["name"]:
            for name, item in effect["parameters"].items():
                if name in truth["values"] and item["interval"]:
                    found.append(item["interval"][0] <= truth["values"][name] <= item["interval"][1])
    return found


def score(records: Sequence[dict[str, Any]]) -> dict[str, Any]:
    """Return the scores of a set."""
    kinds = {kind: [item for item in records if item["kind"] == kind] for kind in ("listed", "null", "weak", "two", "outside")}
    listed, named = kinds["listed"], [item for item in kinds["listed"] if right_name(item)]
    hits = [hit for item in named for hit in covered(item)]
    return {
        "listed": (len(named), len(listed)),
        "place": (sum(right_place(item) for item in listed), len(listed)),
        "null, false names": (sum(item["verdict"] in ("named", "ambiguous") for item in kinds["null"]), len(kinds["null"])),
        "weak, false names": (
            sum(item["verdict"] in ("named", "ambiguous") and not right_name(item) for item in kinds["weak"]),
            len(kinds["weak"]),
        ),
        "outside, called so": (sum(item["verdict"] == "not_in_library" for item in kinds["outside"]), len(kinds["outside"])),
        "two, at least one named": (sum(right_name(item) for item in kinds["two"]), len(kinds["two"])),
        "intervals that cover": (sum(hits), len(hits)),
        "median gap after": statistics.median([item["gap"]["after"] for item in named]) if named else None,
        "median seconds": statistics.median([item["seconds"] for item in records]) if records else None,
    }


def table(scores: dict[str, Any]) -> str:
    """Return the scores as a Markdown table."""
    rows = ["| what | result |", "|---|---|"]
    for name, value in scores.items():
        text = f"{value[0]} of {value[1]}" if isinstance(value, tuple) else f"{value:.3g}" if value is not None else ""
        rows.append(f"| {name} | {text} |")
    return "\n".join(rows)
