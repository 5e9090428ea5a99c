"""The site's navigation has every page, its links lead somewhere there, its notebooks use what is there; no extra is needed to know it."""

import ast
import importlib
import importlib.util
import json
import re
import sys
from pathlib import Path

import pytest
from ruamel.yaml import YAML

import vehgen
from tests.commands.calls import python
from tests.docs.pages import ROOT
from vehgen.commands import COMMANDS
from vehgen.commands.schema import SCHEMAS

DOCS = ROOT / "docs"
NOTEBOOKS = sorted((DOCS / "notebooks").glob("*.py"))
ONLY_WITH_EXTRAS = {"fmpy", "pandas"}
MADE = {"index.md", "commands.md", "schemas.md", "examples.md", "CONTRIBUTING.md", "CHANGELOG.md", "SECURITY.md"}
"""Pages that are made when the site is built."""


@pytest.fixture(scope="module")
def site_module():
    """Return what imports a module of docs/site by its name."""
    sys.path.insert(0, str(DOCS / "site"))
    yield importlib.import_module
    sys.path.remove(str(DOCS / "site"))


def navigation():
    text = (DOCS / "site" / "mkdocs.yml").read_text(encoding="utf-8")
    yaml = YAML(typ="safe")
    yaml.constructor.add_constructor("!ENV", lambda loader, node: True)

    def pages(entry):
        if isinstance(entry, str):
            return [entry]
        return [page for item in (entry.values() if isinstance(entry, dict) else entry) for page in pages(item)]

    return pages(yaml.load(text)["nav"])


def test_every_page_stands_in_the_navigation_once():
    written = {path.name for path in DOCS.glob("*.md")}
    notebooks = {f"notebooks/{path.stem}.md" for path in NOTEBOOKS}
    assert sorted(navigation()) == sorted(written | notebooks | MADE)


@pytest.mark.parametrize(
    ("link", "page", "folder", "expected"),
    [
        ("[a](theory.md#road)", "rigs.md", "docs", "[a](theory.md#road)"),
        ("[a](../CONTRIBUTING.md#test)", "rigs.md", "docs", "[a](CONTRIBUTING.md#test)"),
        ("[a](../README.md)", "rigs.md", "docs", "[a](index.md)"),
        ("[a](docs/theory.md)", "index.md", ".", "[a](theory.md)"),
        ("![a](docs/images/x.svg)", "index.md", ".", "![a](images/x.svg)"),
        ("[a](examples/hidden)", "rigs.md", "docs", "[a](examples.md#hidden)"),
        ("[a](examples/my_truck.yaml)", "rigs.md", "docs", "[a](examples/my_truck.yaml)"),
        ("[a](notebooks/hidden_effect.py)", "rigs.md", "docs", "[a](notebooks/hidden_effect.md)"),
        ("[thresholds](../src/vehgen/diagnose/thresholds.py)", "rigs.md", "docs", "`src/vehgen/diagnose/thresholds.py`"),
        ("[that test](../tests/docs)", "rigs.md", "docs", "that test (`tests/docs`)"),
        ("[a](https://doi.org/10.1/2)", "rigs.md", "docs", "[a](https://doi.org/10.1/2)"),
    ],
)
def test_links_of_the_repository_become_those_of_the_site(site_module, link, page, folder, expected):
    assert site_module("links").for_site(link, page, folder) == expected


def test_the_page_of_commands_has_all_of_them_and_their_options(site_module):
    page = site_module("commands_page").commands_page()
    names = [getattr(command, "NAME", command.__name__.rpartition(".")[2]) for command in COMMANDS]
    assert re.findall(r"^## (\w+)$", page, re.MULTILINE) == names
    simulate = page.partition("## simulate\n")[2].partition("\n## ")[0]
    assert "`--out" in simulate
    assert "%(" not in page


def test_the_page_of_schemas_has_every_file_and_key(site_module):
    pages = site_module("schema_pages")
    text, files = pages.schemas_page(), pages.schema_files()
    assert set(files) == {f"schemas/{name}.schema.json" for name in SCHEMAS}
    for name in SCHEMAS:
        section = text.partition(f"## {name}\n")[2].partition("\n## ")[0]
        schema = json.loads(files[f"schemas/{name}.schema.json"])
        for item in (schema, *schema.get("$defs", {}).values()):
            assert all(f"| `{key}`" in section for key in item.get("properties", {})), name


