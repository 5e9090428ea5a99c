"""What a calibration tells its user, as a value: parameters, intervals, what cannot be told, how well it fits."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated, Any, ClassVar

from pydantic import Field

from vehgen.calibrate.calibration import Calibration
from vehgen.errors import InputError
from vehgen.files.number_text import interval_words
from vehgen.files.result_fields import IN_MEMORY, Array1D, Number
from vehgen.files.results import Result, Table
from vehgen.measure.curves import ChannelCurves
from vehgen.vehicle.writing import variant_text

Interval = tuple[float, float]
MAX_CURVES = 500
"""A file with more curves than this is refused: no figure could show them."""


@dataclass(frozen=True)
class ParameterSummary:
    """One parameter [unit, SI]: its value, and what stands behind it.

    `status` is `identified`, `weak` (its interval spans most of its range), `unidentifiable` (no recording of this kind can tell it: see
    the null directions), `bound` (its range, not the data, set it) or `not assessed`. `interval_given_pivots` is its
    interval if the fixed parameters were known.
    """

    value: float
    interval: Interval | None
    unit: str
    range: Interval
    status: str
    step: str
    interval_given_pivots: Interval | None = None


@dataclass(frozen=True)
class CombinationSummary:
    """A quantity [unit, SI] with its interval, None where the data cannot tell it."""

    value: float
    interval: Interval | None
    unit: str = ""


@dataclass(frozen=True)
class ModeSummary:
    """A natural mode of the calibrated vehicle with its intervals."""

    name: str
    undamped_hz: float
    interval: Interval | None
    damping_ratio: float
    damping_interval: Interval | None


@dataclass(frozen=True)
class FitSummary:
    """Where starts of the polish ended that answer alike: their loss, chi2 (1 is noise alone), and the parameters that ended at a bound."""

    loss: float
    chi2: float
    on_bound: tuple[str, ...]


@dataclass(frozen=True, eq=False)
class NoiseSummary:
    """The noise of a run: `sigma shape (n_channels,)`, and the level of the road's roughness."""

    run: str
    sigma: Array1D
    road_level_m3: Array1D


@dataclass(frozen=True)
class ConditionSummary:
    """What a fit supposes of a run, e.g. that its `speed` was 1.5 % higher than stated.

    `place` is the run as a whole or a sensor; `value` [unit; relative where there is none] lies `sigmas` of its `prior`, the standard
    deviation of what was known, off what the run file states.
    """

    run: str
    step: str
    name: str
    place: str
    value: float
    unit: str
    prior: float
    sigmas: float


@dataclass(frozen=True)
class RecorderSummary:
    """What a step of the polish supposes of recorders that no run file declares.

    `filter`, `order` and `cut_off` [Hz] of the low-pass that suits the recordings of `channels` best; `is_clear` says whether none that
    differs would do as well. Nothing above `compared_to` [Hz] is compared; `told` says it in words.
    """

    step: str
    channels: tuple[str, ...]
    filter: str
    order: int
    cut_off: float | None
    is_clear: bool
    compared_to: float
    told: str


@dataclass(frozen=True)
class FactAdvice:
    """What measuring a fact would do for the intervals of the parameters.

    `entry` is its place in a file of facts; `expected` what the fit makes of it and `uncertainty` how well it would be known [unit].
    `width_left` is the mean share of the intervals' widths that would be left, `width_left_beside_best` that beside the best of all
    facts; `narrows` names the parameters whose intervals would be less than half as wide, most helped first.
    """

    fact: str
    entry: str
    expected: float
    uncertainty: float
    unit: str
    width_left: float
    width_left_beside_best: float
    narrows: tuple[str, ...]


@dataclass(frozen=True)
class HeldMasses:
    """Bodies' masses that no search changes, on which everything else hangs.

    `names` are their parameters. Were all of them 1 % larger, recordings of motion alone would be the same with the parameters of
    `follows` larger by so many percent.
    """

    names: tuple[str, ...]
    follows: dict[str, float]


