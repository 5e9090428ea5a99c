"""What could be missing? One file an effect."""

from vehgen.effects.base import Change, Effect, EffectParameter
from vehgen.effects.entry import extended_library, load_effects
from vehgen.effects.locator import Site, Surveyor
from vehgen.effects.registry import EFFECTS, library

__all__ = ["EFFECTS", "Change", "Effect", "EffectParameter", "Site", "Surveyor", "extended_library", "library", "load_effects"]
