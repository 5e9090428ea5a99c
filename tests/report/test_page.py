"""The build folder and its page: complete, safe, self-contained and reproducible."""

import base64
import hashlib
import html
import re
from html.parser import HTMLParser
from importlib.resources import files
from pathlib import Path

import numpy as np
import pytest
from matplotlib.figure import Figure

from tests.bundled import few
from tests.report.vehicles import EVERY, HOSTILE, build, model
from vehgen.assess import assess
from vehgen.codegen import write_kernel
from vehgen.diagnose.fleet import Fleet, FleetRow
from vehgen.diagnose.verdict import Gap, RunChi, Verdict
from vehgen.errors import InputError
from vehgen.files.number_text import grouped, kilonewtons
from vehgen.mechanics import derive, static_loads
from vehgen.report import plot_response, save_figure, write_build_folder
from vehgen.report.figure_files import inline_svg
from vehgen.report.pages.assessment_page import write_assessment
from vehgen.report.pages.assets import template_text
from vehgen.report.pages.fleet_page import write_fleet_page
from vehgen.simulate import natural_modes
from vehgen.simulate.mode_groups import alike_modes, group_name
from vehgen.vehicle import load_vehicle

VOID = {"meta", "br", "img", "link", "input", "hr"}
FETCHES = {"script", "link", "iframe", "img", "object", "embed", "video", "audio", "source", "base", "form", "input"}


class Page(HTMLParser):
    """Reads a page strictly: every element closed in order."""

    def __init__(self, text):
        super().__init__()
        self.tags, self.ids, self.references, self.words, self.open = [], [], [], [], []
        self.feed(text)
        self.close()
        assert self.open == []

    def handle_starttag(self, tag, attrs):
        self.tags.append(tag)
        if tag not in VOID:
            self.open.append(tag)
        for key, value in attrs:
            if key == "id":
                self.ids.append(value)
            if key in ("href", "src", "xlink:href", "action", "srcset", "data"):
                self.references.append(value)
            assert not key.startswith("on")

    def handle_startendtag(self, tag, attrs):
        self.handle_starttag(tag, attrs)
        if tag not in VOID:
            self.open.pop()

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        self.words.append(data)

    @property
    def text(self):
        return "".join(self.words)


def test_the_folder_holds_what_it_should(tmp_path):
    written = build(tmp_path / "deep" / "folder", "quarter_car")
    names = {"kernel.py", "kernel_legend.txt", "equations.txt", "equations.tex", "drawing.svg", "modes.svg", "index.html", "build.json"}
    assert {path.name for path in written} == names
    assert {path.name for path in (tmp_path / "deep" / "folder").iterdir()} == names
    assert (tmp_path / "deep" / "folder" / "kernel.py").read_text(encoding="utf-8") == write_kernel(model("quarter_car")).text


def test_plots_can_be_left_out(tmp_path):
    written = build(tmp_path, "quarter_car", plots=False)
    names = {"kernel.py", "kernel_legend.txt", "equations.txt", "equations.tex", "index.html", "build.json"}
    assert {path.name for path in written} == names
    assert "<svg" not in (tmp_path / "index.html").read_text(encoding="utf-8")


@pytest.mark.thorough
def test_the_same_vehicle_gives_the_same_bytes(tmp_path):
    one, two = (build(tmp_path / key, "tractor5_cab") for key in ("one", "two"))
    assert all(a.read_bytes() == b.read_bytes() for a, b in zip(one, two, strict=True))


