"""An effect is added only where the runs tell its size."""

from types import SimpleNamespace

import pytest

from vehgen.diagnose import combining
from vehgen.diagnose.combining import Combiner
from vehgen.diagnose.select import criteria
from vehgen.diagnose.select.criteria import is_told
from vehgen.diagnose.verdict import NamedParameter
from vehgen.effects import EFFECTS


@pytest.mark.parametrize(
    ("effect", "interval", "disagree", "told"),
    [
        ("sensor_delay", (-0.130, 0.075), [], False),
        ("sensor_delay", (-0.130, -0.010), [], True),
        ("sensor_gain", (0.97, 1.12), [], False),
        ("sensor_gain", (1.03, 1.12), [], True),
        ("speed_error", (0.93, 0.97), [], True),
        ("sensor_position", (-0.2, 0.3), [], False),
        ("bump_stop", (-1e5, 5e5), [], True),
        ("bump_stop", (1e5, 5e5), ["k from 1e5 to 3e6 N/m"], False),
        ("sensor_gain", None, [], True),
    ],
)
def test_an_interval_that_holds_no_effect_tells_nothing_of_a_sensor_or_a_run(monkeypatch, effect, interval, disagree, told):
    own = EFFECTS[effect]
    values = {item.name: NamedParameter(1.0, interval, item.unit) for item in own.parameters}
    monkeypatch.setattr(criteria, "estimate", lambda fit: values)
    monkeypatch.setattr(criteria, "excluded", lambda fit: disagree)
    assert is_told(SimpleNamespace(last=SimpleNamespace(effect=own))) == told


@pytest.mark.parametrize(("second", "chain"), [("vague", ["first"]), ("clear", ["first", "clear", "clear"])])
def test_a_further_effect_whose_size_is_not_told_is_not_added(monkeypatch, second, chain):
    """All else speaks for it: something is left, it closes that, and not by chance."""
    monkeypatch.setattr(combining, "unfinished", lambda fit, base: True)
    monkeypatch.setattr(combining, "adds", lambda look, fit: True)
    monkeypatch.setattr(combining, "p_value_of", lambda look, fit, tried: 1e-9)
    monkeypatch.setattr(combining, "is_told", lambda fit: fit == "clear")
    look = SimpleNamespace(stopped=False, fits=[second])
    combiner = Combiner(None, None, 100, lambda known: look, lambda known: (), [])
    assert combiner.further(["first"]) == chain
