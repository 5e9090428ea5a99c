"""What may be a name, a heading or a text: the rules themselves, every place where files give names, and YAML that vehgen writes."""

import json
import unicodedata

import pytest
from hypothesis import given
from hypothesis import strategies as st

from vehgen.cargo import load_cargo
from vehgen.cargo.frame_file import load_frame
from vehgen.effects.entry import load_effects
from vehgen.errors import InputError, did_you_mean, shown
from vehgen.files.document import read_text
from vehgen.files.names import MAX_TEXT, as_name, is_column, is_identifier, is_name, unprintable
from vehgen.files.yaml_writer import even_text, yaml_document, yaml_text
from vehgen.simulate import load_run
from vehgen.vehicle import load_vehicle, parse_vehicle
from vehgen.vehicle.writing import variant_text

GOOD_NAMES = ("a", "_", "7", "DHCM-1-2", "v1.2_b-c", "挂车", "été", "Ωmega", "x" * 64, "٣")
BAD_NAMES = (
    "", " ", "a b", "a\tb", "a\nb", "-a", ".a", "=cmd|' /C calc'!A0", "+1", "@SUM(1)", "a/b", "a\\b", "a:b", "a'b", 'a"b', "a&b", "<b>",
    "{a}", "${a}", "[/x]", "$x$", "%n", "a;b", "a\u202eb", "a\u200bb", "a\u00adb", "\ufeffa", "ﬁn", "x²", "e\u0301", "x" * 65,
    "a\x00", "🚚",
)  # fmt: skip
ODD = "\"\"\"\n'''\\ \t{{}} ${x} </script> # : - ? & * ! | > % @ ` \u00e9 \U0001f69a"


def test_what_may_be_a_name():
    assert all(is_name(name) for name in GOOD_NAMES)
    assert [name for name in BAD_NAMES if is_name(name)] == []
    assert is_identifier("kT_1")
    assert not any(is_identifier(name) for name in ("1k", "_k", "k-1", "k.1", "ké", "", "k" * 65, "k\n"))


@given(st.text())
def test_any_text_has_a_nearest_name(text):
    name = as_name(text)
    assert is_name(name)
    assert not is_name(text) or name == text


@given(st.text(max_size=300))
def test_a_heading_stays_on_its_line(text):
    if is_column(text):
        assert len(text.splitlines()) <= 1
        assert not any(unicodedata.category(character) in ("Cc", "Cs") for character in text)


VEHICLE = """\
name: rig
title: a rig
parameters:
  mB: {value: 900 kg, meaning: mass}
bodies:
  frame: {mass: mB, motions: [heave], title: frame}
axles:
  front: {body: frame, tyre: {k: 100 kN/m}, title: tyre}
links:
  post: {ground: {}, frame: {}, k: 10 kN/m, title: post, laws: [{law: {force: k3*d^3, parameters: {k3: 1 N/m^3}}}]}
sets:
  soft: {mB: 800 kg}
"""
RUN = """\
vehicle: vehicle.yaml
title: a run
speed: 2 m/s
duration: 1 s
forces: {shaker: {body: frame, harmonic: {amplitude: 1 N, frequency: 1 Hz}}}
displacements: {post: {harmonic: {amplitude: 1 mm, frequency: 1 Hz}}}
sensors:
  L1: {body: frame, channels: {acceleration: az, velocity: {column: v}}}
outputs: {load: {axle: front, quantity: tyre_load}}
"""
CARGO = """\
name: box
title: a box
source: nowhere
on: frame
behind: frame
rigid: {mass: 1 t, length: 1 m, height: 1 m, front: 0 m}
"""
EFFECTS = """\
effects:
  stiffer:
    title: a stiffer spring
    meaning: a spring
    attaches: suspension
    force: k3*d^3
    parameters:
      k3: {meaning: cubic stiffness, unit: N/m^3, low: 1e4, high: 1e9, starts: [1e7]}
"""

