"""Why does it move? From a Vehicle to its EquationsOfMotion.

Layout, kinematics, energies, Lagrange's equations, sensor rows, static loads and equilibria, and the one evaluator of expressions.
"""

from vehgen.mechanics.derivation import derive
from vehgen.mechanics.equations_of_motion import GRAVITY, Channel, EquationsOfMotion, NumericModel
from vehgen.mechanics.kinematics import Coordinate
from vehgen.mechanics.model_like import ModelLike, all_values, as_model
from vehgen.mechanics.outputs import ElementOutput, Output, Place, PointOutput
from vehgen.mechanics.static_loads import StaticLoads, is_held, static_loads

__all__ = [
    "GRAVITY",
    "Channel",
    "Coordinate",
    "ElementOutput",
    "EquationsOfMotion",
    "ModelLike",
    "NumericModel",
    "Output",
    "Place",
    "PointOutput",
    "StaticLoads",
    "all_values",
    "as_model",
    "derive",
    "is_held",
    "static_loads",
]
