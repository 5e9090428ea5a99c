"""What is said of the project in several places is the same everywhere."""

import io
import re
import tomllib
import zipfile

import pytest

import vehgen
from tests.docs.pages import ROOT

PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))


def test_the_version_is_that_of_the_package():
    assert PROJECT["project"]["dynamic"] == ["version"]
    source = (ROOT / PROJECT["tool"]["hatch"]["version"]["path"]).read_text(encoding="utf-8")
    assert f'__version__ = "{vehgen.__version__}"' in source
    citation = (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    assert re.findall(r"^version: (.*)$", citation, re.MULTILINE) == [vehgen.__version__]
    changes = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    assert re.findall(r"^## (.*)$", changes, re.MULTILINE)[:2] == ["Unreleased", vehgen.__version__]


def test_the_package_stays_small_and_needs_no_more():
    names = [re.split(r"[<>=]", item)[0] for item in PROJECT["project"]["dependencies"]]
    core = {"numpy", "scipy", "sympy", "numba", "llvmlite", "matplotlib", "pydantic", "ruamel.yaml", "rich", "jinja2", "threadpoolctl"}
    assert set(names) == core
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as wheel:
        for folder in (ROOT / "src", ROOT / "models"):
            for path in folder.rglob("*"):
                if path.is_file() and "__pycache__" not in path.parts:
                    wheel.write(path, path.relative_to(ROOT))
    assert 500_000 < len(packed.getvalue()) < 1_125_000  # what tells of the package itself, 25 000 bytes of 1.15 MB, is not in it


def test_what_the_source_package_holds_is_there():
    for name in PROJECT["tool"]["hatch"]["build"]["targets"]["sdist"]["include"]:
        assert (ROOT / name).exists(), name


def test_the_files_that_contributors_are_sent_to_are_there():
    text = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
    paths = set(re.findall(r"`((?:src|tests|docs|benchmarks|\.ci)/[^`*]*)`", text))
    assert len(paths) > 20
    assert [path for path in sorted(paths) if "NAME" not in path and not (ROOT / path).exists()] == []
    assert [path for path in sorted(paths) if "NAME" in path and not (ROOT / path).parent.exists()] == []


@pytest.mark.parametrize("name", ["vehgen.mechanics.laws:LAWS", "vehgen.effects.registry:EFFECTS", "vehgen.commands:COMMANDS"])
def test_the_lists_that_contributors_add_to_have_their_names(name):
    module, _, attribute = name.partition(":")
    assert f"`{attribute}`" in (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
    assert hasattr(__import__(module, fromlist=[attribute]), attribute)
