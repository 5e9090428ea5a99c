"""Which mistakes of the measurement win: over one another, and over effects."""

from types import SimpleNamespace

import pytest

from vehgen.diagnose.inputs import judging
from vehgen.diagnose.inputs.fault import Hypothesis, MeasurementFault, always


def supposed(kind, left, sigmas):
    """Return a hypothesis with its refit: what it leaves, and what it supposes of runs beside."""
    fit = SimpleNamespace(x=None, misfit=SimpleNamespace(adjusted=lambda x: x), conditions=lambda: [SimpleNamespace(sigmas=sigmas)])
    return Hypothesis((), always(MeasurementFault(kind, (), (), kind, "")), 0.25), (fit, left)


@pytest.mark.parametrize(
    ("others", "told"),
    [((0.01, 0.5), "easy"), ((0.2, 0.5), "strained"), ((0.01, 4.0), "strained")],
    ids=["leaves noise", "leaves more than noise", "strained too"],
)
def test_of_mistakes_that_leave_noise_one_that_supposes_nothing_else_is_told(monkeypatch, others, told):
    both = [supposed("strained", -0.05, 4.0), supposed("easy", *others)]
    fits = {id(hypothesis): fit for hypothesis, fit in both}
    monkeypatch.setattr(judging, "PLAIN", ())
    monkeypatch.setattr(judging, "SUBTLE", tuple(lambda case, item=item: [item] for item, _ in both))
    case = SimpleNamespace(excess=3.0, judge=lambda item: fits[id(item)], accept=lambda *_: setattr(case, "excess", 0.0))
    (fault,) = judging.find_mistakes(case)
    assert fault.kind == told


@pytest.mark.parametrize(("kind", "unsure", "told"), [("low_pass", True, True), ("low_pass", False, False), ("hump", True, False)])
def test_a_low_pass_wins_over_an_effect_that_leaves_something_where_it_does_nearly_as_well(monkeypatch, kind, unsure, told):
    """A footprint left 0.066 of the excess of recordings through a low-pass at 8 Hz, which itself left 0.111: it had cut the noise, too."""
    found = (SimpleNamespace(kind=kind),)
    monkeypatch.setattr(judging, "find_mistakes", lambda case: found)
    monkeypatch.setattr(judging, "BaseRefits", lambda detection: SimpleNamespace(excess=0.111, first_excess=1.0))
    detection, footprint = SimpleNamespace(is_quiet=False, chi=5.667), SimpleNamespace(chi=1.745)
    assert judging.explain_gap(detection, footprint, unsure) == (found if told else ())
