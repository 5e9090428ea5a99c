"""The page of a fleet: one table of all vehicles, each with a link to its own report."""

from __future__ import annotations

from pathlib import Path
from urllib.parse import quote

from markupsafe import Markup

from vehgen.diagnose.fleet import Fleet, FleetRow
from vehgen.diagnose.verdict import NamedParameter
from vehgen.files import write_text
from vehgen.files.number_text import interval_words
from vehgen.report.figure_files import figure_svg, inline_svg
from vehgen.report.pages.assets import page_environment, template_text
from vehgen.report.plots.fleet_plot import plot_fleet

FLEET_PAGE = "index.html"


def write_fleet_page(fleet: Fleet, folder: Path) -> Path:
    """Write the page of a fleet into the folder of its results; return the page's path."""
    drawn = any(row.verdict is not None for row in fleet.rows)
    page = (
        page_environment()
        .from_string(template_text("fleet.html.j2"))
        .render(
            fleet=fleet.fleet,
            stopped=fleet.stopped,
            counts=fleet.counts(),
            rows=[_shown_row(row) for row in fleet.rows],
            figure=Markup(inline_svg(figure_svg(plot_fleet(fleet)), "fleet", "chi of every vehicle")) if drawn else "",
            version=fleet.made_by.get("vehgen", ""),
        )
    )
    write_text(folder / FLEET_PAGE, page)
    return folder / FLEET_PAGE


def _shown_row(row: FleetRow) -> dict[str, object]:
    verdict = row.verdict
    effects = () if verdict is None else verdict.effects
    return {
        "name": row.name,
        "report": f"{quote(row.name)}/report.html" if verdict is not None else "",
        "n_runs": len(row.runs) or "",
        "verdict": row.status if verdict is None else verdict.verdict,
        "found": row.found,
        "numbers": [_number(name, item) for effect in effects for name, item in effect.parameters.items()],
        "before": "" if verdict is None else f"{verdict.gap.before:.3f}",
        "after": "" if verdict is None else f"{verdict.gap.after:.3f}",
        "todo": _todo(row),
    }


def _number(name: str, item: NamedParameter) -> str:
    told = f"{name} {item.value:.4g} {item.unit}".strip()
    return told if item.interval is None else f"{told} ({interval_words(item.interval)})"


def _todo(row: FleetRow) -> list[str]:
    """Return what to put right and what to measure next."""
    if row.verdict is None:
        return []
    cures = list(dict.fromkeys(fault.cure for fault in row.verdict.faults))
    return [*cures, *([row.verdict.next_experiment] if row.verdict.next_experiment else [])]
