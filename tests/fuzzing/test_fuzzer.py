"""A short run of the fuzzer; the long one is `python -m benchmarks.fuzz`."""

from __future__ import annotations

import pytest

from tests.fuzzing.cases import FORMATS
from tests.fuzzing.faults import Faults
from tests.fuzzing.fuzzer import make_case
from tests.fuzzing.harness import Worker
from tests.fuzzing.healthy import healthy
from tests.fuzzing.judge import ACCEPTED

FILES = 108


@pytest.mark.thorough
def test_mutilated_files_are_read_or_clearly_refused(worker: Worker):
    faults = Faults()
    for number in range(FILES):
        case = make_case(1, number)
        faults.add(number, case, worker.try_case(case))
    assert not faults.counts, "\n" + faults.list()
    assert all(faults.outcomes[format, "refused"] > 0 for format in FORMATS)


@pytest.mark.thorough
def test_healthy_files_are_accepted(worker: Worker):
    for cases in healthy().values():
        for case in cases:
            verdict = worker.try_case(case)
            assert verdict.outcome == ACCEPTED, (case.format, case.main, verdict.reasons, verdict.answer.message, verdict.answer.crash)


def test_a_seed_gives_the_same_files():
    assert [make_case(5, number) for number in range(16)] == [make_case(5, number) for number in range(16)]
    assert make_case(5, 3) != make_case(6, 3)