@dataclass(frozen=True, eq=False)
class CalibrationSummary(Result):
    """Everything a calibration tells.

    Attributes
    ----------
    vehicle, method, stopped
        What was calibrated and how; whether it was interrupted: the values are then the best so far.
    parameters, modes, combinations, bootstrap
        By name, with intervals at the level `confidence`; the bootstrap checks those of combinations and frequencies.
    rank, searched, pivots, null_directions
        How many combinations of how many parameters the sensors can tell, and along what the others trade.
    objective, chi2, fits, spread
        Eq. 5 by channel; the best fit's chi2; the fits that answer differently; the values among those that fit as well as the best.
    nuisances, noise, tyre_load_minimum
        What is supposed of the runs; each axle's least tyre load over its static load.
    history, steps
        The best objective after each generation, a list a step, and the steps' labels.
    band, psds, histories
        Frequencies compared [Hz], and measured beside simulated.
    provenance
        Versions, settings, and hashes of the inputs.
    calibration
        The calibration itself, None in a summary that was read from a file.
    conditions, run_chi2
        What the fit supposes of each run's clock, speed and hump height, at which `objective`, `psds`, `histories` and `tyre_load_minimum`
        are simulated; and each run's chi2.
    interval_inflation
        By which factor all intervals are wider than the noise alone would have them: the root of the largest chi2 of a run, where
        it exceeds 1.
    prior_data_advice
        Facts that could be measured, best first: what each would do for the intervals.
    recorder
        What stands for recorders that no run file declares, step by step.
    undamped_tyres
        Axles whose mass or tyre's stiffness was searched, and to whose tyres the vehicle file gives no damping: what real ones damp passes
        for lighter axles on softer tyres, and no interval knows of it.
    held_masses
        Bodies' masses that the vehicle file takes as known, and what hangs on them, which no interval counts; None where there are none.
    """

    KIND: ClassVar[str] = "calibration"
    DRAWING: ClassVar[str] = "vehgen.report.plots.calibration_plots:plot_calibration"

    vehicle: str
    method: str
    stopped: bool
    parameters: dict[str, ParameterSummary]
    confidence: float
    rank: int
    searched: int
    pivots: tuple[str, ...]
    null_directions: tuple[dict[str, float], ...]
    combinations: dict[str, CombinationSummary]
    modes: tuple[ModeSummary, ...]
    bootstrap: dict[str, CombinationSummary]
    objective: dict[str, float]
    chi2: float | None
    fits: tuple[FitSummary, ...]
    spread: dict[str, Interval]
    nuisances: dict[str, dict[str, float]]
    noise: tuple[NoiseSummary, ...]
    tyre_load_minimum: dict[str, Number]
    history: Annotated[tuple[tuple[Number, ...], ...], Field(max_length=MAX_CURVES)]
    steps: tuple[str, ...]
    band: tuple[float, float]
    psds: Annotated[tuple[ChannelCurves, ...], Field(max_length=MAX_CURVES)]
    histories: Annotated[tuple[ChannelCurves, ...], Field(max_length=MAX_CURVES)]
    provenance: dict[str, Any]
    calibration: Annotated[Calibration | None, IN_MEMORY] = field(default=None, repr=False)
    conditions: tuple[ConditionSummary, ...] = ()
    run_chi2: dict[str, float] = field(default_factory=dict)
    interval_inflation: float = 1.0
    prior_data_advice: tuple[FactAdvice, ...] = ()
    recorder: tuple[RecorderSummary, ...] = ()
    undamped_tyres: tuple[str, ...] = ()
    held_masses: HeldMasses | None = None

    def __post_init__(self) -> None:
        if len(self.steps) != len(self.history):
            raise ValueError("a label a step was expected")

    def table(self) -> Table:
        """Return the parameters, a row each."""
        return ("parameter", "value", "unit", "low", "high", "status"), [
            (name, item.value, item.unit, *(item.interval or (None, None)), item.status) for name, item in self.parameters.items()
        ]

    def vehicle_text(self, folder: Path, name: str) -> str:
        """Return the calibrated vehicle file, which extends the vehicle that was calibrated.

        Raises
        ------
        InputError
            For a summary that was read from a file: it has no vehicle.
        """
        calibration = self.calibration
        if calibration is None:
            raise InputError("this calibration was read from a file, without its vehicle: calibrate again")
        vehicle = calibration.problem.trials[0].run.vehicle
        runs = ", ".join(trial.name for trial in calibration.problem.trials)
        comments = [
            f"calibrated by vehgen {self.provenance['vehgen']}: {self.method} from {runs}, seed {self.provenance['seed']}",
            f"comments give {self.confidence:.0%} intervals; 'unidentifiable' marks what such recordings cannot determine one by one",
        ]
        notes = {key: self._note(key, item) for key, item in self.parameters.items()}
        title = f"{vehicle.title or vehicle.name}, calibrated"
        return variant_text(vehicle, folder, name, title, calibration.values, comments, notes)

    def _note(self, name: str, item: ParameterSummary) -> str:
        """Return what a parameter's comment in a vehicle file says."""
        if item.interval is not None:
            return f"{item.status} {interval_words(item.interval)}"
        if item.interval_given_pivots is None or name in self.pivots:
            return item.status
        return f"{item.status}; {interval_words(item.interval_given_pivots)} if {' and '.join(self.pivots)} were known"
