"""When an effect counts as found, as one of a pair, or as all there is: the shares of the gap that docs and thresholds tell."""

from types import SimpleNamespace

import pytest

from vehgen.diagnose.fits.candidate import Candidate
from vehgen.diagnose.select import criteria
from vehgen.diagnose.select.criteria import (
    adds,
    closes_training,
    explained_shares,
    freed_instead,
    needs_both,
    p_value_of,
    passes,
    seeds,
    unfinished,
)
from vehgen.diagnose.select.ranking import does_as_well
from vehgen.effects import EFFECTS


def fit(training, validation=None, name="cubic_stiffness", place="rear"):
    """Return what stands for a fit of one effect by the mean squares that it leaves on training and validation runs."""
    own = Candidate(EFFECTS[name], place, (f"{name}_{place}",))
    return SimpleNamespace(
        training=training,
        validation=training if validation is None else validation,
        last=own,
        effects=(own,),
        key=((name, place),),
        least_squares=SimpleNamespace(on_bound=(), adjusted_to_bounds=()),
    )


def looked(*fits, current, faint=False, idle=()):
    return SimpleNamespace(current=current, fits=list(fits), faint=faint, idle=list(idle))


@pytest.mark.parametrize(
    ("before", "training", "validation", "found"),
    [
        (21.0, 2.9, 2.9, True),  # of an excess of 20 it leaves a tenth
        (21.0, 3.2, 2.9, False),
        (21.0, 2.9, 3.2, False),
        (1.5, 1.24, 1.3, True),  # chi 1.15 is enough, where half of the gap is closed
        (1.5, 1.27, 1.3, False),
        (1.5, 1.24, 1.34, False),
        (21.0, 2.9, float("nan"), False),
    ],
)
def test_a_law_passes_where_it_closes_the_gap_on_both_kinds_of_runs(before, training, validation, found):
    assert passes(fit(training, validation), fit(before)) is found


@pytest.mark.parametrize(
    ("mean_square", "best", "before", "as_well"),
    [
        (1.55, 1.2, 19.0, True),  # a fiftieth of the gap, 0.38, lies between, and it is within three times the best's excess
        (1.59, 1.2, 19.0, False),
        (1.14, 1.05, 19.0, True),
        (1.25, 1.05, 19.0, False),
        (1.05, 1.0, 1.0, True),  # half of what counts as noise
        (1.07, 1.0, 1.0, False),
    ],
)
def test_fits_do_as_well_within_a_fiftieth_of_the_gap_and_three_times_the_excess(mean_square, best, before, as_well):
    assert does_as_well(mean_square, best, before) is as_well


def test_freed_parameters_stand_in_for_an_effect_that_is_no_likelier(monkeypatch):
    base, freed, other = fit(21.0), fit(1.1), fit(1.1, place="front")
    merits = {id(freed): 100.0, id(other): 90.0}
    monkeypatch.setattr(criteria, "merit", lambda item: merits[id(item)])
    assert closes_training(freed, base)
    assert freed_instead(looked(other, current=base, idle=[freed]), base) is None
    merits[id(other)] = 110.0
    assert freed_instead(looked(other, current=base, idle=[freed]), base) is freed
    assert freed_instead(looked(current=base, idle=[freed]), base) is freed
    assert freed_instead(looked(other, current=base, idle=[fit(5.0)]), base) is None


def test_shares_of_the_gap_that_is_explained_and_chance_among_all_that_were_tried(monkeypatch):
    base = fit(21.0)
    told = explained_shares(looked(fit(2.0), fit(11.0), fit(25.0), current=base), base)
    assert [share for _, share in told] == pytest.approx([0.95, 0.5, -0.2])
    monkeypatch.setattr(criteria, "p_value", lambda current, item, numbers: 1e-4)
    monkeypatch.setattr(criteria, "own_numbers", lambda item: 1)
    assert p_value_of(looked(current=base), fit(2.0), 40) == pytest.approx(4e-3)
    assert p_value_of(looked(current=base), fit(2.0), 40_000) == 1.0


@pytest.mark.parametrize(
    ("before", "training", "validation", "left"),
    [(1001.0, 5.5, 5.5, False), (1001.0, 6.5, 5.5, True), (1001.0, 5.5, 6.5, True), (11.0, 1.2, 1.2, False), (11.0, 1.23, 1.2, True)],
)
def test_more_than_noise_and_than_a_laws_form_is_left(before, training, validation, left):
    """Chi 1.1, or a two-hundredth of the gap."""
    assert unfinished(fit(training, validation), fit(before)) is left


def test_a_further_effect_leaves_a_quarter_or_at_the_place_of_another_noise_from_another_part():
    current = fit(5.0, name="sensor_gain", place="F_az")
    assert adds(looked(fit(1.9), current=current), fit(1.9))
    assert not adds(looked(fit(2.1), current=current), fit(2.1))
    assert not adds(looked(fit(1.9, 2.1), current=current), fit(1.9, 2.1))
    beside = fit(5.0, name="cubic_stiffness")
    tyre, spring = "tyre_damping", "quadratic_damping"
    assert EFFECTS[tyre].attaches != EFFECTS[spring].attaches == EFFECTS["cubic_stiffness"].attaches
    assert adds(looked(current=beside), fit(1.1, name=tyre))
    assert not adds(looked(current=beside), fit(1.9, name=tyre))
    assert not adds(looked(current=beside), fit(1.1, name=spring))
    assert adds(looked(current=beside), fit(1.1, name=spring, place="front"))


def test_a_further_effect_with_which_more_than_two_tie_is_not_added():
    current = fit(5.0, name="sensor_gain", place="F_az")
    own = fit(1.05)
    rivals = [fit(1.05, name=name, place="front") for name in ("quadratic_damping", "hysteresis", "bump_stop")]
    assert adds(looked(own, *rivals[:2], current=current), own)
    assert not adds(looked(own, *rivals, current=current), own)


def test_pairs_begin_with_the_best_at_two_places_and_need_both_of_their_effects():
    base = fit(21.0)
    first, same_place, second, third = fit(9.0), fit(10.0, name="hysteresis"), fit(12.0, place="front"), fit(13.0, place="mid")
    assert seeds(looked(first, same_place, second, third, current=base)) == [first, second]
    assert seeds(looked(fit(18.5), current=base)) == []  # it leaves more than 85 %
    pair = fit(2.0, place="front")
    assert needs_both(pair, [fit(4.1, place="front"), fit(2.0)])
    assert not needs_both(pair, [fit(3.9, place="front")])
