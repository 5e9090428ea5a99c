"""What does it mean? Ride comfort, tyre loads and road damage, vibration and shock of cargo, and cycles of fatigue, by their standards."""

from vehgen.assess.assessment import assess
from vehgen.assess.result import Assessment

__all__ = ["Assessment", "assess"]