FRAME = """\
name: module
title: a small box
source: nowhere
on: semitrailer
behind: fifth_wheel
front: 0.5 m
size: {length: 2.4 m, width: 1.2 m, height: 1.0 m}
materials:
  board: {E: 8 GPa, nu: 0.25, density: 700 kg/m^3}
sections:
  joist: {bar: {height: 50 mm, width: 10 mm}}
panels:
  floor: {layers: [{material: board, thickness: 20 mm}]}
mesh: {size: 0.2 m}
damping: [{frequency: 10 Hz, ratio: 0.02}, {frequency: 50 Hz, ratio: 0.02}]
"""

# file, line with the name in it, the name
PLACES = [
    (VEHICLE, "name: rig", "rig"),
    (VEHICLE, "  mB: {value: 900 kg", "mB"),
    (VEHICLE, "  frame: {mass", "frame"),
    (VEHICLE, "  front: {body", "front"),
    (VEHICLE, "  post: {ground", "post"),
    (VEHICLE, "  post: {ground: {}, frame: {}", "frame: {}"),
    (VEHICLE, "[{law: {force", "law: {force"),
    (VEHICLE, "parameters: {k3: 1", "k3: 1"),
    (VEHICLE, "  soft: {mB", "soft"),
    (VEHICLE, "  soft: {mB", "mB: 800"),
    (RUN, "forces: {shaker", "shaker"),
    (RUN, "displacements: {post", "post"),
    (RUN, "  L1: {body", "L1"),
    (RUN, "outputs: {load", "load"),
    (CARGO, "name: box", "box"),
    (FRAME, "name: module", "module"),
    (FRAME, "  board: {E", "board"),
    (FRAME, "  joist: {bar", "joist"),
    (EFFECTS, "  stiffer:", "stiffer"),
    (EFFECTS, "      k3: {", "k3"),
]
LOADERS = {VEHICLE: load_vehicle, RUN: load_run, CARGO: load_cargo, FRAME: load_frame, EFFECTS: load_effects}


def refusal(tmp_path, text, changed):
    (tmp_path / "vehicle.yaml").write_text(VEHICLE, encoding="utf-8")
    path = tmp_path / ("vehicle.yaml" if text is VEHICLE else "file.yaml")
    LOADERS[text](_written(path, text))
    with pytest.raises(InputError) as caught:
        LOADERS[text](_written(path, changed))
    return caught.value


def _written(path, text):
    path.write_text(text, encoding="utf-8")
    return path


def place_of(text, line, found):
    """Return line and column, from 1, of `found` within the line that holds `line`."""
    row, whole = next((i, whole) for i, whole in enumerate(text.splitlines(), 1) if line in whole)
    return row, whole.index(found, whole.index(line)) + 1


@pytest.mark.parametrize("bad", ["=cmd()", 'pwn"""\nopen("x")\n"""', "a" * 1000, "-x", "a/../b"])
@pytest.mark.parametrize(("text", "line", "old"), PLACES)
def test_a_bad_name_is_refused_where_it_stands(tmp_path, text, line, old, bad):
    name = old.partition(":")[0]
    row, column = place_of(text, line, old)
    lines = text.splitlines()
    lines[row - 1] = lines[row - 1][: column - 1] + json.dumps(bad) + lines[row - 1][column - 1 + len(name) :]
    error = refusal(tmp_path, text, "\n".join(lines))
    assert (error.position.line, error.position.column) == (row, column)
    assert "cannot be a name" in error.message
    assert len(error.message) < 300
    assert "\n" not in str(error)


def test_every_text_of_a_file_is_checked(tmp_path):
    for text in LOADERS:
        for word in ("title: ", "meaning: ", "source: "):
            if word not in text:
                continue
            start = text.index(word) + len(word)
            end = min(text.find(sign, start) for sign in ",}\n" if text.find(sign, start) > 0)
            row, column = text.count("\n", 0, start) + 1, start - text.rfind("\n", 0, start)
            for bad, why in (("a\u202eb", "U+202E"), ("x" * (MAX_TEXT + 1), "too long"), ("a\x07", "U+0007"), ("a\u2028b", "U+2028")):
                error = refusal(tmp_path, text, text[:start] + json.dumps(bad) + text[end:])
                assert why in error.message
                assert (error.position.line, error.position.column) == (row, column)


