"""The report of a diagnosis: one HTML page with its figures inside."""

from __future__ import annotations

from importlib import resources
from pathlib import Path

import numpy as np
from jinja2 import Environment, StrictUndefined
from markupsafe import Markup
from matplotlib.figure import Figure

from vehgen.codegen import write_text
from vehgen.diagnose.estimates import estimate
from vehgen.diagnose.fitting import Fit
from vehgen.diagnose.free_form import fit_free_form, recover, strongest
from vehgen.diagnose.pipeline import Diagnosis
from vehgen.report.comparison import plot_histories, plot_psds
from vehgen.report.diagnosis_plots import curves, plot_places, plot_waterfall
from vehgen.report.files import figure_svg, inline_svg
from vehgen.report.force_plots import plot_force

MOST = 15
"""So many candidates are listed at most."""


def write_diagnosis_page(diagnosis: Diagnosis, path: Path) -> None:
    """Write the report of a diagnosis to an HTML file."""
    from vehgen import __version__

    text = resources.files("vehgen.report").joinpath("templates/diagnosis.html.j2").read_text(encoding="utf-8")
    environment = Environment(autoescape=True, trim_blocks=True, lstrip_blocks=True, undefined=StrictUndefined)
    figures, force = _figures(diagnosis)
    floor = diagnosis.detection.floor
    noise = {name: f"{sigma:.3g}" for name, sigma in floor.top.items()}
    write_text(
        path,
        environment.from_string(text).render(
            vehicle=diagnosis.trials[0].run.vehicle.title or diagnosis.trials[0].run.vehicle.name,
            verdict=diagnosis.verdict,
            stopped=diagnosis.stopped,
            noise=noise,
            corrected=list(floor.corrected),
            figures=figures,
            force=force,
            fits=[_row(fit) for fit in diagnosis.fits[:MOST]],
            meanings={fit.last.effect.name: fit.last.effect.meaning for item in diagnosis.rounds for fit in item.fits},
            version=__version__,
        ),
    )


def _row(fit: Fit) -> dict[str, str]:
    parameters = ", ".join(f"{name} {item.value:.4g} {item.unit}".strip() for name, item in estimate(fit).items())
    return {
        "label": fit.label,
        "train": f"{np.sqrt(fit.train):.3f}",
        "held_out": f"{np.sqrt(fit.held_out):.3f}" if np.isfinite(fit.held_out) else "",
        "parameters": parameters,
    }


def _figures(diagnosis: Diagnosis) -> tuple[dict[str, Markup], str]:
    found: dict[str, Figure | None] = dict.fromkeys(("places", "force", "waterfall", "psd", "histories"))
    force = ""
    if diagnosis.places:
        found["places"] = plot_places(diagnosis.places, diagnosis.passed)
    shown = strongest(diagnosis.passed)
    law = None if shown is None else fit_free_form(recover(diagnosis.detection, shown))
    if law is not None:
        found["force"], force = plot_force(law), law.describe()
    densities, histories = curves(diagnosis)
    if densities:
        found["waterfall"] = plot_waterfall(diagnosis)
        labels = ("residual before", "residual after")
        found["psd"] = plot_psds(densities, (0.5, 40.0), labels=labels)
        found["histories"] = plot_histories(histories, labels)
    return {
        name: Markup(inline_svg(figure_svg(figure), name, name)) if figure is not None else Markup("") for name, figure in found.items()
    }, force
