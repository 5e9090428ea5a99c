"""What an assessment tells: numbers with the standards that define them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from vehgen.files.result_fields import Array1D
from vehgen.files.results import Cell, Result, Table

ISO_2631, E1049 = "ISO 2631-1:1997", "ASTM E1049-85"
ROAD_STRESS, FOURTH_POWER = "Eisenmann 1975: 1 + 6 s^2 + 3 s^4", "fourth-power law of the AASHO Road Test, mean of (P/P0)^4"
D4169, SHOCK = "ASTM D4169", "ISO 18431-4:2007"


@dataclass(frozen=True)
class ChannelStatistics:
    """RMS and largest deviation of a channel from its mean, in `unit`, and their ratio."""

    name: str
    quantity: str
    unit: str
    rms: float
    peak: float
    crest: float


@dataclass(frozen=True)
class RideComfort:
    """The weighted acceleration of a place: RMS and MTVV [m/s^2], VDV [m/s^1.75], crest factor, and what ISO 2631-1 calls the RMS."""

    name: str
    weighting: str
    rms: float
    mtvv: float
    vdv: float
    crest: float
    reaction: str


@dataclass(frozen=True)
class TyreLoad:
    """The load of an axle's tyres: static [N], dynamic load coefficient, 95th percentile and least load over static, and road damage."""

    axle: str
    static: float
    coefficient: float
    high: float
    least: float
    road_stress: float
    fourth_power: float


@dataclass(frozen=True)
class LevelComparison:
    """A vibration beside a level of ASTM D4169: overall RMS of the level in the same band [g], and the most that its PSD is exceeded."""

    name: str
    rms: float
    excess_db: float
    excess_hz: float


@dataclass(frozen=True, eq=False)
class TransportVibration:
    """The PSD of a place's acceleration `density shape (n,)` [g^2/Hz] at `frequency shape (n,)` [Hz], and its overall RMS [g]."""

    name: str
    rms: float
    band: tuple[float, float]
    levels: tuple[LevelComparison, ...]
    frequency: Array1D
    density: Array1D


@dataclass(frozen=True, eq=False)
class ShockSpectrum:
    """The shock response spectrum of a place: maximax absolute accelerations `shape (n,)` [m/s^2] at natural frequencies [Hz]."""

    name: str
    quality: float
    largest: float
    largest_hz: float
    frequency: Array1D
    maximax: Array1D


@dataclass(frozen=True, eq=False)
class LoadCycles:
    """Rainflow cycles of a travel or force: how many, the largest range, and the range that does the same damage once a second.

    `cycles` counts those of at least a hundredth of the largest range: E1049 lets smaller ones be left out, and rounding makes some of
    them. `cumulative shape (n,)` counts the cycles of at least the ranges `levels shape (n,)`.
    """

    name: str
    quantity: str
    unit: str
    cycles: float
    largest: float
    slope: float
    equivalent: float
    levels: Array1D
    cumulative: Array1D


@dataclass(frozen=True, eq=False)
class Assessment(Result):
    """What a run means to people, roads and cargo.

    Attributes
    ----------
    title, vehicle, source
        Of the run; its vehicle; `simulation` or `recording`.
    start, duration, rate
        What was left out at the beginning and what was assessed [s], and samples a second.
    channels, ride, tyres, transport, shock, cycles
        The numbers.
    notes
        What makes them doubtful or asks for others.
    versions, inputs
        Of packages; names of the files with their SHA-256.
    """

    KIND: ClassVar[str] = "assessment"
    DRAWING: ClassVar[str] = "vehgen.report.plots.assessment_plot:plot_assessment"

    title: str
    vehicle: str
    source: str
    start: float
    duration: float
    rate: float
    channels: tuple[ChannelStatistics, ...]
    ride: tuple[RideComfort, ...]
    tyres: tuple[TyreLoad, ...]
    transport: tuple[TransportVibration, ...]
    shock: tuple[ShockSpectrum, ...]
    cycles: tuple[LoadCycles, ...]
    notes: tuple[str, ...]
    versions: dict[str, str]
    inputs: dict[str, str]

    def table(self) -> Table:
        """Return every number, a row each: of what, its name, value, unit, and where it is defined."""
        rows: list[tuple[Cell, ...]] = []
        for item in self.channels:
            rows += [(item.name, f"{item.quantity} RMS", item.rms, item.unit, "about the mean")]
            rows += [(item.name, f"{item.quantity} peak", item.peak, item.unit, "from the mean")]
            rows += [(item.name, f"{item.quantity} crest factor", item.crest, "-", "peak over RMS")]
        for ride in self.ride:
            source = f"{ISO_2631}, {ride.weighting}"
            rows += [(ride.name, "weighted RMS", ride.rms, "m/s^2", source), (ride.name, "MTVV", ride.mtvv, "m/s^2", source)]
            rows += [(ride.name, "VDV", ride.vdv, "m/s^1.75", source), (ride.name, "weighted crest factor", ride.crest, "-", source)]
        for tyre in self.tyres:
            rows += [(tyre.axle, "static load", tyre.static, "N", "equilibrium")]
            rows += [(tyre.axle, "dynamic load coefficient", tyre.coefficient, "-", "standard deviation over static load")]
            rows += [
                (tyre.axle, "load, 95th percentile", tyre.high, "of static", "quantile over time"),
                (tyre.axle, "least load", tyre.least, "of static", "minimum over time"),
            ]
            rows += [(tyre.axle, "road stress factor", tyre.road_stress, "-", ROAD_STRESS)]
            rows += [(tyre.axle, "mean fourth power of load", tyre.fourth_power, "of static", FOURTH_POWER)]
        for cargo in self.transport:
            rows += [(cargo.name, f"RMS {cargo.band[0]:g}-{cargo.band[1]:g} Hz", cargo.rms, "g", D4169)]
            rows += [(cargo.name, f"RMS over {level.name}", cargo.rms / level.rms, "-", D4169) for level in cargo.levels]
        for shock in self.shock:
            rows += [(shock.name, "largest shock response", shock.largest, "m/s^2", f"{SHOCK}, Q = {shock.quality:g}")]
            rows += [(shock.name, "largest shock response at", shock.largest_hz, "Hz", f"{SHOCK}, Q = {shock.quality:g}")]
        for load in self.cycles:
            rows += [(load.name, "rainflow cycles", load.cycles, "-", E1049), (load.name, "largest range", load.largest, load.unit, E1049)]
            rows += [(load.name, f"equivalent range at 1 Hz, m = {load.slope:g}", load.equivalent, load.unit, f"{E1049}, Miner")]
        return ("of", "number", "value", "unit", "defined by"), rows
