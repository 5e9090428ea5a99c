"""Force laws in the residual form of a step, against displacements and velocities: any law, any place, laws that act at rest."""

import io

import numpy as np
import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st
from ruamel.yaml import YAML

from tests.codegen.test_nonlinear import UNITS, VALUES
from tests.codegen.test_residual import assert_same, every_output, shaken
from tests.oracles.layouts import random_layout, to_yaml
from vehgen.codegen import Kernel, write_kernel
from vehgen.mechanics import Place, derive
from vehgen.mechanics.laws import LAWS
from vehgen.vehicle import load_vehicle, parse_vehicle

SIZES = {"force": 2e3, "k": 3e5, "k3": 1e9, "k2": 1e7, "c": 1e4, "c2": 2e4}
"""Strengths at which a law bends what a truck's suspension does [SI]."""
AXLES = [f"axle{i}" for i in range(1, 6)]


def entry(law):
    """Return a law as the file of a suspension states it."""
    sized = {item.name: f"{SIZES[item.name]} {UNITS[item.name]}" for item in law.parameters if item.name in SIZES}
    return {law.name: {**{item.name: VALUES[item.name] for item in law.parameters if item.name in VALUES}, **sized}}


def written(data):
    text = io.StringIO()
    YAML().dump(data, text)
    return text.getvalue()


def assert_both_forms_agree(vehicle, rng, share=0.4):
    model = derive(vehicle, every_output(vehicle, rng, share), [Place("push", next(iter(vehicle.bodies)))])
    kernel, excitation = Kernel(model), shaken(model, rng)
    assert kernel.source.from_rest
    parameters = np.array([list(model.values().values())])
    found = kernel.run(parameters, excitation, 3)
    expected = kernel.run(parameters, excitation, 3, initial=np.zeros((1, 2 * model.n_dof)))
    assert_same(found.responses[0], expected.responses[0])
    np.testing.assert_allclose(found.residuals, expected.residuals, rtol=1e-6, atol=1e-6)
    return found


@pytest.mark.thorough
@pytest.mark.parametrize("name", sorted(name for name, law in LAWS.items() if "suspension" in law.attaches_to))
def test_every_law_on_all_suspensions_of_a_truck(name):
    laws = {axle: {"suspension": {"laws": [entry(LAWS[name])]}} for axle in AXLES}
    assert_both_forms_agree(parse_vehicle(written({"extends": "tractor5", "axles": laws})), np.random.default_rng(5))


@pytest.mark.slow
@settings(max_examples=12, deadline=None, derandomize=True, suppress_health_check=[HealthCheck.too_slow])
@given(st.integers(0, 10**9))
def test_laws_anywhere_in_any_layout(seed):
    """On suspensions, on links that the ground does not move, and on elements without stiffness or damping."""
    rng = np.random.default_rng(seed)
    data = YAML(typ="safe").load(to_yaml(random_layout(rng)))
    links = [link for link in data.get("links", {}).values() if "ground" not in link]
    parts = [*links, *(axle["suspension"] for axle in data["axles"].values() if axle.get("suspension"))]
    assume(parts)
    names = [name for name, law in LAWS.items() if {"suspension", "link"} <= set(law.attaches_to)]
    for part in [part for part in parts if rng.random() < 0.6] or parts[:1]:
        part["laws"] = [entry(LAWS[str(name)]) for name in rng.choice(names, int(rng.integers(1, 3)), replace=False)]
        part.update({key: 0 for key in ("k", "c") if rng.random() < 0.3})
    assert_both_forms_agree(parse_vehicle(written(data)), rng, 0.2)


@pytest.mark.parametrize(
    "law",
    [
        "law: {force: 400 N + 3e4 N s/m*v}",
        "bump_stop: {k: 1 MN/m, clearance: -2 mm, rebound: 12 mm}",
        "dry_friction: {force: 500 N}}, {law: {force: 400 N}",
    ],
)
def test_a_law_that_acts_at_rest_acts_from_the_first_step(law):
    text = f"extends: tractor5\naxles:\n  axle2: {{suspension: {{laws: [{{{law}}}]}}}}\nhinges:\n  fifth_wheel: {{c: 2 kN m s/rad}}\n"
    found = assert_both_forms_agree(parse_vehicle(text), np.random.default_rng(6), 1.0)
    assert np.abs(found.responses[0]).max() > 0


def test_friction_of_a_hinge():
    text = "extends: tractor5\nhinges:\n  fifth_wheel: {laws: [{dry_friction: {force: 6 kN m}}]}\n"
    assert_both_forms_agree(parse_vehicle(text), np.random.default_rng(7))


def test_laws_that_count_from_the_unloaded_position():
    law = "{progressive_stiffness: {k: 2 MN/m, start: 30 mm, from: unloaded}}"
    text = f"extends: tractor5\naxles:\n  axle1: {{suspension: {{laws: [{law}]}}}}\n  axle4: {{suspension: {{laws: [{law}]}}}}\n"
    assert_both_forms_agree(parse_vehicle(text), np.random.default_rng(8))


def test_a_law_that_the_road_moves_keeps_displacements_and_velocities():
    tyre = parse_vehicle("extends: tractor5\naxles:\n  axle1: {tyre: {laws: [{tyre_liftoff: {}}]}}\n")
    assert not write_kernel(derive(tyre)).from_rest


def test_a_step_with_friction_takes_a_sixth_fewer_operations():
    laws = {axle: {"suspension": {"laws": [entry(LAWS["dry_friction"])]}} for axle in AXLES}
    model = derive(parse_vehicle(written({"extends": "tractor5", "axles": laws})))
    counts = [write_kernel(model, from_rest=value).operation_counts["step"] for value in (True, False)]
    linear = write_kernel(derive(load_vehicle("tractor5"))).operation_counts["step"]
    assert linear < counts[0] < 0.85 * counts[1]
