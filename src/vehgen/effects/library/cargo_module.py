"""A load that moves on its own springs."""

from __future__ import annotations

from vehgen.effects.base import Effect
from vehgen.effects.library.mounted_mass import mass_edit, mass_parameters
from vehgen.effects.places import loading_bodies

CARGO_MODULE = Effect(
    "cargo_module",
    "Cargo module",
    "m z'' = k*(z_body - z) + c*(z_body' - z')",
    "a load, an engine or a building module that vibrates vertically on the body; its mass is cut out of the body's",
    "a resonance with its antiresonance on that body, the same at every amplitude",
    "Wu & Li 2023, Sect. 2.5, doi:10.3390/s23249691",
    "body",
    mass_parameters((3.0, 6.0), (0.15,)),
    loading_bodies,
    mass_edit("module"),
)
