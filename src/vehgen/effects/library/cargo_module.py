"""A load that moves on its own springs."""

from __future__ import annotations

from vehgen.effects.kinds import VehicleEffect
from vehgen.effects.library.mounted_mass import MassEdit, mass_parameters
from vehgen.effects.places import loading_bodies

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