def test_a_heading_may_be_anything_on_one_line_and_names_its_channel_if_it_can(tmp_path):
    _written(tmp_path / "vehicle.yaml", VEHICLE)
    for heading, name in (
        ("a_z", "a_z"),
        ("Acceleration z (m/s^2)", "L1_acceleration"),
        ("=1+2", "L1_acceleration"),
        ("", "L1_acceleration"),
    ):
        run = load_run(_written(tmp_path / "file.yaml", RUN.replace("acceleration: az", f"acceleration: {json.dumps(heading)}")))
        assert run.outputs()[0].name == name
        assert run.file.sensors["L1"].column("L1", "acceleration") == (heading or "L1_acceleration")
    for old in ("acceleration: az", "column: v"):
        row, column = place_of(RUN, old, old.partition(": ")[2])
        for bad in ("a\nb", "x" * 201, "a\tb"):
            error = refusal(tmp_path, RUN, RUN.replace(old, f"{old.partition(':')[0]}: {json.dumps(bad)}"))
            assert "cannot head a column" in error.message
            assert error.position.line == row
            assert error.position.column in (column, column - len("{column: "))


def test_no_channel_takes_the_name_of_the_time(tmp_path):
    error = refusal(tmp_path, RUN, RUN.replace("outputs: {load", "outputs: {t"))
    assert "cannot be named 't'" in error.message
    assert (error.position.line, error.position.column) == place_of(RUN, "outputs: {load", "load")


def test_a_vehicle_without_a_name_takes_that_of_its_file(tmp_path):
    path = _written(tmp_path / "my rig (2).yaml", VEHICLE.removeprefix("name: rig\n"))
    assert load_vehicle(path).name == "my_rig__2_"


def test_errors_quote_little_of_a_file_and_escape_it():
    assert shown("a\u202eb") == r"'a\u202eb'"
    assert shown("x" * 10_000) == "'" + "x" * 57 + "...'"
    assert len(did_you_mean("y" * 10_000, ["x" * 10_000] * 30)) < 1500
    assert "\u202e" not in str(InputError("a\u202eb\n"))
    assert len(str(InputError("x" * 10_000))) <= 2000
    with pytest.raises(InputError) as caught:
        parse_vehicle(VEHICLE.replace("body: frame", f"body: {'z' * 10_000}"))
    assert len(str(caught.value)) < 300


TEXTS = st.text(alphabet=st.characters(exclude_categories=("Cs",)), max_size=30).filter(lambda text: unprintable(text) is None)
LEAVES = st.one_of(TEXTS, st.integers(-(10**9), 10**9), st.floats(allow_nan=False, allow_infinity=False), st.booleans(), st.none())
TREES = st.recursive(LEAVES, lambda inner: st.lists(inner, max_size=3) | st.dictionaries(TEXTS, inner, max_size=3), max_leaves=12)


@given(st.dictionaries(TEXTS, TREES, min_size=1, max_size=4))
def test_whole_files_that_vehgen_writes_read_back(data):
    assert read_text(yaml_document(data), "<text>").plain() == data


def read_back(scalar):
    return read_text(f"- {scalar}\n- {{key: {scalar}, other: 1}}\n", "<text>").plain()


@given(TEXTS)
def test_what_vehgen_writes_as_yaml_reads_back(text):
    assert read_back(yaml_text(text)) == [text, {"key": text, "other": 1}]
    assert read_back(yaml_text(even_text(text)))[0] == " ".join(text.split())


@pytest.mark.parametrize(
    "text", [ODD, "null", "true", "NO", "1e3", "0x10", "~", "", " a ", "2020-01-01", ".nan", "a: b", "a #b", "- a", "'", "?0"]
)
def test_words_that_yaml_reads_as_something_else_read_back(text):
    assert read_back(yaml_text(text)) == [text, {"key": text, "other": 1}]


def test_a_file_with_odd_texts_is_written_and_read_again(tmp_path):
    base = load_vehicle(_written(tmp_path / "it's a (base).yaml", VEHICLE))
    text = variant_text(base, tmp_path, "null", ODD, {"mB": 850.0}, [ODD], {"mB": "note"})
    again = load_vehicle(_written(tmp_path / "variant.yaml", text))
    assert again.name == "null"
    assert again.title == " ".join(ODD.split())
    assert again.values()["mB"] == 850.0
