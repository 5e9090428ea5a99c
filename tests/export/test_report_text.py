"""LaTeX and Markdown: complete, for every bundled vehicle, and without foreign markup."""

import re

import numpy as np
import pytest

from tests.bundled import few
from tests.export.vehicles import hostile, sedan_with, truck
from vehgen.export import export
from vehgen.mechanics import Place, derive, static_loads
from vehgen.vehicle import bundled_models


def tables(text):
    """Return the cells of every table by the heading above it."""
    found = {}
    for title, body in re.findall(r"^## (.*)\n\n((?:\|.*\n)+)", text, re.MULTILINE):
        found[title] = [[cell.strip() for cell in re.split(r"(?<!\\)\|", line)[1:-1]] for line in body.splitlines()]
    return found


@pytest.mark.parametrize("name", few(bundled_models()))
def test_every_bundled_vehicle(name, tmp_path):
    (path,) = export(name, "markdown", tmp_path / "a.md")
    found, numeric = tables(path.read_text(encoding="utf-8")), derive(name).numeric()
    for key in ("M", "C", "K", "P"):
        numbers = [[float(cell) for cell in row[1:]] for row in found[key][2:]]
        assert np.array(numbers) == pytest.approx(getattr(numeric, key), rel=1e-8)
    assert ("Q" in found) == bool(numeric.Q.any())
    (path,) = export(name, "latex", tmp_path / "a.tex")
    text = path.read_text(encoding="utf-8")
    assert text.startswith(r"\documentclass")
    assert text.endswith("\\end{document}\n")


def test_names_units_and_laws_stand_in_the_tables(tmp_path):
    (path,) = export(truck(), "markdown", tmp_path / "a.md")
    found = tables(path.read_text(encoding="utf-8"))
    assert [row[1] for row in found["Inputs w"][2:]] == ["road.front", "road.rear", "ground.rope"]
    assert ["mB", "6000", "kg", "", "sprung mass"] in found["Parameters"]
    (path,) = export(sedan_with("dry_friction", "tyre_liftoff"), "markdown", tmp_path / "b.md")
    laws = tables(path.read_text(encoding="utf-8"))["Force laws"]
    assert laws[2][:3] == ["front", "suspension", r"dry\_friction"]
    assert laws[2][4] == "force = 800"
    (path,) = export(sedan_with("dry_friction"), "latex", tmp_path / "a.tex")
    assert "Dry friction" in path.read_text(encoding="utf-8")


def test_columns_and_static_loads_have_the_names_of_what_they_are_of(tmp_path):
    (path,) = export(truck(), "markdown", tmp_path / "a.md", forces=[Place("engine", "body")])
    found = tables(path.read_text(encoding="utf-8"))
    assert found["F"][0] == ["", "engine"]
    assert found["P"][0] == ["", "road.front", "road.rear", "ground.rope"]
    (path,) = export("tractor5", "markdown", tmp_path / "b.md")
    loads = static_loads("tractor5")
    told = {row[0].replace("\\", ""): float(row[1]) for row in tables(path.read_text(encoding="utf-8"))["Static loads"][2:]}
    assert told == pytest.approx({**loads.axles, **loads.hinges}, rel=1e-5)


def test_hostile_names_stay_texts(tmp_path):
    (path,) = export(hostile(), "markdown", tmp_path / "a.md")
    text = path.read_text(encoding="utf-8")
    assert "</" not in text
    assert not re.search(r"(?<!\\)[*<$`]", text.replace("M q'' ", ""))
    assert tables(text)["Coordinates q"][2][1] == "heave.body"