def test_the_pages_of_the_api_have_every_public_name(site_module):
    text = "\n".join(text for _, text in site_module("api_pages").api_pages().values())
    for name in vehgen.__all__:
        assert f"heading: vehgen.{name}\n" in text
    assert "::: vehgen.calibrate.result.CalibrationSummary\n" in text


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_notebooks_use_what_is_there(path):
    text = path.read_text(encoding="utf-8")
    assert text.startswith("# %% [markdown]\n# # ")
    tree = ast.parse(text)
    for node in ast.walk(tree):
        if isinstance(node, ast.Import | ast.ImportFrom):
            module = node.names[0].name if isinstance(node, ast.Import) else node.module
            base = module.partition(".")[0]
            is_example = any((DOCS / "examples").glob(f"*/{base}.py"))
            assert is_example or base in ONLY_WITH_EXTRAS or importlib.util.find_spec(base) is not None, module
        elif isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and node.value.id == "vehgen":
            assert node.attr in vehgen.__all__, node.attr


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_links_of_notebooks_lead_somewhere(path):
    for target in re.findall(r"\]\(([^)#]+)(?:#[^)]*)?\)", path.read_text(encoding="utf-8")):
        assert (path.parent / target).exists(), target


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_files_that_notebooks_read_are_examples(path):
    for name in re.findall(r"\"((?:phones|hidden)/[\w.]+)\"", path.read_text(encoding="utf-8")):
        assert (DOCS / "examples" / name).exists(), name


def setup_cell(path):
    """Return the first cell of code."""
    return path.read_text(encoding="utf-8").split("# %%\n")[1]


def test_notebooks_begin_in_a_copy_of_the_examples_wherever_they_are_run(tmp_path):
    assert len({setup_cell(path) for path in NOTEBOOKS}) == 1
    script = f"{setup_cell(NOTEBOOKS[0])}\nprint(own, Path('my_truck.yaml').is_file(), Path.cwd().samefile(own))\n"
    (tmp_path / "docs" / "notebooks").mkdir(parents=True)
    (tmp_path / "docs" / "examples").mkdir()
    (tmp_path / "docs" / "examples" / "my_truck.yaml").write_text("name: my_truck\n")
    (tmp_path / "docs" / "notebooks" / "own.py").write_text(script)
    for arguments, folder in (
        (["own.py"], tmp_path / "docs" / "notebooks"),
        (["docs/notebooks/own.py"], tmp_path),
        (["-c", script], tmp_path / "docs" / "notebooks"),  # a notebook knows no file of its own
    ):
        done = python("-W", "error", *arguments, folder=folder)
        own, *found = done.stdout.split()
        assert (done.returncode, done.stderr, found) == (0, "", ["True", "True"])
        assert not Path(own).exists()
    assert python("-c", f"{setup_cell(NOTEBOOKS[0])}\nassert 'own' not in globals()", folder=tmp_path).returncode == 0


@pytest.mark.thorough
def test_the_first_notebook_runs_from_its_own_folder_and_leaves_nothing_there():
    folder = DOCS / "notebooks"
    before = sorted(folder.iterdir())
    done = python("first_vehicle.py", folder=folder, MPLBACKEND="Agg", PYTHONDONTWRITEBYTECODE="1")
    assert done.returncode == 0, done.stderr
    assert sorted(folder.iterdir()) == before


def test_docstrings_are_rewritten_for_the_site(site_module):
    pytest.importorskip("griffe")
    text = "Do it, as :func:`vehgen.x`.\n\nParameters\n----------\na, b\n    Both.\n\nReturns\n-------\nWhat was done;\nand more.\n"
    expected = (
        "Do it, as `vehgen.x`.\n\nParameters\n----------\na\n    Both.\nb\n    Both.\n"
        "Returns\n-------\nfloat\n    What was done;\n    and more.\n"
    )
    assert site_module("docstrings").rewritten(text, "float") == expected
    typed = "Do it.\n\nReturns\n-------\nfloat\n    What was done.\n"
    assert site_module("docstrings").rewritten(typed, "float") == typed


def test_what_a_page_loads_from_another_host_is_seen(site_module):
    for package in ("mkdocs", "jupytext", "nbconvert"):
        pytest.importorskip(package)
    found = site_module("hooks").FROM_ELSEWHERE
    for tag in ('<script src="https://x.org/a.js">', "<img alt='' src=//x.org/a.png>", '<link rel="stylesheet" href="http://x.org/a.css">'):
        assert found.findall(tag) == [tag]
    for tag in ('<a href="https://x.org">', '<script src="assets/a.js">', '<img src="images/a.svg" alt="https://x.org">'):
        assert found.findall(tag) == []


def test_the_search_works_from_a_folder_without_another_host():
    text = (DOCS / "site" / "mkdocs.yml").read_text(encoding="utf-8")
    assert re.search(r"^  - offline\b", text, re.MULTILINE)
    (polyfills,) = re.findall(r"^  polyfills: \[(.*?)\]", text, re.MULTILINE)
    assert polyfills == "iframe-worker.js"
    script = (DOCS / "site" / polyfills).read_text(encoding="utf-8")
    assert not re.search(r"https?:|fetch\(|XMLHttpRequest|eval", script)
