"""Each of the nastiest files is refused in one line that says where, and does nothing."""

from __future__ import annotations

import pytest

from tests.fuzzing.corpus import CORPUS, Nasty
from tests.fuzzing.harness import Worker
from tests.fuzzing.judge import ACCEPTED, FAULT


@pytest.mark.thorough
@pytest.mark.parametrize("nasty", CORPUS, ids=lambda nasty: ascii(nasty.name))
def test_it_is_refused_where_it_is_wrong(worker: Worker, nasty: Nasty):
    verdict = worker.try_case(nasty.case)
    assert verdict.outcome != FAULT, (verdict.reasons, verdict.answer.crash)
    if nasty.refused:
        assert verdict.outcome != ACCEPTED
    if nasty.place is not None:
        assert verdict.answer.place is not None
        assert verdict.answer.place[:2] == nasty.place, verdict.answer.message


def test_names_are_told_apart():
    names = [nasty.name for nasty in CORPUS]
    assert sorted(set(names)) == sorted(names)
