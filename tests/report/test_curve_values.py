"""Curves whose values a page tells: what is embedded lies where the SVG draws it."""

import html
import json
import math
import re

import numpy as np
import pytest
from matplotlib.figure import Figure

from vehgen.report.curve_values import curve_values, inline_figure
from vehgen.report.figure_files import figure_svg

X, Y = [1.0, 4.0, 30.0, 100.0], [0.5, 0.02, 7.0, 0.1]


def drawn(scales=("linear", "linear"), label='<b> & "one"'):
    figure = Figure(figsize=(5.0, 3.0), layout="constrained")
    _, axes = figure.subplots(1, 2)
    axes.plot(X, Y, label=label)
    axes.set_xscale(scales[0])
    axes.set_yscale(scales[1])
    axes.set_xlabel("frequency\n[Hz]")
    axes.axvline(3.0, label="a mark")
    axes.axhline(3.0, label="noise")
    axes.plot([1, 2], [1, 2])
    return figure


def along(axis, value):
    size = math.log if axis["log"] else float
    low, high = map(size, axis["limits"])
    return axis["ends"][0] + (axis["ends"][1] - axis["ends"][0]) * (size(value) - low) / (high - low)


@pytest.mark.parametrize("scales", [("linear", "linear"), ("log", "linear"), ("log", "log")])
def test_values_lie_where_the_curve_is_drawn(scales):
    figure = drawn(scales)
    svg = figure_svg(figure)
    (panel,) = curve_values(figure)
    (curve,) = panel["curves"]
    assert (curve["x"], curve["y"]) == (X, Y)
    expected = [(along(panel["x"], x), along(panel["y"], y)) for x, y in zip(X, Y, strict=True)]
    paths = [re.findall(r"[ML] (\S+) (\S+)", path) for path in re.findall(r'<path d="([^"]*)" clip-path', svg)]
    near = [np.abs(np.array(path, dtype=float) - expected).max() for path in paths if len(path) == len(X)]
    assert min(near) < 0.02


def test_the_figure_of_a_page_carries_them_as_text():
    element = inline_figure(drawn(), "name", "A <title>")
    assert "<title>A &lt;title&gt;</title>" in element
    (data,) = re.findall(r'<svg data-curves="([^"]*)"', element)
    (panel,) = json.loads(html.unescape(data))
    assert panel["curves"][0]["name"] == '<b> & "one"'
    assert panel["x"]["label"] == "frequency [Hz]"
    assert "<b>" not in element


def test_what_cannot_be_seen_or_has_no_name_is_left_out():
    figure = Figure()
    axes = figure.subplots()
    axes.plot([1.0, 2.0, 3.0, 4.0, 5.0], [1.0, np.nan, 50.0, 2.123456789, 3.0], label="seen")
    axes.set_xlim(0.0, 4.5)
    axes.set_ylim(10.0, 0.0)
    (panel,) = curve_values(figure)
    assert panel["curves"] == [{"name": "seen", "x": [1.0, 4.0], "y": [1.0, 2.1235]}]
    assert inline_figure(Figure(), "empty", "Nothing").startswith("<svg ")
    assert "data-curves" not in inline_figure(Figure(), "empty", "Nothing")
