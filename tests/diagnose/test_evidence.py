"""The evidence of a diagnosis: what its page shows, from the fitted models and from a file alike."""

import html
import json
import re

import numpy as np
import pytest

from vehgen.commands import main
from vehgen.diagnose.collecting import collect, run_chis
from vehgen.diagnose.detect.detection import detect
from vehgen.diagnose.pipeline import with_evidence
from vehgen.diagnose.result import Decided, Diagnosis, DiagnosisModels
from vehgen.diagnose.verdict import Gap, Verdict
from vehgen.errors import InputError
from vehgen.files.results import read_json
from vehgen.fit.trial import load_trials
from vehgen.report.pages.diagnosis_page import write_diagnosis_page
from vehgen.vehicle import load_vehicle


@pytest.fixture(scope="module")
def written(told):
    """The folder that `diagnose` writes for a sedan with a cubic spring."""
    return told[1]


@pytest.mark.thorough
def test_report_draws_the_same_page_from_the_file(written, tmp_path, capsys):
    assert main(["report", str(written / "diagnosis.json"), "--out", str(tmp_path), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["files"] == [str(tmp_path / "report.html")]
    assert (tmp_path / "report.html").read_bytes() == (written / "report.html").read_bytes()


@pytest.mark.thorough
def test_the_page_tells_what_it_was_made_from_and_rings_the_place(written):
    origin = read_json(written / "diagnosis.json")["evidence"]["origin"]
    page = (written / "report.html").read_text(encoding="utf-8")
    assert origin["command"].startswith("vehgen diagnose ")
    assert html.escape(origin["command"]).replace("&#x27;", "&#39;") in page
    assert origin["made_on"] in page
    assert {"numpy", "python", "vehgen"} <= set(origin["versions"])
    assert any(name.endswith(".csv") for name in origin["inputs"])
    assert all(f"{name}: SHA-256 {digest}" in page and len(digest) == 64 for name, digest in origin["inputs"].items())
    assert 'id="vehicle-marked-suspension-rear"' in page
    assert "marked-suspension-front" not in page


@pytest.mark.thorough
def test_the_file_holds_the_verdict_and_its_evidence(written):
    path = written / "diagnosis.json"
    assert path.stat().st_size < 2_000_000
    data = read_json(path)
    assert data["verdict"] == "named"
    assert data["reason"].startswith("Cubic stiffness of about 1")
    assert data["reason"].endswith("in the rear suspension: it explains all of what the model missed on runs that it was not fitted to")
    assert data["gap"]["runs"][0].keys() == {"run", "untouched", "before", "after"}
    diagnosis = Diagnosis.from_dict(data)
    assert Diagnosis.from_dict(diagnosis.to_dict()) == diagnosis
    assert {item.label for item in diagnosis.evidence.places if item.passes} == {"suspension rear", "tyre rear"}
    assert {item.run for item in diagnosis.evidence.histories} == {"high"}
    assert diagnosis.evidence.steps[-1].validation == pytest.approx(1.0, abs=0.1)
    assert diagnosis.evidence.force.units == ("m", "m/s", "N")
    assert {item.run for item in diagnosis.evidence.responses} == {"high"}
    for item, residual in zip(diagnosis.evidence.responses, diagnosis.evidence.histories, strict=True):
        assert item.measured - item.simulated == pytest.approx(residual.simulated, abs=2e-4 * np.abs(item.measured).max())
    with pytest.raises(InputError, match="read from a file"):
        _ = diagnosis.detection


@pytest.mark.thorough
@pytest.mark.parametrize(
    ("place", "value", "said"),
    [
        (("evidence", "steps", 0, "training"), "much", "`evidence.steps[0].training`: input should be a valid number, found 'much'"),
        (("effects", 0, "parameters"), [], "`verdict.effects[0].parameters`"),
        (("evidence", "psds", 0, "x"), [1.0], "`evidence.psds[0]`: value error, two curves"),
        (("evidence", "force", "travel", "x"), [0.0, 1.0], "`evidence.force.travel`: value error, curves of one length"),
        (("verdict",), "sure", "`verdict.verdict`: input should be 'no_missing_effect'"),
        (("evidence", "places", 0, "chi"), 1e308, "cannot be drawn"),
        (("format",), "vehgen invoice", "holds the result of a 'invoice', which has no page"),
    ],
)
def test_a_damaged_file_is_refused_in_one_line(written, tmp_path, capsys, place, value, said):
    data = read_json(written / "diagnosis.json")
    node = data
    for part in place[:-1]:
        node = node[part]
    node[place[-1]] = value
    path = tmp_path / "diagnosis.json"
    path.write_text(json.dumps(data), encoding="utf-8")
    assert main(["report", str(path), "--out", str(tmp_path / "out")]) == 2
    error = capsys.readouterr().err
    assert said in error
    assert error.startswith(f"error: {path}")
    assert error.count("\n") == 1
    assert not (tmp_path / "out").exists()


@pytest.mark.thorough
def test_what_a_stranger_writes_into_names_is_text_on_the_page(written, tmp_path):
    data = read_json(written / "diagnosis.json")
    data["reason"] = data["evidence"]["vehicle"] = "<script>alert(1)</script>"
    data["evidence"]["places"][0]["label"] = data["evidence"]["steps"][0]["label"] = "$\\frac{<b>$"
    data["evidence"]["psds"][0]["quantity"] = data["evidence"]["histories"][0]["quantity"] = "$\\nothing$"
    path = tmp_path / "diagnosis.json"
    path.write_text(json.dumps(data), encoding="utf-8")
    assert main(["report", str(path)]) == 0
    page = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert page.count("<script") == 1
    assert "&lt;script&gt;" in page


@pytest.fixture(scope="module")
def rate(record, tmp_path_factory):
    """A detection of a sedan whose front damping is given as a rate [1/s]."""
    path = tmp_path_factory.mktemp("rate") / "rated.yaml"
    path.write_text(
        "extends: sedan2.yaml\nname: rated\nparameters:\n"
        "  fade: {value: 2.18 Hz, range: [1 Hz, 5 Hz]}\n"
        "axles: {front: {suspension: {c: fade*mH}}}\n",
        encoding="utf-8",
    )
    return detect(load_trials(record(), load_vehicle(path)))


@pytest.mark.thorough
def test_units_are_shown_whole(rate, tmp_path):
    models = DiagnosisModels(rate, (), ())
    evidence = collect(models, quick=True)
    units = {item.name: item.unit for item in evidence.parameters}
    assert units["fade"] == "1/s"
    assert units["kf"] == "N/m"
    gap = Gap(1.0, 1.0, 1.0, run_chis(rate.base, rate.base, [trial.name for trial in rate.validation_runs]))
    diagnosis = Diagnosis(Verdict("no_missing_effect", "nothing", (), gap), False, evidence, models)
    write_diagnosis_page(diagnosis, tmp_path / "report.html")
    row = re.search(r"<td>fade</td>.*", (tmp_path / "report.html").read_text(encoding="utf-8"))
    assert row is not None
    assert re.search(r"2\.\d+ 1/s", row[0])
    assert not re.search(r"\d /s", row[0])
    assert Diagnosis.from_dict(diagnosis.to_dict()) == diagnosis


@pytest.mark.thorough
def test_ctrl_c_while_evidence_is_collected_leaves_what_takes_no_time(rate):
    stages = []

    def stop(stage, done, total, best):
        stages.append(stage)
        if stage == "evidence":
            raise KeyboardInterrupt

    verdict = Verdict("no_missing_effect", "nothing", (), Gap(1.0, 1.0, 1.0))
    found = with_evidence(Decided(DiagnosisModels(rate, (), ()), verdict), stop)
    assert stages == ["evidence"]
    assert found.stopped
    assert found.evidence.parameters
    assert found.evidence.force is None


@pytest.mark.thorough
def test_a_diagnosis_that_was_stopped_can_be_written_and_drawn(rate, tmp_path):
    gap = Gap(1.0, 1.0, 1.0, ())
    models = DiagnosisModels(rate, (), ())
    stopped = Diagnosis(Verdict("insufficient_data", "No verdict", (), gap), True, collect(models, quick=True), models)
    again = Diagnosis.from_dict(stopped.to_dict())
    for name, item in (("a", stopped), ("b", again)):
        write_diagnosis_page(item, tmp_path / name)
    assert (tmp_path / "a").read_bytes() == (tmp_path / "b").read_bytes()
    assert "stopped by hand" in (tmp_path / "a").read_text(encoding="utf-8")
