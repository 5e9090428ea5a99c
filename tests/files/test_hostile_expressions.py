"""Texts that try to do something: refused, in no time, and nothing runs."""

from __future__ import annotations

import subprocess
import sys

import pytest

from vehgen.errors import InputError
from vehgen.files.expression_parser import MAX_LENGTH
from vehgen.files.expressions import ExpressionError, parse
from vehgen.vehicle import parse_vehicle

CHARACTERS = "only numbers, units, parameter names, + - * / ** and sqrt, abs, sign, min, max may stand in an expression, found "
SYNTAX = "cannot read "
CALLS = "only sqrt, abs, sign, min, max may be called in an expression"
UNDERSCORE = "a name may not start with an underscore"
NODES = CHARACTERS.removesuffix(", found ")

HOSTILE = {
    "__import__('os').system('touch /tmp/x')": UNDERSCORE,
    "open(b1)": CALLS,
    "exec(b1)": CALLS,
    "eval(b1)": CALLS,
    "print(1)": CALLS,
    "getattr(b1, b2)": CALLS,
    "breakpoint()": CALLS,
    "sqrt(1)(2)": CALLS,
    "(sqrt)(2)(3)": CALLS,
    "min(*b1)": "min takes 2 arguments",
    "min(**b1)": CALLS,
    "min(1, 2, 3)": "min takes 2 arguments",
    "sqrt()": "sqrt takes 1 argument",
    "sqrt(1, 2)": "sqrt takes 1 argument",
    "max(b1=1, b2=2)": CHARACTERS + "'='",
    "b1.real": CHARACTERS + "'.'",
    "(1).real": CHARACTERS + "'.'",
    "b1[0]": CHARACTERS + "'['",
    "[b1][0]": CHARACTERS + "'['",
    "[x for x in b1]": CHARACTERS + "'['",
    "(x for x in b1)": NODES,
    "{b1: b2}": CHARACTERS + "'{'",
    "lambda: 1": CHARACTERS + "':'",
    "(lambda x: x)(1)": CHARACTERS + "':'",
    "(b1 := 2)": CHARACTERS + "':'",
    "b1 = 2": CHARACTERS + "'='",
    "b1 == b2": CHARACTERS + "'='",
    "b1 < b2": CHARACTERS + "'<'",
    "b1 if b1 else b2": NODES,
    "b1 and b2": NODES,
    "not b1": NODES,
    "b1 in b2": NODES,
    "b1 is b2": NODES,
    "b1, b2": NODES,
    "()": NODES,
    "await b1": NODES,
    "(yield b1)": NODES,
    "import os": SYNTAX,
    "b1; b2": CHARACTERS + "';'",
    "b1\\\n": CHARACTERS,
    "b1 # b2": CHARACTERS + "'#'",
    "'text'": CHARACTERS,
    '"text"': CHARACTERS,
    "f'{b1}'": CHARACTERS,
    "b'1'": CHARACTERS,
    "'\\d'": CHARACTERS,
    "b1 // b2": NODES,
    "b1 % b2": CHARACTERS + "'%'",
    "b1 @ b2": CHARACTERS + "'@'",
    "b1 << 2": CHARACTERS + "'<'",
    "b1 | b2": CHARACTERS,
    "~b1": CHARACTERS + "'~'",
    "`b1`": CHARACTERS + "'`'",
    "$b1": CHARACTERS,
    "...": CHARACTERS,
    "True": NODES,
    "None": NODES,
    "1j": "'j' after 1 is not a unit",
    "0x10": "'x10' after 0 is not a unit",
    "1_000": "'_000' after 1 is not a unit",
    "_q0": UNDERSCORE,
    "__class__": UNDERSCORE,
    "b1.__class__": CHARACTERS + "'.'",
    "1 + _q0": UNDERSCORE,
    "\uff3fq0 + 1": CHARACTERS,
    "s\u0071rt": "",
    "\u017fqrt(2)": CHARACTERS,
    "\u0663": CHARACTERS,
    "b\u00b2": CHARACTERS,
    "\u2212b1": CHARACTERS,
    "\x00": CHARACTERS,
    "b1\x00": CHARACTERS,
    "\ud800": CHARACTERS,
    "9**9**9": "an exponent must be a plain number between -10 and 10",
    "9**99999": "an exponent must be",
    "9**-99999": "an exponent must be",
    "b1**b2": "an exponent must be",
    "b1**(1 + 1)": "an exponent must be",
    "b1**(1/0)": "an exponent must be",
    "b1**(2 m)": "an exponent must be",
    "b1**1e999": "1e999 is too large a number",
    "9" * 400: "is too large a number",
    "1e999999999": "is too large a number",
    "m": "",
    "(": SYNTAX,
    ")": SYNTAX,
    "1 +": SYNTAX,
    "* 2": SYNTAX,
    "b1 b2": SYNTAX,
    "b1 2": SYNTAX,
    "1 m 2 m": SYNTAX,
    "": "an expression is empty",
    " \n\t ": "an expression is empty",
    "(" * 450 + "1" + ")" * 450: SYNTAX,
    "-" * 900 + "1": "nested",
    "+" * 900 + "1": "nested or: cannot read",
    "abs(" * 150 + "1" + ")" * 150: "nested or: cannot read",
    "1" + " + 1" * 200: "nested more than 100 deep",
    "b1 + " * 300 + "b1": "too long",
    "1" * 1_000_000: "an expression of 1000000 characters is too long (at most 1000)",
    "(" * 1_000_000: "too long",
    " " * 1_000_000: "too long",
}
FINE = [text for text, message in HOSTILE.items() if not message]


