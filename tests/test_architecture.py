"""The rooms import downwards only, their map is up to date, and files, functions and names keep the house's measure."""

import ast
import importlib.util
import re
from collections import defaultdict
from functools import cache
from pathlib import Path

import pytest

SCRIPT = Path(__file__).parents[1] / "docs" / "generate" / "architecture.py"
SOURCE = Path(__file__).parents[1] / "src" / "vehgen"
MAX_FILE_LINES, MAX_FUNCTION_LINES = 300, 60
WAITING_FLAGS = {"files/outputs.py"}
"""Files of the library that still speak of options of the command line; the list may only shrink."""
COMMAND_CONSTANTS = {"NAME", "EXAMPLE", "ARGUMENT_OPTIONS"}
"""What every command declares of itself."""
FORMER_NAMES = {
    "Noun", "LinearModel", "Columns", "Entries", "Motion", "_Joint", "Printer", "straight", "cut", "Drive", "rests", "keep", "doubts",
    "Surveyor", "Site", "line_numbers", "lines", "white_lines", "Polished", "equals", "free", "hold", "springs", "renew", "gauge",
    "can_tell", "pivots", "Facts", "conclude", "Outcome", "Case", "Round", "look", "Footing", "pose", "place_test", "test_places", "decoys",
    "rivals", "further_runs", "trying", "settling", "strange", "told", "seen", "held_out", "untouched", "later",
}  # fmt: skip
"""Names that classes, functions and modules once had; the field's names took their place."""


def load():
    specification = importlib.util.spec_from_file_location("make_architecture", SCRIPT)
    module = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(module)
    return module


@cache
def sources():
    """Return of every file of the package its place, its text, and the nodes of its syntax tree, the module first."""
    found = [(path.relative_to(SOURCE).as_posix(), path.read_text(encoding="utf-8")) for path in sorted(SOURCE.rglob("*.py"))]
    return [(place, text, list(ast.walk(ast.parse(text)))) for place, text in found]


def functions(nodes):
    return [node for node in nodes if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef)]


def lines_of(function):
    """Return how many lines a function has, its docstring aside: what it explains of many arguments is no code to follow."""
    first = function.body[0]
    is_docstring = isinstance(first, ast.Expr) and isinstance(first.value, ast.Constant) and isinstance(first.value.value, str)
    return function.end_lineno - function.lineno + 1 - (first.end_lineno - first.lineno + 1 if is_docstring else 0)


def constants(tree):
    """Yield the names in capitals that a module sets, without the underscore that makes one private."""
    for node in tree.body:
        targets = node.targets if isinstance(node, ast.Assign) else [node.target] if isinstance(node, ast.AnnAssign) and node.value else []
        for target in targets:
            for item in target.elts if isinstance(target, ast.Tuple) else [target]:
                if isinstance(item, ast.Name) and item.id.isupper():
                    yield item.id.lstrip("_")


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
    assert module.page_with(module.sections()) == module.PAGE.read_text(encoding="utf-8")


def test_every_room_and_every_box_says_what_it_answers_and_what_it_holds():
    module = load()
    folders = {path.parent.relative_to(SOURCE).as_posix() for path in SOURCE.rglob("__init__.py")} - {"."}
    shown = {folder for folder, _ in module.described()}
    assert folders <= shown
    for _, (question, holds) in module.described():
        assert question.endswith("?")
        assert holds


def test_no_file_is_longer_than_one_reads_at_once():
    long = {place for place, text, _ in sources() if len(text.splitlines()) > MAX_FILE_LINES}
    assert long == set()


def test_no_function_is_longer_than_a_screen():
    long = set()
    for place, _, nodes in sources():
        long |= {(place, node.name) for node in functions(nodes) if lines_of(node) > MAX_FUNCTION_LINES}
    assert long == set()


def test_a_constant_name_means_one_thing_in_the_whole_house():
    owners = defaultdict(list)
    for place, _, nodes in sources():
        for name in set(constants(nodes[0])):
            if not (place.startswith("commands/") and name in COMMAND_CONSTANTS):
                owners[name].append(place)
    assert {name: places for name, places in owners.items() if len(places) > 1} == {}


@pytest.mark.parametrize(("value", "owner"), [(9.81, "mechanics/equations_of_motion.py"), (9.80665, "files/units.py")])
def test_gravity_and_the_unit_g_have_one_owner_each(value, owner):
    found = {place for place, _, nodes in sources() for node in nodes if isinstance(node, ast.Constant) and node.value in (value, -value)}
    assert found == {owner}


def test_only_commands_speak_of_options_of_the_command_line():
    found = set()
    for place, _, nodes in sources():
        documented = (ast.Module, ast.ClassDef, ast.FunctionDef)
        told = {id(node.body[0].value) for node in nodes if isinstance(node, documented) and ast.get_docstring(node)}
        texts = [node for node in nodes if isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in told]
        if any(re.search(r"(?<![\w-])--[a-z]", node.value) for node in texts):
            found.add(place)
    assert {place for place in found if not place.startswith("commands/")} <= WAITING_FLAGS


def test_parts_of_scipy_are_loaded_when_they_are_first_used():
    """`import scipy` loads none of them, and a simulation over a hump needs none."""
    found = set()
    for place, _, nodes in sources():
        modules = [item.name for node in nodes[0].body if isinstance(node, ast.Import) for item in node.names]
        modules += [node.module or "" for node in nodes[0].body if isinstance(node, ast.ImportFrom)]
        if any(name.startswith("scipy.") for name in modules):
            found.add(place)
    assert found == set()


def test_no_former_name_comes_back():
    found = [(place, Path(place).stem) for place, _, _ in sources() if Path(place).stem in FORMER_NAMES]
    for place, _, nodes in sources():
        found += [(place, node.name) for node in nodes if isinstance(node, ast.ClassDef) and node.name in FORMER_NAMES]
        found += [(place, node.name) for node in functions(nodes) if node.name in FORMER_NAMES]
    assert found == []
