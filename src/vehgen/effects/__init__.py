"""What could be missing? Effects of the vehicle, of runs and sensors, and of spectral lines.

Each tells where it attaches, what it changes and how many numbers it costs; other packages and files may add more.
"""

from vehgen.effects.base import Change, Effect, EffectParameter
from vehgen.effects.entry import effects, effects_named, load_effects
from vehgen.effects.kinds import LineEffect, RunEffect, VehicleEffect
from vehgen.effects.locator import EffectLocator, EffectSite
from vehgen.effects.registry import EFFECTS, library

__all__ = [
    "EFFECTS",
    "Change",
    "Effect",
    "EffectLocator",
    "EffectParameter",
    "EffectSite",
    "LineEffect",
    "RunEffect",
    "VehicleEffect",
    "effects",
    "effects_named",
    "library",
    "load_effects",
]
