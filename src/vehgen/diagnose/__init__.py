"""What does the model lack? Detection, localisation, effects one by one, and what to measure next."""

from vehgen.diagnose.api import diagnose
from vehgen.diagnose.result import Diagnosis

__all__ = ["Diagnosis", "diagnose"]
