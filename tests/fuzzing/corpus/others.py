"""Cargo, frame, facts and effects files, and phone exports."""

from __future__ import annotations

from tests.fuzzing.cases import Case
from tests.fuzzing.corpus.entry import Nasty, marked
from tests.fuzzing.corpus.vehicles import HOSTILE, quoted
from tests.fuzzing.healthy import EFFECTS, FACTS, read
from tests.fuzzing.hostile import MARK
from tests.fuzzing.table_mutations import archive_of, lying

CARGO = read("docs/examples/cargo/pallets.yaml").decode()
FRAME = read("docs/examples/cargo/steel_module.yaml").decode().replace("{size: 0.2 m}", "{size: 0.7 m}")
WALLS = FRAME[FRAME.index("  walls:") :].partition("\n")[0] + "\n"


def changed(format: str, name: str, healthy: str, old: str, new: str, refused: bool = True) -> Nasty:
    """Return a healthy file with one text exchanged."""
    assert old in healthy
    return marked(format, name, healthy.replace(old, new, 1), refused)


def hostile(i: int, text: str) -> list[Nasty]:
    """Return files of which a name is a hostile text."""
    name = quoted(text)
    return [
        changed("cargo", f"name {i}", CARGO, "on: ", f"name: §{name}\non: "),
        changed("cargo", f"body {i}", CARGO, "on: semitrailer", f"on: §{name}"),
        changed("frame", f"material {i}", FRAME.replace("material: steel,", f"material: {name},"), "  steel:", f"  §{name}:"),
        changed("facts", f"axle {i}", FACTS, "{axle1:", f"{{§{name}:"),
        changed("facts", f"parameter {i}", FACTS, "{a1:", f"{{§{name}:"),
        changed("effects", f"name {i}", EFFECTS, "  soft_damper", f"  §{name}"),
        changed("effects", f"parameter {i}", EFFECTS, "      c3:", f"      §{name}:"),
        changed("effects", f"unit {i}", EFFECTS, "N s^3/m^3", f"§{name}"),
    ]


def free(i: int, text: str) -> list[Nasty]:
    """Return files whose free texts are hostile: they may be accepted."""
    return [
        changed("cargo", f"title {i}", CARGO, "title: stacked pallets", f"title: {quoted(text)}", refused=False),
        changed("frame", f"title {i}", FRAME, "title: steel-framed building module", f"title: {quoted(text)}", refused=False),
        changed("effects", f"title {i}", EFFECTS, "title: Damper with a soft centre", f"title: {quoted(text)}", refused=False),
    ]


def export(name: str, data: bytes, refused: bool = True) -> Nasty:
    """Return a phone export."""
    return Nasty(f"export: {name}", Case("export", {"phone.zip": data}, "phone.zip"), refused=refused)


ROWS = b"Time (s),X (m/s^2),Y (m/s^2),Z (m/s^2)\n" + b"".join(b"%d.%02d,0,0,9.81\n" % divmod(i, 100) for i in range(400))
ARCHIVE = archive_of({"Accelerometer.csv": ROWS})

OTHERS: tuple[Nasty, ...] = (
    *(nasty for i, text in enumerate(HOSTILE) for nasty in (hostile(i, text) if i in (0, 6, 10, 34) else ())),
    *(nasty for i, text in enumerate(HOSTILE) for nasty in free(i, text)[i % 3 : i % 3 + 1]),
    changed("cargo", "1e300 kg", CARGO, "10 t", "§1e300 kg"),
    changed("cargo", "no mass", CARGO, "10 t", "§0 t"),
    changed("cargo", "1e-300 m long", CARGO, "8 m", "§1e-300 m"),
    changed("cargo", "alias of itself", CARGO, "rigid: ", "x: &x [*x]\nrigid: "),
    changed("frame", "fine mesh", FRAME, "0.7 m", "§1e-9 m"),
    changed("frame", "mesh of 1e300 m", FRAME, "0.7 m", "1e300 m", refused=False),
    changed("frame", "1e9 m long", FRAME, "length: 8.7 m", "length: §1e9 m"),
    changed("frame", "100 m long", FRAME, "length: 8.7 m", "length: §100 m"),
    changed("frame", "1e-9 m wide", FRAME, "width: 3.0 m", "width: 1e-9 m", refused=False),
    changed("frame", "layer of 1e-300 m", FRAME, "22 mm", "§1e-300 m"),
    changed("frame", "1e-300 Pa", FRAME, "200 GPa", "§1e-300 Pa"),
    changed("frame", "studs without walls", FRAME, WALLS, "", refused=False),
    changed("cargo", "on a base of 1e12 m", CARGO, "base: 0 m", "base: §1e12 m"),
    changed("frame", "spacing of 1 um", FRAME, "spacing: 0.45 m", "spacing: 1e-6 m"),
    changed("frame", "E of 1e300", FRAME, "200 GPa", "§1e300 GPa"),
    changed(
        "frame",
        "100 000 layers",
        FRAME,
        "[{material: cement_board, thickness: 44 mm}",
        "[" + "{material: cement_board, thickness: 44 mm}, " * 20000,
    ),
    changed("facts", "not a number", FACTS, "104 kN", "§.nan"),
    changed("facts", "uncertainty of nothing", FACTS, "0.5 kN", "§0 kN"),
    changed("effects", "call", EFFECTS, "c3*v^3 + k3*d^3", "§\"__import__('os').getpid()*v\""),
    changed("effects", "deep force", EFFECTS, "c3*v^3 + k3*d^3", "§" + "(" * 20000 + "c3*v^3 + k3*d^3" + ")" * 20000),
    changed("effects", "tower", EFFECTS, "c3*v^3", "§c3*v^3^9^9^9^9^9"),
    changed("effects", "starts of nothing", EFFECTS, "[0.3, 3]", "§[]"),
    marked("effects", "6 MB", "effects:\n" + "# " + "x" * 6_000_000),
    changed("effects", "upside down", EFFECTS, "low: 0.01, high: 100", "low: 100, high: 0.01"),
    export("empty", b""),
    export("no archive", b"PK\x03\x04" + b"\x00" * 100),
    export("cut off", ARCHIVE[: len(ARCHIVE) // 2]),
    export("bomb", archive_of({"Accelerometer.csv": ROWS + b"0,0,0,0\n" * (1 << 24)})),
    export("lies about its size", lying(archive_of({"Accelerometer.csv": ROWS + b"0,0,0,0\n" * (1 << 22)}), 10)),
    export("10 000 files", archive_of({f"{i}.csv": b"x\n" for i in range(10_000)})),
    export("climbing names", archive_of({f"../../{MARK}.csv": ROWS, f"/tmp/{MARK}": b"x"})),
    export("archive in an archive", archive_of({"phone.zip": ARCHIVE})),
    export("Excel", b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1" + bytes(2000)),
    export("MATLAB", b"MATLAB 5.0 MAT-file, Platform: PCWIN64".ljust(124) + b"\x00\x01IM" + b"\xff" * 200),
    Nasty("export: link to memory", Case("export", {}, "phone.zip", special={"phone.zip": "link:/proc/self/mem"})),
    export("hostile header", archive_of({"Accelerometer.csv": b"Time (s),\x1b[2JX,\xe2\x80\xaeY,=cmd|' /C calc'!A0\n0,0,0,0\n"})),
)
