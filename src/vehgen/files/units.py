"""Units of vehicle and run files, and the dimensions they carry."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from fractions import Fraction

from vehgen.errors import InputError, did_you_mean, shown


@dataclass(frozen=True)
class Dimension:
    """Exponents of metre, kilogram and second; the radian counts as a plain number."""

    length: Fraction = Fraction(0)
    mass: Fraction = Fraction(0)
    time: Fraction = Fraction(0)

    def __mul__(self, other: Dimension) -> Dimension:
        return Dimension(self.length + other.length, self.mass + other.mass, self.time + other.time)

    def __truediv__(self, other: Dimension) -> Dimension:
        return self * other.power(Fraction(-1))

    def power(self, exponent: Fraction) -> Dimension:
        """Return this dimension raised to `exponent`."""
        return Dimension(self.length * exponent, self.mass * exponent, self.time * exponent)

    def __str__(self) -> str:
        """Name the dimension by its SI unit, the field's usual one where there is one."""
        for name, dimension in NAMED_DIMENSIONS.items():
            if dimension == self:
                return name
        parts = []
        for symbol, exponent in (("kg", self.mass), ("m", self.length), ("s", self.time)):
            if exponent:
                parts.append(symbol if exponent == 1 else f"{symbol}^{exponent}")
        return " ".join(parts)


def _dimension(length: int, mass: int, time: int) -> Dimension:
    return Dimension(Fraction(length), Fraction(mass), Fraction(time))


NONE = _dimension(0, 0, 0)
LENGTH = _dimension(1, 0, 0)
MASS = _dimension(0, 1, 0)
TIME = _dimension(0, 0, 1)
SPEED = _dimension(1, 0, -1)
ACCELERATION = _dimension(1, 0, -2)
FREQUENCY = _dimension(0, 0, -1)
FORCE = _dimension(1, 1, -2)
MOMENT = _dimension(2, 1, -2)
STIFFNESS = _dimension(0, 1, -2)
DAMPING = _dimension(0, 1, -1)
INERTIA = _dimension(2, 1, 0)
PITCH_DAMPING = _dimension(2, 1, -1)

NAMED_DIMENSIONS: dict[str, Dimension] = {
    "no unit": NONE,
    "m": LENGTH,
    "kg": MASS,
    "s": TIME,
    "m/s": SPEED,
    "m/s^2": ACCELERATION,
    "1/s": FREQUENCY,
    "N": FORCE,
    "N m": MOMENT,
    "N/m": STIFFNESS,
    "N s/m": DAMPING,
    "kg m^2": INERTIA,
    "N m s": PITCH_DAMPING,
}

STANDARD_GRAVITY = 9.80665
"""Standard acceleration of free fall [m/s^2], the unit g of accelerometers and of spectra; what pulls on a vehicle is mechanics.GRAVITY."""
POUND_KG = 0.45359237
"""The international avoirdupois pound [kg]."""

UNITS: dict[str, tuple[float, Dimension]] = {
    "m": (1.0, LENGTH),
    "mm": (1e-3, LENGTH),
    "cm": (1e-2, LENGTH),
    "km": (1e3, LENGTH),
    "in": (0.0254, LENGTH),
    "ft": (0.3048, LENGTH),
    "kg": (1.0, MASS),
    "g": (1e-3, MASS),
    "t": (1e3, MASS),
    "lb": (POUND_KG, MASS),
    "s": (1.0, TIME),
    "ms": (1e-3, TIME),
    "min": (60.0, TIME),
    "h": (3600.0, TIME),
    "Hz": (1.0, FREQUENCY),
    "rpm": (1.0 / 60.0, FREQUENCY),
    "mph": (0.44704, SPEED),
    "N": (1.0, FORCE),
    "kN": (1e3, FORCE),
    "MN": (1e6, FORCE),
    "GN": (1e9, FORCE),
    "lbf": (POUND_KG * STANDARD_GRAVITY, FORCE),
    "Pa": (1.0, FORCE / (LENGTH * LENGTH)),
    "kPa": (1e3, FORCE / (LENGTH * LENGTH)),
    "MPa": (1e6, FORCE / (LENGTH * LENGTH)),
    "GPa": (1e9, FORCE / (LENGTH * LENGTH)),
    "rad": (1.0, NONE),
    "mrad": (1e-3, NONE),
    "deg": (math.pi / 180.0, NONE),
}
"""Unit name -> (factor to SI, dimension); Hz and rpm count turns, so that neither is a unit of an angular rate."""
GRAVITIES = {"g": STANDARD_GRAVITY, "mg": STANDARD_GRAVITY / 1000}
"""What accelerometers are read in [m/s^2]; of a mass, g is the gram."""
MAX_EXPONENT = 9
SPELT = {"kmh": "km/h", "kph": "km/h", "kmph": "km/h", "mps": "m/s", "fps": "ft/s"}
"""Units as people write them, and as they are read."""
RAISED_DIGITS = {"²": "2", "³": "3"}
_UNIT_FACTOR = re.compile(r"([A-Za-z]+)(?:(?:\^|\*\*)(-?[0-9]+)|([²³]))?")
_TURNS = re.compile(r"(?<![A-Za-z_])(Hz|rpm)(?![A-Za-z0-9_])")
_IN_GRAVITIES = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*(m?g)\s*", re.ASCII)
_RUN_TOGETHER = re.compile(rf"\s*({'|'.join(sorted(UNITS.keys() - {'ms'}, key=len, reverse=True))})")
"""A unit within units written together; `ms` there is metres times seconds."""
_JOIN = re.compile(r"\s*([/*·])\s*|\s+")


