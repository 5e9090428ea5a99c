"""How an answer on a rig counts, and whether its intervals hold the hidden values."""

from __future__ import annotations

from typing import Any

Data = dict[str, Any]
WEAK = 1.0
"""A hidden law whose distinct strength is below cannot be asked for."""
SYNONYMS: dict[str, tuple[str, ...]] = {
    "hidden_spring": ("added_stiffness",),
    "free_play": ("damper_free_play",),
    "directional_friction": ("asymmetric_friction",),
}
"""Other names that a library may have for a hidden law. Extend freely."""
MISSED = ("not_in_library", "too_weak", "no_missing_effect", "insufficient_data")


def judged_rig(truth: Data, answer: Data) -> str:
    """Return how a diagnosis of a rig is to be counted."""
    verdict, effects = str(answer["verdict"]), answer.get("effects", [])
    if verdict == "measurement_fault":
        return "false fault"
    if verdict not in ("named", "ambiguous", *MISSED):
        return verdict
    if not truth["effects"]:
        return _on_healthy(verdict)
    hits = [any(_hit(hidden, effect) for effect in effects) for hidden in truth["effects"]]
    if verdict == "ambiguous":
        return "tie with the truth in it" if any(hits) else "tie without the truth"
    if verdict == "named":
        return _on_named(truth["effects"], effects, hits)
    if verdict == "not_in_library" and not truth["effects"][0]["listed"]:
        return "not in library, right"
    weak = truth["strength"]["distinct"] < WEAK
    return {
        "no_missing_effect": "too weak, and not seen" if weak else "missed",
        "too_weak": "too weak, and said so" if weak else "called too weak",
        "not_in_library": "called not in library",
    }.get(verdict, verdict)


def _on_healthy(verdict: str) -> str:
    return {
        "no_missing_effect": "healthy called healthy",
        "named": "false effect",
        "ambiguous": "false effects, a tie",
        "not_in_library": "false gap",
        "too_weak": "false gap, too weak",
    }.get(verdict, verdict)


def _on_named(hidden: list[Data], effects: list[Data], hits: list[bool]) -> str:
    surplus = len(effects) > sum(hits)
    if all(hits):
        return "named right" + (", with another" if surplus else "")
    if any(hits):
        return "one of two named" + (", with another" if surplus else "")
    names = {name for item in hidden for name in _names(item)}
    return "right law, wrong place" if names & {effect["name"] for effect in effects} else "named wrong"


def _names(hidden: Data) -> tuple[str, ...]:
    return (hidden["name"], *hidden["accepted"], *SYNONYMS.get(hidden["name"], ()))


def _hit(hidden: Data, effect: Data) -> bool:
    return effect["place"] == hidden["place"] and effect["name"] in _names(hidden)


def rig_rows(truth: Data, answer: Data) -> list[Data]:
    """Return the parameters of effects that were told rightly: law, name, truth, value and 90 % interval (None without one)."""
    found = []
    for hidden in truth["effects"]:
        for effect in answer.get("effects", []):
            if not _hit(hidden, effect):
                continue
            values = hidden["values"] if effect["name"] == hidden["name"] else hidden["accepted"].get(effect["name"], {})
            for name, right in values.items():
                item = effect["parameters"].get(name)
                if item is not None:
                    low, high = item["interval"] or (None, None)
                    found.append({"family": effect["name"], "name": name, "truth": right, "value": item["value"], "low": low, "high": high})
    return found
