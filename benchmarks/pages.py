"""Tables for pages, and the places they go to."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from vehgen.files import write_text

ROOT = Path(__file__).parents[1]


def table(header: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """Return a Markdown table."""
    return "\n".join(f"| {' | '.join(row)} |" for row in [header, ["---"] * len(header), *rows])


def fill(page: Path, blocks: dict[str, str]) -> None:
    """Put tables between a page's markers `<!-- NAME: start -->` and `<!-- NAME: end -->`."""
    text = page.read_text(encoding="utf-8")
    for name, block in blocks.items():
        head, rest = text.split(f"<!-- {name}: start -->")
        tail = rest.split(f"<!-- {name}: end -->")[1]
        text = f"{head}<!-- {name}: start -->\n\n{block}\n\n<!-- {name}: end -->{tail}"
    write_text(page, text)