def read_unit(text: str, start: int = 0) -> tuple[float, Dimension, int] | None:
    """Read the longest run of units that begins at `text[start]`.

    Returns
    -------
    (factor, dimension, end) with the factor to SI, or None where no unit stands.
    `N s/m` divides by the metre only; `*`, a space and a middle dot multiply.

    Raises
    ------
    InputError
        For an exponent beyond MAX_EXPONENT.
    """
    factor, dimension, end = 1.0, NONE, start
    divide = False
    position = start
    while True:
        atom = _UNIT_FACTOR.match(text, position)
        if atom is None or atom.group(1) not in UNITS or _continues_name(text, atom.end()):
            break
        if end > start and text.startswith("(", atom.end()):
            break  # `0.5 m * min(a, b)`: a function, not minutes
        if len((atom.group(2) or "").lstrip("-0")) > 1:
            raise InputError(f"the exponent of a unit must be between -{MAX_EXPONENT} and {MAX_EXPONENT}, found {atom.group(2)[:40]}")
        size, unit = UNITS[atom.group(1)]
        exponent = int(atom.group(2) or RAISED_DIGITS.get(atom.group(3), "1")) * (-1 if divide else 1)
        factor *= size**exponent
        dimension = dimension * unit.power(Fraction(exponent))
        end = atom.end()
        join = _JOIN.match(text, end)
        if join is None:
            break
        divide = join.group(1) == "/"
        position = join.end()
    return (factor, dimension, end) if end > start else None


def _continues_name(text: str, position: int) -> bool:
    return position < len(text) and (text[position].isalnum() or text[position] == "_")


def nearest_unit(word: str) -> str:
    """Say which units differ from `word` in capitals only, else which is it with spaces and `^`, else which are spelt alike."""
    if word.strip() in SPELT:
        return f"did you mean {shown(SPELT[word.strip()])}?"
    first = word.strip().split("/")[0].split(" ")[0]
    near = [unit for unit in UNITS if unit.lower() == first.lower() and unit != first]
    apart = _RUN_TOGETHER.sub(r" \1", word).replace("/ ", "/").strip()
    apart = re.sub(r"(?<=[A-Za-z])(?=[2-4]\b)", "^", apart)
    found = read_unit(apart)
    if not near and found and found[2] == len(apart) and (" " not in apart or re.search(r"N|\^", apart)):
        near = [apart]
    return "did you mean " + " or ".join(shown(unit) for unit in near) + "?" if near else did_you_mean(first, UNITS)


def parse_unit(text: str) -> tuple[float, Dimension]:
    """Parse a whole unit such as `kN s/m`; raises InputError naming the nearest unit."""
    found = read_unit(text.strip())
    if found is None or found[2] != len(text.strip()):
        raise InputError(f"unknown unit {shown(text)}; {nearest_unit(text)}")
    return found[0], found[1]


def factor_to_si(unit: str, dimension: Dimension) -> float | None:
    """Return what a unit is worth in SI; None where it is none of this dimension. Of an acceleration, `g` is standard gravity."""
    if dimension == ACCELERATION and unit in GRAVITIES:
        return GRAVITIES[unit]
    found = read_unit(unit)
    return found[0] if found is not None and found[2] == len(unit) and found[1] == dimension else None


def example_of(number: str, dimension: Dimension) -> str:
    """Return how a number of a dimension may be written, in quotes."""
    return f"'{number} Hz' ('{number} rad/s' of an angular rate)" if dimension == FREQUENCY else f"'{number} {dimension}'"


def units_of(dimension: Dimension) -> list[str]:
    """Return the units that have a name of their own and a dimension, standard gravity's among those of an acceleration."""
    return [unit for unit, (_, own) in UNITS.items() if own == dimension] + (list(GRAVITIES) if dimension == ACCELERATION else [])


def counts_turns(text: str) -> bool:
    """Whether a unit, or a quantity with one, is in turns (Hz, rpm), not in radians, of a time."""
    return _TURNS.search(text) is not None


def without_gravities(text: str, dimension: Dimension) -> str:
    """Return the text of a quantity, its `g` written as m/s^2 where an acceleration is asked for: there it is no gram."""
    found = _IN_GRAVITIES.fullmatch(text) if dimension == ACCELERATION else None
    return text if found is None else f"{float(found.group(1)) * GRAVITIES[found.group(2)]!r} m/s^2"
