"""An independent generator of phone-like recordings of vehicles with hidden effects: nothing here imports vehgen.

Bodies, axles and a pin move by Newton and Euler with explicit pin forces (system.py), effects edit that system (effects/), a compiled
Runge-Kutta integrates it (integrate.py), and phones sample it with noise (simulate.py). z up, x forward, pitch positive nose-down.
"""

from benchmarks.hidden_effects.generator.cases import (
    REFERENCE_RUN,
    SENSORS,
    SHARP_RUN,
    SILENT,
    Case,
    Effect,
    Hump,
    Noise,
    RandomRoad,
    Recording,
    RunSpec,
    SensorSpec,
)
from benchmarks.hidden_effects.generator.effects import EFFECTS
from benchmarks.hidden_effects.generator.files import write_case
from benchmarks.hidden_effects.generator.library import EffectOption, list_effects, visibility
from benchmarks.hidden_effects.generator.simulate import simulate_case, true_parameters
from benchmarks.hidden_effects.generator.vehicles import nominal, perturbed

__all__ = [
    "EFFECTS",
    "REFERENCE_RUN",
    "SENSORS",
    "SHARP_RUN",
    "SILENT",
    "Case",
    "Effect",
    "EffectOption",
    "Hump",
    "Noise",
    "RandomRoad",
    "Recording",
    "RunSpec",
    "SensorSpec",
    "list_effects",
    "nominal",
    "perturbed",
    "simulate_case",
    "true_parameters",
    "visibility",
    "write_case",
]
