"""Which candidates are worth fitting, by what the place test found."""

from dataclasses import replace

import pytest
from benchmarks.hidden_effects.generator import Effect

from tests.diagnose.conftest import CUBIC, HUMPS
from vehgen.diagnose.fits.candidate import list_candidates
from vehgen.diagnose.localise.localisation import shortlist
from vehgen.diagnose.localise.unknown_force import Place, PlaceResult
from vehgen.diagnose.select import search
from vehgen.effects import EFFECTS
from vehgen.effects.evidence import PlaceEvidence

GAIN = Effect("sensor_gain", "F_az", {"error": 0.2})


def test_a_channel_whose_absence_leaves_more_than_noise_excludes_nothing(detection_of):
    detection = detection_of(runs=HUMPS)
    base = detection.base
    every = list_candidates(detection.trials[0].run.vehicle, detection.trials, list(EFFECTS.values()))

    def left(chi):
        without = [PlaceResult(Place("channel", "R_az", (), ("R_az",)), chi, 1, base.least_squares.x)]
        return shortlist(base, every, without, without)

    assert left(1.4) == every
    found = {item.label for item in left(1.05)}
    assert "sensor_gain at R_az" in found
    assert "dry_friction at rear" not in found


@pytest.mark.slow
@pytest.mark.parametrize(
    ("hidden", "tries_all"), [(CUBIC, True), (Effect("sensor_gain", "F_az", {"error": 0.2}), False)], ids=["a spring", "a gain"]
)
def test_where_no_effect_of_a_channel_explains_what_channels_may_all_others_are_tried(detection_of, monkeypatch, hidden, tries_all):
    detection = detection_of(hidden, runs=HUMPS)
    every = list_candidates(detection.trials[0].run.vehicle, detection.trials, [EFFECTS["cubic_stiffness"], EFFECTS["sensor_gain"]])
    base = detection.base
    silent = [PlaceResult(Place("channel", name, (), (name,)), 1.0, 1, base.least_squares.x) for name in ("F_az", "R_az")]
    monkeypatch.setattr(search, "localise", lambda current, runner: (silent, silent))
    fits = search.search_round(detection, base, every).fits
    assert any(fit.last.effect.name == "cubic_stiffness" for fit in fits) == tries_all
    assert fits[0].last.effect.name == ("cubic_stiffness" if tries_all else "sensor_gain")


def test_an_engines_line_is_tried_where_runs_show_one_though_another_place_suffices():
    """The base of a car had bent to a line of 18.8 Hz so that a force at the front tyre explained the rest."""
    engine = EFFECTS["engine_harmonic"]
    elsewhere = PlaceEvidence(frozenset({"front"}), frozenset({"tyre"}), True, frozenset())
    assert not engine.is_likely("body", elsewhere)
    assert engine.is_likely("body", replace(elsewhere, steady_lines=True))
    assert not EFFECTS["frame_bending"].is_likely("body", replace(elsewhere, steady_lines=True))
