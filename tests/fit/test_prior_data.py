"""What is known besides the recordings: it enters a fit, must belong to the vehicle, and weighs axles as a lever does."""

import pickle

import numpy as np
import pytest

from tests.fit.recordings import sedan_truth, write_run
from vehgen.errors import InputError
from vehgen.fit.least_squares import fit_least_squares
from vehgen.fit.prior_data import axle_load, kerb_mass, load_prior_data
from vehgen.fit.problem import make_problem
from vehgen.fit.trial import load_trials
from vehgen.mechanics import derive
from vehgen.vehicle import load_vehicle


@pytest.fixture(scope="module")
def problem(tmp_path_factory):
    return make_problem(load_trials([write_run(tmp_path_factory.mktemp("runs"), "fast", sedan_truth())]))


def test_facts_enter_the_fit(problem, tmp_path):
    path = tmp_path / "facts.yaml"
    path.write_text("parameters: {mf: {value: 95 kg, uncertainty: 1 mg}}\n".replace("1 mg", "1 g"), encoding="utf-8")
    facts = load_prior_data(path, problem)
    fit = fit_least_squares(problem, problem.space.unit(problem.space.start), prior_data=facts)
    assert fit.values[problem.space.names.index("mf")] == pytest.approx(95.0, abs=0.05)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("parameters: {mq: {value: 95 kg, uncertainty: 1 g}}", "no parameter 'mq'"),
        ("parameters: {mf: {value: 95 m, uncertainty: 1 g}}", "mf .*in kg"),
        ("parameters: {mf: {value: 95 kg, uncertainty: 0 kg}}", "above 0"),
        ("axle_weights: {middle: {value: 9 kN, uncertainty: 1 kN}}", "has no axle 'middle'"),
        ("uncoupled: {boddy: {front: {value: 9 kN, uncertainty: 1 kN}}}", "has no body 'boddy'"),
        ("kerb_mass: {value: 9 kN, uncertainty: 1 kg}", "expected kg"),
        ("kerb_mass: {value: 2 t, uncertainty: 0 kg}", "above 0"),
        ("{}", "no fact"),
        ("axle_weights: {front: {value: -9 kN, uncertainty: 1 kN}}", "above 0, found -9"),
        ("uncoupled: {body: {front: {value: 9 kN, uncertainty: 0.001 N}}}", "at least 1e-06 of the value was expected, found 0.001"),
        ("parameters: {Lf: {value: 96 m, uncertainty: 1 cm}}", r"Lf is searched from 0\.9 to 1\.9 \(SI units\), found 96"),
    ],
)
def test_facts_that_do_not_fit_are_refused(problem, tmp_path, text, said):
    path = tmp_path / "facts.yaml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match=said):
        load_prior_data(path, problem)


def test_a_fact_that_is_missed_by_far_is_told(problem, tmp_path):
    path = tmp_path / "facts.yaml"
    path.write_text(
        "axle_weights: {front: {value: 9.4 N, uncertainty: 0.1 kN}}\nkerb_mass: {value: 1.7 t, uncertainty: 1 t}", encoding="utf-8"
    )
    (told,) = load_prior_data(path, problem).missed(problem.space.start)
    start = dict(zip(problem.space.names, problem.space.start, strict=True))
    load = 9.81 * (1500.0 * (2.8 - start["Lf"]) / 2.8 + start["mf"])
    assert told.startswith(f"the fact 'load of front' is missed by {(load - 9.4) / 100:.0f} standard deviations; check its value")


def test_axle_weights_are_those_of_a_lever(problem, tmp_path):
    path = tmp_path / "facts.yaml"
    path.write_text("axle_weights: {front: {value: 1 kN, uncertainty: 1 kN}}", encoding="utf-8")
    residual = load_prior_data(path, problem).residuals(problem.space.start)[0]
    start = dict(zip(problem.space.names, problem.space.start, strict=True))
    load = 9.81 * (1500.0 * (2.8 - start["Lf"]) / 2.8 + start["mf"])
    assert residual == pytest.approx(load / 1000 - 1, rel=1e-9)


def test_facts_of_all_kinds_can_be_sent_to_other_processes(problem, tmp_path):
    path = tmp_path / "facts.yaml"
    load = "{front: {value: 1 kN, uncertainty: 1 kN}}"
    facts = ["parameters: {kf: {value: 60 kN/m, uncertainty: 2 kN/m}}", "kerb_mass: {value: 1.5 t, uncertainty: 10 kg}"]
    path.write_text("\n".join([*facts, f"axle_weights: {load}", f"uncoupled: {{body: {load}}}"]), encoding="utf-8")
    facts = load_prior_data(path, problem)
    sent = pickle.loads(pickle.dumps(facts))
    np.testing.assert_array_equal(sent.residuals(problem.space.start), facts.residuals(problem.space.start))
    assert len(facts.residuals(problem.space.start)) == 4


def test_derivatives_of_facts_are_those_of_a_lever_and_of_the_numbers_themselves(problem, tmp_path):
    path = tmp_path / "facts.yaml"
    facts = ["kerb_mass: {value: 1.5 t, uncertainty: 10 kg}", "axle_weights: {front: {value: 1 kN, uncertainty: 1 kN}}"]
    path.write_text("\n".join([*facts, "parameters: {kf: {value: 60 kN/m, uncertainty: 2 kN/m}}"]), encoding="utf-8")
    found = load_prior_data(path, problem).jacobian(problem.space.start)
    names = problem.space.names
    expected = np.zeros((3, len(names)))
    expected[0, names.index("kf")] = 1 / 2000
    expected[1, [names.index("mf"), names.index("mr")]] = 1 / 10
    expected[2, names.index("mf")] = 9.81 / 1000
    expected[2, names.index("Lf")] = -9.81 * 1500 / 2.8 / 1000
    np.testing.assert_allclose(found, expected, rtol=1e-6, atol=1e-9)


def test_what_does_not_stand_by_itself_is_told(problem, tmp_path):
    path = tmp_path / "facts.yaml"
    path.write_text("axle_weights: {front: {value: 1 kN, uncertainty: 1 kN}}", encoding="utf-8")
    loose = problem.space.start.copy()
    loose[problem.space.names.index("ktf")] = 0.0
    with pytest.raises(InputError, match="singular stiffness"):
        load_prior_data(path, problem).residuals(loose)


def test_the_kerb_mass_is_that_of_bodies_and_axles(problem, tmp_path):
    path = tmp_path / "facts.yaml"
    path.write_text("kerb_mass: {value: 1.5 t, uncertainty: 10 kg}", encoding="utf-8")
    residual = load_prior_data(path, problem).residuals(problem.space.start)[0]
    start = dict(zip(problem.space.names, problem.space.start, strict=True))
    assert residual == pytest.approx((start["mf"] + start["mr"]) / 10, rel=1e-9)


def test_the_kerb_mass_counts_what_a_link_to_the_ground_carries():
    """A trailer on its jockey wheel: its axle carries less than its mass weighs."""
    trailer = load_vehicle("sedan2").with_changes({"links": {"jockey": {"body": {"x": "1 m"}, "ground": {"x": "1 m"}, "k": "60 kN/m"}}})
    model, values = derive(trailer), {name: np.full(2, value) for name, value in trailer.values().items()}
    values["mf"] = np.array([80.0, 95.0])
    assert axle_load(model, "front")(values)[0] + axle_load(model, "rear")(values)[0] < 0.8 * 9.81 * kerb_mass(model)(values)[0]
    assert kerb_mass(model)(values) == pytest.approx(1500 + np.array([80, 95]) + 150)
