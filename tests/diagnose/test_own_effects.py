"""Effects from entry points and from files take part in a diagnosis as the library's do."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from tests.diagnose.conftest import CUBIC, HUMPS
from vehgen.diagnose.fits.candidate import list_candidates
from vehgen.diagnose.localise.localisation import shortlist
from vehgen.diagnose.localise.unknown_force import Place, PlaceResult
from vehgen.diagnose.select import early_end
from vehgen.diagnose.select.ranking import own_numbers
from vehgen.diagnose.select.search import fit_candidates
from vehgen.effects import EFFECTS, load_effects, registry

TWINS = {"cubic_stiffness": "rear", "sensor_gain": "F_az", "engine_harmonic": "body"}
"""An effect of each kind and where it is tried."""
FILE = """effects:
  hardening:
    title: A
    meaning: b
    attaches: suspension
    force: k3*d^3
    parameters:
      k3: {unit: N/m^3, low: 0.01, high: 30, starts: [0.3, 3], times: k/travel^2, meaning: c}
  misread:
    title: A
    meaning: b
    adjusts: gain
    parameters:
      by: {low: 0.7, high: 1.4, starts: [0.9, 1.1], meaning: c}
  hum:
    title: A
    meaning: b
    line: {low: 5 Hz, high: 40 Hz}
"""


@pytest.fixture(scope="module")
def detection(detection_of):
    return detection_of(CUBIC, runs=HUMPS)


def candidates(detection, effects):
    vehicle = detection.problem.trials[0].run.vehicle
    listed = list_candidates(vehicle, detection.trials, effects, detection.floor.noises)
    return [item for item in listed if item.place in TWINS.values()]


@pytest.fixture(scope="module", autouse=True)
def every_candidate():
    """No candidate ends the search before the others are fitted."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(early_end, "MOST_AT_ONCE", 0)
        yield


@pytest.fixture(scope="module")
def known(detection):
    """Return the fits of the library's effect of each kind, by name."""
    listed = candidates(detection, [EFFECTS[name] for name in TWINS])
    fits, _ = fit_candidates(detection, detection.base, [], [item for item in listed if TWINS[item.effect.name] == item.place], quiet)
    return {fit.last.effect.name: fit for fit in fits}


def quiet(*progress):
    """Say nothing."""


def check(fits, known, names):
    """Check that effects fit as those of the library that they are named after."""
    assert {fit.last.effect.name for fit in fits} == set(names)
    for fit in fits:
        twin = known[names[fit.last.effect.name]]
        assert fit.training == pytest.approx(twin.training, rel=1e-3)
        assert own_numbers(fit) == own_numbers(twin)
    assert fits[0].training < 0.1 * fits[1].training


@pytest.mark.thorough
def test_a_file_may_add_effects_of_every_kind(detection, known, tmp_path):
    (tmp_path / "own.yaml").write_text(FILE, encoding="utf-8")
    effects = load_effects(tmp_path / "own.yaml")
    assert {effect.file for effect in effects.values()} == {str(tmp_path / "own.yaml")}
    names = dict(zip(effects, TWINS, strict=True))
    listed = [item for item in candidates(detection, list(effects.values())) if TWINS[names[item.effect.name]] == item.place]
    check(fit_candidates(detection, detection.base, [], listed, quiet)[0], known, names)


@pytest.mark.thorough
def test_packages_may_add_effects_of_every_kind(detection, known, monkeypatch):
    names = {f"own_{name}": name for name in TWINS}
    points = [SimpleNamespace(name=own, load=lambda own=own: replace(EFFECTS[names[own]], name=own)) for own in names]
    monkeypatch.setattr(registry, "entry_points", lambda group: points)
    effects = [registry.library()[own] for own in names]
    listed = [item for item in candidates(detection, effects) if TWINS[names[item.effect.name]] == item.place]
    check(fit_candidates(detection, detection.base, [], listed, quiet)[0], known, names)


def test_a_global_effect_of_ones_own_is_tried_where_no_single_force_suffices(detection):
    effects = [replace(EFFECTS["cubic_stiffness"], name=f"own_{told}", is_global=told) for told in (False, True)]
    listed = candidates(detection, effects)
    x = detection.base.least_squares.x
    body = PlaceResult(Place("link", "elsewhere", ({},), ()), chi=1.0, x=x, unknowns=2)
    left = shortlist(detection.base, listed, [body], [body])
    assert {item.effect.name for item in left} == {"own_True"}


def test_an_effect_that_adjusts_what_one_before_it_adjusts_is_not_tried_beside_it(detection):
    gain = EFFECTS["sensor_gain"]
    own = replace(gain, name="misread")
    first, second = (next(item for item in candidates(detection, [effect]) if item.place == "F_az") for effect in (gain, own))
    other = next(item for item in list_candidates(detection.problem.trials[0].run.vehicle, detection.trials, [own]) if item.place == "R_az")
    assert second.is_among([first])
    assert not other.is_among([first])
    assert np.isfinite(second.shared[0].bounds).all()
