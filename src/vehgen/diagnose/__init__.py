"""What is missing? The way from recordings to a verdict.

Inputs are checked, the gap is detected, localised, named and verified, the next experiment proposed; the result, and the thresholds that
decide.
"""

from vehgen.diagnose.api import diagnose
from vehgen.diagnose.result import Diagnosis

__all__ = ["Diagnosis", "diagnose"]
