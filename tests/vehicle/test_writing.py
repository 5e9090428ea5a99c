"""YAML that vehgen writes: whatever the texts are, the file reads back as it was meant."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.vehicle.rig import GOOD
from vehgen.files.document import read_text
from vehgen.files.names import unprintable
from vehgen.files.units import FREQUENCY, NAMED_DIMENSIONS, NONE
from vehgen.files.yaml_writer import even_text, yaml_document, yaml_text
from vehgen.vehicle import load_vehicle
from vehgen.vehicle.writing import variant_text

ODD = "\"\"\"\n'''\\ \t{{}} ${x} </script> # : - ? & * ! | > % @ ` \u00e9 \U0001f69a"
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
    path = tmp_path / "it's a (base).yaml"
    path.write_text(GOOD, encoding="utf-8")
    base = load_vehicle(path)
    text = variant_text(base, tmp_path, "null", ODD, {"mB": 850.0}, [ODD], {"mB": "note"})
    variant = tmp_path / "variant.yaml"
    variant.write_text(text, encoding="utf-8")
    again = load_vehicle(variant)
    assert again.name == "null"
    assert again.title == " ".join(ODD.split())
    assert again.values()["mB"] == 850.0


def test_a_parameter_of_every_unit_reads_back(tmp_path):
    units = {
        f"p{i}": str(dimension) if dimension != FREQUENCY else "s^-1"
        for i, dimension in enumerate(NAMED_DIMENSIONS.values())
        if dimension != NONE
    }
    own = "".join(f"  {name}: {{value: 1.5 {unit}}}\n" for name, unit in units.items())
    (tmp_path / "base.yaml").write_text(GOOD.replace("parameters:\n", f"parameters:\n{own}"), encoding="utf-8")
    base, values = load_vehicle(tmp_path / "base.yaml"), dict.fromkeys(units, 2.25)
    (tmp_path / "again.yaml").write_text(variant_text(base, tmp_path, "again", "", values, [], {}), encoding="utf-8")
    again = load_vehicle(tmp_path / "again.yaml")
    assert {name: again.values()[name] for name in units} == values
    assert all(again.dimensions[name] == base.dimensions[name] for name in units)
