"""A run that does not agree with the others on the vehicle or a sensor, where recalibration and errors of runs hide it."""

from dataclasses import replace

import numpy as np
import pytest
from benchmarks.hidden_effects.generator import Case, true_parameters

from tests.diagnose.conftest import HUMPS
from vehgen.diagnose import decision
from vehgen.diagnose.detect.all_runs import AllRuns
from vehgen.diagnose.detect.detection import detect
from vehgen.diagnose.detect.odd_run import OddChannel, OddRun, disagreement
from vehgen.diagnose.inputs.adjustments import RunGain
from vehgen.diagnose.inputs.refits import BaseRefits
from vehgen.diagnose.pipeline import diagnose_trials
from vehgen.effects import library

OTHER = {"kr": 0.99, "cf": 1.008, "IZ": 1.008}
"""What the other vehicle has of some parameters: so little that its run nearly agrees, in recordings as good as these."""


@pytest.fixture(scope="module")
def mixed(trials_of):
    """Three runs, the fast one by another vehicle."""
    truth = true_parameters(Case("sedan2", None, (), HUMPS, seed=3))
    other = trials_of(runs=HUMPS, parameters=truth | {name: factor * truth[name] for name, factor in OTHER.items()})
    return [own if trial.name == "fast" else trial for trial, own in zip(trials_of(runs=HUMPS), other, strict=True)]


@pytest.mark.thorough
def test_a_run_by_another_vehicle_is_odd(mixed):
    detection = detect(mixed)
    assert detection.is_quiet
    found = disagreement(detection)
    assert isinstance(found, OddRun)
    assert found.run == "fast"
    assert found.others_agree


def test_runs_by_one_vehicle_agree(detection_of):
    assert disagreement(detection_of(runs=HUMPS)) is None


@pytest.mark.thorough
def test_two_runs_cannot_tell_which_of_them_is_odd(mixed):
    assert disagreement(detect(mixed[1:])) is None


@pytest.fixture(scope="module")
def spring():
    """The effect that is tried: what the others of the library do is not asked here."""
    return [library()["cubic_stiffness"]]


@pytest.mark.slow
def test_a_run_by_another_vehicle_is_told_where_no_effect_explains_it(mixed, spring):
    found = diagnose_trials(mixed, spring)
    assert found.verdict.verdict == "measurement_fault"
    assert [(item.kind, item.runs) for item in found.verdict.faults] == [("other_vehicle", ("fast",))]
    assert "loaded as in the other runs" in found.verdict.faults[0].cure


@pytest.mark.slow
def test_a_run_that_disagrees_is_told_without_a_cause_where_the_others_do_not_agree_either(mixed, spring, monkeypatch):
    odd = disagreement(detect(mixed))
    monkeypatch.setattr(decision, "disagreement", lambda detection: replace(odd, others_agree=False))
    found = diagnose_trials(mixed, spring)
    assert found.verdict.verdict == "too_weak"
    assert "The runs do not agree on the vehicle" in found.verdict.reason
    assert "repeat fast" in found.verdict.next_experiment


GAIN = 1.1


@pytest.fixture(scope="module")
def louder(trials_of):
    """Three runs; in the fast one the first channel reads 10 % more."""
    found = []
    for trial in trials_of(runs=HUMPS):
        values = trial.recording.values.copy()
        if trial.name == "fast":
            values[:, 0] *= GAIN
        found.append(replace(trial, recording=replace(trial.recording, values=values)))
    return detect(found)


@pytest.mark.thorough
def test_a_sensor_that_reads_more_in_one_run_is_told_with_its_factor(louder):
    found = disagreement(louder)
    assert isinstance(found, OddChannel)
    assert (found.run, found.channel) == ("fast", louder.trials[0].channels[0])
    assert found.factor == pytest.approx(GAIN, abs=4 * found.sigma)
    assert found.sigma < 0.01


@pytest.mark.slow
def test_so_is_one_over_a_measured_road(trials_of):
    found = []
    for trial in trials_of():
        values = trial.recording.values.copy()
        if trial.name == "rough":
            values[:, 2] *= GAIN
        found.append(replace(trial, recording=replace(trial.recording, values=values)))
    odd = disagreement(detect(found))
    assert isinstance(odd, OddChannel)
    assert (odd.run, odd.channel) == ("rough", found[0].channels[2])
    assert odd.factor == pytest.approx(GAIN, abs=0.02)


@pytest.mark.thorough
def test_first_order_gains_are_those_of_a_fit_with_that_number_free(louder):
    runs = AllRuns(louder)
    run = [trial.name for trial in runs.trials].index("fast")
    channel = runs.trials[run].channels[0]
    own = runs.own_gain(run, 0)
    case = BaseRefits(louder)
    together = case.refit(case.problem)[1]
    fit, left = case.refit(case.problem, (RunGain(channel, 0.05, 1.0, run="fast"),), (1.0,))
    values = sum(2 * lines.size for lines in fit.misfit.whitened_spectrum(fit.x))
    assert fit.misfit.adjusted(fit.x)[-1] == pytest.approx(1 + own.values[0], abs=0.05 * (GAIN - 1))
    assert (together - left) * case.excess * values == pytest.approx(own.gain, rel=0.2)


@pytest.mark.thorough
def test_of_two_numbers_the_one_takes_what_the_other_seemed_to_need(louder):
    """Beside the gain of the channel that has one, no parameters of its own are needed in any run."""
    runs = AllRuns(louder)
    run = [trial.name for trial in runs.trials].index("fast")
    gain, vehicle = runs.own_gain(run, 0), runs.own_parameters(run)
    assert vehicle.gain > 100 > 50 > runs.beside(vehicle, gain).gain
    assert np.all(np.linalg.eigvalsh(runs.beside(vehicle, gain).information) > 0)
