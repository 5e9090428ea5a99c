"""The carriage of docs/emps.md, where its recordings are at hand: friction named from the raw file, and as good on pulses never seen."""

import importlib
import json
from pathlib import Path

import pytest

from vehgen.commands import main
from vehgen.diagnose.api import diagnose

FOLDER = Path(__file__).parents[2] / "docs" / "examples" / "emps"
DATA = "shared/data/emps/DATA_EMPS.mat"


@pytest.fixture(scope="module")
def emps():
    path = next((parent / DATA for parent in Path(__file__).parents if (parent / DATA).is_file()), None)
    if path is None:
        pytest.skip("no EMPS data here")
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(str(FOLDER))
        for name in ("prepare", "force_error"):
            patch.delitem(importlib.sys.modules, name, raising=False)
        yield importlib.import_module("prepare"), importlib.import_module("force_error"), path
        for name in ("prepare", "force_error"):
            importlib.sys.modules.pop(name, None)


@pytest.mark.slow
def test_friction_of_a_real_carriage_is_named_from_its_raw_file(emps, tmp_path):
    prepare, force_error, path = emps
    runs = prepare.write_runs(path, tmp_path / "runs")
    out = tmp_path / "diagnosis"
    main(["diagnose", str(FOLDER / "emps.yaml"), *map(str, runs), "--out", str(out)])
    verdict = json.loads((out / "diagnosis.json").read_text(encoding="utf-8"))
    assert verdict["verdict"] == "named"
    assert any(note.startswith("asymmetric dry friction in the link rail") for note in verdict["notes"])
    vehicle = out / "emps_with_dry_friction.yaml"
    assert vehicle.is_file()
    share, constant = force_error.force_error(vehicle, path.with_name("DATA_EMPS_PULSES.mat"))
    assert share < 0.065
    assert constant == pytest.approx(3.2, abs=0.3)


def halved(path):
    """Cut a run's table to the first half of its time."""
    header, *rows = path.read_text(encoding="utf-8").splitlines()
    path.write_text("\n".join([header, *rows[: (len(rows) + 1) // 2]]) + "\n", encoding="utf-8")


@pytest.mark.slow
def test_half_periods_cannot_tell_friction_from_a_constant_force(emps, tmp_path):
    runs = emps[0].write_runs(emps[2], tmp_path)
    for run in runs:
        for table in tmp_path.glob(f"{run.stem}*.csv"):
            halved(table)
    verdict = diagnose(FOLDER / "emps.yaml", runs).verdict
    assert verdict.verdict == "insufficient_data"
    assert "c of 0.4" in verdict.reason
