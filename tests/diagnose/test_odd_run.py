"""A run that does not agree with the others on the vehicle, where recalibration and errors of runs hide it."""

import pytest
from benchmarks.hidden_effects.generator import Case, true_parameters

from tests.diagnose.conftest import HUMPS
from vehgen.diagnose.detect.detection import detect
from vehgen.diagnose.detect.odd_run import odd_run
from vehgen.diagnose.pipeline import diagnose_trials

OTHER = {"kr": 0.99, "cf": 1.008, "IZ": 1.008}
"""What the other vehicle has of some parameters: so little that its run nearly agrees, in recordings as good as these."""


@pytest.fixture(scope="module")
def mixed(trials_of):
    """Three runs, the fast one by another vehicle."""
    truth = true_parameters(Case("sedan2", None, (), HUMPS, seed=3))
    other = trials_of(runs=HUMPS, parameters=truth | {name: factor * truth[name] for name, factor in OTHER.items()})
    return [own if trial.name == "fast" else trial for trial, own in zip(trials_of(runs=HUMPS), other, strict=True)]


def test_a_run_by_another_vehicle_is_odd(mixed):
    detection = detect(mixed)
    assert detection.is_quiet
    found = odd_run(detection)
    assert found is not None
    assert found.run == "fast"


def test_runs_by_one_vehicle_agree(detection_of):
    assert odd_run(detection_of(runs=HUMPS)) is None


def test_two_runs_cannot_tell_which_of_them_is_odd(mixed):
    assert odd_run(detect(mixed[1:])) is None


def test_what_hides_in_the_noise_is_told_by_the_run_that_shows_it(mixed):
    found = diagnose_trials(mixed)
    assert found.verdict.verdict == "too_weak"
    assert "fast" in found.verdict.reason
    assert "The runs do not agree on the vehicle" in found.verdict.reason
    assert "repeat fast" in found.verdict.next_experiment