@pytest.mark.parametrize(("text", "message"), [(t, m) for t, m in HOSTILE.items() if m], ids=lambda item: repr(item)[:30])
def test_refused(text: str, message: str):
    with pytest.raises(ExpressionError) as caught:
        parse(text)
    assert any(part in str(caught.value) for part in message.split(" or: "))
    assert 0 <= caught.value.offset <= max(len(text), 1)


@pytest.mark.parametrize("text", FINE)
def test_a_name_is_but_a_name(text: str):
    assert parse(text).names == {text}


def test_the_longest_expression_and_the_deepest_are_read():
    text = ("b1 + " * 99 + "b1").ljust(MAX_LENGTH)
    assert parse(text).evaluate({"b1": 1.0}) == 100.0
    assert parse("(" * 90 + "b1" + ")" * 90).evaluate({"b1": 1.0}) == 1.0
    assert parse("-" * 100 + "b1").evaluate({"b1": 1.0}) == 1.0


@pytest.mark.parametrize("text", ["1/0", "1 m/(2 - 2)", "sqrt(-1)", "(0 - 8)**0.5", "(0 - 8)**(1/3)", "1e300**9", "0**-1"])
def test_what_has_no_value_is_an_error_and_no_crash(text: str):
    with pytest.raises(ExpressionError, match="has no value"):
        parse(text).evaluate({})


def test_towers_of_small_powers_end():
    text = "b1" + "**10" * 1
    tower = parse("(" * 30 + text + ")**10" * 30)
    with pytest.raises(ExpressionError, match="has no value"):
        tower.evaluate({"b1": 2.0})
    assert tower.evaluate({"b1": 1.0}) == 1.0


WATCHED = """
import sys
from tests.files.test_hostile_expressions import HOSTILE, refuse_all
seen = []
refuse_all(list(HOSTILE))
watching = True
def watch(event, arguments):
    if watching and event in ("exec", "import", "open", "os.system", "os.exec", "os.spawn", "subprocess.Popen", "object.__getattr__"):
        seen.append((event, repr(arguments)[:100]))
sys.addaudithook(watch)
refused = refuse_all(list(HOSTILE))
watching = False
exec("pass")
print(refused, seen)
"""


def refuse_all(texts: list[str]) -> int:
    """Parse every text, and as a vehicle's mass too; return how many were refused."""
    refused = 0
    for text in texts:
        try:
            parse(text)
        except ExpressionError:
            refused += 1
    return refused


def test_nothing_runs():
    """Python's own audit hook sees no code executed, no module imported, no file opened, no command run."""
    found = subprocess.run([sys.executable, "-c", WATCHED], capture_output=True, text=True, check=True)
    assert found.stdout.strip() == f"{len(HOSTILE) - len(FINE)} []"


@pytest.mark.parametrize("text", ["__import__('os').system('true')", "b1.real", "[1 for a in b]", "9**9**9", "(" * 400])
def test_in_a_file_they_are_input_errors_at_their_place(text: str):
    quoted = "'" + text.replace("'", "''") + "'"
    file = f"bodies:\n  body: {{mass: 1 kg, motions: [heave]}}\naxles:\n  axle: {{body: body, tyre: {{k: {quoted}}}}}\n"
    with pytest.raises(InputError, match=r"^bad\.yaml:4:\d+: ") as caught:
        parse_vehicle(file, "bad.yaml")
    assert len(str(caught.value)) < 1000
