"""Vehicles that the tests of the report draw and write down."""

from collections.abc import Sequence
from functools import cache
from pathlib import Path

import numpy as np

from tests.oracles.layouts import random_layout, to_yaml
from vehgen.codegen import write_kernel
from vehgen.mechanics import EquationsOfMotion, Place, PointOutput, derive, static_loads
from vehgen.report import write_build_folder
from vehgen.simulate import natural_modes
from vehgen.vehicle import bundled_models, load_vehicle, parse_vehicle

HOSTILE = r'</script><script>alert("1")</script> & $\frac$ 50 % {x}_y^2 #~'
WITH_LAWS = rf"""
extends: tractor5_cab.yaml
name: with_laws
title: '{HOSTILE}'
source: 'Wu & Li, https://doi.org/10.3390/s23249691, 车辆 µ² <img src=x onerror=alert(1)>'
description: 'Damped tyre 5, force laws; see <a href="https://example.org">'
axles:
  axle2: {{suspension: {{laws: [{{bump_stop: {{k: 2 MN/m, clearance: 30 mm}}}}, {{dry_friction: {{force: 3 kN}}}}]}}}}
  axle5: {{tyre: {{c: 1 kN s/m}}}}
links:
  seat: {{laws: [{{law: {{force: "q3*d**3", parameters: {{q3: 5 MN/m^3}}}}}}]}}
hinges:
  fifth_wheel: {{laws: [{{dry_friction: {{force: 500 N m}}}}]}}
"""
RIG = """
name: rig
bodies:
  table: {mass: 900 kg, pitch_inertia: 300 kg m^2, size: {length: 4 m, height: 0.5 m}}
links:
  shaker_front: {ground: {}, table: {x: 1.5 m}, k: 200 kN/m, c: 2 kN s/m}
  shaker_rear: {ground: {}, table: {x: -1.5 m}, k: 200 kN/m}
"""
EVERY = (*bundled_models(), "with_laws", "rig")


@cache
def model(name: str) -> EquationsOfMotion:
    """Return a bundled model or one of the above, with an output and a force."""
    vehicle = (
        load_vehicle(bundled_models()[name]) if name in bundled_models() else parse_vehicle({"with_laws": WITH_LAWS, "rig": RIG}[name])
    )
    first = next(iter(vehicle.bodies))
    return derive(vehicle, [PointOutput("a", Place("s1", first), "acceleration")], [Place("push", first)])


@cache
def random_model(seed: int) -> EquationsOfMotion:
    """Return a random vehicle of hinged bodies, axles of both kinds, links, modules, cabs, rigid loads."""
    return derive(parse_vehicle(to_yaml(random_layout(np.random.default_rng(seed)))))


def build(folder: Path, name: str, warnings: Sequence[str] = (), plots: bool = True) -> list[Path]:
    """Write the build folder of one of them."""
    m = model(name)
    return write_build_folder(folder, m, m.values(), natural_modes(m), static_loads(m), write_kernel(m), warnings, plots=plots)
