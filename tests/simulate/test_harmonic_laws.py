"""Laws under harmonic travel against describing functions in closed form, and derivatives against differences."""

import numpy as np
import pytest

from vehgen.calibrate.identifiability import answer_derivatives, answers
from vehgen.mechanics import Place, derive
from vehgen.mechanics.outputs import ElementOutput, PointOutput
from vehgen.simulate import harmonic_laws as of_laws
from vehgen.simulate.harmonic_laws import TRAVELS, harmonic_laws
from vehgen.vehicle import parse_vehicle

FREQUENCY = np.array([0.5, 2.0, 11.0])
SEDAN = """
name: car
extends: sedan2
parameters:
  friction: {{value: 400 N}}
  k3: {{value: 2e7 N/m^3}}
  stops: {{value: 300 kN/m}}
  gap: {{value: 60 mm}}
  mount: {{value: 80 kN/m}}
  time: {{value: 20 ms}}
  loop: {{value: 700 N}}
  short: {{value: 3 mm}}
  ratio: {{value: 0.6}}
  lip: {{value: 300 N}}
axles:
  front: {{suspension: {{laws: {front}}}}}
  rear: {{suspension: {{laws: {rear}}}, tyre: {{laws: {tyre}}}}}
"""


def car(front="[]", rear="[]", tyre="[]"):
    text = SEDAN.format(front=front, rear=rear, tyre=tyre)
    outputs = [PointOutput(name, Place(name, "body", behind=name), "acceleration") for name in ("front", "rear")]
    return derive(parse_vehicle(text), [*outputs, ElementOutput("F", "front", "suspension_force")])


def only(model):
    """Return the laws of the only element that has any, at each amplitude."""
    return [laws[0].law.numbers for laws in harmonic_laws(model, model.values(), FREQUENCY)]


@pytest.fixture
def fine(monkeypatch):
    monkeypatch.setattr(of_laws, "CYCLE_STEPS", 4000)


def test_friction_is_the_textbooks(fine):
    for found, travel in zip(only(car("[{dry_friction: {force: friction}}]")), TRAVELS, strict=True):
        assert found == pytest.approx(np.full(3, 4j * 400 / (np.pi * travel)), rel=1e-5)


def test_a_cubic_spring_is_the_textbooks(fine):
    for found, travel in zip(only(car("[{cubic_stiffness: {k3: k3}}]")), TRAVELS, strict=True):
        assert found == pytest.approx(np.full(3, 0.75 * 2e7 * travel**2 + 0j), rel=1e-9)


@pytest.mark.thorough
def test_stops_act_where_travel_reaches_them(fine):
    found = only(car("[{bump_stop: {k: stops, clearance: gap, rebound: gap}}]"))
    for numbers, travel in zip(found, TRAVELS, strict=True):
        u = min(0.06 / travel, 1.0)
        expected = 3e5 * (1 - 2 / np.pi * (np.arcsin(u) + u * np.sqrt(1 - u * u)))
        assert numbers == pytest.approx(np.full(3, expected + 0j), rel=1e-5, abs=1e-6)
    assert np.any(found[-1])


@pytest.mark.thorough
def test_relaxation_is_a_maxwell_branch(fine):
    turned = 2j * np.pi * FREQUENCY * 0.02
    for found in only(car("[{relaxation: {k: mount, time: time}}]")):
        assert found == pytest.approx(8e4 * turned / (1 + turned), rel=5e-3)  # after one cycle


@pytest.mark.thorough
def test_a_damper_with_play_moves_as_a_backlash_does(fine):
    """A. Gelb, W. E. Vander Velde, Multiple-Input Describing Functions, 1968: backlash."""
    for found, travel in zip(only(car("[{damper_free_play: {c: 3 kN s/m, play: short}}]")), TRAVELS, strict=True):
        share = min(2 * 0.0015 / travel, 2.0)
        in_phase = 0.5 + (np.arcsin(1 - share) + (1 - share) * np.sqrt(share * (2 - share))) / np.pi
        behind = share * (2 - share) / np.pi
        expected = 3e3 * 2j * np.pi * FREQUENCY * (in_phase - 1j * behind)
        assert found == pytest.approx(expected, rel=5e-3, abs=1e-6)


LAWS = {
    "friction": ("[{dry_friction: {force: friction}}, {cubic_stiffness: {k3: k3}}]", "[]", "[]"),
    "memories": (
        "[{relaxation: {k: mount, time: time}}, {hysteresis: {force: loop, travel: short}}]",
        "[{hysteresis: {force: 2 * loop, travel: short}}]",
        "[]",
    ),
    "one way": ("[{asymmetric_damping: {c: cf, ratio: ratio}}]", "[{asymmetric_friction: {force: lip, ratio: ratio}}]", "[]"),
    "weight": ("[{progressive_stiffness: {k: stops, start: gap, from: unloaded}}]", "[]", "[{tyre_liftoff: {}}]"),
    "stops": (
        "[{bump_stop: {k: stops, clearance: gap, rebound: gap}}]",
        "[{law: {force: q*v*abs(v), parameters: {q: friction/(1 m/s)^2}}}]",
        "[]",
    ),
}


@pytest.mark.thorough
@pytest.mark.parametrize("laws", LAWS.values(), ids=LAWS)
def test_derivatives_of_responses_with_laws_agree_with_differences(laws):
    model = car(*laws)
    values = model.values()
    names = ("mH", "Lf", "kf", "cf", "cr", "ktr", "friction", "k3", "stops", "mount", "time", "loop", "short", "ratio", "lip")
    found = answer_derivatives(model, values, names)
    for i, name in enumerate(names):
        step = 1e-6 * values[name]
        ends = [answers(model, values | {name: values[name] + sign * step}) for sign in (1, -1)]
        expected = (ends[0] - ends[1]) / (2 * step)
        assert np.abs(found[i] - expected).max() <= 1e-4 * np.abs(expected).max(), name
