"""What a run file says of the recorders of its channels: a preset's name, `none`, `unknown`, or a low-pass with its numbers."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, cast

from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from vehgen.errors import InputError, did_you_mean, shown
from vehgen.files.entry import FileModel
from vehgen.files.expressions import ExpressionError, parse
from vehgen.files.quantities import Frequency, RecorderDelay
from vehgen.files.units import Dimension, read_unit, without_gravities
from vehgen.measure.acquisition import FILTER_KINDS, MAX_ORDER, POINT_SAMPLES, UNKNOWN, AcquisitionChain, FilterKind
from vehgen.measure.recorders import RECORDERS
from vehgen.mechanics.quantities import QUANTITIES

if TYPE_CHECKING:
    from vehgen.simulate.run_file.loading import Run

WITHOUT_CUT_OFF = ("none", "unknown")
"""Kinds of filter that have no cut-off; they may stand alone, as texts."""
Path = tuple[str, ...]


class AcquisitionEntry(FileModel):
    """A recorder: its low-pass, how late it is besides, the largest value and the smallest step that it records."""

    filter: str
    order: int = Field(4, strict=True, ge=1, le=MAX_ORDER)
    cut_off: Frequency | None = None
    delay: RecorderDelay = 0.0
    range: str | float | None = None
    resolution: str | float | None = None
    rate: Frequency | None = None

    @model_validator(mode="after")
    def _complete(self) -> AcquisitionEntry:
        if self.cut_off is None and self.filter in FILTER_KINDS and self.filter not in WITHOUT_CUT_OFF:
            raise PydanticCustomError("joint", "a {filter} low-pass lacks the key cut_off, e.g. 45 Hz", {"filter": self.filter})
        if self.cut_off is not None and self.filter in WITHOUT_CUT_OFF:
            raise PydanticCustomError("joint", "a filter that is {filter} has no cut_off", {"filter": self.filter})
        if self.filter == "ideal" and "order" in self.model_fields_set:
            raise PydanticCustomError("joint", "an ideal low-pass has no order")
        return self


def channel_chains(run: Run, rate: float) -> dict[str, AcquisitionChain]:
    """Return the chain of every sensor channel of a run by its name, where the recorder delivers at `rate` [Hz]."""
    found = {}
    for sensor, quantity, entry, path in _entries(run):
        name = run.file.sensors[sensor].channel(sensor, quantity)
        found[name] = _chain(run, entry, path, quantity, rate)
    return found


def check_acquisition(run: Run) -> None:
    """Check kinds, presets, ranges and resolutions of a run's recorders; raises InputError at the first fault."""
    told: dict[Path, list[str]] = {}
    for _, quantity, entry, path in _entries(run):
        _check_kind(run, entry, path)
        told.setdefault(path, []).append(quantity)
    for path, quantities in told.items():
        entry = next(item for _, _, item, own in _entries(run) if own == path)
        if isinstance(entry, AcquisitionEntry):
            for key in ("range", "resolution"):
                _check_size(run, getattr(entry, key), (*path, key), quantities)


def check_nyquist(run: Run, rate: float) -> None:
    """Refuse a cut-off above half the rate of a recording [Hz], or of the chip's own where the file gives it."""
    for _, _, entry, path in _entries(run):
        if isinstance(entry, AcquisitionEntry) and entry.cut_off is not None and entry.cut_off > (half := (entry.rate or rate) / 2):
            whose = "the chip samples" if entry.rate else "the recording was sampled"
            raise InputError(
                f"a cut-off of {entry.cut_off:g} Hz, but {whose} at {2 * half:.4g} Hz: at most half of it, {half:.4g} Hz, was expected; "
                "give the chip's own `rate` where it is higher, or write `acquisition: unknown`",
                run.document.find((*path, "cut_off")),
            )


def _entries(run: Run) -> Iterator[tuple[str, str, str | AcquisitionEntry, Path]]:
    """Yield every sensor channel with what the file says of its recorder, and where: of the channel, else of the sensor, else of all."""
    default = "unknown" if run.file.recording is not None else "none"
    for name, sensor in run.file.sensors.items():
        for quantity, channel in sensor.channels.items():
            own = None if isinstance(channel, str) else channel.acquisition
            places: list[tuple[str | AcquisitionEntry | None, Path]] = [
                (own, ("sensors", name, "channels", quantity, "acquisition")),
                (sensor.acquisition, ("sensors", name, "acquisition")),
                (run.file.acquisition, ("acquisition",)),
                (default, ()),
            ]
            yield name, quantity, *next((entry, path) for entry, path in places if entry is not None)


def _check_kind(run: Run, entry: str | AcquisitionEntry, path: Path) -> None:
    if isinstance(entry, str):
        known = (*WITHOUT_CUT_OFF, *RECORDERS)
        if entry in FILTER_KINDS and entry not in known:
            raise InputError(f"a {entry} low-pass needs its cut-off: {{filter: {entry}, cut_off: 45 Hz}}", run.document.find(path))
        if entry not in known:
            raise InputError(f"unknown recorder {shown(entry)}; {did_you_mean(entry, known)}", run.document.find(path))
    elif entry.filter not in FILTER_KINDS:
        place = run.document.find((*path, "filter"))
        raise InputError(f"unknown filter {shown(entry.filter)}; {did_you_mean(entry.filter, FILTER_KINDS)}", place)


def _chain(run: Run, entry: str | AcquisitionEntry, path: Path, quantity: str, rate: float) -> AcquisitionChain:
    if isinstance(entry, str):
        return POINT_SAMPLES if entry == "none" else UNKNOWN if entry == "unknown" else RECORDERS[entry].chain(rate)
    reach, step = (_size(run, getattr(entry, key), (*path, key), quantity) for key in ("range", "resolution"))
    kind = cast("FilterKind", entry.filter)
    return AcquisitionChain(kind, entry.order, entry.cut_off, entry.delay, reach, step, entry.rate)


def _check_size(run: Run, text: str | float | None, path: Path, quantities: list[str]) -> None:
    """Refuse a range or resolution of none of the quantities, and one that is not above 0."""
    if text is not None and all(_size(run, text, path, quantity) is None for quantity in quantities):
        units = " or ".join(dict.fromkeys(QUANTITIES[quantity] for quantity in quantities))
        raise InputError(f"a {path[-1]} in {units} was expected, found {shown(text)}", run.document.find(path))


def _size(run: Run, text: str | float | None, path: Path, quantity: str) -> float | None:
    """Return a range or resolution [SI]; None where it is one of another quantity."""
    if text is None:
        return None
    try:
        expression = parse(without_gravities(str(text), _dimension(quantity)))
        if expression.names:
            raise ExpressionError(f"expected a plain quantity, found a symbol in {shown(text)}")
        dimension, number = expression.dimension({}), expression.evaluate({})
    except ExpressionError as error:
        raise InputError(str(error), run.document.find(path, offset=error.offset)) from error
    if not 0 < number < float("inf"):
        raise InputError(f"a {path[-1]} above 0 was expected, found {shown(text)}", run.document.find(path))
    return number if dimension == _dimension(quantity) else None


def _dimension(quantity: str) -> Dimension:
    found: Any = read_unit(QUANTITIES[quantity])
    dimension: Dimension = found[1]
    return dimension
