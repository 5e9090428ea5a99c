"""Vehicle files: names that would be code, bombs, circles, depths."""

from __future__ import annotations

import json
import re
from dataclasses import replace

from tests.fuzzing.bulk_mutations import carried, chained, doubling, many
from tests.fuzzing.cases import Case
from tests.fuzzing.corpus.entry import HERE, Nasty, marked
from tests.fuzzing.hostile import MARK, TEXTS

REST = """\
bodies:
  body: {mass: 1 t, motions: [heave]}
axles:
  axle: {body: body, tyre: {k: 1 MN/m}}
"""
HOSTILE = [text for text in TEXTS if MARK in text and text != f"é{MARK}\U0001f69a"]
ALLOWED = re.compile(r"\w[\w.-]{0,63}")
"""A name, as docs/vehicle-file.md has it."""


def quoted(text: str) -> str:
    """Return a text as a double-quoted scalar of YAML."""
    return json.dumps(text)


def named(i: int, text: str) -> list[Nasty]:
    """Return vehicles whose name, body, axle, parameter or set is a hostile text."""
    name, allowed = quoted(text), ALLOWED.fullmatch(text) is not None
    axle = f"axles:\n  axle: {{body: {name}, tyre: {{k: 1 MN/m}}}}\n"
    return [
        marked("vehicle", f"name {i}", f"name: {'' if allowed else HERE}{name}\n{REST}", refused=not allowed),
        marked("vehicle", f"body {i}", f"bodies:\n  §{name}: {{mass: 1 t, motions: [heave]}}\n{axle}"),
        marked("vehicle", f"axle {i}", REST.replace("  axle:", f"  §{name}:")),
        marked("vehicle", f"parameter {i}", f"parameters:\n  §{name}: {{value: 1 kg}}\n{REST}"),
        marked("vehicle", f"set {i}", f"parameters:\n  p: {{value: 1 kg}}\nsets:\n  §{name}: {{p: 2 kg}}\n{REST}"),
    ]


def harmless_words(text: str, i: int) -> Nasty:
    """Return a vehicle whose free texts are hostile: accepted or refused, they are never code."""
    words = "".join(f"{key}: {quoted(text)}\n" for key in ("title", "source", "description"))
    return marked("vehicle", f"free text {i}", words + REST.replace("tyre", f"title: {quoted(text)}, tyre"), refused=False)


def with_files(nasty: Nasty, **files: str) -> Nasty:
    """Return an entry with more YAML files beside it."""
    more = {f"{name}.yaml": text.encode() for name, text in files.items()}
    return replace(nasty, case=replace(nasty.case, files={**nasty.case.files, **more}))


NO_UTF8 = b"name: x\ntitle: a\xff\xfeb\n" + REST.encode()
BOMB = "\n".join(f"b{i}: &b{i} [{', '.join([f'*b{i - 1}'] * 9)}]" for i in range(1, 10))

