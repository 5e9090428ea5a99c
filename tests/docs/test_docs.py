"""What the pages show is there and works."""

import importlib.util
import re

import numpy as np
import pytest

from tests.calibrate.trucks import truck_problem
from tests.docs.pages import PAGES, ROOT
from vehgen.fit.prior_data import load_prior_data
from vehgen.mechanics import derive
from vehgen.simulate import load_run, simulate
from vehgen.vehicle import bundled_models, load_vehicle


@pytest.mark.parametrize("page", PAGES, ids=lambda path: path.name)
def test_links_lead_somewhere(page):
    for target in re.findall(r"\]\(([^)#]+)\)", page.read_text(encoding="utf-8")):
        if not target.startswith("http"):
            assert (page.parent / target).exists(), target


@pytest.mark.parametrize("page", PAGES, ids=lambda path: path.name)
def test_links_within_pages_lead_to_a_heading(page):
    for target, anchor in re.findall(r"\]\(([^)#:]*)#([^)]+)\)", page.read_text(encoding="utf-8")):
        text = (page.parent / target if target else page).read_text(encoding="utf-8")
        headings = [re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-") for title in re.findall(r"^#+ (.*)$", text, re.MULTILINE)]
        assert anchor in headings, (target, anchor)


def test_every_bundled_vehicle_is_drawn():
    text = (ROOT / "docs" / "models.md").read_text(encoding="utf-8")
    for name in bundled_models():
        assert f"## {name}\n" in text
        assert (ROOT / "docs" / "images" / "models" / f"{name}.svg").exists()


def test_force_laws_page_is_up_to_date():
    specification = importlib.util.spec_from_file_location("make_force_laws_page", ROOT / "docs" / "generate" / "force_laws_page.py")
    module = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(module)
    assert module.PAGE.read_text(encoding="utf-8") == module.page()


def test_the_tutorials_road_train():
    run = load_run(ROOT / "docs" / "examples" / "two_humps.yaml")
    response = simulate(run)
    peaks = {channel.name: abs(response.values[0, :, i]).max() for i, channel in enumerate(response.channels)}
    assert peaks["cab_az"] == pytest.approx(3.7584, abs=1e-4)
    assert peaks["tridem_force"] == pytest.approx(69302, abs=1)
    assert any("tridem_front would leave the road" in text for text in response.warnings)
    assert derive(run.vehicle).n_dof == 16


def test_the_tutorials_files_are_those_on_the_page():
    text = (ROOT / "docs" / "tutorial.md").read_text(encoding="utf-8")
    for name in ("my_truck.yaml", "two_humps.yaml"):
        assert (ROOT / "docs" / "examples" / name).read_text(encoding="utf-8") in text
    assert load_vehicle(ROOT / "docs" / "examples" / "my_truck.yaml").title == "My first truck"


def test_the_calibration_walks_facts_agree_with_its_truck_and_stand_on_the_page(tmp_path):
    specification = importlib.util.spec_from_file_location("calibrate_walk", ROOT / "docs" / "generate" / "calibrate_walk.py")
    walk = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(walk)
    problem = truck_problem(tmp_path)
    true = walk.truth()
    facts = load_prior_data(walk.PHONES / "facts.yaml", problem)
    assert abs(facts.residuals(np.array([true[name] for name in problem.space.names]))).max() < 2.0
    _, *lines = (walk.PHONES / "facts.yaml").read_text(encoding="utf-8").splitlines()
    assert "\n".join(lines) in walk.PAGE.read_text(encoding="utf-8")
