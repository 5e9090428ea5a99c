"""vehgen: declare a road vehicle in YAML; derive, compile and simulate its pitch-plane dynamics.

The names below are imported when they are first used, so that `import vehgen` stays fast.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

__version__ = "0.1.0"

_HOMES = {
    "InputError": "vehgen.errors",
    "ModelWarning": "vehgen.errors",
    "bundled_models": "vehgen.vehicle",
    "load_vehicle": "vehgen.vehicle",
    "parse_vehicle": "vehgen.vehicle",
    "ElementOutput": "vehgen.mechanics",
    "EquationsOfMotion": "vehgen.mechanics",
    "Place": "vehgen.mechanics",
    "PointOutput": "vehgen.mechanics",
    "derive": "vehgen.mechanics",
    "static_loads": "vehgen.mechanics",
    "Excitation": "vehgen.codegen",
    "Kernel": "vehgen.codegen",
    "Response": "vehgen.simulate",
    "Simulator": "vehgen.simulate",
    "load_run": "vehgen.simulate",
    "natural_modes": "vehgen.simulate",
}

__all__ = [*_HOMES]

if TYPE_CHECKING:
    from vehgen.codegen import Excitation, Kernel
    from vehgen.errors import InputError, ModelWarning
    from vehgen.mechanics import ElementOutput, EquationsOfMotion, Place, PointOutput, derive, static_loads
    from vehgen.simulate import Response, Simulator, load_run, natural_modes
    from vehgen.vehicle import bundled_models, load_vehicle, parse_vehicle


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module 'vehgen' has no attribute {name!r}")
    return getattr(import_module(_HOMES[name]), name)


def __dir__() -> list[str]:
    return [*__all__, "__version__"]
