"""What the diagnoses of a fleet found: a row a vehicle, written, read, and shown as one table."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from typing import ClassVar, Literal

from vehgen.diagnose.verdict import Verdict
from vehgen.files.results import Cell, Result, Table

FLEET_COLUMNS = (
    "vehicle", "runs", "verdict", "effect", "place", "parameter", "value", "unit", "low", "high", "chi_before", "chi_after", "error",
)  # fmt: skip
NAMED_COLUMNS = ("vehicle", "error")
"""Those with the names of folders and files."""


@dataclass(frozen=True)
class FleetRow:
    """One vehicle of a fleet.

    `name` is its folder's; `status` tells whether its diagnosis is finished, failed (then `error` says why, in one line) or was not
    reached; `inputs` are the SHA-256 of the files that were read, and `fingerprint` that of all that the result depends on.
    """

    name: str
    status: Literal["finished", "failed", "waiting"] = "waiting"
    runs: tuple[str, ...] = ()
    verdict: Verdict | None = None
    error: str | None = None
    fingerprint: str | None = None
    inputs: tuple[tuple[str, str], ...] = ()

    @property
    def found(self) -> str:
        """What is missing, or what went wrong, in one line."""
        if self.verdict is None:
            return self.error or "not reached"
        told = [f"{effect.name} at {effect.place}" for effect in self.verdict.effects]
        told += [f"{fault.kind} of {', '.join(fault.runs)}" if fault.runs else fault.kind for fault in self.verdict.faults]
        return "; ".join(told) or self.verdict.reason


@dataclass(frozen=True, eq=False)
class Fleet(Result):
    """The diagnoses of a fleet's vehicles, in the order of their names; `stopped` tells that Ctrl-C ended them."""

    KIND: ClassVar[str] = "fleet"
    DRAWING: ClassVar[str] = "vehgen.report.plots.fleet_plot:plot_fleet"

    fleet: str
    rows: tuple[FleetRow, ...]
    made_by: dict[str, str]
    stopped: bool = False

    def table(self) -> Table:
        """Return a row for every parameter of a named effect, and one for every vehicle without."""
        return FLEET_COLUMNS, [cells for row in self.rows for cells in _cells(row)]

    def counts(self) -> dict[str, int]:
        """Return how many vehicles have each verdict, failed or were not reached; the most frequent first."""
        return dict(Counter(row.status if row.verdict is None else row.verdict.verdict for row in self.rows).most_common())


def _cells(row: FleetRow) -> list[tuple[Cell, ...]]:
    verdict = row.verdict
    if verdict is None:
        return [(row.name, len(row.runs), row.status, *[None] * (len(FLEET_COLUMNS) - 4), row.error)]
    head, chi = (row.name, len(row.runs), verdict.verdict), (verdict.gap.before, verdict.gap.after, None)
    named = verdict.table()[1]
    return [(*head, *cells, *chi) for cells in named] or [(*head, *[None] * 7, *chi)]
