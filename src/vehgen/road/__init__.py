"""What excites it? Humps, random roads of ISO 8608, measured profiles, the tyre's footprint, speeds, and what every wheel sees of them."""

from vehgen.road.humps import Hump
from vehgen.road.iso8608 import CLASSES, Iso8608Road, check_length, displacement_psd
from vehgen.road.speed import AdjustedSpeed, ConstantSpeed, SpeedHistory, SpeedLaw, Wander
from vehgen.road.track import UNDEFORMED, MeasuredProfile, Profile, Track
from vehgen.road.wheels import WheelInputs, nearby_inputs, pass_time, wheel_inputs

__all__ = [
    "CLASSES",
    "UNDEFORMED",
    "AdjustedSpeed",
    "ConstantSpeed",
    "Hump",
    "Iso8608Road",
    "MeasuredProfile",
    "Profile",
    "SpeedHistory",
    "SpeedLaw",
    "Track",
    "Wander",
    "WheelInputs",
    "check_length",
    "displacement_psd",
    "nearby_inputs",
    "pass_time",
    "wheel_inputs",
]
