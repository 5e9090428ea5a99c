"""The rooms import downwards only, and the page that shows it is up to date."""

import importlib.util
from pathlib import Path

SCRIPT = Path(__file__).parents[1] / "docs" / "generate" / "architecture.py"


def load():
    specification = importlib.util.spec_from_file_location("make_architecture", SCRIPT)
    module = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(module)
    return module


def test_no_import_runs_up():
    module = load()
    edges = module.imports()
    assert set(edges) <= set(module.ROOMS)
    upward = [
        (room, other, sorted(files))
        for room, others in edges.items()
        for other, files in others.items()
        if module.ROOMS.index(other) > module.ROOMS.index(room)
    ]
    assert upward == []


def test_the_page_shows_the_code_as_it_is():
    module = load()
    assert module.page_with(module.section()) == module.PAGE.read_text(encoding="utf-8")
