"""What recordings tell though not of single parameters, and how sure the fit is where it does not reach the noise."""

from types import SimpleNamespace

import numpy as np
import pytest

from tests.calibrate.trucks import along_the_first_direction, fit_at, truck_problem
from vehgen.calibrate.combinations import combination_unit, identifiable_ratios, sprung_mass
from vehgen.calibrate.identifiability import find_structure
from vehgen.calibrate.intervals import Frozen, Uncertainty, _covariance, _with_frozen
from vehgen.fit.least_squares import FIRST_NOISE
from vehgen.fit.prior_data import load_prior_data


@pytest.fixture(scope="module")
def truck(tmp_path_factory):
    return truck_problem(tmp_path_factory.mktemp("truck"))


@pytest.fixture(scope="module")
def structure(truck):
    return find_structure(truck, truck.space.start)


@pytest.fixture(scope="module")
def known(truck, structure):
    return Uncertainty(fit_at(truck, truck.space.start), structure)


def test_masses_stiffnesses_and_dampings_are_told_over_the_sprung_mass(truck, known):
    found = {item.name: item for item in identifiable_ratios(known)}
    assert set(found) == {f"{kind}{i}/(mT + mS)" for kind in ("m", "k", "c", "kt") for i in range(1, 6)}
    start = dict(zip(truck.space.names, truck.space.start.tolist(), strict=True))
    other = along_the_first_direction(start, 0.7 * start["mS"])
    for item in found.values():
        assert item.low < item.value < item.high
        name = item.name.partition("/")[0]
        assert other[name] / (8000.0 + other["mS"]) == pytest.approx(item.value, rel=1e-9)
    assert combination_unit(truck.trials[0].run.vehicle, "k1/(mT + mS)") == "s^-2"
    assert combination_unit(truck.trials[0].run.vehicle, "m1/(mT + mS)") == ""


def test_what_facts_tell_of_single_parameters_is_no_longer_told_as_a_ratio(truck, structure, tmp_path):
    (tmp_path / "facts.yaml").write_text("parameters: {mS: {value: 38 t, uncertainty: 0.2 t}}\n", encoding="utf-8")
    facts = load_prior_data(tmp_path / "facts.yaml", truck)
    known = Uncertainty(fit_at(truck, truck.space.start), structure, facts)
    assert identifiable_ratios(known) == []
    assert next(item for item in known.parameters() if item.name == "k1").low is not None


def test_the_sprung_mass_is_named_only_where_it_is_made_of_parameters(truck):
    vehicle = truck.trials[0].run.vehicle
    assert str(sprung_mass(vehicle)) == "mT + mS"


def test_a_mass_that_a_scale_tells_is_held_fixed_before_other_parameters(structure):
    assert "mS" in {structure.space.names[i] for i in structure.fixed_parameters}


def test_intervals_grow_by_the_root_of_chi2_and_never_shrink(tmp_path, known):
    def widths(item):
        estimates = [*identifiable_ratios(item), *(hz for hz, _ in item.frequencies()), *item.given_fixed_parameters()]
        return np.log([estimate.high / estimate.value for estimate in estimates if estimate.high != estimate.value])

    worse, better = (truck_problem(tmp_path, noise=noise) for noise in (2 * FIRST_NOISE, FIRST_NOISE / 2))
    loud, quiet = (Uncertainty(fit_at(item, item.space.start), known.structure) for item in (worse, better))
    assert loud.inflation == pytest.approx(2.0, rel=0.05)
    assert widths(loud) == pytest.approx(2 * widths(known), rel=0.05)
    assert quiet.inflation == 1.0
    assert widths(quiet) == pytest.approx(widths(known), rel=0.05)


def test_an_interval_holds_nine_of_ten_and_is_symmetric_on_a_logarithmic_scale_above_zero():
    """Of a standard deviation of 0.2: 1.645 of it to either side, relative to the value."""
    alone = SimpleNamespace(covariance=np.diag([0.01, 5.0]))
    above, below = (Uncertainty._interval(alone, "x", value, np.array([2.0, 0.0])) for value in (2.0, -2.0))
    assert (above.low * above.high, above.high) == pytest.approx((4.0, 2.0 * np.exp(1.6449 * 0.1)), rel=1e-4)
    assert (below.low, below.high) == pytest.approx((-2.0 - 1.6449 * 0.2, -2.0 + 1.6449 * 0.2), rel=1e-4)


def test_what_recordings_say_nothing_of_is_known_to_two_ranges_and_that_adds_little_to_what_they_say():
    assert _covariance(np.diag([0.0, 1e4])) == pytest.approx(np.diag([4.0, 1e-4]), rel=1e-3)


def test_what_was_frozen_adds_its_own_error_to_what_leans_on_it():
    """Errors propagate: b moves by -s for a unit of a, s = I_ab/I_bb, beside its own variance 1/I_bb; a keeps that of its step."""
    information, variance = np.array([[9e6, 2e6], [2e6, 4e6]]), 1e-5
    found = np.linalg.inv(_with_frozen(information, ["a", "b"], Frozen(("a",), np.array([[1 / variance]]))))
    slope = 2e6 / 4e6
    assert found == pytest.approx(np.array([[variance, -slope * variance], [-slope * variance, 1 / 4e6 + slope**2 * variance]]), rel=1e-5)
