"""An import of phone recordings as a value: the channels, what each phone recorded, and all that was assumed."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Annotated, ClassVar

from pydantic import Field

from vehgen.files.result_fields import IN_MEMORY, Array1D, Array2D
from vehgen.files.results import Result, Table
from vehgen.phones.export import Stream
from vehgen.phones.importing import Imported, ImportedPhone
from vehgen.phones.run_text import phone_notes

MAX_PHONES = 100
"""A file with more phones than this is refused: no figure could show them."""


@dataclass(frozen=True)
class ImportedNoise:
    """A channel's noise: standard deviation in the quiet lead-in, and that of white noise as strong as the top of its band."""

    sigma: float
    band_sigma: float


@dataclass(frozen=True, eq=False)
class PhoneSamples:
    """What a phone recorded of one channel, turned upright, before it was put on an even clock: `time`, `values` `shape (n,)`.

    `quiet` is its quiet stretch, `onset` when energy set in (None for a measured road), all on the run's clock [s].
    """

    channel: str
    unit: str
    time: Array1D
    values: Array1D
    quiet: tuple[float, float]
    onset: float | None


@dataclass(frozen=True)
class PhoneSummary:
    """One phone: its export, app and sensor, sampling rates [Hz], tilt [deg], the run's t = 0 on its clock [s], how well it fits.

    `noise` is by channel; `notes` say in words what was found and assumed.
    """

    export: str
    app: str
    sensor: str
    rates: tuple[float, ...]
    tilt: float | None
    zero: float
    correlation: float
    noise: dict[str, ImportedNoise]
    notes: tuple[str, ...]


@dataclass(frozen=True, eq=False)
class PhoneImport(Result):
    """What the phones of one pass recorded, on one even clock.

    `time shape (n,)` [s] and `values shape (n, n_channels)` of `channels` [m/s^2, rad/s]; `speed` [m/s], where it is from, and its
    standard deviation where a GPS tells it, `fitted_speed` what the axles' marks say; `at` [m] where the hump begins (None for a measured
    profile); `wheels` the distance of every axle behind the front wheel [m]; `files` what was written; `imported` everything else, None in
    an import that was read from a file.
    """

    KIND: ClassVar[str] = "phone import"
    DRAWING: ClassVar[str] = "vehgen.report.plots.import_plot:plot_import"

    title: str
    time: Array1D
    values: Array2D
    channels: tuple[str, ...]
    speed: float
    speed_source: str
    speed_deviation: float | None
    fitted_speed: float | None
    at: float | None
    wheels: dict[str, float]
    phones: Annotated[tuple[PhoneSummary, ...], Field(max_length=MAX_PHONES)]
    samples: Annotated[tuple[PhoneSamples, ...], Field(max_length=2 * MAX_PHONES)]
    warnings: tuple[str, ...]
    files: tuple[str, ...] = ()
    imported: Annotated[Imported | None, IN_MEMORY] = field(default=None, repr=False)

    def __post_init__(self) -> None:
        if self.values.shape != (len(self.time), len(self.channels)) or [item.channel for item in self.samples] != list(self.channels):
            raise ValueError("a value for every sample and channel, and the samples of every channel were expected")

    @property
    def noise(self) -> dict[str, ImportedNoise]:
        """The noise of all channels that have a quiet stretch."""
        return {name: item for phone in self.phones for name, item in phone.noise.items()}

    def table(self) -> Table:
        """Return the channels' largest magnitudes and noise, a row each."""
        peaks = abs(self.values).max(axis=0).tolist()
        noise = self.noise
        return ("channel", "largest magnitude", "noise sigma", "by its top band"), [
            (name, peak, *((noise[name].sigma, noise[name].band_sigma) if name in noise else (None, None)))
            for name, peak in zip(self.channels, peaks, strict=True)
        ]


def summarise_import(imported: Imported, files: tuple[str, ...] = ()) -> PhoneImport:
    """Return what an import tells."""
    vehicle = imported.plan.vehicle
    return PhoneImport(
        title=f"{vehicle.title or vehicle.name}, {imported.speed.value:.3g} m/s",
        time=imported.time,
        values=imported.values,
        channels=imported.channels,
        speed=imported.speed.value,
        speed_source=imported.speed.source,
        speed_deviation=imported.speed.deviation,
        fitted_speed=imported.fitted_speed,
        at=imported.at,
        wheels=imported.wheels,
        phones=tuple(_phone(imported, item) for item in imported.phones),
        samples=tuple(_samples(imported)),
        warnings=imported.warnings,
        files=files,
        imported=imported,
    )


def _phone(imported: Imported, item: ImportedPhone) -> PhoneSummary:
    return PhoneSummary(
        export=item.phone.name,
        app=item.phone.export.app,
        sensor=item.phone.sensor.name,
        rates=tuple(item.phone.rates),
        tilt=item.orientation.tilt if item.orientation else None,
        zero=item.zero,
        correlation=item.match.correlation,
        noise={name: ImportedNoise(floor.sigma, floor.band_sigma) for name, floor in item.noise},
        notes=tuple(phone_notes(imported, item)),
    )


def _samples(imported: Imported) -> list[PhoneSamples]:
    streams: list[tuple[ImportedPhone, Stream]] = [
        (item, stream) for item in imported.phones for stream in (item.upward, item.pitch) if stream is not None
    ]
    found = []
    for name, (item, stream) in zip(imported.channels, streams, strict=True):
        part = stream.between(item.zero, item.zero + float(imported.time[-1]))
        quiet = (max(item.quiet[0] - item.zero, 0.0), item.quiet[1] - item.zero)
        onset = item.event.onset - item.zero if item.event else None
        found.append(PhoneSamples(name, stream.unit, part.time - item.zero, part.values[:, 0], quiet, onset))
    return found
