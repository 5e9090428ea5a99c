"""Which candidates the first order says are worth fitting."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from benchmarks.hidden_effects.generator import Effect

from tests.diagnose.conftest import HUMPS
from vehgen.diagnose.fits import screening
from vehgen.diagnose.fits.candidate import Candidate, list_candidates
from vehgen.diagnose.fits.model_fit import CurrentModel
from vehgen.diagnose.localise.unknown_force import Place, PlaceResult
from vehgen.diagnose.select import search
from vehgen.effects import EFFECTS, EffectLocator
from vehgen.simulate import SimulatorPool

LAWS = [EFFECTS[name] for name in ("dry_friction", "hysteresis", "bump_stop", "quadratic_damping", "cubic_stiffness", "asymmetric_damping")]


@pytest.mark.thorough
@pytest.mark.parametrize("force", [15.0, 150.0])
def test_friction_far_below_where_its_search_begins_is_worth_a_fit(detection_of, monkeypatch, force):
    """Friction that holds what truly slips is of no use to first order; where it is small, so is its first order."""
    monkeypatch.setattr(screening, "MAX_CANDIDATES", 3)
    detection = detection_of(Effect("dry_friction", "front", {"force": force}), runs=HUMPS)
    trial = detection.trials[0]
    candidates = list_candidates(trial.run.vehicle, detection.trials, LAWS)
    locator = EffectLocator(trial.run.vehicle, dict(trial.values))
    gains = screening.FirstOrderGains(detection.base, CurrentModel.of(detection.base), locator, SimulatorPool())
    found = screening.screen(candidates, gains)
    assert any(item.effect.name == "dry_friction" and item.place in ("front", "all suspensions") for item in found)
    assert len(found) < len(candidates)


@pytest.mark.thorough
def test_every_law_at_a_place_that_is_kept_is_worth_a_fit(detection_of, monkeypatch):
    monkeypatch.setattr(screening, "MAX_CANDIDATES", 3)
    detection = detection_of(Effect("dry_friction", "front", {"force": 150.0}), runs=HUMPS)
    trial = detection.trials[0]
    candidates = list_candidates(trial.run.vehicle, detection.trials, LAWS)
    locator = EffectLocator(trial.run.vehicle, dict(trial.values))
    gains = screening.FirstOrderGains(detection.base, CurrentModel.of(detection.base), locator, SimulatorPool())
    found = screening.screen(candidates, gains, "rear")
    assert {item.effect.name for item in found if item.place == "rear"} == {effect.name for effect in LAWS}
    assert len(found) < len(candidates)


@pytest.mark.thorough
@pytest.mark.parametrize("nowhere", [True, False])
def test_a_bending_frame_is_worth_a_fit_where_no_single_force_explains_the_gap(detection_of, monkeypatch, nowhere):
    """A base that bent to it tells a first order of it that any friction beats."""
    monkeypatch.setattr(screening, "MAX_CANDIDATES", 3)
    detection = detection_of(Effect("dry_friction", "front", {"force": 150.0}), runs=HUMPS)
    trial = detection.trials[0]
    candidates = list_candidates(trial.run.vehicle, detection.trials, [*LAWS, EFFECTS["frame_bending"], EFFECTS["tyre_damping"]])
    locator = EffectLocator(trial.run.vehicle, dict(trial.values))
    gains = screening.FirstOrderGains(detection.base, CurrentModel.of(detection.base), locator, SimulatorPool())
    found = screening.screen(candidates, gains, nowhere=nowhere)
    assert any(item.effect.name == "frame_bending" for item in found) == nowhere
    assert len(found) < len(candidates)


@pytest.mark.thorough
def test_laws_of_tyres_are_worth_a_fit_where_their_axles_parameters_are_at_bounds(detection_of, monkeypatch):
    """An unsprung mass at its bound does part of what tyre damping does, which then gains nothing to the first order."""
    monkeypatch.setattr(screening, "MAX_CANDIDATES", 1)
    detection = detection_of(Effect("dry_friction", "front", {"force": 150.0}), runs=HUMPS)
    trial, fit = detection.trials[0], detection.base.least_squares
    candidates = list_candidates(trial.run.vehicle, detection.trials, [*LAWS, EFFECTS["tyre_damping"]])
    locator = EffectLocator(trial.run.vehicle, dict(trial.values))
    x = fit.x.copy()
    x[fit.misfit.problem.space.names.index("mr")] = 0.0
    chosen = []
    for base in (detection.base, replace(detection.base, least_squares=replace(fit, x=x))):
        gains = screening.FirstOrderGains(base, CurrentModel.of(base), locator, SimulatorPool())
        chosen.append({item.label for item in screening.screen(candidates, gains) if item.effect.name == "tyre_damping"})
    assert chosen[1] >= {"tyre_damping at rear", "tyre_damping at all tyres", "tyre_damping at each tyre"}
    assert "tyre_damping at front" not in chosen[1] - chosen[0]
    assert len(chosen[0]) < len(chosen[1])


def test_a_place_is_kept_only_where_the_base_fit_is_strained():
    """It is that of the one force that leaves least, which a body's is not: it stands for several."""
    rows, x = ({0: 1.0},), np.zeros(0)
    places = [
        PlaceResult(Place("body", "body (pitch moment)", rows), 2.0, 1, x),
        PlaceResult(Place("body", "body", rows * 2), 1.1, 2, x),
        PlaceResult(Place("suspension", "rear", rows), 9.0, 1, x),
        PlaceResult(Place("tyre", "front", rows), 7.0, 1, x),
        PlaceResult(Place("channel", "F_az", (), ("F_az",)), 3.0, 1, x),
    ]

    def current(on_bound, effects=()):
        return SimpleNamespace(effects=effects, least_squares=SimpleNamespace(on_bound=on_bound))

    assert search._strained_place(current(("kf",)), places) == "front"
    assert search._strained_place(current(()), places) == ""
    assert search._strained_place(current(("kf",), ("an effect",)), places) == ""
    assert search._strained_place(current(("kf",)), places[:2]) == ""


def test_untrue_wheels_are_worth_a_fit_where_they_gain_more_than_chance_and_than_other_wheels():
    """Over three runs a wheel has a radius and 18 amplitudes and phases, an engine 14 numbers."""

    def kept(**known):
        places = {f"axle{i}": "wheel_runout" for i in range(1, 4)} | {"body": "engine_harmonic", "rear": "dry_friction"}
        candidates = [Candidate(EFFECTS[effect], place, (), ()) for place, effect in places.items()]
        problem = SimpleNamespace(trials=(1, 2, 3))
        gains = SimpleNamespace(of=lambda item: (known.get(item.place, 0.0), ()), misfit=SimpleNamespace(problem=problem))
        return [item.place for item in screening.shaking_in_earnest(candidates, gains)]

    assert kept() == ["rear"]
    assert kept(axle1=62.0, axle2=64.0, body=52.0) == ["axle2", "rear"]
    assert kept(axle1=99.0, axle2=101.0, axle3=400.0, body=54.0) == ["axle2", "axle3", "body", "rear"]


def test_the_start_beside_the_others_is_smaller_than_all_of_them():
    starts = [np.array([40.0, 1.0]), np.array([20.0, 3.0])]
    np.testing.assert_allclose(screening._smaller(starts, np.array([0.2, 0.0])), [2.0, 3.0])
    np.testing.assert_allclose(screening._smaller(starts, np.array([-1.0, 0.0])), [20.0, 3.0])
    assert screening._smaller([np.zeros(0)], np.zeros(0)).size == 0
