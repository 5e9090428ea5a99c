"""Drawings show what is there; the page is whole, escaped, and fetches nothing."""

import itertools
import re

import numpy as np
import pytest
from matplotlib.patches import Circle

from vehgen.codegen import write_kernel
from vehgen.mechanics import derive, static_loads
from vehgen.report import draw_modes, draw_vehicle, equations_latex, equations_text, plot_response, write_build_folder
from vehgen.simulate import natural_modes
from vehgen.vehicle import load_vehicle, parse_vehicle


def build(vehicle, folder, plots=True):
    model = derive(vehicle)
    values = model.values()
    return write_build_folder(
        folder, model, values, natural_modes(model, values), static_loads(model, values), write_kernel(model), ["look out"], plots
    )


def test_wheels_stand_where_the_axles_are():
    model = derive(load_vehicle("tractor5"))
    axes = draw_vehicle(model).axes[0]
    wheels = sorted({round(patch.center[0], 6) for patch in axes.patches if isinstance(patch, Circle) and patch.get_radius() > 0.3})
    np.testing.assert_allclose(wheels, [-12.16, -10.93, -3.48, -2.14, 1.32], atol=1e-6)
    labels = {text.get_text() for text in axes.texts}
    assert {"3.46", "1.34", "7.45", "1.23", "2.43", "4.14", "tractor", "semitrailer", "axle1", "fifth_wheel"} <= labels


def test_every_mode_has_its_panel():
    model = derive(load_vehicle("tractor5_cab"))
    modes = natural_modes(model)
    titles = [text.get_text() for text in draw_modes(model, modes).axes[0].texts]
    assert len(titles) == 2 * model.n_dof
    assert any("driver heave" in name and "1.46 Hz" in numbers for name, numbers in itertools.pairwise(titles))


def test_written_equations_are_the_matrices():
    model = derive(load_vehicle("tractor5"))
    values = model.vehicle.all_values(model.values())
    numeric = model.numeric()
    lines = re.findall(r"^  ([MCKP])\[(\d+),(\d+)\] = (.+)$", equations_text(model), re.M)
    assert len(lines) > 50
    for name, i, j, text in lines:
        found = eval(text, {"__builtins__": {}}, values)
        assert found == pytest.approx(getattr(numeric, name)[int(i) - 1, int(j) - 1], rel=1e-12)


def test_latex_names_everything():
    text = equations_latex(derive(load_vehicle("tractor5_module")))
    assert text.startswith(r"\documentclass")
    assert text.count(r"\begin") == text.count(r"\end")
    for part in (r"\theta_{\mathrm{tractor}}", "k_{t1}", r"\ddot q"):
        assert part in text


def test_the_page_is_whole_and_fetches_nothing(tmp_path):
    written = build(load_vehicle("tractor5_module"), tmp_path / "out")
    assert {path.name for path in written} == {
        "kernel.py",
        "kernel_legend.txt",
        "equations.txt",
        "equations.tex",
        "drawing.svg",
        "modes.svg",
        "index.html",
        "build.json",
    }
    page = (tmp_path / "out" / "index.html").read_text(encoding="utf-8")
    for part in ("semitrailer pitch", "look out", "module heave", "fifth_wheel", "SHA-256", "<svg", "<math"):
        assert part in page
    assert not re.search(r"(src|href)\s*=\s*[\"']?(https?:)?//", page)
    assert page.count("<script") == 1


def test_hostile_texts_are_escaped(tmp_path):
    text = "extends: quarter_car\ntitle: '<script>alert(1)</script>'\ndescription: '<img src=x onerror=y>'\n"
    build(parse_vehicle(text), tmp_path)
    page = (tmp_path / "index.html").read_text(encoding="utf-8")
    assert page.count("<script") == 1
    assert "<img" not in page
    assert "&lt;script&gt;" in page


def test_responses_have_labels_and_units():
    time = np.linspace(0, 1, 11)
    figure = plot_response(
        time, [("a", "acceleration", "m/s^2"), ("b", "acceleration", "m/s^2"), ("q", "pitch_rate", "rad/s")], np.zeros((11, 3))
    )
    assert [axes.get_ylabel() for axes in figure.axes] == ["acceleration\n[m/s^2]", "pitch rate\n[rad/s]"]
    assert figure.axes[-1].get_xlabel() == "time [s]"
    assert [text.get_text() for text in figure.axes[0].get_legend().get_texts()] == ["a", "b"]
