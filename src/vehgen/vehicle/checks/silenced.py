"""Which warnings a vehicle file silences: known kinds, of parts that there are."""

from __future__ import annotations

from vehgen.errors import InputError, did_you_mean, shown
from vehgen.vehicle.model import Vehicle

WARNINGS = {
    "negative_load": "axles",
    "lift": "hinges",
    "deflection": "axles",
    "gyration": "bodies",
    "axle_gap": "axles",
    "link_gap": "links",
    "body_mode": "bodies",
}
"""Kinds of warnings -> the parts that they speak of."""


def check_silenced(vehicle: Vehicle) -> None:
    """Check `silence`; raises InputError at the first entry that is no warning, or of a part that there is not."""
    for index, entry in enumerate(vehicle.silence):
        kind, *parts = entry.split()
        place = vehicle.position("silence", index)
        if kind not in WARNINGS:
            raise InputError(f"unknown warning {shown(kind)}; {did_you_mean(kind, WARNINGS)}", place)
        known = getattr(vehicle, WARNINGS[kind])
        if len(parts) > 1:
            raise InputError(
                f"a warning and at most one part were expected, e.g. {kind} {next(iter(known), 'name')}; found {shown(entry)}", place
            )
        if parts and parts[0] not in known:
            raise InputError(f"no {WARNINGS[kind]} are called {shown(parts[0])}; {did_you_mean(parts[0], known)}", place)


def is_silenced(vehicle: Vehicle, kind: str, part: str) -> bool:
    """Tell whether a vehicle's file silences a warning of a kind about a part."""
    return any(entry.split() in ([kind], [kind, part]) for entry in vehicle.silence)
