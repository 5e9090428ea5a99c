"""A mass on its own springs on a body: a load that moves, a cab on its mounts."""

from __future__ import annotations

import math
from dataclasses import dataclass
from operator import attrgetter

from vehgen.effects.base import Change, EffectParameter, Symbols
from vehgen.effects.kinds import VehicleEffect
from vehgen.effects.locator import EffectSite
from vehgen.effects.places import front_body, loading_bodies
from vehgen.files.names import joined_name


@dataclass(frozen=True)
class MassEdit:
    """The edit that cuts a heave-only mass, called `name`, out of a body and mounts it on a link."""

    name: str

    def __call__(self, site: EffectSite, symbols: Symbols) -> Change:
        """Return the change of the vehicle at a site."""
        body, new = site.place, joined_name(self.name, site.place)
        mass, f, zeta, x = (symbols[key] for key in ("mass", "frequency", "damping_ratio", "x"))
        omega = 2 * math.pi * f
        return {
            "bodies": {
                body: {"mass": site.vehicle.bodies[body].mass - mass},
                new: {"mass": mass, "motions": ["heave"], "carried_by": {"body": body, "x": x}},
            },
            "links": {
                joined_name(new, "mount"): {body: {"x": x}, new: {"x": "0 m"}, "k": mass * omega**2, "c": 2 * zeta * mass * omega},
            },
        }


def mass_parameters(frequencies: tuple[float, ...], share: tuple[float, ...]) -> tuple[EffectParameter, ...]:
    """Return mass, natural frequency, damping ratio and place of a mounted mass."""
    return (
        EffectParameter(
            "mass",
            "kg",
            "mass",
            low=0.01,
            high=0.6,
            starts=share,
            scale=attrgetter("mass"),
            of="the body's mass",
        ),
        EffectParameter("frequency", "Hz", "natural frequency on its mounts", low=0.8, high=12.0, starts=frequencies),
        EffectParameter("damping_ratio", "", "damping ratio", low=0.005, high=0.7, starts=(0.1,)),
        EffectParameter(
            "x",
            "m",
            "ahead of the COG of the body",
            low=-0.7,
            high=0.7,
            starts=(0.0,),
            scale=attrgetter("span"),
            of="the distance of the body's outermost supports, at least 1 m",
        ),
    )


CARGO_MODULE_EFFECT = VehicleEffect(
    name="cargo_module",
    title="Cargo module",
    equation="m z'' = k*(z_body - z) + c*(z_body' - z')",
    meaning="a load, an engine or a building module that vibrates vertically on the body; its mass is cut out of the body's",
    signature="a resonance with its antiresonance on that body, the same at every amplitude",
    source="Wu & Li 2023, Sect. 2.5, doi:10.3390/s23249691",
    attaches="body",
    places=loading_bodies,
    parameters=mass_parameters((3.0, 6.0), (0.15,)),
    is_global=True,
    edit=MassEdit("module"),
)


SUSPENDED_CAB_EFFECT = VehicleEffect(
    name="suspended_cab",
    title="Suspended cab",
    equation="m z'' = k*(z_body - z) + c*(z_body' - z')",
    meaning="the cab rides on its own springs; its mass is cut out of the body's",
    signature="a resonance with its antiresonance at 1.5 to 6 Hz, strongest near the front axle",
    source="T. D. Gillespie, Heavy Truck Ride, SAE Technical Paper 850001, 1985, doi:10.4271/850001",
    attaches="body",
    places=front_body,
    parameters=mass_parameters((2.5, 4.5), (0.1,)),
    is_global=True,
    edit=MassEdit("cab"),
)
