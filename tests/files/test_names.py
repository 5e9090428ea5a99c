"""What may be a name, a heading or a text, and how errors quote what a file says."""

import unicodedata

from hypothesis import given
from hypothesis import strategies as st

from vehgen.errors import InputError, did_you_mean, shown
from vehgen.files.names import as_name, is_column, is_identifier, is_name

GOOD_NAMES = ("a", "_", "7", "DHCM-1-2", "v1.2_b-c", "挂车", "été", "Ωmega", "x" * 64, "٣")
BAD_NAMES = (
    "", " ", "a b", "a\tb", "a\nb", "-a", ".a", "=cmd|' /C calc'!A0", "+1", "@SUM(1)", "a/b", "a\\b", "a:b", "a'b", 'a"b', "a&b", "<b>",
    "{a}", "${a}", "[/x]", "$x$", "%n", "a;b", "a\u202eb", "a\u200bb", "a\u00adb", "\ufeffa", "ﬁn", "x²", "e\u0301", "x" * 65,
    "a\x00", "🚚",
)  # fmt: skip


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


def test_capitals_do_not_hide_the_nearest_name():
    assert did_you_mean("SPEED", ["speed", "step", "set"]) == "did you mean 'speed'?"
    assert did_you_mean("kf", ["kF", "KF", "kr"]) == "did you mean 'kF' or 'KF'?"
    assert did_you_mean("MASS", []) == "none is declared"


def test_errors_quote_little_of_a_file_and_escape_it():
    assert shown("a\u202eb") == r"'a\u202eb'"
    assert shown("x" * 10_000) == "'" + "x" * 57 + "...'"
    assert len(did_you_mean("y" * 10_000, ["x" * 10_000] * 30)) < 1500
    assert "\u202e" not in str(InputError("a\u202eb\n"))
    assert len(str(InputError("x" * 10_000))) <= 2000
