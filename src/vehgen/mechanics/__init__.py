"""Why does it move? From a Vehicle to its EquationsOfMotion.

Layout, kinematics, energies, Lagrange's equations, sensor rows, static loads and equilibria, and the one evaluator of expressions.
"""

from typing import TYPE_CHECKING

from vehgen.late_imports import import_late

if TYPE_CHECKING:
    from vehgen.mechanics.coordinates import Coordinate
    from vehgen.mechanics.derivation import ModelLike, all_values, as_model, derive
    from vehgen.mechanics.equations_of_motion import GRAVITY, Channel, EquationsOfMotion
    from vehgen.mechanics.numeric_model import NumericModel
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

import_late(
    __name__,
    {
        "vehgen.mechanics.equations_of_motion": (
            "GRAVITY",
            "Channel",
            "EquationsOfMotion",
        ),
        "vehgen.mechanics.coordinates": ("Coordinate",),
        "vehgen.mechanics.derivation": (
            "ModelLike",
            "all_values",
            "as_model",
            "derive",
        ),
        "vehgen.mechanics.numeric_model": ("NumericModel",),
        "vehgen.mechanics.outputs": (
            "ElementOutput",
            "Output",
            "Place",
            "PointOutput",
        ),
        "vehgen.mechanics.static_loads": (
            "StaticLoads",
            "is_held",
            "static_loads",
        ),
    },
)
