"""What a diagnosis says in the end, in a form that programs can read."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Annotated, Any, ClassVar, Literal

from pydantic import Field

from vehgen.diagnose.inputs.fault import MeasurementFault
from vehgen.files.results import Result, Table

VerdictName = Literal[
    "no_missing_effect",
    "named",
    "several_effects",
    "ambiguous",
    "not_in_library",
    "too_weak",
    "insufficient_data",
    "measurement_fault",
]


@dataclass(frozen=True)
class NamedParameter:
    """A parameter of a named effect [unit], with its 90 % interval."""

    value: float
    interval: tuple[float, float] | None
    unit: str


@dataclass(frozen=True)
class NamedEffect:
    """An effect that the data ask for: where it is, how strong, how sure.

    `p_value` holds for the whole library (Bonferroni); `validation_gain` is the share of the excess on validation runs that it closes,
    with its block-bootstrap `gain_interval` (None where those runs show no gap); `alternatives` do as well within the slack; `sentence`
    names it in words.
    """

    name: str
    place: str
    parameters: dict[str, NamedParameter]
    p_value: float
    validation_gain: Annotated[float | None, Field(alias="held_out_gain")]
    gain_interval: tuple[float, float] | None
    alternatives: tuple[str, ...] = ()
    sentence: str = ""


@dataclass(frozen=True)
class RunChi:
    """A run's chi before and after the effects were added; `validation` tells that no fit has seen the run."""

    run: str
    validation: Annotated[bool, Field(alias="untouched")]
    before: float
    after: float


@dataclass(frozen=True)
class Gap:
    """How far model and measurement are apart, as chi (1 is the noise floor): before, after, run by run."""

    before: float
    after: float
    noise_floor: float
    runs: tuple[RunChi, ...] = ()


@dataclass(frozen=True)
class PlaceChi:
    """A place that passes the place test, with the chi that an unknown force there leaves."""

    place: str
    chi: float


@dataclass(frozen=True)
class Verdict(Result):
    """The verdict of a diagnosis.

    `reason` says it in plain sentences; `places` are the places that pass the place test; `next_experiment` what would tell more; `notes`
    what a careful reader should know; `free_form` describes the unknown force where no effect of the library does; `faults` are mistakes of
    the measurement, to be put right before anything is named; beside effects, those of runs that were left out.
    """

    KIND: ClassVar[str] = "verdict"
    DRAWING: ClassVar[str] = "vehgen.report.plots.diagnosis_plots:plot_run_gaps"

    verdict: VerdictName
    reason: str
    effects: tuple[NamedEffect, ...]
    gap: Gap
    places: tuple[PlaceChi, ...] = ()
    vehicle_file: str | None = None
    next_experiment: str | None = None
    notes: tuple[str, ...] = field(default_factory=tuple)
    free_form: dict[str, Any] | None = None
    faults: tuple[MeasurementFault, ...] = ()

    def table(self) -> Table:
        """Return the named effects' parameters, a row each."""
        columns = ("effect", "place", "parameter", "value", "unit", "low", "high")
        return columns, [
            (effect.name, effect.place, name, item.value, item.unit, *(item.interval or (None, None)))
            for effect in self.effects
            for name, item in effect.parameters.items()
        ]
