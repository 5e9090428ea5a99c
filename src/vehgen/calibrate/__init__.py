"""Which parameters does it have? Calibration, validation, sensitivities, and where to put sensors."""

from vehgen.calibrate.api import calibrate
from vehgen.calibrate.result import CalibrationSummary
from vehgen.calibrate.sensitivity import SensitivityIndices, sensitivity
from vehgen.calibrate.sensor_placement import SensorAdvice, advise_sensors
from vehgen.calibrate.validation import Validation, validate

__all__ = [
    "CalibrationSummary",
    "SensitivityIndices",
    "SensorAdvice",
    "Validation",
    "advise_sensors",
    "calibrate",
    "sensitivity",
    "validate",
]
