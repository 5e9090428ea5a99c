"""The evidence of a diagnosis as values: every number that its page and figures show, and nothing that computes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any

from pydantic import Field

from vehgen.diagnose.detect.harmonics import Distortion
from vehgen.diagnose.verdict import NamedParameter
from vehgen.files.result_fields import Array1D, Number
from vehgen.measure.curves import ChannelCurves

MAX_PANELS = 200
"""More panels, places or rows than this are refused: no figure could show them."""


@dataclass(frozen=True)
class ChannelNoise:
    """The noise of a channel that the fits used: its standard deviation in the quietest run and in the loudest [unit of the quantity]."""

    channel: str
    quantity: str
    least: float
    largest: float


@dataclass(frozen=True)
class BaseParameter:
    """A parameter of the base model [unit]: the file's value, the refit of the base, and the refit with all effects found.

    `refit_on_bound` and `final_on_bound` tell that a refit ended at the edge of its range.
    """

    name: str
    unit: str
    filed: float
    refit: float
    refit_on_bound: bool
    final: float
    final_on_bound: bool


@dataclass(frozen=True)
class RunConditions:
    """What the last fit supposes of a run beyond its file: the clock's delay [s], relative errors of speed and road height."""

    run: str
    delay: float
    speed: float
    height: float


@dataclass(frozen=True)
class RunSize:
    """How large a run's gap is beside its amplitude: hump's height [m] (0 without one), speed [m/s], the gap's share of the recording."""

    run: str
    hump_height: float
    speed: float
    share: float


@dataclass(frozen=True)
class BandChi:
    """chi of a channel within a band [Hz], before and after, pooled over the validation runs (over all, where there are none)."""

    channel: str
    band: tuple[float, float]
    before: float
    after: float


@dataclass(frozen=True)
class PlaceEvidence:
    """A place of the place test: the chi that `unknowns` unknown forces leave there; `passes` as one of the smallest hypotheses that do.

    `is_force` is false for a channel or a sensor that was left out instead.
    """

    label: str
    chi: float
    unknowns: int
    is_force: bool
    passes: bool


@dataclass(frozen=True)
class FittedCandidate:
    """A candidate as it was fitted: chi on the runs for fitting and on validation runs (not a number where it was not checked)."""

    label: str
    training: float
    validation: Number
    parameters: dict[str, NamedParameter]


@dataclass(frozen=True)
class RoundEvidence:
    """One look for one effect: beside which model, the chi this leaves, the places that suffice, the best of `tried` candidates."""

    beside: str
    chi: float
    places: tuple[PlaceEvidence, ...]
    tried: int
    candidates: tuple[FittedCandidate, ...]


@dataclass(frozen=True)
class RunAsks:
    """What one run alone asks of a parameter of an effect, with its 90 % half width [unit of the parameter]."""

    effect: str
    parameter: str
    run: str
    value: float
    half_width: float


@dataclass(frozen=True)
class StepChi:
    """A step from the file's parameters to the noise: the chi that it leaves on the runs for fitting and on the validation runs."""

    label: str
    training: Number
    validation: Number


@dataclass(frozen=True, eq=False)
class LawCurve:
    """A curve of a free-form law over travel or rate, with its 90 % interval, and the recovered force at instants (`dots_x`, `dots`)."""

    x: Array1D
    force: Array1D
    low: Array1D
    high: Array1D
    dots_x: Array1D
    dots: Array1D

    def __post_init__(self) -> None:
        if not len(self.x) == len(self.force) == len(self.low) == len(self.high) >= 2 or not len(self.dots) == len(self.dots_x) >= 2:
            raise ValueError("curves of one length, of two points or more, were expected")


@dataclass(frozen=True, eq=False)
class ForceEvidence:
    """The unknown force at a place in one run, and the free-form law fitted to it.

    Attributes
    ----------
    place, kind, run
        Where (`kind` is suspension, tyre, link, hinge or body) and in which run.
    angular
        Whether travel, rate and force are an angle [rad], its rate [rad/s] and a moment [N m], not m, m/s and N.
    description
        The law in a sentence.
    travel, rate
        Its curves over travel and rate.
    time, force, deviation, law
        `shape (n,)`: the recovered force, its standard deviation, and the law as the band shows it.
    """

    place: str
    kind: str
    run: str
    angular: bool
    units: tuple[str, str, str]
    description: str
    travel: LawCurve
    rate: LawCurve
    time: Array1D
    force: Array1D
    deviation: Array1D
    law: Array1D

    def __post_init__(self) -> None:
        if not len(self.time) == len(self.force) == len(self.deviation) == len(self.law) >= 2:
            raise ValueError("histories of one length, of two points or more, were expected")


@dataclass(frozen=True)
class Origin:
    """What a diagnosis was made from.

    Attributes
    ----------
    command, made_on
        The command line, empty where it was called from Python; date and time [UTC].
    inputs, versions
        Names of files with their SHA-256; of vehgen, Python and packages.
    vehicle, values
        The plain data of the vehicle's file, with all that this extends; its free parameters as filed [SI].
    """

    command: str
    made_on: str
    inputs: dict[str, str]
    versions: dict[str, str]
    vehicle: dict[str, Any]
    values: dict[str, float]


@dataclass(frozen=True, eq=False)
class Evidence:
    """What stands behind a verdict.

    Attributes
    ----------
    vehicle, made_by
        The vehicle's title; the version of vehgen that made the diagnosis.
    band
        Frequencies compared [Hz].
    noise, noise_slope, corrected
        Noise by channel; its density falls as f^-slope; `run: channel` whose lead-in holds more than noise.
    runs, bands, distortions
        How large the gap is by run, by band, and what harmonics show.
    places, rounds, alone
        The place test on the base model; the looks for effects; what single runs ask for.
    meanings
        What each effect tried is, by name.
    steps
        From the file's parameters to the noise.
    psds, histories
        The residual of the loudest validation run before (as measured) and after (as simulated).
    parameters, conditions
        The base model, and what is supposed of the runs.
    force
        The unknown force where the model errs.
    responses
        The loudest run as measured and as the last model, with its effects, simulates it.
    origin
        What it was made from; None in a file of an earlier version.
    """

    vehicle: str
    made_by: str
    band: tuple[float, float]
    noise: tuple[ChannelNoise, ...]
    noise_slope: float
    corrected: tuple[str, ...]
    runs: tuple[RunSize, ...]
    bands: tuple[BandChi, ...]
    distortions: tuple[Distortion, ...]
    places: Annotated[tuple[PlaceEvidence, ...], Field(max_length=MAX_PANELS)]
    rounds: Annotated[tuple[RoundEvidence, ...], Field(max_length=MAX_PANELS)]
    alone: tuple[RunAsks, ...]
    meanings: dict[str, str]
    steps: Annotated[tuple[StepChi, ...], Field(max_length=MAX_PANELS)]
    psds: Annotated[tuple[ChannelCurves, ...], Field(max_length=MAX_PANELS)]
    histories: Annotated[tuple[ChannelCurves, ...], Field(max_length=MAX_PANELS)]
    parameters: tuple[BaseParameter, ...]
    conditions: tuple[RunConditions, ...]
    force: ForceEvidence | None = None
    responses: Annotated[tuple[ChannelCurves, ...], Field(max_length=MAX_PANELS)] = ()
    origin: Origin | None = None
