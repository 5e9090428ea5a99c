"""What a base hides that has bent its parameters and the errors of its runs to a mistake of the measurement."""

from types import SimpleNamespace

import numpy as np
import pytest
from benchmarks.hidden_effects.generator import perturbed

from tests.diagnose.conftest import HUMPS, edited
from vehgen.diagnose.inputs import judging, vehicle
from vehgen.diagnose.inputs.fault import MeasurementFault
from vehgen.diagnose.inputs.judging import plain_mistakes, recorded_mistakes
from vehgen.diagnose.inputs.labels import label_hypotheses
from vehgen.diagnose.inputs.refits import BaseRefits
from vehgen.diagnose.inputs.vehicle import axle_hypotheses

BAND = (0.5, 25.0)
R_AZ, R_Q = 2, 3


def in_degrees(values):
    values[:, R_Q] *= 57.3
    return values


def dead(values):
    values[:, R_AZ] = 0.01 * np.random.default_rng(2).standard_normal(len(values))
    return values


def told(faults):
    return [(item.kind, len(item.runs), item.channels) for item in faults]


def test_a_unit_is_told_where_refits_do_not_tell(trials_of, monkeypatch):
    plain = trials_of(runs=HUMPS)
    monkeypatch.setattr(judging, "find_mistakes", lambda detection, plain_only: SimpleNamespace(faults=()))
    bent = SimpleNamespace(trials=edited(plain, in_degrees), band=BAND, chi=1.2)
    assert told(plain_mistakes(bent)) == [("unit", len(plain), ("R_q",))]
    assert plain_mistakes(SimpleNamespace(trials=plain, band=BAND, chi=1.2)) == ()


def test_a_dead_channel_is_told_where_the_base_hardly_moves_there(trials_of, detection_of):
    """Of one run alone it is left to the refits."""
    plain = trials_of(runs=HUMPS)
    quiet = SimpleNamespace(floor=detection_of(runs=HUMPS).floor, band=BAND, is_quiet=True, trials=edited(plain, dead))
    assert told(recorded_mistakes(quiet)) == [("dead", len(plain), ("R_az",))]
    for trials in (plain, edited(plain, dead, plain[0].name)):
        quiet.trials = trials
        assert recorded_mistakes(quiet) == ()


@pytest.mark.parametrize(("least", "turned"), [(-0.1, True), (0.1, False)])
def test_a_channel_that_follows_its_opposite_in_the_mean_of_runs_is_tried_as_turned(trials_of, least, turned):
    """In each run by itself it follows too little: -0.3 is asked there."""
    own = np.diag([0.6, 0.6, least, 0.6])[None]
    items = [SimpleNamespace(own=np.diagonal(own, axis1=1, axis2=2), best=0, within=lambda lag: own)] * 3
    found = list(label_hypotheses(SimpleNamespace(trials=trials_of(runs=HUMPS)[:3], comparisons=items)))
    assert [told(item.describe(np.zeros(0))) for item in found] == ([[("turned", 3, ("R_az",))]] if turned else [])


def test_a_recording_that_is_put_right_keeps_the_noise_of_the_base(detection_of):
    """What measured roads and their errors make of it is known for the base alone: by a lead-in's noise nothing would be put right."""
    case = BaseRefits(detection_of(runs=HUMPS))
    changed = edited(case.trials, in_degrees, case.trials[0].name)
    noises = case._noises(changed, frozenset())
    for trial in case.trials:
        factors = [1, 1, 1, 57.3] if trial is case.trials[0] else [1, 1, 1, 1]
        known = case.base.misfit.noises[trial.name]
        np.testing.assert_allclose(noises[trial.name].sigma, known.sigma * factors, rtol=1e-6)
        np.testing.assert_array_equal(noises[trial.name].levels, known.levels)


@pytest.mark.parametrize(("clock", "blamed"), [(None, True), ((1.1, 0.2), True), ((1.1, 0.0), False)])
def test_axles_are_not_blamed_where_a_clock_leaves_noise(detection_of, monkeypatch, clock, blamed):
    parameters = perturbed("sedan2", 3)
    parameters["wheelbase"] *= 1.15
    monkeypatch.setattr(vehicle, "other_rate", lambda case: clock)
    assert bool(list(axle_hypotheses(BaseRefits(detection_of(parameters=parameters, runs=HUMPS))))) is blamed


@pytest.mark.parametrize(("excess", "told_as_tie"), [(0.1, True), (0.2, False)])
def test_a_clock_that_leaves_noise_is_a_tie_with_the_effect_that_explains_more(excess, told_as_tie):
    """A sedan's clock that ran 10 % fast was named a speed 8 % off, which leaves chi 1.04 of 3.2."""
    fault = MeasurementFault("clock_or_speed", (), (), "the clock seems to run 9 % too fast", "check it")
    undone = judging.Undone((fault,), 0.42, True, SimpleNamespace(excess=excess))
    detection, leading = SimpleNamespace(is_quiet=False, chi=3.2), SimpleNamespace(chi=1.04)
    found = judging.explain_gap(detection, leading, vehicle=False, undone=undone)
    assert found == ((fault,) if told_as_tie else ())
