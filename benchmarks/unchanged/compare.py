"""Compares two records: exact equality of what is deterministic arithmetic, relative differences of the rest."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

EXACT = ("modes", "static", "responses", "populations", "advice")
"""Sections in which no digit may differ, whatever the tolerance."""
IGNORED = {"machine", "provenance", "files", "vehicle_file"}
"""Versions, dates, hashes of inputs, settings and paths."""
PROSE = {"reason", "notes", "warnings", "next_experiment", "title", "source", "meaning", "speed_source", "failed"}
"""Sentences for people: other words are told, but are no change of what was computed; more or fewer sentences are."""
RENAMED: dict[str, str] = {"DHCM-1&2": "DHCM-1-2", "DHCM-F&R": "DHCM-F-R", "gauge": "unidentifiable", "high_2ms": "high_2.5ms"}
"""Keys, their parts between commas, and words such as a status, of the older record -> what the newer one calls them."""


@dataclass(frozen=True)
class Difference:
    """A value that differs: where it stands, both values, and how far they are apart (None: no numbers, or nothing to compare)."""

    place: str
    old: Any
    new: Any
    relative: float | None = None
    prose: bool = False

    def __str__(self) -> str:
        far = "" if self.relative is None else f", relative difference {self.relative:.3g}"
        return f"{self.place}: {_short(self.old)} -> {_short(self.new)}{far}"

    def matters(self, tolerance: float) -> bool:
        """Whether it is a change beyond a relative tolerance, which the exact sections do not have."""
        exact = self.place.split(" / ")[0] in EXACT
        return not self.prose and (exact or self.relative is None or self.relative > tolerance)


def compare(old: Any, new: Any, place: str = "", key: str = "") -> Iterator[Difference]:
    """Yield what differs between two records. What only the newer one holds is no difference.

    Parameters
    ----------
    old, new
        Values of JSON.
    place, key
        Where they stand, and under which key.
    """
    if key in IGNORED:
        return
    if isinstance(old, dict) and isinstance(new, dict):
        renamed = {renamed_to(name): value for name, value in old.items()}
        for name, value in renamed.items():
            inside = f"{place} / {name}" if place else name
            if name in new:
                yield from compare(value, new[name], inside, name)
            elif name not in IGNORED:
                yield Difference(inside, value, "missing", prose=name in PROSE)
    elif key in PROSE:
        if old != new:
            more_or_fewer = isinstance(old, list) and isinstance(new, list) and len(old) != len(new)
            yield Difference(place, old, new, prose=not more_or_fewer)
    elif isinstance(old, list) and isinstance(new, list) and len(old) == len(new):
        for index, (first, second) in enumerate(zip(old, new, strict=True)):
            name = first.get("name") if isinstance(first, dict) else None
            yield from compare(first, second, f"{place}[{index if name is None else name}]", "")
    elif _is_number(old) and _is_number(new):
        if old != new:
            yield Difference(place, old, new, abs(old - new) / max(abs(old), abs(new)))
    elif old != new and not (isinstance(old, str) and renamed_to(old) == new):
        yield Difference(place, old, new)


def renamed_to(name: str) -> str:
    """Return what the newer record calls a key or a word of the older one."""
    return ", ".join(RENAMED.get(part, part) for part in name.split(", "))


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _short(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= 80 else f"{text[:77]}..."


def report(old: dict[str, Any], new: dict[str, Any], tolerance: float, wording: bool) -> tuple[list[str], bool]:
    """Return the lines to print, and whether nothing that was computed changed."""
    lines = []
    if old.get("machine") != new.get("machine"):
        lines.append(f"note: not the same machine or libraries, so bits may differ: {old.get('machine')} -> {new.get('machine')}")
    same = True
    for section in (name for name in old if name not in IGNORED):
        if section not in new:
            lines.append(f"{section}: not recorded again")
            same = False
            continue
        found = list(compare(old[section], new[section], section))
        changed = [item for item in found if item.matters(tolerance)]
        within = [item for item in found if not item.matters(tolerance) and not item.prose]
        words = [item for item in found if item.prose]
        same = same and not changed
        shown = [*changed, *within, *(words if wording else [])]
        lines.append(f"{section}: {len(changed)} changed, {len(within)} within the tolerance, {len(words)} sentences worded otherwise")
        lines += [f"  {item}" for item in shown]
    lines.append("nothing that was computed changed" if same else "CHANGED: see above")
    return lines, same
