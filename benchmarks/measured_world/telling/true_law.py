"""The law that is hidden, as a candidate of the library at its true place, and its true numbers."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from benchmarks.measured_world.accepted import SAME_PLACE
from vehgen.diagnose.fits.candidate import Candidate

Data = dict[str, Any]
Numbers = Mapping[str, float]
DAMPERS = {"front": "cf", "rear": "cr"}
"""Dampings of the sedan's axles; those of the truck's are c1 to c5."""


def _mount(values: Numbers, place: str, vehicle: Numbers) -> dict[str, float]:
    return {"k": vehicle[DAMPERS.get(place, place.replace("axle", "c"))] / values["time"]}


WORDED: dict[str, Callable[[Numbers, str, Numbers], dict[str, float]]] = {
    "damper_mount": _mount,
    "hinge_friction": lambda values, place, vehicle: {"force": values["moment"]},
    "sensor_gain": lambda values, place, vehicle: {"gain": 1 + values["error"]},
    "sensor_tilt": lambda values, place, vehicle: {"tilt": values["angle"]},
    "sensor_delay": lambda values, place, vehicle: {"delay": values["time"]},
    "speed_error": lambda values, place, vehicle: {"scale": 1 + values["error"]},
}
"""The library's numbers where the truth gives others; elsewhere both have the same names."""


def true_candidate(hidden: Data, candidates: Sequence[Candidate]) -> Candidate:
    """Return the candidate that is the hidden effect at its place; raises ValueError where the library has none."""
    places = (hidden["place"], *SAME_PLACE.get(hidden["place"], ()))
    for candidate in candidates:
        if candidate.effect.name == hidden["name"] and candidate.place in places:
            return candidate
    raise ValueError(f"the library has no {hidden['name']} at {hidden['place']}")


def true_start(candidate: Candidate, hidden: Data, vehicle: Numbers, usual: Sequence[float]) -> tuple[float, ...]:
    """Return the hidden effect's numbers as a start of the candidate's fit; as in a `usual` start where the truth has none."""
    values = {**hidden["values"]}
    if hidden["name"] in WORDED:
        values |= WORDED[hidden["name"]](values, hidden["place"], vehicle)
    names = [item.name for item in candidate.effect.parameters]
    return tuple(float(values.get(name, number)) for name, number in zip(names, usual, strict=False))
