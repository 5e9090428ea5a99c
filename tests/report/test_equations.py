"""The written equations are those of the model: read back, they give its numbers."""

import html
import re
import shutil
import subprocess
import time
from xml.etree import ElementTree

import numpy as np
import pytest
import sympy as sp

from tests.bundled import few
from tests.report.vehicles import EVERY, HOSTILE, model, random_model
from vehgen.files.expressions import parse
from vehgen.mechanics import GRAVITY, derive
from vehgen.report import equations_latex, equations_mathml, equations_text
from vehgen.report.equations.latex import unit_latex
from vehgen.report.equations.notation import Name, gravity_symbol, latex_name, latex_text, number_text, split_name, tidy
from vehgen.report.equations.writing import (
    balance_mathml,
    balance_text,
    coordinate_latex,
    coordinate_mathml,
    expression_mathml,
    law_rows,
    matrices,
)
from vehgen.vehicle import parse_vehicle

ENTRY = re.compile(r"^  ([MCKPQFW])\[(\d+)(?:,(\d+))?\] = (.*)$", re.MULTILINE)


@pytest.mark.parametrize("name", few(EVERY))
def test_the_text_read_back_gives_the_matrices(name):
    m = model(name)
    check_text(m, m.values(overrides={"push.shift": 0.3}))


@pytest.mark.parametrize("seed", range(20))
def test_the_text_of_any_vehicle_gives_its_matrices(seed):
    m = random_model(seed)
    check_text(m, m.values())
    assert equations_latex(m).endswith("\\end{document}\n")
    assert equations_mathml(m)


def check_text(m, values):
    known = {**m.vehicle.all_values({key: values[key] for key in m.vehicle.free_parameters}), "g": GRAVITY}
    numeric = m.numeric(values)
    found = {key: np.zeros_like(getattr(numeric, key)) for key in "MCKPQF"} | {"W": np.zeros(m.n_dof)}
    for symbol, row, column, text in ENTRY.findall(equations_text(m)):
        value = parse(text.replace("push.shift", "0.3")).evaluate(known)
        if symbol == "W":
            found["W"][int(row) - 1] = value
            continue
        found[symbol][int(row) - 1, int(column) - 1] = value
        if symbol in "MCK":
            found[symbol][int(column) - 1, int(row) - 1] = value
    for key in "MCKPQF":
        np.testing.assert_allclose(found[key], getattr(numeric, key), rtol=1e-9, atol=1e-9 * np.abs(getattr(numeric, key)).max(initial=1))
    np.testing.assert_allclose(found["W"], numeric.weight, rtol=1e-9, atol=1e-6)


@pytest.mark.parametrize("name", few(EVERY))
def test_the_text_defines_every_symbol_that_it_uses(name):
    m = model(name)
    text = equations_text(m)
    used = {str(symbol) for matrix in matrices(m) for value in matrix.entries.values() for symbol in value.free_symbols}
    for symbol in used:
        assert re.search(rf"^  {re.escape(symbol)}( = .*)?: .*\[.*\]$|^  g = 9.81", text, re.MULTILINE), symbol
    for item in m.coordinates:
        assert f"{item.symbol}: {item.meaning} [{item.unit}]" in text


def test_the_equation_of_motion_has_the_terms_that_there_are():
    assert balance_text(model("with_laws")) == "M q'' + C q' + K q + L n = P w + Q w' + F f"
    assert balance_text(model("tractor5")) == "M q'' + C q' + K q = P w + F f"


LIMBER = """
name: limber
parameters: {mF: {value: 9 t}, IF: {value: 20 t m^2}, kF: {value: 800 kN/m}}
bodies:
  frame: {mass: mF, pitch_inertia: IF, bending: {length: 6 m, frequency: 9 Hz, damping_ratio: 0.02}}
links:
  front: {ground: {}, frame: {x: 2 m}, k: kF, laws: [{dry_friction: {force: 500 N}}]}
  rear: {ground: {}, frame: {x: -2 m}, k: kF}
"""


def bare_text(fragment):
    return html.unescape(re.sub("<.*?>", "", fragment))


