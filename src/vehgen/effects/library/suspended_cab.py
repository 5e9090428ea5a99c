"""A cab on its own mounts."""

from __future__ import annotations

from vehgen.effects.base import Effect
from vehgen.effects.library.mounted_mass import mass_edit, mass_parameters
from vehgen.effects.places import front_body

SUSPENDED_CAB = Effect(
    "suspended_cab",
    "Suspended cab",
    "m z'' = k*(z_body - z) + c*(z_body' - z')",
    "the cab rides on its own springs; its mass is cut out of the body's",
    "a resonance with its antiresonance at 1.5 to 6 Hz, strongest near the front axle",
    "T. D. Gillespie, Heavy Truck Ride, SAE Technical Paper 850001, 1985, doi:10.4271/850001",
    "body",
    mass_parameters((2.5, 4.5), (0.1,)),
    front_body,
    mass_edit("cab"),
)
