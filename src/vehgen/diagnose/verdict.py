"""What a diagnosis says in the end, in a form that programs can read."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, Literal

VerdictName = Literal["no_missing_effect", "named", "ambiguous", "not_in_library", "too_weak", "insufficient_data"]


@dataclass(frozen=True)
class NamedParameter:
    """A parameter of a named effect [unit], with its 90 % interval."""

    value: float
    interval: tuple[float, float] | None
    unit: str


@dataclass(frozen=True)
class NamedEffect:
    """An effect that the data ask for: where it is, how strong, how sure.

    `p_value` holds for the whole library (Bonferroni); `held_out_gain` is the share of the excess on untouched runs that it closes, with
    its block-bootstrap `gain_interval` (None where those runs show no gap); `alternatives` do as well within the slack.
    """

    name: str
    place: str
    parameters: dict[str, NamedParameter]
    p_value: float
    held_out_gain: float | None
    gain_interval: tuple[float, float] | None
    alternatives: tuple[str, ...] = ()


@dataclass(frozen=True)
class Gap:
    """How far model and measurement are apart, as chi (1 is the noise floor): before, after, run by run."""

    before: float
    after: float
    noise_floor: float
    runs: tuple[dict[str, Any], ...] = ()


@dataclass(frozen=True)
class Verdict:
    """The verdict of a diagnosis.

    `reason` says why in a sentence; `places` are the places that pass the place test, with their chi; `next_experiment` what would
    tell more; `notes` what a careful reader should know; `free_form` describes the unknown force where no effect of the library does.
    """

    verdict: VerdictName
    reason: str
    effects: tuple[NamedEffect, ...]
    gap: Gap
    places: tuple[tuple[str, float], ...] = ()
    vehicle_file: str | None = None
    next_experiment: str | None = None
    notes: tuple[str, ...] = field(default_factory=tuple)
    free_form: dict[str, Any] | None = None

    def to_dict(self) -> dict[str, Any]:
        """Return plain data for JSON."""
        return {
            "verdict": self.verdict,
            "reason": self.reason,
            "effects": [
                {
                    "name": effect.name,
                    "place": effect.place,
                    "parameters": {
                        name: {"value": item.value, "interval": None if item.interval is None else list(item.interval), "unit": item.unit}
                        for name, item in effect.parameters.items()
                    },
                    "p_value": effect.p_value,
                    "held_out_gain": effect.held_out_gain,
                    "gain_interval": None if effect.gain_interval is None else list(effect.gain_interval),
                    "alternatives": list(effect.alternatives),
                }
                for effect in self.effects
            ],
            "gap": {
                "before": self.gap.before,
                "after": self.gap.after,
                "noise_floor": self.gap.noise_floor,
                "runs": list(self.gap.runs),
            },
            "places": [{"place": name, "chi": chi} for name, chi in self.places],
            "vehicle_file": self.vehicle_file,
            "next_experiment": self.next_experiment,
            "notes": list(self.notes),
            "free_form": self.free_form,
        }


def sentence(items: Sequence[str], word: str = "or") -> str:
    """Return names joined as in a sentence, the last by a word."""
    listed = list(items)
    return listed[0] if len(listed) == 1 else f"{', '.join(listed[:-1])} {word} {listed[-1]}" if listed else "nothing"
