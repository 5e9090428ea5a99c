"""Write the parts of architecture.md that follow from the code as it is: the map of the rooms, and which room imports which.

A room is a package of vehgen, a box a package inside a room. What it answers and what it holds stand in its own docstring: a question,
then the rest. Run it after moving walls: `python docs/generate/architecture.py`. A test fails while the page and the code differ.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

HERE = Path(__file__).parents[1]
SOURCE = HERE.parent / "src" / "vehgen"
PAGE = HERE / "architecture.md"
MARKS = "<!-- {}: start -->", "<!-- {}: end -->"
ROOMS = [
    "errors",
    "late_imports",
    "process_start",
    "files",
    "vehicle",
    "mechanics",
    "codegen",
    "road",
    "measure",
    "simulate",
    "cargo",
    "phones",
    "fit",
    "assess",
    "effects",
    "calibrate",
    "diagnose",
    "report",
    "export",
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


def described() -> Iterator[tuple[str, tuple[str, str]]]:
    """Yield every room, and after it its boxes, as `room/box`: its name, and what its docstring says it answers and holds."""
    for room in ROOMS:
        folder = SOURCE / room
        if not folder.is_dir():
            yield room, question_and_rest(SOURCE / f"{room}.py")
            continue
        yield room, question_and_rest(folder / "__init__.py")
        for box in sorted(path.parent for path in folder.glob("*/__init__.py")):
            yield f"{room}/{box.name}", question_and_rest(box / "__init__.py")


def question_and_rest(path: Path) -> tuple[str, str]:
    """Return the question at the head of a file's docstring, and the rest of it."""
    text = ast.get_docstring(ast.parse(path.read_text(encoding="utf-8"))) or ""
    question, mark, holds = " ".join(text.split()).partition("?")
    return question + mark, holds.strip()


def rooms_table() -> list[str]:
    """Return the map: every room in the order in which they stand on one another, its boxes below it."""
    lines = ["| room | answers | holds |", "|---|---|---|"]
    for name, (question, holds) in described():
        label = f"– {name}" if "/" in name else f"**{name}**"
        lines.append(f"| {label} | {question} | {holds} |")
    return lines


def imports_table() -> list[str]:
    """Return the rooms, their number of files, and what they import."""
    edges = imports()
    lines = ["| room | files | imports from |", "|---|---|---|"]
    for room in ROOMS:
        if room not in edges:
            continue
        paths = [SOURCE / f"{room}.py"] if (SOURCE / f"{room}.py").exists() else sorted((SOURCE / room).rglob("*.py"))
        below = ", ".join(other for other in ROOMS if other in edges[room]) or "nothing"
        lines.append(f"| {room} | {len(paths)} | {below} |")
    return lines


def sections() -> dict[str, list[str]]:
    """Return the lines of every generated section by its name."""
    return {"rooms": rooms_table(), "imports": imports_table()}


def page_with(found: dict[str, list[str]]) -> str:
    """Return the page with its generated sections replaced."""
    text = PAGE.read_text(encoding="utf-8")
    for name, lines in found.items():
        start, end = (mark.format(name) for mark in MARKS)
        text = text[: text.index(start)] + "\n".join([start, "", *lines, "", end]) + text[text.index(end) + len(end) :]
    return text


if __name__ == "__main__":
    PAGE.write_text(page_with(sections()), encoding="utf-8")
