"""What the jobs took, as tables."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass


@dataclass(frozen=True)
class Taken:
    """CPU seconds of a job, in all and split by stage and by room (see `sampler.py`)."""

    cpu: float
    stages: Mapping[str, float]
    rooms: Mapping[str, float]


def shortest(rounds: Sequence[Taken]) -> Taken:
    """Return the round of a job that took the least CPU time."""
    return min(rounds, key=lambda taken: taken.cpu)


def totals(jobs: Mapping[str, Sequence[Taken]]) -> list[str]:
    """Return a table in Markdown, a row a job: one column a checkout, this one last, and what it takes over the first."""
    several = len(next(iter(jobs.values()))) > 1
    head = ["job", *(["against [s]"] if several else []), "here [s]", *(["ratio"] if several else [])]
    rows = []
    for name, taken in jobs.items():
        ratio = [f"{taken[-1].cpu / taken[0].cpu:.2f}"] if several else []
        rows.append([name, *(f"{item.cpu:.1f}" for item in taken), *ratio])
    return _table(head, rows)


def split(jobs: Mapping[str, Sequence[Taken]], kind: str) -> list[str]:
    """Return a table of CPU seconds by `stages` or `rooms`, a column a job; with two checkouts `before → here`."""
    parts: dict[str, float] = {}
    for taken in jobs.values():
        for item in taken:
            for part, seconds in getattr(item, kind).items():
                parts[part] = max(parts.get(part, 0.0), seconds)
    rows = []
    for part in sorted(parts, key=lambda name: -parts[name]):
        if parts[part] >= 0.1:
            rows.append([part, *(" → ".join(f"{getattr(item, kind).get(part, 0.0):.1f}" for item in taken) for taken in jobs.values())])
    return _table([f"CPU [s] by {kind.removesuffix('s')}", *jobs], rows)


def _table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> list[str]:
    return [f"| {' | '.join(row)} |" for row in (head, ["---"] * len(head), *rows)]
