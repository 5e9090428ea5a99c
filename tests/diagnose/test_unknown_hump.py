"""Humps that nobody measured: declared as they look, and found from the passes."""

import re

import pytest
from benchmarks.hidden_effects.generator import Case, write_case

from tests.diagnose.conftest import RUNS
from vehgen.diagnose.detect.detection import detect
from vehgen.fit.trial import load_trials
from vehgen.vehicle import load_vehicle


@pytest.mark.thorough
@pytest.mark.parametrize("factor", [0.7, 1.4])
def test_height_and_length_are_found_where_the_run_file_guesses_them(tmp_path, factor):
    vehicle = load_vehicle("sedan2")
    true = vehicle.all_values(vehicle.values())
    true |= {"kf": 0.9 * true["kf"], "cr": 1.15 * true["cr"]}
    (tmp_path / "runs").mkdir()
    (tmp_path / "truth").mkdir()
    write_case(Case("sedan2", true, (), RUNS[:3], seed=3), tmp_path / "runs", tmp_path / "truth")
    for path in (tmp_path / "runs").glob("*.yaml"):
        text = re.sub(r"(height|length): ([\d.]+)", lambda found: f"{found[1]}: {factor * float(found[2]):.6g}", path.read_text())
        path.write_text(text + "\nuncertainty: {height: 0.5, length: 0.5, form: 0.5}\n")
    found = detect(load_trials(sorted((tmp_path / "runs").glob("*.yaml"))))
    assert found.is_quiet
    errors = [item for part in found.base.parts for item in part.conditions() if item.name in ("height", "length")]
    assert len(errors) == 6
    for item in errors:
        assert factor * (1 + item.value) == pytest.approx(1.0, abs=0.01), item


@pytest.mark.thorough
def test_a_guess_that_claims_to_be_exact_leaves_a_gap(tmp_path):
    (tmp_path / "truth").mkdir()
    write_case(Case("sedan2", None, (), RUNS[:3], seed=3), tmp_path, tmp_path / "truth")
    for path in tmp_path.glob("*.yaml"):
        path.write_text(re.sub(r"length: ([\d.]+)", lambda found: f"length: {1.4 * float(found[1]):.6g}", path.read_text()))
    assert not detect(load_trials(sorted(tmp_path.glob("*.yaml")))).is_quiet
