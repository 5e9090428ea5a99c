"""What is measured or applied where: sensors, outputs and force inputs of a run, and their rows."""

from __future__ import annotations

import math
from dataclasses import dataclass
from numbers import Real

import sympy as sp
from pydantic_core import PydanticCustomError

from vehgen.errors import ArgumentError, InputError, did_you_mean, shown
from vehgen.files.checks import check_dimension
from vehgen.files.document import locate_arguments
from vehgen.files.expressions import Expression, ExpressionError, parse
from vehgen.files.limits import VEHICLE_LENGTH
from vehgen.files.quantities import read_quantity
from vehgen.files.units import LENGTH
from vehgen.mechanics.energies import Energies
from vehgen.mechanics.equations_of_motion import Channel
from vehgen.mechanics.hinge_forces import hinge_force_channel
from vehgen.mechanics.kinematics import Kinematics
from vehgen.mechanics.layout import Layout
from vehgen.mechanics.quantities import AXLE_MOTIONS, ELEMENT_QUANTITIES, POINT_QUANTITIES
from vehgen.mechanics.rows import Row, combine
from vehgen.mechanics.symbols import number, parameter, to_sympy
from vehgen.vehicle.model import Vehicle

DISTANCE_ALONE = "`distance` counts from what `behind` names, and nothing is named: from the COG the place is `x: {ahead} m`"


@dataclass(frozen=True)
class Place:
    """A place on a body: `x` ahead of its COG, or `distance` [m] behind an axle, hinge or body named `behind`, `height` [m] above the COG.

    `x` may be given as a text, such as `1.2 m` or `wheelbase - 1 m`, or as a number [m]; lengths may be texts, too. A number that is no
    length of at most 1 km, `x` beside `behind`, and a `distance` behind nothing are an InputError.
    Each place has a parameter `NAME.shift` [m], which moves it forward; it is 0 unless a population or a fit says otherwise.
    """

    name: str
    body: str
    x: Expression | None = None
    behind: str | None = None
    distance: float = 0.0
    height: float = 0.0

    def __post_init__(self) -> None:
        for key in ("distance", "height"):
            object.__setattr__(self, key, _metres(getattr(self, key), key))
        if self.x is not None and not isinstance(self.x, Expression):
            is_number = isinstance(self.x, Real) and not isinstance(self.x, bool)
            try:
                object.__setattr__(self, "x", parse(f"{_metres(self.x, 'x')!r} m" if is_number else str(self.x)))
            except ExpressionError as error:
                raise ArgumentError(f"`x`: {error}", "x") from error
        if self.x is not None and self.behind is not None:
            raise ArgumentError(f"{self.name}: a place has `x`, or `behind` with `distance`, not both", "x", "behind")
        if self.distance and self.behind is None:
            said = DISTANCE_ALONE.format(ahead=f"{-self.distance:g}")
            raise ArgumentError(f"{self.name}: {said}", "distance", "behind")

    @property
    def shift(self) -> str:
        """Name of the parameter that moves it forward [m]."""
        return f"{self.name}.shift"

    def locate(self, vehicle: Vehicle, layout: Layout) -> sp.Expr:
        """Return its position ahead of its body's COG [m]; raises InputError for names the vehicle lacks."""
        if self.body not in vehicle.bodies:
            raise InputError(f"{self.name}: no body {shown(self.body)}; {did_you_mean(self.body, vehicle.bodies)}")
        shift = parameter(self.shift)
        if self.behind is None:
            self._check_x(vehicle)
            return (to_sympy(self.x) if self.x is not None else sp.S.Zero) + shift
        known = {**vehicle.axles, **vehicle.hinges, **vehicle.bodies}
        if self.behind not in known:
            raise InputError(f"{self.name}: nothing named {shown(self.behind)} to be behind of; {did_you_mean(self.behind, known)}")
        return layout.place(vehicle, self.behind) - layout.bodies[self.body][0] - number(self.distance) + shift

    def _check_x(self, vehicle: Vehicle) -> None:
        """Refuse an `x` that is no length of the vehicle's parameters."""
        if self.x is not None:
            check_dimension(self.x, LENGTH, vehicle.dimensions, locate_arguments({"x": self.x}, f"Place {self.name}"), "x")


@dataclass(frozen=True)
class PointOutput:
    """A quantity of POINT_QUANTITIES at a place, written to the channel `name`."""

    name: str
    place: Place
    quantity: str


@dataclass(frozen=True)
class ElementOutput:
    """A quantity of ELEMENT_QUANTITIES or AXLE_MOTIONS of an axle, link or hinge, written to the channel `name`."""

    name: str
    owner: str
    quantity: str


Output = PointOutput | ElementOutput


