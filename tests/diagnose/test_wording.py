"""Verdicts in plain sentences."""

import pytest

from vehgen.diagnose import wording
from vehgen.diagnose.phrases import effect_words, force_words, place_words
from vehgen.diagnose.verdict import NamedParameter
from vehgen.effects import EFFECTS
from vehgen.files.number_text import interval_words
from vehgen.fit.nuisances import Condition


def found(name, place, **values):
    effect = EFFECTS[name]
    units = {item.name: item.unit for item in effect.parameters}
    parameters = {key: NamedParameter(value, None, units[key]) for key, value in values.items()}
    return effect_words(effect.title, place_words(effect.attaches, place), parameters)


def test_a_named_effect_reads_as_a_sentence():
    assert wording.named([found("dry_friction", "rear", force=446.2)], 1.0) == (
        "Dry friction of about 446 N in the rear suspension: it explains all of what the model missed on runs that it was not fitted to"
    )


@pytest.mark.parametrize(
    ("interval", "expected"),
    [
        ((199_980.0, 200_020.0), "1.9998e+05 to 2.0002e+05"),
        ((1.23456, 2.0), "1.235 to 2"),
        ((3.0, 3.0), "3 to 3"),
        ((-0.5, 0.25), "-0.5 to 0.25"),
    ],
)
def test_the_ends_of_an_interval_differ_where_they_do(interval, expected):
    assert interval_words(interval) == expected


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        (found("cubic_stiffness", "axle2", k3=1.02e8), "Cubic stiffness of about 1.02e+08 N/m^3 in the axle2 suspension"),
        (found("dry_friction", "rear", force=12345.0), "Dry friction of about 12300 N in the rear suspension"),
        (found("tyre_footprint", "all tyres", length=0.12), "Tyre footprint of about 0.12 m in all tyres"),
        (found("dry_friction", "all suspensions", force=400.0), "Dry friction of about 400 N in all suspensions, alike"),
        (
            found("dry_friction", "axle4 and axle5", force=400.0),
            "Dry friction of about 400 N in the suspensions of axle4 and axle5, alike",
        ),
        (found("tyre_liftoff", "front"), "Tyre that leaves the road in the front tyre"),
        (found("hinge_stiffness", "fifth_wheel", k=5e5), "Hinge stiffness of about 500000 N m in the hinge fifth_wheel"),
        (found("sensor_gain", "F_az", gain=1.2), "Sensor gain of about 1.2 at F_az"),
        (found("speed_error", "all runs", scale=1.05), "Speed error of about 1.05 in all runs"),
        (
            found("walking_beam", "axle4+axle5", share=0.9, split=0.5),
            "Walking beam at the axles axle4 and axle5 (share 0.9, split 0.5)",
        ),
        (
            found("cargo_module", "body", mass=200.0, frequency=5.0),
            "Cargo module on the body body (mass 200 kg, frequency 5 Hz)",
        ),
    ],
)
def test_effects_are_told_with_strength_and_place(words, expected):
    assert words == expected


def test_several_effects_ties_and_doubts_are_told():
    friction, gain = found("dry_friction", "rear", force=446.0), found("sensor_gain", "F_az", gain=1.2)
    both = wording.named([friction, gain], 0.973, ["Hysteresis in the rear suspension"])
    assert both == (
        "Dry friction of about 446 N in the rear suspension and sensor gain of about 1.2 at F_az: together they explain 97 % of what the "
        "model missed on runs that they were not fitted to; hysteresis in the rear suspension would do as well as one of these"
    )
    assert wording.ambiguous([friction, gain]).endswith("or sensor gain of about 1.2 at F_az: each explains the runs equally well")
    assert wording.ambiguous([friction] * 5).count("ry friction") == 5
    many = wording.ambiguous([friction, *[gain] * 8])
    assert many.count("sensor gain") == 3
    assert many.endswith("or one of 5 others: each explains the runs equally well")
    assert wording.named([friction], None).endswith("on the runs for fitting; the other runs show no gap")


def test_a_more_general_law_is_told_with_the_force_that_it_supposes():
    words = found("asymmetric_friction", "rear", force=19.0, ratio=1.38)
    force = Condition("", "force_offset", "motor", 0.0771, "N", 1.0)
    assert wording.more_general(words, [wording.constant_force_words(force)]) == (
        "asymmetric dry friction in the rear suspension (force 19 N, ratio 1.38), with a constant force of 0.0771 N beside motor would do "
        "as well; the one with fewer numbers is named"
    )


def test_what_is_in_no_library_is_told_by_where_it_is():
    causes = [force_words("suspension", "rear"), force_words("tyre", "rear"), force_words("sensor", "F")]
    text = wording.not_in_library((12, "dry friction in the front suspension", 3.21), causes)
    assert "of 12 tried, dry friction in the front suspension comes nearest and leaves chi 3.21" in text
    assert text.endswith("an unknown force in the rear suspension, an unknown force in the rear tyre or leaving out the sensor F would")
    assert "would not either" in wording.not_in_library(None, [])
    assert "can live where the model errs" in wording.not_in_library(None, causes)
    assert "more than other values of cf or kf do" in wording.not_in_library(None, causes, ("cf", "kf"))


def test_parts_of_a_gap_are_told_with_what_each_leaves():
    friction, gain = found("dry_friction", "rear", force=446.0), found("sensor_gain", "F_az", gain=1.2)
    assert wording.several_effects([friction, gain], [9.66, 3.0, 1.04], 0.99) == (
        "Dry friction of about 446 N in the rear suspension (9.66 to 3) and sensor gain of about 1.2 at F_az (3 to 1.04), in brackets "
        "the chi before and after each: together they explain 99 % of what the model missed on runs that they were not fitted to, none "
        "does alone"
    )
    assert wording.ranked([(friction, 0.62), (gain, -0.1)]) == (
        "by the share of the gap that each would close alone: Dry friction of about 446 N in the rear suspension 62 % and sensor gain of "
        "about 1.2 at F_az 0 %"
    )


@pytest.mark.parametrize(("share", "words"), [(-0.78, "none"), (0.0, "none"), (0.42, "42 %"), (0.996, "all")])
def test_a_law_that_makes_it_worse_explains_none(share: float, words: str):
    assert wording.best_random_law(8, share).endswith(f"explains {words} of what the model missed")


def test_what_several_suppositions_have_in_common_is_said_once():
    """A note listed fourteen errors, each with the same words behind it."""
    far = " (4 standard deviations of what was thought possible)"
    told = wording.supposed([f"CF_az reads 4 % more{far}", "R was low-passed at 8 Hz", f"CV sits 0.08 m off{far}"]).partition(": ")[2]
    assert (
        told
        == "CF_az reads 4 % more; CV sits 0.08 m off (each 4 standard deviations of what was thought possible); R was low-passed at 8 Hz"
    )
    assert wording.supposed([f"CF_az reads 4 % more{far}"]).endswith(f"CF_az reads 4 % more{far}")
