"""What the recordings of a case could tell of the effect that is hidden in it."""

from dataclasses import replace

import pytest
from benchmarks.hidden_effects.generator.cases import Effect
from benchmarks.measured_world.make import write_case
from benchmarks.measured_world.sets import draw_case
from benchmarks.measured_world.telling.falls import price
from benchmarks.measured_world.telling.measure import measure_set
from benchmarks.measured_world.telling.rule import is_tellable, levels
from benchmarks.measured_world.telling.table import missed, telling_page
from benchmarks.measured_world.telling.true_law import true_start

HIDDEN = {"name": "cubic_stiffness", "place": "rear", "values": {"k3": 1.0}}


def record(hidden, *fits, **more):
    return {
        "set": "effects",
        "case": "effects_000",
        "vehicle": "sedan2",
        "recorder": "logger",
        "hidden": hidden,
        "chi": 1.0,
        "fits": fits,
    } | more


def fit(beyond, again=1.0, true=True, name="cubic_stiffness"):
    return {"name": name, "beyond_price": beyond, "validation_fall": again, "true": true}


def test_a_law_must_fall_further_than_any_law_does_without_an_effect_and_on_validation_runs():
    bare = [
        record(None, fit(3.0), fit(40.0, true=False)),
        record(None, fit(25.0)),
        record(None, fit(90.0, true=False, name="engine_harmonic")),
    ]
    known = levels(bare)
    assert known == {("sedan2", False): 40.0, ("sedan2", True): 90.0}
    assert is_tellable(record(HIDDEN, fit(41.0)), known)
    assert not is_tellable(record(HIDDEN, fit(39.0)), known)
    assert not is_tellable(record(HIDDEN, fit(410.0, again=-0.1)), known)
    assert is_tellable(record(HIDDEN, failed="crash"), known)  # what was not measured excuses nothing


def scored(case, judged, name="cubic_stiffness"):
    return {"case": case, "effects": [{"name": name, "place": "rear"}], "judged": judged}


def test_only_measured_misses_that_cannot_be_told_are_left_out_of_the_rate():
    cases = [scored("a", "named right"), scored("b", "too_weak"), scored("c", "no_missing_effect"), scored("d", "import_refused")]
    cases += [scored("e", "named wrong"), scored("f", "not_in_library", "fluid_mount"), scored("g", "ambiguous, truth among them")]
    assert missed(cases) == ["b", "c"]
    measured = [
        record(None, fit(40.0)),
        record(HIDDEN, fit(10.0), judged="too_weak"),
        record(HIDDEN, fit(50.0), judged="no_missing_effect"),
    ]
    measured += [record(HIDDEN, fit(10.0), judged="named wrong"), record(HIDDEN, failed="refused", judged="import_refused")]
    page = telling_page(measured, cases)
    assert "| of all | 1 of 6 | 17 % | 2 of 6 |" in page
    assert "| of those that can be told | 1 of 5 | 20 % | 2 of 5 |" in page


def test_the_true_numbers_are_said_in_the_words_of_the_library():
    from types import SimpleNamespace

    def candidate(*names):
        return SimpleNamespace(effect=SimpleNamespace(parameters=[SimpleNamespace(name=name) for name in names]))

    mount = {"name": "damper_mount", "place": "front", "values": {"time": 0.01}}
    assert true_start(candidate("k"), mount, {"cf": 3000.0}, [1.0]) == pytest.approx([300e3])
    tilt = {"name": "sensor_tilt", "place": "F", "values": {"angle": 0.3}}
    assert true_start(candidate("tilt", "height"), tilt, {}, [0.1, 0.0]) == pytest.approx([0.3, 0.0])


@pytest.mark.slow
def test_a_strong_law_can_be_told_and_the_same_law_of_no_size_cannot(tmp_path):
    """The weaker one is the twin without the law: neither its true law nor any other reaches what the strong one does."""
    case = draw_case("trial", 31, "effects", 0, "logger")
    strong = replace(case, effects=(Effect("quadratic_damping", "front", {"c2": 4000.0}),), strength=10.0)
    none = replace(case, effects=(Effect("quadratic_damping", "front", {"c2": 1e-3}),), strength=0.0)
    for name, one in (("strong", strong), ("none", none), ("twins", replace(case, effects=(), strength=None))):
        write_case(one, tmp_path / name)
        twins_of = tmp_path / "strong" if name == "twins" else None
        measure_set(tmp_path / name, tmp_path / "out.jsonl", [case.name], twins_of)
    from benchmarks.measured_world.page import read

    first, weak, bare = read([tmp_path / "out.jsonl"])
    known = levels([bare])
    assert is_tellable(first, known)
    assert not is_tellable(weak, known)
    told = next(item for item in first["fits"] if item["true"])
    assert told["numbers"]["c2"] == pytest.approx(4000.0, rel=0.2)
    assert told["fall"] - told["beyond_price"] == pytest.approx(price(1, first["residuals"]))
    assert told["fall"] > 1000.0
    assert bare["asked"]["name"] == "quadratic_damping"
