"""The pages in Python say what the package has, and what they show runs."""

import importlib.util
import re
import runpy
import shutil
from pathlib import Path

import pytest

import vehgen

DOCS = Path(__file__).parents[2] / "docs"


@pytest.fixture(scope="module")
def generator():
    specification = importlib.util.spec_from_file_location("make_api_page", DOCS / "generate" / "api_page.py")
    module = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(module)
    return module


@pytest.fixture
def examples(tmp_path, monkeypatch):
    for name in ("my_truck.yaml", "my_road_train.yaml", "two_humps.yaml"):
        shutil.copy(DOCS / "examples" / name, tmp_path)
    for name in ("hidden", "phones", "cargo"):
        shutil.copytree(DOCS / "examples" / name, tmp_path / name)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_the_page_is_up_to_date(generator):
    assert generator.PAGE.read_text(encoding="utf-8") == generator.page()


def test_the_page_has_every_public_name_once_and_in_a_snippet(generator):
    assert sorted(name for section in generator.SECTIONS for name in section.names) == sorted(vehgen.__all__)
    for section in generator.SECTIONS:
        for name in section.names:
            assert re.search(rf"\bvehgen\.{name}\b", section.snippet), name
            assert generator.meaning(name), name


@pytest.mark.slow
def test_the_pages_snippets_run(examples, capsys):
    space = {}
    for snippet in re.findall(r"```python\n(.*?)```", (DOCS / "api.md").read_text(encoding="utf-8"), re.DOTALL):
        exec(compile(snippet, "api.md", "exec"), space)
    told = capsys.readouterr().out
    assert "Dry friction of about 4" in told
    assert "did you mean 'tractor5' or" in told
    assert (examples / "imported_recording.csv").is_file()
    assert (examples / "pages" / "report.html").is_file()
    assert vehgen.load_run(examples / "imported.yaml").vehicle.name == "tractor5"
    assert vehgen.load_vehicle(examples / "laden.yaml").bodies.keys() > space["vehgen"].load_vehicle("tractor5").bodies.keys()


@pytest.mark.thorough
def test_the_tutorial_in_python_says_what_the_tutorial_says(examples, capsys):
    runpy.run_path(str(DOCS / "tutorial.py"))
    told = " ".join(capsys.readouterr().out.split())
    for words in (
        "body heave with body pitch 1.5676 1.5634 0.1656",
        "rear: 39,395 N",
        "16 degrees of freedom",
        "the cab heaves at 1.15 Hz, the tridem beam rocks at 11.2 Hz",
        "'tridem_middle': 54013",
        "cab_az m/s^2 3.7584",
        "tridem_force N 69302",
        "the tyre of tridem_front would leave the road: its dynamic force falls to -1.12",
        "(100, 3155, 1)",
    ):
        assert words in told
    for name in ("my_truck.svg", "response.png", "build/my_truck/index.html"):
        assert (examples / name).is_file()


def test_the_tutorial_uses_public_names_only():
    text = (DOCS / "tutorial.py").read_text(encoding="utf-8")
    assert set(re.findall(r"^(?:from|import) .*$", text, re.MULTILINE)) == {"import numpy as np", "import vehgen"}
    assert set(re.findall(r"\bvehgen\.(\w+)", text)) <= set(vehgen.__all__)


def test_the_snippet_of_the_readme_runs(examples, capsys):
    (snippet,) = re.findall(r"```python\n(.*?)```", (DOCS.parent / "README.md").read_text(encoding="utf-8"), re.DOTALL)
    exec(compile(snippet, "README.md", "exec"), {})
    assert capsys.readouterr().out.count("Hz") == vehgen.derive("tractor5").n_dof
