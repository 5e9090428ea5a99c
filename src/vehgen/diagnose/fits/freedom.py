"""No effect, but the freedom that one gives the base parameters at its place: something that can be fitted as effects are."""

from __future__ import annotations

from dataclasses import dataclass

from vehgen.diagnose.fits.candidate import Candidate
from vehgen.effects import Effect
from vehgen.effects.places import nowhere


@dataclass(frozen=True, kw_only=True)
class FreedBase(Effect):
    """No effect at all, but the freedom that another one gives the base parameters at its place."""

    def n_numbers(self, n_runs: int) -> int:
        """Return 0: it adds no parameter."""
        return 0


FREED_BASE = FreedBase(name="freed_base", title="Base parameters beyond the file's", attaches="base", places=nowhere)


def freed_alone(names: tuple[str, ...]) -> Candidate:
    """Return the candidate that sets base parameters free and adds nothing."""
    return Candidate(FREED_BASE, ", ".join(names), (), (), names)