def test_a_folder_that_cannot_be_written_is_an_input_error(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(InputError, match="cannot write"):
        build(tmp_path / "file" / "folder", "quarter_car", plots=False)


@pytest.mark.parametrize("name", few(EVERY))
def test_the_page_names_everything(name, pages):
    m = model(name)
    text = Page(pages(name)).text
    for item in m.coordinates:
        assert item.name in text
        assert item.meaning in text
    for key, parameter in m.vehicle.parameters.items():
        assert key in text
        assert parameter.meaning in text
    for key in (*m.vehicle.axles, *m.vehicle.hinges):
        assert key in text
    for group in alike_modes(natural_modes(m)):
        assert group_name(group) in text
        assert f"{group[0].undamped_hz:.3f}" in text
        assert f"{group[0].damping_ratio:.3f}" in text
    for path in m.vehicle.files:
        assert path.name in text
    assert (m.vehicle.title or m.vehicle.name) in text
    assert m.vehicle.source.strip() in text
    assert "a warning of <b>2 & 3</b>" in text
    assert "def run(" in text


def check_that_nothing_is_fetched(source, links=()):
    """Check that a page's only script is the one of all pages, that its policy allows no other, and that it refers to nothing else."""
    page = Page(source)
    assert not (FETCHES - {"script"}) & set(page.tags)
    assert page.tags.count("script") == 1
    (script,) = re.findall(r"<script>(.*?)</script>", source, re.DOTALL)
    assert script == template_text("page.js")
    digest = base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()
    policy = f"default-src &#39;none&#39;; style-src &#39;unsafe-inline&#39;; script-src &#39;sha256-{digest}&#39;"
    assert f'<meta http-equiv="Content-Security-Policy" content="{policy}">' in source
    assert not re.search(r"fetch\(|XMLHttpRequest|import\b|eval|innerHTML|https?:", script)
    assert all(reference.startswith("#") or reference in links for reference in page.references)
    assert not re.search(r"@import|url\((?!#)", source)
    assert template_text("page.css") in source


@pytest.mark.parametrize("name", few(EVERY))
def test_the_page_fetches_nothing_and_runs_one_script_of_its_own(name, pages):
    check_that_nothing_is_fetched(pages(name))


def test_the_pages_of_fleets_and_assessments_are_held_to_the_same(tmp_path):
    hostile = "<script>alert(1)</script>"
    gap = Gap(3.0, 1.0, 1.0, (RunChi("hump", False, 3.0, 1.0),))
    verdict = Verdict(verdict="no_missing_effect", reason=hostile, effects=(), gap=gap)
    rows = (FleetRow("good one", "finished", ("hump",), verdict), FleetRow(hostile, "failed", error=hostile), FleetRow("left"))
    source = write_fleet_page(Fleet(hostile, rows, {"vehgen": "1"}), tmp_path).read_text(encoding="utf-8")
    check_that_nothing_is_fetched(source, links=("good%20one/report.html",))
    assert Page(source).text.count(hostile) == 5
    (tmp_path / "run.yaml").write_text("vehicle: sedan2\nspeed: 10 m/s\nduration: 1 s\nroad: [{iso8608: {class: A}}]\n")
    page, *_ = write_assessment(assess(tmp_path / "run.yaml"), tmp_path)
    check_that_nothing_is_fetched(page.read_text(encoding="utf-8"))


@pytest.mark.parametrize("path", sorted(Path(str(files("vehgen.report"))).glob("templates/*.html.j2")), ids=lambda path: path.name)
def test_every_template_has_the_policy_the_style_and_the_script_of_all_pages(path):
    text = path.read_text(encoding="utf-8")
    for part in ('http-equiv="Content-Security-Policy" content="{{ policy }}"', "{{ style }}", "<script>{{ script }}</script>"):
        assert text.count(part) == 1
    assert "#fff" not in text
    assert "color-scheme" not in text


@pytest.mark.parametrize("name", few(EVERY))
def test_ids_are_unique_and_links_lead_somewhere(name, pages):
    page = Page(pages(name))
    assert len(page.ids) == len(set(page.ids))
    assert {reference[1:] for reference in page.references} <= set(page.ids)
    clipped = set(re.findall(r"url\(#([^)]+)\)", pages(name)))
    assert clipped <= set(page.ids)


def test_hostile_text_stays_text(pages):
    source = pages("with_laws")
    assert source.count("<script") == 1
    assert "<img" not in source
    assert '<a href="https' not in source
    assert html.escape(HOSTILE, quote=False).split("$")[0].split('"')[0] in source
    assert HOSTILE in Page(source).text


@pytest.mark.thorough
@pytest.mark.parametrize("name", ["tractor5", "road_train", "with_laws", "rig"])
def test_axle_loads_sum_to_the_weight(name, pages):
    m = model(name)
    loads = static_loads(m)
    for force in loads.axles.values():
        assert kilonewtons(force) in pages(name)
    found = dict(re.findall(r"<th>(sum|weight)</th>(?:<th></th>)?<th class=\"n\">([^<]*)</th>", pages(name)))
    assert found["weight"] == kilonewtons(_weight(m))
    if name != "rig":
        assert found["sum"] == found["weight"]


def _weight(m):
    values = m.vehicle.all_values(m.vehicle.values())
    masses = [body.mass for body in m.vehicle.bodies.values()] + [axle.mass for axle in m.vehicle.axles.values() if axle.mass]
    return 9.81 * sum(mass.evaluate(values) for mass in masses)


def test_force_laws_and_ranges_are_shown(pages):
    text = Page(pages("with_laws")).text
    assert "suspension of axle2" in text
    assert "f = k*(max(d - clearance, 0)" in text
    assert "The force laws are left out." in text
    assert "0.8 to 2.2" in text


def test_a_value_outside_its_range_is_marked(tmp_path):
    m = model("tractor5")
    values = m.values(overrides={"b1": 2.5})
    write_build_folder(tmp_path, m, values, natural_modes(m, values), static_loads(m, values), write_kernel(m), plots=False)
    assert "0.8 to 2.2 (outside)" in (tmp_path / "index.html").read_text(encoding="utf-8")


def test_without_warnings_the_page_says_so(tmp_path):
    build(tmp_path, "quarter_car", plots=False)
    assert "No warnings." in (tmp_path / "index.html").read_text(encoding="utf-8")


def test_a_vehicle_file_that_has_gone_does_not_stop_the_page(tmp_path):
    path = tmp_path / "gone.yaml"
    path.write_text("extends: quarter_car.yaml\nname: gone\n")
    m = derive(load_vehicle(path))
    path.unlink()
    write_build_folder(tmp_path / "out", m, m.values(), natural_modes(m), static_loads(m), write_kernel(m), plots=False)
    assert "gone.yaml: no longer there" in (tmp_path / "out" / "index.html").read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (1590640.0, "1 590 640"),
        (0.97, "0.97"),
        (-0.163502, "−0.163502"),
        (0.0, "0"),
        (1e-6, "1e-06"),
        (8000.0, "8 000"),
        (12345.678, "12 345.7"),
    ],
)
def test_numbers_are_grouped(value, text):
    assert grouped(value).replace("\u202f", " ") == text


