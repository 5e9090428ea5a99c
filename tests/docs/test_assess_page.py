"""The page on assessments shows what its example gives."""

import importlib.util

import pytest

from tests.docs.pages import ROOT


def test_the_tables_are_those_of_the_example():
    specification = importlib.util.spec_from_file_location("make_assess_page", ROOT / "docs" / "generate" / "assess_page.py")
    module = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(module)
    page = module.PAGE.read_text(encoding="utf-8")
    shown = page.partition(module.START)[2].partition(module.END)[0].splitlines()
    lines = iter(line for line in shown if line)
    for table in module.tables():
        for expected in (line for line in module.markdown(table).splitlines() if line):
            found = next(lines)
            if not expected.startswith("| "):
                assert found == expected
                continue
            for cell, own in zip(found.split("|"), expected.split("|"), strict=True):
                assert cell == own or float(cell) == pytest.approx(float(own), rel=2e-3)
    assert next(lines, None) is None
