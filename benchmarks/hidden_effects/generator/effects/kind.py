"""What is known of a kind of effect: where it can sit, its values and their usual sizes, its equation, and how it edits a vehicle."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from benchmarks.hidden_effects.generator.setup import Setup

Values = Mapping[str, float]


@dataclass(frozen=True)
class Value:
    """A value of an effect, SI units. Weak and visible ranges are multiples of `scale` (see library.py: Scales). `neutral`: where the
    effect is absent."""

    name: str
    unit: str
    meaning: str
    weak: tuple[float, float]
    visible: tuple[float, float]
    scale: str = "one"
    neutral: float | None = None


@dataclass(frozen=True)
class EffectKind:
    """A kind of effect. `listed` False: it stands for what no library of candidates holds."""

    name: str
    equation: str
    places: Callable[[str], tuple[str, ...]]
    values: tuple[Value, ...]
    apply: Callable[[Setup, str, Values], None]
    listed: bool = True

    @property
    def neutral(self) -> dict[str, float]:
        """Return the values at which the effect is absent."""
        return {value.name: value.neutral for value in self.values if value.neutral is not None}


def suspensions(vehicle: str) -> tuple[str, ...]:
    """Return every axle of a vehicle."""
    return ("front", "rear") if vehicle == "sedan2" else tuple(f"axle{i}" for i in range(1, 6))


def bodies(vehicle: str) -> tuple[str, ...]:
    """Return every body of a vehicle."""
    return ("body",) if vehicle == "sedan2" else ("tractor", "semitrailer")


def front_body(vehicle: str) -> tuple[str, ...]:
    """Return the body that carries cab and engine."""
    return bodies(vehicle)[:1]


def long_body(vehicle: str) -> tuple[str, ...]:
    """Return the body long enough to bend."""
    return bodies(vehicle)[-1:]


def pins(vehicle: str) -> tuple[str, ...]:
    """Return every pin of a vehicle."""
    return () if vehicle == "sedan2" else ("fifth_wheel",)


def sensors(vehicle: str) -> tuple[str, ...]:
    """Return the names of the usual phones."""
    return ("F", "R") if vehicle == "sedan2" else ("L1", "L2")


def channels(vehicle: str) -> tuple[str, ...]:
    """Return the names of the usual phones' channels."""
    return tuple(f"{sensor}_{channel}" for sensor in sensors(vehicle) for channel in ("az", "q"))


def everywhere(vehicle: str) -> tuple[str, ...]:
    """Return the place of what acts on all wheels alike."""
    return ("all",)


def axles_and_all(vehicle: str) -> tuple[str, ...]:
    """Return every axle, and all of them together."""
    return (*suspensions(vehicle), "all")


def tandems(vehicle: str) -> tuple[str, ...]:
    """Return the pairs of axles close enough to share a beam."""
    return () if vehicle == "sedan2" else ("axle4+axle5", "axle2+axle3")