def test_ids_of_inlined_drawings_are_prefixed():
    svg = '<?xml version="1.0"?><svg width="3pt"><metadata>x</metadata><g id="a" clip-path="url(#c)"><use xlink:href="#d"/></g></svg>'
    found = inline_svg(svg, "first", "A title")
    assert found == (
        '<svg width="3pt" role="img"><title>A title</title><g id="first-a" clip-path="url(#first-c)"><use xlink:href="#first-d"/></g></svg>'
    )


def response(n=12, kinds=2):
    time = np.linspace(0.0, 2.0, 101)
    channels = [(f"_s{i}$x$", ["acceleration", "pitch_rate"][i % kinds], ["m/s^2", "rad/s"][i % kinds]) for i in range(n)]
    return time, channels, np.sin(np.outer(time, 1.0 + np.arange(n)))


def test_response_panels_have_labels_with_units():
    figure = plot_response(*response(), title="a $title")
    assert [axes.get_ylabel() for axes in figure.axes] == ["acceleration\n[m/s^2]", "pitch rate\n[rad/s]"]
    assert figure.axes[-1].get_xlabel() == "time [s]"
    assert all(len(axes.get_legend().get_texts()) == 6 for axes in figure.axes)


def test_response_lines_differ_and_the_legend_lies_beside_the_data(tmp_path):
    figure = plot_response(*response(24, 1))
    lines = [line for line in figure.axes[0].lines if len(line.get_xdata()) > 2]
    styles = {(line.get_color(), str(line._unscaled_dash_pattern)) for line in lines}
    assert len(lines) == 24
    assert len(styles) == 24
    save_figure(figure, tmp_path / "response.png")
    legend, axes = figure.axes[0].get_legend().get_window_extent(), figure.axes[0].get_window_extent()
    assert legend.x0 >= axes.x1


def test_response_of_the_wrong_shape_is_refused():
    time, channels, values = response()
    with pytest.raises(ValueError, match="shape"):
        plot_response(time, channels, values.T)


@pytest.mark.parametrize("suffix", ["png", "svg", "pdf", "SVG"])
def test_figures_are_saved_whole_and_the_same(tmp_path, suffix):
    paths = [tmp_path / f"{key}.{suffix}" for key in ("one", "two")]
    for path in paths:
        save_figure(plot_response(*response(4)), path)
    assert paths[0].read_bytes() == paths[1].read_bytes()
    assert len(list(tmp_path.iterdir())) == 2


def test_an_unknown_kind_of_figure_is_an_input_error(tmp_path):
    with pytest.raises(InputError, match=r"must end in \.png, \.svg, \.pdf"):
        save_figure(Figure(), tmp_path / "figure.bmp")
    (tmp_path / "file").write_text("")
    with pytest.raises(InputError, match="cannot write"):
        save_figure(Figure(), tmp_path / "file" / "figure.png")
    assert [path.name for path in tmp_path.iterdir()] == ["file"]
