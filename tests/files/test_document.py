"""Reading YAML: the place of every key and value, and files that a stranger could send."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

import pytest

from vehgen.errors import InputError
from vehgen.files.document import MAX_DOCUMENT_BYTES, Located, read_document, read_text
from vehgen.vehicle import bundled_models, load_vehicle


def walk(node: Located, path: tuple[str | int, ...] = ()) -> Iterator[tuple[tuple[str | int, ...], Located]]:
    yield path, node
    if isinstance(node.value, dict):
        for key, item in node.value.items():
            yield from walk(item, (*path, key))
    elif isinstance(node.value, list):
        for index, item in enumerate(node.value):
            yield from walk(item, (*path, index))


@pytest.mark.parametrize("name", sorted(bundled_models()))
def test_every_key_and_value_of_a_model_stands_where_it_is_said_to(name: str):
    path = bundled_models()[name]
    lines = path.read_text(encoding="utf-8").splitlines()
    document = read_document(path)
    count = 0
    for where, node in walk(document):
        position = document.find(where)
        assert position.file == path
        rest = lines[position.line - 1][position.column - 1 :]
        if isinstance(node.value, (dict, list)):
            opening = "{" if isinstance(node.value, dict) else "["
            assert rest.startswith((opening, *list(node.value)[:1]))
        elif not rest.startswith((">-", '"')):
            assert rest.startswith(str(node.value).lower() if isinstance(node.value, bool) else str(node.value))
            assert document.find(where, offset=0) == position
        if where and isinstance(where[-1], str):
            key = document.find(where, key=True)
            assert lines[key.line - 1][key.column - 1 :].startswith(f"{where[-1]}:")
            count += 1
    assert count > 10


TEXT = """\
# a comment
name: 'small one'
parameters:
  b1: {value: "1.3 m",   range: [0.8 m, 2.2 m]}
  'b2' : {value: 7}
bodies:
  - first
  -   second
"long": >-
  two
  lines