def test_heave_pitch_and_bending_of_one_body_are_written_differently():
    m = derive(parse_vehicle(LIMBER))
    text = equations_text(m)
    assert "q1 = z_frame: rise of the COG" in text
    assert "q3 = eta_frame: rise of the ends of frame in its bending mode [m]" in text
    assert coordinate_latex(m) == [r"z_{\mathrm{frame}}", r"\theta_{\mathrm{frame}}", r"\eta_{\mathrm{frame}}"]
    assert [bare_text(fragment) for fragment in coordinate_mathml(m)] == ["zframe", "θframe", "ηframe"]
    travel = next(travel for where, travel, _ in law_rows(m) if where == "link front")
    written = bare_text(expression_mathml(m, travel))
    assert [written.count(symbol) for symbol in ("zframe", "θframe", "ηframe")] == [1, 1, 1]
    assert all(rf"{sign}_{{\mathrm{{frame}}}}" in equations_latex(m).split("Force laws")[1] for sign in ("z", r"\theta", r"\eta"))


def test_force_laws_are_written_with_their_travel_and_values():
    text = equations_text(model("with_laws"))
    assert "suspension of axle2: d = z_axle2 - z_tractor - theta_tractor*(b2 + xF)" in text
    assert "link seat: d = z_cab - z_driver - theta_cab*xD" in text
    assert "f = k*(max(d - clearance, 0) - max(-d - rebound, 0)); k = 2000000 [N/m], clearance = 0.03 [m]" in text
    assert "f = 5000000*d**3" in text
    assert "force = 500 [N m]" in text
    assert "Force laws" not in equations_text(model("tractor5"))
    assert [where for where, _, _ in law_rows(model("with_laws"))] == ["suspension of axle2", "link seat", "hinge fifth_wheel"]


@pytest.mark.parametrize("name", few(EVERY))
def test_latex_is_balanced_and_plain(name):
    m = model(name)
    document = equations_latex(m)
    bare = re.sub(r"\\[\\{}%$#&_]", "", document)
    assert bare.count("{") == bare.count("}")
    assert document.count(r"\left") - document.count(r"\leftarrow") == document.count(r"\right")
    opened, closed = (sorted(re.findall(rf"\\{word}{{(\w+\*?)}}", document)) for word in ("begin", "end"))
    assert opened == closed
    assert document.isascii() or "µ" not in document
    for matrix in matrices(m):
        assert f"${matrix.symbol}$: " in document
    assert ("bmatrix" in document) == any(max(matrix.shape) <= 10 for matrix in matrices(m))


@pytest.mark.skipif(shutil.which("pdflatex") is None, reason="needs pdflatex")
@pytest.mark.parametrize("name", ["tractor5", "with_laws", "road_train", "rig"])
def test_latex_compiles(name, tmp_path):
    (tmp_path / "equations.tex").write_text(equations_latex(model(name)), encoding="utf-8")
    command = ["pdflatex", "-interaction=nonstopmode", "-halt-on-error", "-no-shell-escape", "equations.tex"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, timeout=120, check=False)
    assert done.returncode == 0, done.stdout.decode(errors="replace")[-2000:]
    wide = [float(width) for width in re.findall(r"Overfull \\hbox \(([\d.]+)pt", done.stdout.decode(errors="replace"))]
    assert max(wide, default=0.0) < 30.0


@pytest.mark.parametrize("name", few(EVERY))
def test_mathml_is_well_formed_and_complete(name):
    m = model(name)
    sections = equations_mathml(m)
    assert [section.symbol for section in sections] == [matrix.symbol for matrix in matrices(m)]
    fragments = [balance_mathml(m), *coordinate_mathml(m)]
    for section, matrix in zip(sections, matrices(m), strict=True):
        fragments += [section.whole] if section.whole else []
        fragments += [fragment for _, left, value in section.rows for fragment in (left, value)]
        assert bool(section.whole) == (max(matrix.shape) <= 10)
        if section.whole:
            assert section.whole.count("<mtr>") == matrix.shape[0]
            assert section.whole.count("<mtd>") == matrix.shape[0] * matrix.shape[1]
        else:
            assert len(section.rows) == len(matrix.entries)
    for fragment in fragments:
        root = ElementTree.fromstring(html.unescape(fragment).replace("&", "&amp;"))
        assert root.tag == "math"
        assert "-" not in [item.text for item in root.iter("mo")]


