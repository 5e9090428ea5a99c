"""Recordings and other tables: values, names and shapes that no sensor gives."""

from __future__ import annotations

from dataclasses import replace

from tests.fuzzing.cases import Case
from tests.fuzzing.corpus.entry import Nasty, marked
from tests.fuzzing.corpus.runs import RUN
from tests.fuzzing.hostile import MARK

HEALTHY = ["t,az", *(f"{i / 100:.2f},{(i * 7919 % 13) / 1000}" for i in range(401))]


def table(name: str, lines: list[str] | bytes, refused: bool = True) -> Nasty:
    """Return a run with a recording of these lines."""
    data = lines if isinstance(lines, bytes) else ("\n".join(lines) + "\n").encode("utf-8", "surrogatepass")
    found = marked("table", name, f"{RUN}recording: recording.csv\n", refused, recording_csv=data)
    return replace(found, case=replace(found.case, format="table"))


def with_cell(row: int, text: str) -> list[str]:
    """Return the healthy recording with another value in a row."""
    return [*HEALTHY[:row], f"{HEALTHY[row].partition(',')[0]},{text}", *HEALTHY[row + 1 :]]


def special(kind: str) -> Nasty:
    """Return a run whose recording is no regular file."""
    main = f"{RUN}recording: recording.csv\n".encode()
    truck = table("", []).case.files["my_truck.yaml"]
    case = Case("table", {"my_truck.yaml": truck, "table.yaml": main}, "table.yaml", special={"recording.csv": kind})
    return Nasty(f"table: recording is {kind}", case, ("table.yaml", main.count(b"\n")))


def recording(path: str) -> Nasty:
    """Return a run whose `recording` is a path that cannot be used."""
    return marked("table", f"recording {path[:20]}", f"{RUN}recording: §{path}\n")


TABLES: tuple[Nasty, ...] = (
    *(
        table(f"value {text[:20]}", with_cell(200, text))
        for text in ("1e300", "-1e300", "1e999", "inf", "x", "=cmd|' /C calc'!A0", "9" * 5000)
    ),
    table("missing value", with_cell(200, "nan")),
    table("two columns called t", ["t,t,az", *(f"{line.partition(',')[0]},{line}" for line in HEALTHY[1:])], refused=False),
    table("two columns called az", ["t,az,az", *(f"{line},0" for line in HEALTHY[1:])]),
    table("formula in the header", [f"t,az,=cmd|' /C calc'!A0{MARK}", *(f"{line},0" for line in HEALTHY[1:])], refused=False),
    table("hostile header", [f"t,\u202e{MARK}\u2066\x1b[2J", *HEALTHY[1:]]),
    table("long header", ["t," + "x" * 1_000_000, *HEALTHY[1:]]),
    table("many columns", [",".join(["t", *(f"c{i}" for i in range(100_000))]), "0" + ",1" * 100_000]),
    table("empty", b""),
    table("header alone", ["t,az"]),
    table("one row", HEALTHY[:2]),
    table("no UTF-8", "\n".join(HEALTHY).encode() + b"\n\xff\xfe\n"),
    table("zero bytes", b"\x00" * 100_000),
    table("open quote", ['t,"az', *HEALTHY[1:]]),
    table("a row too short", [*HEALTHY[:100], "1", *HEALTHY[100:]]),
    table("a row too long", [*HEALTHY[:100], HEALTHY[100] + ",1,1,1", *HEALTHY[101:]]),
    table("clock that stands", ["t,az", *(f"1,{i}" for i in range(400))]),
    table("clock backwards", [HEALTHY[0], *reversed(HEALTHY[1:])]),
    table("clock of 1e300", ["t,az", *(f"{i}e300,0.1" for i in range(100))]),
    table("clock of 1e-300", ["t,az", *(f"{i}e-300,0.1" for i in range(100))]),
    *(special(kind) for kind in ("pipe", "folder", "link:/dev/zero", "link:/proc/self/mem", "link:recording.csv", "link:absent")),
    *(
        recording(path)
        for path in ("x" * 5000, "y/" * 3000, "/dev/zero", "/dev/stdin", '"a\\0b"', '"\\e[2J"', '"\\u202Efdp.csv"', "/", '""')
    ),
)
