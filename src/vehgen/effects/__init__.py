"""What could be missing? Effects of the vehicle, of runs and sensors, of spectral lines, and of wheels.

Each tells where it attaches, what it changes and how many numbers it costs; other packages and files may add more.
"""

from vehgen.effects.base import Change, Effect, EffectParameter
from vehgen.effects.entry import effects, effects_named, load_effects
from vehgen.effects.kinds import LineEffect, RunEffect, VehicleEffect, WheelEffect
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
    "WheelEffect",
    "effects",
    "effects_named",
    "library",
    "load_effects",
]