VEHICLES: tuple[Nasty, ...] = (
    *(nasty for i, text in enumerate(HOSTILE) for nasty in named(i, text)[: 5 if i < 3 else 1]),
    *(harmless_words(text, i) for i, text in enumerate(HOSTILE)),
    marked("vehicle", "alias bomb", f"b0: &b0 [x]\n{BOMB}\n{REST}"),
    marked("vehicle", "alias of itself", f"x: &x [*x]\n{REST}"),
    marked(
        "vehicle",
        "merge bomb",
        "x0: &x0 {a: 1}\n" + "\n".join(f"x{i}: &x{i} {{<<: [*x{i - 1}, *x{i - 1}]}}" for i in range(1, 30)) + "\n" + REST,
    ),
    marked("vehicle", "deep list", "x: " + "[" * 20000 + "]" * 20000 + "\n" + REST),
    marked("vehicle", "deep sequence", "- " * 20000 + "x\n"),
    marked("vehicle", "deep brackets", REST.replace("mass: 1 t", "mass: §" + "(" * 20000 + "1 t" + ")" * 20000)),
    marked("vehicle", "many minus signs", REST.replace("mass: 1 t", "mass: §" + "-" * 20001 + "1 t")),
    marked("vehicle", "long sum", REST.replace("mass: 1 t", "mass: §1 t" + " + 1 t" * 50000)),
    marked("vehicle", "tower of powers", REST.replace("mass: 1 t", "mass: §9**9**9**9**9 * 1 t")),
    marked("vehicle", "long number", REST.replace("1 t", "§" + "9" * 100000 + " kg")),
    marked("vehicle", "large integer", f"name: §{'9' * 10000}\n{REST}"),
    marked("vehicle", "huge mass", REST.replace("1 t", "§1e300 kg")),
    marked("vehicle", "huge unit", REST.replace("1 t", "§1 kg^99999999999")),
    marked("vehicle", "not a number", REST.replace("1 t", "§.nan")),
    marked("vehicle", "call", REST.replace("1 t", "§'__import__(\"os\").getpid() * 1 kg'")),
    marked("vehicle", "python tag", "name: §!!python/object/apply:os.system ['touch pwned']\n" + REST),
    Nasty("vehicle: no UTF-8", Case("vehicle", {"vehicle.yaml": NO_UTF8}, "vehicle.yaml"), ("vehicle.yaml", 2)),
    Nasty("vehicle: zero bytes", Case("vehicle", {"vehicle.yaml": b"\x00" * 100000}, "vehicle.yaml"), ("vehicle.yaml", 1)),
    marked("vehicle", "half surrogate", f'name: x\ntitle: §"\\ud800"\n{REST}', refused=False),
    marked("vehicle", "1000 bodies carried", json.dumps(carried(1000, circle=False), indent=1), refused=False),
    marked("vehicle", "1000 bodies in a circle", json.dumps(carried(1000, circle=True), indent=1)),
    marked("vehicle", "100 bodies in a circle", json.dumps(carried(100, circle=True), indent=1)),
    marked("vehicle", "chain of 51 bodies", json.dumps(chained(51), indent=1), refused=False),
    marked("vehicle", "chain of 100 bodies", json.dumps(chained(100), indent=1)),
    marked("vehicle", "100 axles, 98 links, 98 sets", json.dumps(many(98), indent=1), refused=False),
    marked("vehicle", "half a million values", f"x: [{'1,' * 490_000}1]\n{REST}"),
    marked("vehicle", "doubling", json.dumps(doubling(60, power=False), indent=1), refused=False),
    marked("vehicle", "powers", json.dumps(doubling(60, power=True), indent=1), refused=False),
    marked("vehicle", "power of a thousandth", "parameters: {p: {value: 2}}\n" + REST.replace("1 t", "1 t*p**1e-3"), refused=False),
    marked("vehicle", "parameter of itself", f"parameters:\n  a: {{equals: b}}\n  b: {{equals: a}}\n{REST}"),
    marked("vehicle", "extends itself", "extends: §vehicle.yaml\n"),
    with_files(marked("vehicle", "extends in a circle", "extends: a.yaml\n"), a="extends: b.yaml\n", b="extends: a.yaml\n"),
    with_files(marked("vehicle", "extends 1000 deep", "extends: e0.yaml\n"), **{f"e{i}": f"extends: e{i + 1}.yaml\n" for i in range(1000)}),
    *(
        marked("vehicle", f"extends {path}", f"name: x\nextends: §{path}\n")
        for path in ("/dev/zero", "/", "pipe", "/proc/self/mem", "x" * 5000)
    ),
    Nasty("vehicle: extends a password file", Case("vehicle", {"vehicle.yaml": b"extends: /etc/passwd\n"}, "vehicle.yaml")),
    *(
        Nasty(f"vehicle: is {kind}", Case("vehicle", {}, "vehicle.yaml", special={"vehicle.yaml": kind}))
        for kind in ("pipe", "folder", "link:/dev/zero", "link:/proc/self/mem", "link:vehicle.yaml", "link:absent")
    ),
    marked("vehicle", "singular stiffness", "bodies:\n  body: {mass: 1 kg, motions: [heave]}\n", command=("static", "vehicle.yaml")),
    marked("vehicle", "unknown body", REST.replace("body: body", "body: §bodyy"), command=("static", "vehicle.yaml")),
)
