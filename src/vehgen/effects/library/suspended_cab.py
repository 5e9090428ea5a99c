"""A cab on its own mounts."""

from __future__ import annotations

from vehgen.effects.kinds import VehicleEffect
from vehgen.effects.library.mounted_mass import MassEdit, mass_parameters
from vehgen.effects.places import front_body

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
