"""One error of the measurement in place of many: which one is told, and that none is where there are two, or where many are likelier."""

from dataclasses import replace
from importlib import import_module
from types import SimpleNamespace

import pytest
from benchmarks.hidden_effects.generator import Effect

from tests.diagnose.conftest import CUBIC, HUMPS
from vehgen.diagnose.detect.detection import BELIEVED_SIGMAS, supposing
from vehgen.diagnose.fits.candidate import list_candidates
from vehgen.diagnose.select.estimates import estimate
from vehgen.diagnose.select.fitter import Fitter
from vehgen.diagnose.select.one_error import _explains, _within_belief, one_error, taken_over
from vehgen.effects import EFFECTS

GAIN = Effect("sensor_gain", "F_az", {"error": 0.15})
LATE = Effect("sensor_delay", "R", {"time": 0.06})
FAST = Effect("speed_error", "all", {"error": 0.05})
NAMES = ("cubic_stiffness", "sensor_gain", "sensor_delay", "speed_error")
NOTHING = SimpleNamespace(stopped=False, models=SimpleNamespace(chosen=()))
"""What a search finds that names no effect."""


def candidates_of(detection, names=NAMES):
    return list_candidates(detection.trials[0].run.vehicle, detection.trials, [EFFECTS[name] for name in names], detection.floor.noises)


def tried(detection, strained=None, found=NOTHING, names=NAMES):
    believed = supposing(detection, BELIEVED_SIGMAS)
    return one_error(strained or detection, believed, found, candidates_of(detection, names))


@pytest.mark.thorough
@pytest.mark.parametrize(
    ("effect", "label", "value"),
    [pytest.param(GAIN, "sensor_gain at F_az", 1.15, marks=pytest.mark.slow), (FAST, "speed_error at all runs", 1.05)],
    ids=["gain", "speed"],
)
def test_the_one_error_that_explains_the_runs_is_found(detection_of, effect, label, value):
    round_ = tried(detection_of(effect, runs=HUMPS))
    assert [fit.label for fit in round_.fits] == [label]
    (found,) = estimate(round_.fits[0]).values()
    assert found.value == pytest.approx(value, rel=0.02)
    assert found.interval[0] < value < found.interval[1]
    for part in round_.fits[0].parts:
        assert max(abs(item.sigmas) for item in part.conditions()) <= 2.5 + 1e-9


@pytest.mark.thorough
def test_an_error_takes_over_what_the_base_supposes_of_each_run(detection_of):
    detection = detection_of(FAST, runs=HUMPS)
    base = detection.base
    found = {item.label: taken_over(base, item) for item in candidates_of(detection)}
    (unit, errors), (number,) = found["speed_error at all runs"]
    before = base.least_squares.conditions()
    speeds = [item.value for item in before if item.name == "speed"]
    assert number == pytest.approx(1 + sum(speeds) / len(speeds))
    assert number == pytest.approx(1.05, abs=0.02)
    for item, left in zip(before, errors, strict=True):
        assert left * item.sigma == pytest.approx(item.value - (number - 1 if item.name == "speed" else 0.0), abs=1e-12)
    assert unit == pytest.approx(base.least_squares.x[: len(unit)])
    assert found["cubic_stiffness at rear"] is None


@pytest.mark.slow
def test_where_the_believable_base_has_lost_the_phase_a_fit_begins_at_the_strained_one(detection_of, monkeypatch):
    for name in ("fit_all_begun", "fit_all"):
        monkeypatch.setattr(Fitter, name, lambda *_: iter(()))
    (found,) = tried(detection_of(FAST, runs=HUMPS)).fits
    assert found.label == "speed_error at all runs"
    (value,) = estimate(found).values()
    assert value.interval[0] < 1.05 < value.interval[1]


@pytest.mark.slow
@pytest.mark.parametrize("effects", [(GAIN, LATE), (CUBIC,)], ids=["two errors", "an effect of the vehicle"])
def test_none_is_told_where_one_alone_does_not_explain_the_runs(detection_of, effects):
    assert tried(detection_of(*effects, runs=HUMPS)).fits == ()


@pytest.mark.slow
def test_none_is_told_where_many_small_errors_are_likelier(detection_of):
    detection = detection_of(GAIN, runs=HUMPS)
    fit = detection.base.least_squares
    likelier = replace(detection, base=replace(detection.base, least_squares=replace(fit, loss=fit.loss - 1e4)))
    assert tried(detection, likelier, names=("sensor_gain",)).fits == ()


@pytest.mark.parametrize(("numbers", "gain", "told"), [(1, 6.8, False), (1, 7.0, True), (2, 13.7, False), (2, 13.9, True)])
def test_an_error_pays_for_its_numbers_by_the_log_of_all_samples(monkeypatch, numbers, gain, told):
    """BIC of 1000 residuals: each number has to gain ln(1000) = 6.91, in -2 ln of the likelihood."""
    monkeypatch.setattr(import_module("vehgen.diagnose.select.one_error"), "leaves_noise", lambda fit, detection: True)
    misfit = SimpleNamespace(problem=SimpleNamespace(trials=[None]))
    fit = SimpleNamespace(
        n_residuals=1000,
        least_squares=SimpleNamespace(loss=-500.0 - gain, misfit=misfit),
        last=SimpleNamespace(effect=SimpleNamespace(n_numbers=lambda n_runs: numbers * n_runs)),
    )
    strained = SimpleNamespace(base=SimpleNamespace(least_squares=SimpleNamespace(loss=-500.0)))
    assert _explains(fit, strained, None) is told


@pytest.mark.thorough
def test_none_is_tried_after_a_stop_or_beside_an_effect_of_the_vehicle(detection_of):
    detection = detection_of(GAIN, runs=HUMPS)
    stopped = tried(detection, found=SimpleNamespace(stopped=True, models=SimpleNamespace(chosen=())))
    assert (stopped.fits, stopped.stopped) == ((), True)
    easy = SimpleNamespace(sigmas=1.0)
    spring = SimpleNamespace(
        effects=[SimpleNamespace(effect=EFFECTS["cubic_stiffness"])], least_squares=SimpleNamespace(conditions=lambda: [easy])
    )
    beside = tried(detection, found=SimpleNamespace(stopped=False, models=SimpleNamespace(chosen=[spring])))
    assert (beside.fits, beside.stopped) == ((), False)


@pytest.mark.thorough
def test_what_a_fit_supposes_beyond_belief_is_held_within(detection_of):
    """The base of runs with a wrong gain supposes other gains of four standard deviations; held within, it is the believable one."""
    detection = detection_of(GAIN, runs=HUMPS)
    held, believed = _within_belief(detection.base, detection), supposing(detection, BELIEVED_SIGMAS).base
    largest = [max(abs(item.sigmas) for part in fit.parts for item in part.conditions()) for fit in (detection.base, held)]
    assert largest[0] > 3.9
    assert largest[1] <= 2.5 + 1e-9
    assert (held.training, held.validation) == pytest.approx((believed.training, believed.validation), rel=1e-2)
