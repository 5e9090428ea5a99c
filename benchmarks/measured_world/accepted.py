"""Which answers count as right: the mistakes' names here beside those that a diagnosis may give them. Adjust the tables freely."""

from __future__ import annotations

from typing import Any

Data = dict[str, Any]
SAME_PLACE = {"all": ("all tyres", "all runs", "all")}
"""The generator's words for places, and a diagnosis's."""
KINDS: dict[str, tuple[str, ...]] = {
    "unit_g": ("unit",),
    "unit_degrees": ("unit",),
    "speed_unit": ("speed_unit", "speed"),
    "speed_off": ("speed",),
    "sign_reversed": ("turned",),
    "channels_exchanged": ("exchanged",),
    "sensors_exchanged": ("exchanged",),
    "dead_channel": ("dead", "stuck"),
    "clipped": ("clipped",),
    "low_passed": ("low_pass",),
    "clocks_apart": ("clocks_apart",),
    "speeds_swapped": ("exchanged_speeds", "exchanged_recordings", "speed"),
    "humps_swapped": ("exchanged_roads", "exchanged_heights", "exchanged_recordings", "hump_height", "hump"),
    "other_hump": ("hump", "hump_length", "hump_form", "hump_height"),
    "other_vehicle": ("other_vehicle", "other_parameters", "stranger"),
    "wheelbase": ("axle_position",),
    "gain_one_run": ("gain",),
    "profile_moved": ("road_position", "clock"),
    "near_copies": ("copy",),
    "clock_fast": ("clock_rate", "clock_or_speed"),
}
"""Kinds of `measurement_fault` that name a mistake: swapped speeds or humps where two recordings were exchanged are the same."""
WORDS: dict[str, tuple[str, ...]] = {
    "unit_g": ("unit", "in g", "9.8"),
    "unit_degrees": ("unit", "deg"),
    "speed_unit": ("speed",),
    "speed_off": ("speed",),
    "sign_reversed": ("turned", "sign", "reversed"),
    "channels_exchanged": ("exchanged",),
    "sensors_exchanged": ("exchanged",),
    "dead_channel": ("dead", "stuck", "noise only"),
    "clipped": ("clip",),
    "low_passed": ("low-pass", "filter"),
    "clocks_apart": ("clock",),
    "speeds_swapped": ("speed",),
    "humps_swapped": ("hump",),
    "other_hump": ("hump",),
    "other_vehicle": ("vehicle",),
    "wheelbase": ("axle",),
    "gain_one_run": ("gain", "scale"),
    "profile_moved": ("profile",),
    "near_copies": ("same recording", "copy", "copies"),
    "clock_fast": ("clock",),
}
"""Words in the reason of a refusal, or of too little data, that tell the user of the mistake."""
AS_EFFECTS: dict[str, tuple[str, ...]] = {
    "unit_g": ("sensor_gain",),
    "unit_degrees": ("sensor_gain",),
    "gain_one_run": ("sensor_gain",),
    "sign_reversed": ("sensor_gain",),
    "clocks_apart": ("sensor_delay",),
    "speed_unit": ("speed_error",),
    "speed_off": ("speed_error",),
    "wheelbase": ("sensor_position",),
}
"""Effects of a library that describe a mistake, where it has no name of its own."""
ABSTAINING = ("insufficient_data", "refused", "import_refused")


def judged_effect(truth: list[Data], answer: Data) -> str:
    """Return how an answer on effects (none, or one) is to be counted."""
    verdict, effects = answer["verdict"], answer.get("effects", [])
    names = [effect["name"] for effect in effects]
    if verdict == "named" and truth:
        places = {truth[0]["place"], *SAME_PLACE.get(truth[0]["place"], ())}
        there = [effect["name"] for effect in effects if effect["place"] in places]
        if truth[0]["name"] not in names:
            return "named wrong"
        return ("named right" if truth[0]["name"] in there else "named right, elsewhere") + ("" if len(names) == 1 else ", with another")
    if verdict == "ambiguous" and truth:
        return "ambiguous, truth among them" if truth[0]["name"] in names else "ambiguous, wrong"
    return str(verdict)


def judged_fault(fault: Data, answer: Data) -> str:
    """Return how an answer on a case with a mistake is to be counted."""
    verdict = answer["verdict"]
    if verdict == "measurement_fault":
        items = answer.get("faults", [])
        kinds = [str(item.get("kind", "")) for item in items]
        if not set(kinds) & set(KINDS[fault["kind"]]):
            return "another fault named"
        return "fault named right, place too" if any(_placed(fault, item) for item in items) else "fault named right"
    if verdict in ABSTAINING:
        reason = str(answer.get("reason", "")).lower()
        return f"{verdict}, fault told" if any(word in reason for word in WORDS[fault["kind"]]) else f"{verdict}, otherwise"
    if verdict in ("named", "ambiguous"):
        names = {effect["name"] for effect in answer.get("effects", [])}
        return "named as an effect that describes it" if names & set(AS_EFFECTS.get(fault["kind"], ())) else "named as a false effect"
    return str(verdict)


def _placed(fault: Data, item: Data) -> bool:
    """Return whether a named fault tells a run, sensor or channel concerned."""
    told = {*item.get("runs", ()), *item.get("channels", ())}
    return any(name in told for name in (*fault["runs"], *fault["items"]))