escaped: "a\\tb"
empty:
"""


@pytest.mark.parametrize(
    ("path", "key", "offset", "place"),
    [
        (("name",), False, None, (2, 7)),
        (("name",), False, 0, (2, 8)),
        (("name",), False, 6, (2, 14)),
        (("name",), True, None, (2, 1)),
        (("parameters",), False, None, (4, 3)),
        (("parameters",), True, None, (3, 1)),
        (("parameters", "b1"), False, None, (4, 7)),
        (("parameters", "b1"), False, 3, (4, 7)),
        (("parameters", "b1", "value"), False, None, (4, 15)),
        (("parameters", "b1", "value"), False, 4, (4, 20)),
        (("parameters", "b1", "range"), True, None, (4, 26)),
        (("parameters", "b1", "range", 1), False, None, (4, 41)),
        (("parameters", "b1", "range", 1), False, 4, (4, 45)),
        (("parameters", "b1", "range", 2), False, None, (4, 33)),
        (("parameters", "b2"), True, None, (5, 3)),
        (("parameters", "b2", "value"), False, None, (5, 18)),
        (("parameters", "b3", "value"), False, None, (4, 3)),
        (("bodies", 1), False, None, (8, 7)),
        (("long",), True, None, (9, 1)),
        (("long",), False, 5, (9, 9)),
        (("escaped",), False, 3, (12, 10)),
        (("empty",), True, None, (13, 1)),
        (("empty",), False, None, (13, 1)),
        (("empty",), False, 0, (13, 1)),
        ((), False, None, (2, 1)),
    ],
)
def test_places(path: tuple[str | int, ...], key: bool, offset: int | None, place: tuple[int, int]):
    position = read_text(TEXT, "a.yaml").find(path, key=key, offset=offset)
    assert (position.line, position.column) == place
    assert str(position) == f"a.yaml:{place[0]}:{place[1]}"


def test_plain_data():
    assert read_text(TEXT, "a.yaml").plain() == {
        "name": "small one",
        "parameters": {"b1": {"value": "1.3 m", "range": ["0.8 m", "2.2 m"]}, "b2": {"value": 7}},
        "bodies": ["first", "second"],
        "long": "two lines",
        "escaped": "a\tb",
        "empty": None,
    }


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("7", 7),
        ("-7", -7),
        ("0x10", 16),
        ("1.5", 1.5),
        ("1e3", 1000.0),
        ("true", True),
        ("False", False),
        ("null", None),
        ("~", None),
        ("yes", "yes"),
        ("no", "no"),
        ("'7'", "7"),
        ("2020-01-01", "2020-01-01"),
        ("8000 kg", "8000 kg"),
        ("12:30:00", "12:30:00"),
    ],
)
def test_scalars(text: str, value: object):
    found = read_text(f"a: {text}\n", "a.yaml").plain()["a"]
    assert found == value
    assert type(found) is type(value)


@pytest.mark.parametrize("blank", ["\ufeff{}", "{}"])
@pytest.mark.parametrize("newline", ["\n", "\r\n"])
def test_byte_order_mark_and_line_ends_of_windows(blank: str, newline: str, tmp_path: Path):
    path = tmp_path / "a.yaml"
    path.write_bytes(blank.format(f"a: 1{newline}b: {{c: 2 m}}{newline}").encode())
    document = read_document(path)
    assert document.plain() == {"a": 1, "b": {"c": "2 m"}}
    position = document.find(("b", "c"))
    assert (position.line, position.column) == (2, 8)


def test_an_alias_stands_for_its_anchor():
    document = read_text("a: &x {k: 1 N/m}\nb: *x\n", "a.yaml")
    assert document.plain()["b"] == {"k": "1 N/m"}
    assert document.find(("b", "k")).line == 1


@pytest.mark.parametrize(
    ("text", "place", "message"),
    [
        ("", (1, 1), "the file is empty"),
        ("# only a comment\n", (1, 1), "the file is empty"),
        ("a: 1\na: 2\n", (2, 1), "duplicate name 'a'; each may stand once"),
        ("b:\n  a: 1\n  c: 2\n  'a': 3\n", (4, 3), "duplicate name 'a'"),
        ("b: {a: 1, c: 2, a: 3}\n", (1, 17), "duplicate name 'a'"),
        ("1: a\n'1': b\n", (2, 1), "duplicate name '1'"),
        ("a:\n\tb: 1\n", (2, 1), "not valid YAML: found character '\\t'"),
        ("a: 1\n\tb: 2\n", (2, 1), "not valid YAML"),
        ("a: {b: 1\n", (1, 8), "not valid YAML: expected ',' or '}', but got '<stream end>'"),
        ("a: [1, 2}\n", (1, 9), "not valid YAML"),
        ("a: b: c\n", (1, 5), "not valid YAML: mapping values are not allowed here"),
        ("a: 'b\n", (1, 5), "not valid YAML"),
        ("a: *nowhere\n", (1, 4), "not valid YAML: found undefined alias 'nowhere'"),
        ("a: 1\n---\nb: 2\n", (2, 1), "not valid YAML: but found another document"),
        ("a: @b\n", (1, 4), "not valid YAML: found character '@' that cannot start any token"),
        ("? [a, b]\n: 1\n", (1, 3), "a key must be a name"),
        ("{a: 1}: 2\n", (1, 1), "a key must be a name"),
        ("a: !!python/object/apply:os.system ['true']\n", (1, 4), "the tag tag:yaml.org,2002:python/object/apply:os.system is not allowed"),
        ("a: !!python/name:os.system\n", (1, 4), "the tag tag:yaml.org,2002:python/name:os.system is not allowed"),
        ("b:\n - !vehicle {a: 1}\n", (2, 4), "the tag !vehicle is not allowed"),
        ("a: !!bool yes\n", (1, 4), "true or false was expected, found 'yes'"),
        ("%YAML 1.1\n---\na: yes\n", (1, 1), "YAML 1.2 was expected, found '1.1'"),
        ("a: !!set {b, c}\n", (1, 4), "the tag tag:yaml.org,2002:set is not allowed"),
        ("a: !!binary aGVsbG8=\n", (1, 4), "the tag tag:yaml.org,2002:binary is not allowed"),
        ("!!python/name:os.system a: 1\n", (1, 1), "the tag tag:yaml.org,2002:python/name:os.system is not allowed"),
        ("%TAG ! tag:evil,2000:\n---\na: !b c\n", (3, 4), "the tag tag:evil,2000:b is not allowed"),
        ("a: &x [*x]\n", (1, 4), "nested more than 20 deep"),
        ("a: " + "[" * 30 + "]" * 30 + "\n", (1, 24), "nested more than 20 deep"),
        ('a: "\\e[2J"\n', (1, 4), "the character U+001B is not allowed"),
        ('a: "b\\0c"\n', (1, 4), "the character U+0000 is not allowed"),
        ('a: "\\ud800"\n', (1, 4), "the character U+D800 is not allowed"),
        ('"a\\x07": 1\n', (1, 1), "the character U+0007 is not allowed"),
        ("a: \x00\n", (1, 4), "not valid YAML: unacceptable character #x0000"),
    ],
)
def test_refused_with_its_place(text: str, place: tuple[int, int], message: str):
    with pytest.raises(InputError) as caught:
        read_text(text, "a.yaml")
    assert str(caught.value).startswith(f"a.yaml:{place[0]}:{place[1]}: {message}")
    assert "\n" not in str(caught.value)


def test_aliases_that_multiply_are_refused():
    bomb = "a0: &a0 [1, 1, 1, 1, 1, 1, 1, 1, 1, 1]\n" + "".join(f"a{i}: &a{i} [{', '.join([f'*a{i - 1}'] * 10)}]\n" for i in range(1, 15))
    with pytest.raises(InputError, match=r"a.yaml:\d+:\d+: more than 20000 values \(do aliases multiply\?\)"):
        read_text(bomb, "a.yaml")


@pytest.mark.parametrize("opening", ["[", "{a: ", "- ", "? ", "a:\n "])
def test_nesting_that_exhausts_the_stack_is_refused(opening: str):
    text = opening * 3000 if "\n" not in opening else "".join(" " * i + "a:\n" for i in range(900))
    with pytest.raises(InputError, match=r"a\.yaml:\d+:\d+: (nested|not valid YAML)"):
        read_text(text, "a.yaml")


def test_a_file_of_ten_megabytes_is_refused(tmp_path: Path):
    path = tmp_path / "large.yaml"
    path.write_bytes(b"a: 1\n" * 2_000_000)
    with pytest.raises(InputError, match=f"10000000 bytes; a YAML file of at most {MAX_DOCUMENT_BYTES} bytes was expected"):
        read_document(path)


@pytest.mark.skipif(not Path("/dev/zero").exists(), reason="needs a file without an end")
def test_a_file_without_an_end_is_not_read_for_ever():
    with pytest.raises(InputError, match="/dev/zero is a pipe, socket or device"):
        read_document(Path("/dev/zero"))


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"name: \xff\xfe", r"a\.yaml:1:7: not UTF-8 text"),
        ("name: small\n".encode("utf-16"), "not UTF-8 text"),
        ("# \u00fc\nname: caf".encode() + b"\xe9\n", r"a\.yaml:2:10: not UTF-8 text: the byte 0xe9"),
        (b"", "the file is empty"),
        (b"\x00" * 100, "not valid YAML"),
        (b"\x89PNG\r\n\x1a\n", "not UTF-8 text"),
    ],
)
def test_files_that_are_no_text(content: bytes, message: str, tmp_path: Path):
    path = tmp_path / "a.yaml"
    path.write_bytes(content)
    with pytest.raises(InputError, match=message):
        read_document(path)


def test_no_file_a_folder_and_a_locked_file(tmp_path: Path):
    with pytest.raises(InputError, match=r"^no file .*absent\.yaml$"):
        read_document(tmp_path / "absent.yaml")
    with pytest.raises(InputError, match="is a folder; a YAML file was expected"):
        read_document(tmp_path)
    with pytest.raises(InputError, match="File name too long"):
        read_document(tmp_path / ("a" * 300))
    with pytest.raises(InputError, match="File name too long"):
        load_vehicle("a" * 300)
    locked = tmp_path / "locked.yaml"
    locked.write_text("a: 1\n")
    locked.chmod(0)
    if not os.access(locked, os.R_OK):
        with pytest.raises(InputError, match=r"cannot read .*locked\.yaml: Permission denied"):
            read_document(locked)


@pytest.mark.parametrize("digits", [401, 5000, 400_000])
def test_a_number_of_many_digits_stays_text_and_is_refused_in_one_line(digits: int, tmp_path: Path):
    assert read_text("a: 0x" + "f" * digits, "a.yaml").plain() == {"a": "0x" + "f" * digits}
    path = tmp_path / "a.yaml"
    path.write_text("bodies:\n  b: {mass: 0x" + "f" * digits + "}\n")
    with pytest.raises(InputError, match=r"a\.yaml:2:"):
        load_vehicle(path)


@pytest.mark.parametrize("text", ["a: [\n", "a: {\n\n\n", "a: 'b\n\n", "- \n- {\n", "a:\n  -\n", "a: |\n", "? \n", "a: [1,\n"])
def test_no_place_lies_beyond_the_end(text: str):
    lines = text.splitlines()
    try:
        places = [node.position for _, node in walk(read_text(text, "a.yaml"))]
    except InputError as error:
        places = [error.position]
    for place in places:
        assert place is not None
        assert 1 <= place.line <= len(lines)
        assert 1 <= place.column <= len(lines[place.line - 1]) + 1


def test_what_the_reader_of_yaml_quotes_is_cut():
    with pytest.raises(InputError, match="not valid YAML: found undefined alias") as caught:
        read_text(f"a: *{'1+' * 5000}\n", "a.yaml")
    assert len(str(caught.value)) < 300
