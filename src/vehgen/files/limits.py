"""Physical limits of every quantity: what lies outside is a slip of the pen or of the units, and could cost hours of computing.

They are wide: they refuse no vehicle, rig or road that could stand in a laboratory.
"""

from __future__ import annotations

from dataclasses import dataclass
from numbers import Integral

from vehgen.errors import ArgumentError, InputError, shown
from vehgen.files.units import (
    DAMPING,
    FORCE,
    FREQUENCY,
    INERTIA,
    LENGTH,
    MASS,
    MOMENT,
    NONE,
    PITCH_DAMPING,
    SPEED,
    STIFFNESS,
    TIME,
    Dimension,
)

MOST_PARTS = {"parameters": 1000, "bodies": 100, "hinges": 50, "axles": 100, "links": 200, "sets": 100}
"""How many of each a vehicle may have; a chain of hinges couples every body to every other, at a cost that grows with the third power."""
MOST_ROADS = 200
"""So many entries a road may have."""
MOST_CHANNELS = 500
"""So many channels a run may have."""
LONGEST_PATH = 1000
"""No file is named by more characters."""
LARGEST_SEED = 2**63 - 1


@dataclass(frozen=True)
class Limit:
    """The least and the greatest magnitude that `what` can have, in the SI unit of `dimension`; 0 and signs are others' concern."""

    what: str
    low: float
    high: float
    dimension: Dimension

    def refusal(self, number: float) -> str | None:
        """Say what is wrong with a number; None where its magnitude lies within the limits or it is 0."""
        if number == 0 or self.low <= abs(number) <= self.high:
            return None
        unit = "" if self.dimension == NONE else f" {self.dimension}"
        reach = f"{self.low:g} to {self.high:g}" if self.low else f"at most {self.high:g}"
        return f"{self.what} is {reach}{unit} in magnitude, found {number:g}{unit}: a question of units?"

    def check(self, number: float, where: str) -> None:
        """Raise InputError, `where` before it, for a number outside the limits."""
        if (reason := self.refusal(number)) is not None:
            raise InputError(f"{where}: {reason}")


SPEED_LIMIT = Limit("a speed", 0.01, 150.0, SPEED)
HUMP_LENGTH = Limit("the length of a hump", 1e-3, 50.0, LENGTH)
HUMP_HEIGHT = Limit("the height of a hump", 0.0, 2.0, LENGTH)
PROFILE_HEIGHT = Limit("the height of a profile", 0.0, 9e3, LENGTH)
EDGE_RADIUS = Limit("the radius of an edge", 1e-6, 50.0, LENGTH)
FOOTPRINT = Limit("a tyre's footprint", 1e-3, 2.0, LENGTH)
ROAD_POSITION = Limit("a place along the road", 0.0, 1e6, LENGTH)
DURATION = Limit("a duration", 1e-3, 1e5, TIME)
TIME_OF_FILE = Limit("a time of a file", 0.0, 1e10, TIME)
STEP = Limit("a step", 1e-6, 0.1, TIME)
SAMPLE = Limit("the time between samples", 1e-6, 100.0, TIME)
RECORDER_DELAY = Limit("the delay of a recorder", 0.0, 1.0, TIME)
FREQUENCY_LIMIT = Limit("a frequency", 1e-4, 1e5, FREQUENCY)
FORCE_LIMIT = Limit("a force", 0.0, 1e9, FORCE)
DISPLACEMENT = Limit("a displacement", 0.0, 100.0, LENGTH)
VELOCITY_LIMIT = Limit("a velocity", 0.0, 1e3, SPEED)
PITCH_RATE = Limit("a pitch rate", 0.0, 1e4, FREQUENCY)
ANGLE = Limit("an angle in rad", 0.0, 1.6, NONE)
PHASE = Limit("a phase in rad", 0.0, 6.3, NONE)
VEHICLE_LENGTH = Limit("a length on a vehicle", 0.0, 1e3, LENGTH)
RELATIVE_ERROR = Limit("a relative uncertainty", 0.0, 1.0, NONE)

VEHICLE_LIMITS: dict[Dimension, Limit] = {
    MASS: Limit("a mass", 1e-6, 1e7, MASS),
    INERTIA: Limit("a moment of inertia", 1e-12, 1e12, INERTIA),
    LENGTH: VEHICLE_LENGTH,
    STIFFNESS: Limit("a stiffness", 0.0, 1e15, STIFFNESS),
    DAMPING: Limit("a damping", 0.0, 1e12, DAMPING),
    MOMENT: Limit("a hinge's stiffness", 0.0, 1e15, MOMENT),
    PITCH_DAMPING: Limit("a hinge's damping", 0.0, 1e15, PITCH_DAMPING),
    FREQUENCY: FREQUENCY_LIMIT,
    NONE: Limit("a damping ratio", 0.0, 100.0, NONE),
}
"""What the quantities of a vehicle may be, by their dimension."""


def check_seed(seed: int, name: str) -> None:
    """Raise ArgumentError for a seed that is negative or beyond LARGEST_SEED; `name` is the argument's."""
    if not (isinstance(seed, int) and 0 <= seed <= LARGEST_SEED):
        raise ArgumentError(f"`{name}`: a seed is a whole number from 0 to {LARGEST_SEED}, found {shown(seed)}", name)


def check_count(count: int, name: str, least: int, most: int) -> None:
    """Raise ArgumentError for a number of things below `least` or above `most`; `name` is the argument's."""
    if isinstance(count, bool) or not (isinstance(count, Integral) and least <= count <= most):
        raise ArgumentError(f"`{name}`: a whole number from {least} to {most} was expected, found {shown(count)}", name)


def check_share(number: float, name: str) -> None:
    """Raise ArgumentError for a relative uncertainty below 0 or beyond 1; `name` is the argument's."""
    if not number >= 0:
        raise ArgumentError(f"`{name}` must not be below 0, found {number}", name)
    if (reason := RELATIVE_ERROR.refusal(number)) is not None:
        raise ArgumentError(f"`{name}`: {reason}", name)