def test_a_long_entry_stands_below_its_matrix():
    section = next(item for item in equations_mathml(model("tractor5")) if item.symbol == "M")
    assert [place for place, _, _ in section.rows] == ["2,2", "2,3", "3,3"]
    assert "<mtext>2,2</mtext>" in section.whole


@pytest.mark.parametrize(
    ("text", "base", "index", "upright"),
    [
        ("mT", "m", "T", False),
        ("kt1", "k", "t1", False),
        ("b1", "b", "1", False),
        ("L1h", "L", "1h", False),
        ("LSt", "L", "St", False),
        ("m01", "m", "01", False),
        ("kt12", "k", "t12", False),
        ("a", "a", "", False),
        ("k_rear", "k", "rear", False),
        ("kt_rear", "k", "t,rear", False),
        ("mu", "μ", "", False),
        ("beta2", "β", "2", False),
        ("rho_air", "ρ", "air", False),
        ("mass", "mass", "", True),
        ("cab", "cab", "", True),
        ("hub_mass", "hub_mass", "", True),
        ("push.shift", "push.shift", "", True),
    ],
)
def test_names_are_subscripted(text, base, index, upright):
    assert split_name(text) == Name(base, index, upright)


def test_no_two_parameters_of_a_model_are_written_alike():
    for name in EVERY:
        names = list(model(name).vehicle.parameters)
        assert len({latex_name(split_name(item)) for item in names}) == len(names)


def test_names_do_not_become_accents_or_powers():
    # sympy itself would print kbar as k with a bar and mprime with a prime
    assert "bar" in expression_mathml(model("tractor5"), sp.Symbol("kbar", real=True))
    assert latex_name(split_name("mprime")) == r"\mathrm{mprime}"


def test_tidy_turns_negative_sums_only():
    a, b, k = sp.symbols("a b k", real=True)
    assert str(tidy(-k * (-a - b))) == "k*(a + b)"
    assert str(tidy(k * (-a - b) ** 2)) == "k*(a + b)**2"
    assert str(tidy(k * (a - b))) == "k*(a - b)"
    assert str(tidy(k / (-a - b))) == str(k / (-a - b))
    assert tidy(sp.sqrt(a) - 2 * k) == sp.sqrt(a) - 2 * k


def test_gravity_is_written_as_g():
    m = sp.Symbol("m", real=True)
    assert str(gravity_symbol(sp.Float("9.81", 17) * -m, 9.81)) == "-g*m"


@pytest.mark.parametrize(("value", "text"), [(3.46, "3.46"), (0.1 + 0.2, "0.3"), (1e-9, "1e-09"), (2.5e13, "2.5e+13")])
def test_numbers_have_no_noise(value, text):
    assert number_text(sp.Float(value, 17)) == text


def test_latex_text_escapes_everything():
    assert latex_text("50 % & #1 $x$ {y} a_b ~^\\") == r"50 \% \& \#1 \$x\$ \{y\} a\_b \textasciitilde{}\textasciicircum{}\textbackslash{}"
    assert latex_text("é – µ²\n车") == r"é -- \ensuremath{\mu}\ensuremath{^2} ?"
    assert r"\frac" not in equations_latex(model("with_laws")).split(r"\subsection")[0]
    assert HOSTILE not in equations_latex(model("with_laws"))


@pytest.mark.parametrize(("unit", "written"), [("kg m^2", r"$\mathrm{kg\,m^{2}}$"), ("no unit", "--"), ("m^-1", r"$\mathrm{m^{-1}}$")])
def test_units_in_latex(unit, written):
    assert unit_latex(unit) == written


def test_a_road_train_is_written_in_seconds():
    m = model("road_train")
    start = time.perf_counter()
    equations_text(m), equations_latex(m), equations_mathml(m)
    assert time.perf_counter() - start < 8.0
