"""The rigs of docs/rigs.md, against what a pencil says."""

from pathlib import Path

import numpy as np
import pytest

from vehgen.commands import main
from vehgen.simulate import load_run, simulate
from vehgen.vehicle import bundled_models

RIGS = Path(__file__).parents[2] / "docs" / "examples" / "rigs"


def response(name):
    return simulate(load_run(RIGS / f"{name}_run.yaml"))


def test_a_dropped_car_falls_lands_and_comes_to_rest_on_its_weight():
    found = response("drop_test")
    _, load = found.values[0].T
    assert load[:8] == pytest.approx(0.0, abs=1e-6)
    assert load.max() > 1.2 * load[-1]
    weight = 9.81 * (600 * 1.4 / 2.6 + 40)
    assert load[-1] == pytest.approx(weight, rel=2e-3)


def test_a_damper_pushes_its_load_cell_by_its_rate():
    found = response("damper_dyno")
    assert found.warnings == ()
    assert abs(found.values[0, :, 0]).max() == pytest.approx(2500 * 0.02 * 2 * np.pi * 1.5, rel=1e-4)  # no jump as it begins
    force, stroke = found.values[0, found.time > 0.5].T
    assert np.ptp(stroke) == pytest.approx(0.04, rel=1e-3)
    assert np.ptp(force) == pytest.approx(2 * 2500 * 0.02 * 2 * np.pi * 1.5, rel=2e-3)


def test_a_shaken_machine_answers_as_its_frequency_response():
    found = response("shaker")
    late = found.time > 2.0
    w = 2 * np.pi * 7.0
    heave = 100.0 / (2 * (180e3 + 400j * w) - 120 * w**2)
    pitch = -0.3 * 100.0 / (2 * 0.25**2 * (180e3 + 400j * w) - 6 * w**2)
    expected = abs(-(w**2) * (heave - 0.2 * pitch))
    basis = np.column_stack([np.sin(w * found.time[late]), np.cos(w * found.time[late])])
    found_amplitude = np.hypot(*np.linalg.lstsq(basis, found.values[0, late, 0], rcond=None)[0])
    assert found_amplitude == pytest.approx(expected, rel=0.02)


def test_what_a_rig_has_not_is_left_out_of_tables_and_page(tmp_path, capsys):
    vehicle = "damper_dyno"
    main(["build", vehicle, "--out", str(tmp_path / "built"), "--no-plots"])
    printed = capsys.readouterr().out
    page = (tmp_path / "built" / "index.html").read_text(encoding="utf-8")
    assert "Static loads" not in printed
    assert "body mode outside" not in printed
    assert "Static loads" not in page
    assert "; 5 kg." in page
    main(["static", vehicle])
    words = " ".join(capsys.readouterr().out.split())
    assert "springs at rest" in words
    assert "load_cell 0.000 0.00" in words


def test_the_page_of_a_rig_with_weight_shows_what_its_links_carry_and_no_empty_table(tmp_path, capsys):
    main(["build", "shaker", "--out", str(tmp_path / "built"), "--no-plots"])
    printed = " ".join(capsys.readouterr().out.split())
    assert "force, kN" in printed
    assert "front 0.589" in printed
    page = (tmp_path / "built" / "index.html").read_text(encoding="utf-8")
    assert "<th>axle</th>" not in page
    assert "<th>spring</th>" in page
    assert page.count(f"{120 * 9.81 / 2e3:.3f}") >= 2
    assert f"{120 * 9.81 / 1e3:.3f}" in page


def test_every_rig_is_a_bundled_model_with_a_run():
    runs = {load_run(path).vehicle.name: path for path in sorted(RIGS.glob("*_run.yaml"))}
    assert sorted(runs) == ["damper_dyno", "drop_test", "shaker"]
    assert all(name in bundled_models() for name in runs)
