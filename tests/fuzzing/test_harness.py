"""The harness sees every kind of mischief: a fuzzer that finds nothing must be able to find something."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from tests.fuzzing.cases import Case, read_case
from tests.fuzzing.faults import Faults
from tests.fuzzing.harness import Worker
from tests.fuzzing.judge import ACCEPTED, FAULT, REFUSED, Limits
from tests.fuzzing.mischief import EXPECTED, MISCHIEF


def mischief(name: str) -> Case:
    return Case("mischief", {"mischief.yaml": name.encode()}, "mischief.yaml")


@pytest.mark.thorough
@pytest.mark.parametrize("name", MISCHIEF)
def test_mischief_is_seen(worker: Worker, name: str):
    verdict = worker.try_case(mischief(name), Limits(0.5), patience=1.0)
    if expected := EXPECTED[MISCHIEF[name]]:
        assert verdict.outcome == FAULT
        assert any(reason.startswith(expected) for reason in verdict.reasons), verdict.reasons
    else:
        assert verdict.outcome == (REFUSED if name == "refuse" else ACCEPTED), verdict.reasons


@pytest.mark.thorough
def test_a_file_that_nobody_can_have_is_not_missed(worker: Worker):
    case = mischief("refuse")
    assert worker.try_case(replace(case, files={**case.files, "x" * 300: b""})).outcome == REFUSED


@pytest.mark.thorough
def test_a_fault_is_kept_once_and_done_again(worker: Worker, tmp_path: Path):
    faults = Faults()
    for number, name in enumerate(("crash", "crash", "two_lines", "refuse")):
        faults.add(number, mischief(name), worker.try_case(mischief(name)))
    assert faults.outcomes == {("mischief", FAULT): 3, ("mischief", REFUSED): 1}
    assert sorted(faults.counts.values()) == [1, 2]
    faults.write(tmp_path)
    kept = sorted(path.name for path in tmp_path.iterdir())
    assert kept == ["mischief-001", "mischief-002"]
    assert read_case(tmp_path / kept[0]) == mischief("crash")
    assert worker.try_case(read_case(tmp_path / kept[0])).outcome == FAULT


@pytest.mark.thorough
def test_the_files_of_a_fault_in_the_folder_of_results_are_kept(worker: Worker, tmp_path: Path):
    case = mischief("crash")
    case, faults = replace(case, files={**case.files, "out/given.txt": b"x"}), Faults()
    faults.add(0, case, worker.try_case(case))
    faults.write(tmp_path)
    assert read_case(tmp_path / "mischief-001") == case
