"""How answers on rigs count."""

import pytest
from benchmarks.measured_world.page import page
from benchmarks.measured_world.rigs.judging import judged_rig, rig_rows


def hidden(name, place="rear", listed=True, accepted=None, **values):
    return {"name": name, "place": place, "values": values, "listed": listed, "accepted": accepted or {}}


def truth(*effects, distinct=20.0):
    return {"effects": list(effects), "strength": {"raw": 30.0, "distinct": distinct}}


def told(name, place="rear", **parameters):
    return {"name": name, "place": place, "parameters": parameters}


def answer(verdict, *effects):
    return {"verdict": verdict, "effects": list(effects)}


FRICTION = hidden("dry_friction", force=80.0)
PLAY = hidden("free_play", listed=False, gap=1e-3)
APART = hidden("directional_friction", "rail", False, {"dry_friction": {"force": 20.0}}, bump=15.0, rebound=25.0)


@pytest.mark.parametrize(
    ("case", "said", "counted"),
    [
        (truth(FRICTION), answer("named", told("dry_friction")), "named right"),
        (truth(FRICTION), answer("named", told("dry_friction", "front")), "right law, wrong place"),
        (truth(FRICTION), answer("named", told("hysteresis")), "named wrong"),
        (truth(FRICTION), answer("named", told("dry_friction"), told("bump_stop")), "named right, with another"),
        (truth(FRICTION), answer("ambiguous", told("hysteresis"), told("dry_friction")), "tie with the truth in it"),
        (truth(FRICTION), answer("ambiguous", told("hysteresis"), told("bump_stop")), "tie without the truth"),
        (truth(FRICTION), answer("no_missing_effect"), "missed"),
        (truth(FRICTION, distinct=0.3), answer("no_missing_effect"), "too weak, and not seen"),
        (truth(FRICTION, distinct=0.3), answer("too_weak"), "too weak, and said so"),
        (truth(FRICTION), answer("too_weak"), "called too weak"),
        (truth(FRICTION), answer("not_in_library"), "called not in library"),
        (truth(FRICTION), answer("measurement_fault"), "false fault"),
        (truth(FRICTION), answer("crash"), "crash"),
        (truth(FRICTION, hidden("dry_friction", "front", force=70.0)), answer("named", told("dry_friction")), "one of two named"),
        (truth(PLAY), answer("not_in_library"), "not in library, right"),
        (truth(PLAY), answer("named", told("dry_friction")), "named wrong"),
        (truth(APART), answer("named", told("dry_friction", "rail")), "named right"),
        (truth(APART), answer("not_in_library"), "not in library, right"),
        (truth(), answer("no_missing_effect"), "healthy called healthy"),
        (truth(), answer("named", told("dry_friction")), "false effect"),
        (truth(), answer("not_in_library"), "false gap"),
        (truth(), answer("measurement_fault"), "false fault"),
    ],
)
def test_every_answer_has_its_judgement(case, said, counted):
    assert judged_rig(case, said) == counted


def test_intervals_are_compared_with_the_values_of_the_law_that_was_told():
    force = {"value": 82.0, "interval": [78.0, 86.0], "unit": "N"}
    said = answer("named", told("dry_friction", force=force))
    (row,) = rig_rows(truth(FRICTION), said)
    assert row == {"family": "dry_friction", "name": "force", "truth": 80.0, "value": 82.0, "low": 78.0, "high": 86.0}
    (row,) = rig_rows(truth(APART), answer("named", told("dry_friction", "rail", force={**force, "interval": None})))
    assert (row["truth"], row["low"]) == (20.0, None)
    assert rig_rows(truth(FRICTION), answer("named", told("hysteresis", force=force))) == []


def test_the_page_counts_rigs_and_their_intervals():
    said = answer("named", told("dry_friction", force={"value": 82.0, "interval": [78.0, 86.0]})) | {"seconds": 2.0}
    record = {"case": "rigs_000", "kind": "rigs", "vehicle": "dyno", "recorder": "declared", "fault": None, "answer": said}
    record |= {**truth(FRICTION), "judged": "named right", "rows": rig_rows(truth(FRICTION), said)}
    text = page([record])
    assert "## Test rigs: 1 cases" in text
    assert "| named right | 1 | 1 |" in text
    assert "| dry_friction | 1 | 0 | 100" in text
