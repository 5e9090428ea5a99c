"""A good vehicle with one of everything, and how a fault that is put into it is refused."""

from __future__ import annotations

import pytest

from vehgen.errors import InputError
from vehgen.vehicle import parse_vehicle

GOOD = """\
name: rig
parameters:
  mB: {value: 8000 kg, meaning: body mass}
  b1: {value: 1.32 m, range: [0.8 m, 2.2 m], meaning: axle 1 ahead of the COG}
  b2: {equals: 3.46 m - b1, meaning: axle 2 behind the COG}
  kF: {value: 200 kN/m, meaning: front stiffness}
bodies:
  frame: {mass: mB, pitch_inertia: 9000 kg m^2}
  trailer: {mass: 5 t, pitch_inertia: 9000 kg m^2}
  cab: {mass: 800 kg, size: {length: 2 m, height: 1 m}, carried_by: {body: frame, x: 1 m, z: 1 m}}
  load: {mass: 900 kg, motions: [], carried_by: {body: trailer, x: 0 m, z: 1 m}}
hinges:
  pin: {frame: {x: -2 m, z: 0}, trailer: {x: 3 m, z: 0}, k: 1 kN m/rad}
axles:
  front: {body: frame, x: b1, mass: 600 kg, suspension: {k: kF, c: 5 kN s/m}, tyre: {k: 1 MN/m}}
  rear: {body: frame, x: -b2, tyre: {k: 1 MN/m}}
  last: {body: trailer, x: -2 m, tyre: {k: 1 MN/m}}
links:
  mount: {frame: {x: 1 m}, cab: {x: 0 m}, k: 100 kN/m, c: 1 kN s/m}
  shaker: {ground: {}, trailer: {x: 1 m}, k: 10 kN/m}
sets:
  soft: {kF: 150 kN/m}
"""

Fault = tuple[str, str, str, str]
"""What is wrong, the old text, the new one, and how the message begins.

`@` in the new text marks where the error must point; without it the message begins with its line and column.
"""


def check_refused(old: str, new: str, message: str) -> None:
    """Check that GOOD with `new` in place of `old` is refused in one line, at its place."""
    assert old in GOOD
    text = GOOD.replace(old, new, 1)
    if "@" in new:
        before, _, after = text.partition("@")
        message = f"{before.count(chr(10)) + 1}:{len(before) - before.rfind(chr(10))}: {message}"
        text = before + after
    with pytest.raises(InputError) as caught:
        parse_vehicle(text, "bad.yaml")
    assert str(caught.value).startswith(f"bad.yaml:{message}")
    assert "\n" not in str(caught.value)


def name_of(fault: Fault) -> str:
    """Return what is wrong: the name of a test's case."""
    return fault[0]
