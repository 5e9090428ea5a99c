"""The suite itself: every test asserts something, and nothing that looks like a test is left out."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

TESTS = Path(__file__).parent
TREES = {path: ast.parse(path.read_text(encoding="utf-8")) for path in sorted(TESTS.rglob("*.py"))}
CHECKS = {"raises", "warns", "fail"}
"""What of pytest asserts."""
MAX_LINES = 450


def functions(tree: ast.AST) -> Iterator[ast.FunctionDef]:
    return (node for node in ast.walk(tree) if isinstance(node, ast.FunctionDef))


def called(node: ast.AST) -> set[str]:
    """Return the names of what is called within a node, without what they are called on."""
    calls = [item.func for item in ast.walk(node) if isinstance(item, ast.Call)]
    return {call.id if isinstance(call, ast.Name) else call.attr for call in calls if isinstance(call, (ast.Name, ast.Attribute))}


def asserts(node: ast.AST, helpers: dict[str, list[ast.FunctionDef]], seen: frozenset[str] = frozenset()) -> bool:
    """Whether a node asserts: by itself, by pytest or numpy, or in a function of the suite that it calls."""
    if any(isinstance(item, ast.Assert) for item in ast.walk(node)):
        return True
    names = called(node)
    if names & CHECKS or any(name.startswith("assert_") for name in names):
        return True
    return any(asserts(helper, helpers, seen | names) for name in names - seen for helper in helpers.get(name, ()))


def silent(trees: dict[Path, ast.Module]) -> list[str]:
    """Return the tests that assert nothing."""
    helpers: dict[str, list[ast.FunctionDef]] = {}
    for tree in trees.values():
        for function in functions(tree):
            helpers.setdefault(function.name, []).append(function)
    tests = [(path, function) for path, tree in trees.items() for function in functions(tree) if function.name.startswith("test_")]
    return [f"{path.name}: {function.name}" for path, function in tests if not asserts(function, helpers)]


def test_every_test_asserts_something():
    assert silent(TREES) == []


def test_a_test_without_an_assertion_is_seen():
    text = "def helper(x):\n    assert x\n\ndef test_a():\n    helper(1)\n\ndef test_b():\n    print(1)\n"
    assert silent({Path("a.py"): ast.parse(text)}) == ["a.py: test_b"]


def test_no_table_of_cases_hangs_on_a_function_that_is_not_collected():
    missed = [
        f"{path.name}: {function.name}"
        for path, tree in TREES.items()
        for function in functions(tree)
        if any("mark.parametrize" in ast.unparse(mark) for mark in function.decorator_list) and not function.name.startswith("test_")
    ]
    assert missed == []


def test_no_test_hides_another_of_its_name():
    for path, tree in TREES.items():
        names = [node.name for node in tree.body if isinstance(node, ast.FunctionDef)]
        assert sorted(set(names)) == sorted(names), path.name


def test_no_file_is_too_long_to_be_one_story():
    assert [path.name for path in TREES if path.read_text(encoding="utf-8").count("\n") > MAX_LINES] == []
