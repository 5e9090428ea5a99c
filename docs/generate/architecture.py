"""Write the part of architecture.md that shows which room imports which, from the code as it is.

Run it after moving walls: `python docs/generate/architecture.py`. A test fails while the page and the code differ.
"""

from __future__ import annotations

import ast
from pathlib import Path

HERE = Path(__file__).parents[1]
SOURCE = HERE.parent / "src" / "vehgen"
PAGE = HERE / "architecture.md"
START, END = "<!-- imports: start -->", "<!-- imports: end -->"
ROOMS = [
    "errors",
    "files",
    "vehicle",
    "mechanics",
    "codegen",
    "road",
    "simulate",
    "cargo",
    "measure",
    "phones",
    "fit",
    "effects",
    "calibrate",
    "diagnose",
    "report",
    "commands",
]
"""Ground floor first: a room imports only from itself and from rooms before it."""


def room_of(module: str) -> str | None:
    """Return the room of a module's name, None outside the package."""
    parts = module.split(".")
    return parts[1] if parts[0] == "vehgen" and len(parts) > 1 else None


def imports() -> dict[str, dict[str, set[str]]]:
    """Return room -> room imported -> the files that do so; imports inside functions and for type checks count too."""
    found: dict[str, dict[str, set[str]]] = {}
    for path in sorted(SOURCE.rglob("*.py")):
        place = path.relative_to(SOURCE)
        room = place.parts[0].removesuffix(".py")
        if room in ("__init__", "__main__"):
            continue
        found.setdefault(room, {})
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            names = (
                [node.module or ""]
                if isinstance(node, ast.ImportFrom)
                else [item.name for item in node.names]
                if isinstance(node, ast.Import)
                else []
            )
            if isinstance(node, ast.ImportFrom) and node.module == "vehgen":
                names = [f"vehgen.{item.name}" for item in node.names]
            for name in names:
                other = room_of(name)
                if other and other != room and not other.startswith("__"):
                    found[room].setdefault(other, set()).add(str(place))
    return found


def section() -> str:
    """Return the generated section: a table of rooms, their number of files, and what they import."""
    edges = imports()
    lines = [START, "", "| room | files | imports from |", "|---|---|---|"]
    for room in ROOMS:
        if room not in edges:
            continue
        paths = [SOURCE / f"{room}.py"] if (SOURCE / f"{room}.py").exists() else sorted((SOURCE / room).rglob("*.py"))
        below = ", ".join(other for other in ROOMS if other in edges[room]) or "nothing"
        lines.append(f"| {room} | {len(paths)} | {below} |")
    return "\n".join([*lines, "", END])


def page_with(section_text: str) -> str:
    """Return the page with its generated section replaced."""
    text = PAGE.read_text(encoding="utf-8")
    return text[: text.index(START)] + section_text + text[text.index(END) + len(END) :]


if __name__ == "__main__":
    PAGE.write_text(page_with(section()), encoding="utf-8")
