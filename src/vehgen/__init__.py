"""vehgen: declare a road vehicle in YAML; derive, compile, simulate, calibrate and diagnose its pitch-plane dynamics.

The names below are imported when they are first used, so that `import vehgen` stays fast.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from vehgen.late_imports import import_late

__version__ = "0.1.0"

_HOMES = {
    "InputError": "vehgen.errors",
    "ModelWarning": "vehgen.errors",
    "Axle": "vehgen.vehicle",
    "Body": "vehgen.vehicle",
    "Hinge": "vehgen.vehicle",
    "Link": "vehgen.vehicle",
    "Parameter": "vehgen.vehicle",
    "Spring": "vehgen.vehicle",
    "Vehicle": "vehgen.vehicle",
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
    "Run": "vehgen.simulate",
    "Simulator": "vehgen.simulate",
    "frequency_response": "vehgen.simulate",
    "load_run": "vehgen.simulate",
    "make_scenario": "vehgen.simulate",
    "natural_modes": "vehgen.simulate",
    "road_response": "vehgen.simulate",
    "simulate": "vehgen.simulate",
    "state_space": "vehgen.simulate",
    "laden": "vehgen.cargo",
    "PhoneSensor": "vehgen.phones",
    "import_phones": "vehgen.phones",
    "transmissibility": "vehgen.fit.transmissibility",
    "assess": "vehgen.assess",
    "Effect": "vehgen.effects",
    "effects": "vehgen.effects",
    "advise_sensors": "vehgen.calibrate",
    "calibrate": "vehgen.calibrate",
    "sensitivity": "vehgen.calibrate",
    "validate": "vehgen.calibrate",
    "diagnose": "vehgen.diagnose",
    "build": "vehgen.report",
    "draw_vehicle": "vehgen.report",
    "read_result": "vehgen.report",
    "report": "vehgen.report",
    "export": "vehgen.export",
}

__all__ = [*_HOMES]

if TYPE_CHECKING:
    from vehgen.assess import assess
    from vehgen.calibrate import advise_sensors, calibrate, validate
    from vehgen.calibrate.sensitivity import sensitivity
    from vehgen.cargo.laden import laden
    from vehgen.codegen import Excitation, Kernel
    from vehgen.diagnose import diagnose
    from vehgen.effects import Effect, effects
    from vehgen.errors import InputError, ModelWarning
    from vehgen.export import export
    from vehgen.fit.transmissibility import transmissibility
    from vehgen.mechanics import ElementOutput, EquationsOfMotion, Place, PointOutput, derive, static_loads
    from vehgen.phones import PhoneSensor, import_phones
    from vehgen.report import build, draw_vehicle, read_result, report
    from vehgen.simulate import Response, Run, Simulator, load_run, make_scenario, natural_modes, simulate
    from vehgen.simulate.frequency_response import frequency_response
    from vehgen.simulate.road_response import road_response
    from vehgen.simulate.state_space import state_space
    from vehgen.vehicle import Axle, Body, Hinge, Link, Parameter, Spring, Vehicle, bundled_models, load_vehicle, parse_vehicle


import_late(__name__, {home: [name for name in _HOMES if _HOMES[name] == home] for home in _HOMES.values()})
