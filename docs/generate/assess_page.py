"""Write the tables and figures of assess.md from its example: `python docs/generate/assess_page.py`."""

from __future__ import annotations

from pathlib import Path

import vehgen
from vehgen.assess.tables import NumberTable, assessment_tables
from vehgen.report import save_figure

HERE = Path(__file__).parents[1]
PAGE = HERE / "assess.md"
RUN = HERE / "examples" / "road_b.yaml"
START, END = "<!-- tables: start -->\n", "<!-- tables: end -->\n"


def tables() -> list[NumberTable]:
    """Return the tables of the example."""
    return assessment_tables(vehgen.assess(RUN))


def markdown(table: NumberTable) -> str:
    """Return a table as the page shows it."""
    lines = [f"### {table.title}", "", "| " + " | ".join(table.columns) + " |", "|---|" + "--:|" * (len(table.columns) - 1)]
    lines += ["| " + " | ".join(row) + " |" for row in table.rows]
    return "\n".join([*lines, "", f"{table.source[0].upper()}{table.source[1:]}.", ""])


def main() -> None:
    """Write the tables into the page, and draw both figures."""
    text = PAGE.read_text(encoding="utf-8")
    before, _, rest = text.partition(START)
    _, _, after = rest.partition(END)
    PAGE.write_text(before + START + "\n" + "\n".join(markdown(table) for table in tables()) + "\n" + END + after, encoding="utf-8")
    save_figure(vehgen.assess(RUN).plot(), HERE / "images" / "assess.png")
    save_figure(vehgen.road_response("tractor5_cab", speed=20.0, roughness="B").plot(), HERE / "images" / "response.png")


if __name__ == "__main__":
    main()
