"""The vertical force of a hinge as a sum of channels: what accelerates the bodies beyond it, less what their springs carry."""

from __future__ import annotations

from collections.abc import Mapping

from vehgen.mechanics import ElementOutput, Output, Place, PointOutput
from vehgen.mechanics.static_loads import bodies_beyond
from vehgen.vehicle import Vehicle
from vehgen.vehicle.parts import GROUND

Terms = list[tuple[float, Output]]


def hinge_force_terms(vehicle: Vehicle, hinge: str, values: Mapping[str, float]) -> Terms | None:
    """Return the channels whose weighted sum is the dynamic force that a hinge's first-named body exerts upwards on the second [N].

    Parameters
    ----------
    vehicle
        The vehicle.
    hinge
        One of its hinges.
    values
        All its parameters [SI] by name.

    Returns
    -------
    Factors with their channels, named `BODY`, `AXLE spring` and `LINK force`; None where a body beyond the hinge bends, whose mean
    motion no channel shows.
    """
    beyond = bodies_beyond(vehicle, hinge)
    if any(vehicle.bodies[name].bending is not None for name in beyond):
        return None
    terms: Terms = [
        (vehicle.bodies[name].mass.evaluate(values), PointOutput(name, Place(name, name), "acceleration"))
        for name in vehicle.bodies
        if name in beyond
    ]
    for name, axle in vehicle.axles.items():
        if axle.body in beyond:
            quantity = "suspension_force" if axle.suspension is not None else "tyre_force"
            terms.append((-1.0, ElementOutput(f"{name} spring", name, quantity)))
    for name, link in vehicle.links.items():
        (low, _), (high, _) = link.ends if link.ends[1][0] != GROUND else link.ends[::-1]
        if (high in beyond) != (low in beyond):
            terms.append((-1.0 if high in beyond else 1.0, ElementOutput(f"{name} force", name, "link_force")))
    return terms