def point_channel(output: PointOutput, vehicle: Vehicle, layout: Layout, motion: Kinematics, energies: Energies) -> Channel:
    """Return the row of a quantity at a point of a body."""
    quantity = output.quantity
    if quantity not in POINT_QUANTITIES:
        raise InputError(f"{output.name}: unknown quantity {shown(quantity)} of a sensor; {did_you_mean(quantity, POINT_QUANTITIES)}")
    x = output.place.locate(vehicle, layout)
    if quantity == "fore_aft_acceleration":
        row = fore_aft_row(output.place, x, motion, energies)
    else:
        row = motion.turn(output.place.body, x) if quantity.startswith("pitch") else motion.rise(output.place.body, x)
    part = {"pitch": "displacement", "pitch_rate": "velocity"}.get(quantity, quantity.removeprefix("pitch_").removeprefix("fore_aft_"))
    return Channel(output.name, quantity, POINT_QUANTITIES[quantity], output.place.body, **{part: row})


def fore_aft_row(place: Place, x: sp.Expr, motion: Kinematics, energies: Energies) -> Row:
    """Return how far forward a place `x` ahead of its body's COG moves: with its group of bodies, with its body, and as it pitches."""
    own = motion.forward(place.body, x, number(place.height))
    return combine((sp.S.One, energies.eliminated(motion.groups[place.body])), (sp.S.One, own))


def element_channel(
    output: ElementOutput, vehicle: Vehicle, layout: Layout, motion: Kinematics, energies: Energies, forces: tuple[Place, ...]
) -> Channel:
    """Return the row of a travel or force of a suspension, tyre, link or hinge (compression positive), or of an axle's motion."""
    quantity = output.quantity
    if quantity in AXLE_MOTIONS:
        return _axle_motion(output, vehicle, layout, motion)
    if quantity not in ELEMENT_QUANTITIES:
        known = did_you_mean(quantity, ELEMENT_QUANTITIES)
        raise InputError(f"{output.name}: unknown quantity {shown(quantity)} of an axle, link or hinge; {known}")
    if quantity in ("hinge_force", "hinge_load"):
        pushed = [place.body for place in forces]
        return hinge_force_channel(output.name, quantity, output.owner, vehicle, motion, energies.elements, pushed)
    kind, _, part = quantity.rpartition("_")
    owners = {element.name: number for number, element in enumerate(energies.elements) if element.kind == kind}
    if output.owner not in owners:
        raise InputError(f"{output.name}: {shown(output.owner)} has no {kind}; {did_you_mean(output.owner, owners)}")
    number = owners[output.owner]
    element = energies.elements[number]
    unit = ELEMENT_QUANTITIES[quantity]
    if part in ("travel", "angle"):
        return Channel(output.name, quantity, unit, output.owner, displacement=element.row, input=element.input_row)
    scaled: dict[str, Row] = {
        "displacement": combine((element.k, element.row)),
        "input": combine((element.k, element.input_row)),
        "velocity": combine((element.c, element.row)),
        "input_rate": combine((element.c, element.input_row)),
        "laws": {number: sp.S.One},
    }
    return Channel(output.name, quantity, unit, output.owner, **scaled)


def _axle_motion(output: ElementOutput, vehicle: Vehicle, layout: Layout, motion: Kinematics) -> Channel:
    """Return the row of an axle's own motion: that of its body where its wheel sits on it, as on a tandem's beam."""
    axle = vehicle.axles.get(output.owner)
    if axle is None:
        hint = did_you_mean(output.owner, vehicle.axles) if vehicle.axles else f"{vehicle.name} has none"
        raise InputError(f"{output.name}: {shown(output.owner)} is no axle; {hint}")
    if axle.mass is None:
        row = motion.rise(axle.body, layout.axles[output.owner] - layout.bodies[axle.body][0])
    else:
        row = {motion.index(f"hop.{output.owner}"): sp.S.One}
    return Channel(output.name, output.quantity, AXLE_MOTIONS[output.quantity], output.owner, **{output.quantity: row})


def _metres(value: object, key: str) -> float:
    """Return a length [m] from a number, or a text with its unit; raises ArgumentError for what is none or beyond any vehicle."""
    try:
        number = float(value) if isinstance(value, Real) and not isinstance(value, bool) else read_quantity(value, LENGTH)
    except PydanticCustomError as error:
        raise ArgumentError(f"`{key}`: {error.message()}", key) from error
    if not math.isfinite(number):
        raise ArgumentError(f"`{key}`: a finite number in m was expected, found {number}", key)
    if (reason := VEHICLE_LENGTH.refusal(number)) is not None:
        raise ArgumentError(f"`{key}`: {reason}", key)
    return number
