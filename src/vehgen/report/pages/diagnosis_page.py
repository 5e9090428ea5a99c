"""The report of a diagnosis: one HTML page with its figures inside, of what the result holds."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
from markupsafe import Markup
from matplotlib.figure import Figure

from vehgen.diagnose.evidence import BaseParameter, Evidence, FittedCandidate, Origin, RoundEvidence
from vehgen.diagnose.result import Diagnosis
from vehgen.effects import EFFECTS
from vehgen.errors import InputError
from vehgen.files import write_text
from vehgen.files.document import MAX_DOCUMENT_BYTES
from vehgen.files.number_text import interval_words
from vehgen.report.curve_values import inline_figure
from vehgen.report.drawing.vehicle import draw_vehicle
from vehgen.report.pages.assets import page_environment, template_text
from vehgen.report.plots.comparison import QUANTITY_UNITS, plot_histories, plot_psds
from vehgen.report.plots.diagnosis_plots import plot_places, plot_waterfall
from vehgen.report.plots.force_plots import plot_force
from vehgen.vehicle import parse_vehicle


def write_diagnosis_page(diagnosis: Diagnosis, path: Path) -> None:
    """Write the report of a diagnosis to an HTML file."""
    write_text(path, diagnosis_page(diagnosis))


def diagnosis_page(diagnosis: Diagnosis) -> str:
    """Return the report of a diagnosis as HTML."""
    text = template_text("diagnosis.html.j2")
    environment = page_environment()
    evidence = diagnosis.evidence
    return environment.from_string(text).render(
        vehicle=evidence.vehicle,
        verdict=diagnosis.verdict,
        stopped=diagnosis.stopped,
        mistakes_left_out=_mistakes_left_out(diagnosis),
        noise=[f"{item.channel} {item.least:.3g} to {item.largest:.3g} {QUANTITY_UNITS.get(item.quantity, '')}" for item in evidence.noise],
        parameters=[_parameter(item) for item in evidence.parameters],
        conditions=[
            (item.run, f"{1e3 * item.delay:+.1f} ms", f"{100 * item.speed:+.2f} %", f"{100 * item.height:+.2f} %")
            for item in evidence.conditions
        ],
        n_validation=sum(run.validation for run in diagnosis.verdict.gap.runs),
        slope=evidence.noise_slope,
        corrected=evidence.corrected,
        figures=_figures(diagnosis),
        force="" if evidence.force is None else evidence.force.description,
        on_road=any(size.speed for size in evidence.runs),
        runs=_runs(diagnosis),
        bands=_bands(evidence),
        distortions=evidence.distortions,
        rounds=[_round(item) for item in evidence.rounds],
        tested=bool(evidence.places),
        alone=_alone(evidence),
        meanings=evidence.meanings,
        version=evidence.made_by,
        origin=evidence.origin,
        marked=_marked(diagnosis),
        interval_words=interval_words,
    )


def _mistakes_left_out(diagnosis: Diagnosis) -> bool:
    """Return whether no run that is shown has a mistake."""
    shown = {item.run for item in diagnosis.verdict.gap.runs}
    return all(fault.runs and not shown.intersection(fault.runs) for fault in diagnosis.verdict.faults)


def _parameter(item: BaseParameter) -> dict[str, str]:
    return {
        "name": item.name,
        "filed": f"{item.filed:.4g} {item.unit}",
        "refitted": f"{item.refit:.4g} {item.unit}{' (at its bound)' if item.refit_on_bound else ''}",
        "last": f"{item.final:.4g} {item.unit}{' (at its bound)' if item.final_on_bound else ''}",
    }


def _runs(diagnosis: Diagnosis) -> list[dict[str, str]]:
    chis = {run.run: run for run in diagnosis.verdict.gap.runs}
    return [
        {
            "run": size.run,
            "hump": f"{1e3 * size.hump_height:.0f} mm" if size.hump_height else "none",
            "speed": f"{size.speed:.3g} m/s",
            "use": "checking only" if chis[size.run].validation else "fitting",
            "share": f"{100 * size.share:.1f} %",
            "before": f"{chis[size.run].before:.3f}",
            "after": f"{chis[size.run].after:.3f}",
        }
        for size in diagnosis.evidence.runs
        if size.run in chis
    ]


def _bands(evidence: Evidence) -> dict[str, list[tuple[str, str, str]]]:
    """Return by channel: the band, chi before and chi after."""
    found: dict[str, list[tuple[str, str, str]]] = {}
    for item in evidence.bands:
        band = f"{item.band[0]:g} to {item.band[1]:g} Hz"
        found.setdefault(item.channel, []).append((band, f"{item.before:.2f}", f"{item.after:.2f}"))
    return found


def _round(item: RoundEvidence) -> dict[str, object]:
    """Return one look for one effect: what it was added to, the places that passed and the best candidates."""
    return {
        "beside": item.beside,
        "chi": f"{item.chi:.2f}",
        "places": [f"{place.label} (chi {place.chi:.2f})" for place in item.places],
        "fits": [_row(candidate) for candidate in item.candidates],
        "tried": item.tried,
    }


def _row(candidate: FittedCandidate) -> dict[str, str]:
    return {
        "label": candidate.label,
        "train": f"{candidate.training:.3f}",
        "validation": f"{candidate.validation:.3f}" if np.isfinite(candidate.validation) else "",
        "parameters": ", ".join(f"{name} {item.value:.4g} {item.unit}".strip() for name, item in candidate.parameters.items()),
    }


def _alone(evidence: Evidence) -> list[tuple[str, str, list[str]]]:
    """Return by effect and parameter what every run for fitting alone asks for."""
    found: dict[tuple[str, str], list[str]] = {}
    for item in evidence.alone:
        found.setdefault((item.effect, item.parameter), []).append(f"{item.run} {item.value:.4g} ± {item.half_width:.2g}")
    return [(*key, told) for key, told in found.items()]


def _marked(diagnosis: Diagnosis) -> list[str]:
    """Return the places to ring: those of the effects named, else those that pass the place test."""
    of_sensors = {name for name, effect in EFFECTS.items() if not effect.changes_vehicle}
    named = [effect.place for effect in diagnosis.verdict.effects if effect.name not in of_sensors]
    if diagnosis.verdict.effects:
        return named
    labels = [place.label for place in diagnosis.evidence.places if place.passes]
    return [label for label in labels if not label.startswith(("sensor ", "channel "))]


def _draw(origin: Origin, marked: list[str]) -> Figure:
    """Return the drawing of the vehicle with places ringed; its data are checked as a file's are."""
    text = json.dumps(origin.vehicle)
    if len(text) > MAX_DOCUMENT_BYTES:
        raise InputError(f"the diagnosis holds no vehicle's data of at most {MAX_DOCUMENT_BYTES} bytes")
    vehicle = parse_vehicle(text, "the diagnosis")
    if not set(vehicle.free_parameters) <= set(origin.values):
        raise InputError("the diagnosis holds other parameters than its vehicle has: diagnose it again")
    return draw_vehicle(vehicle, origin.values, marked=marked)


def _figures(diagnosis: Diagnosis) -> dict[str, Markup]:
    evidence = diagnosis.evidence
    found: dict[str, Figure | None] = dict.fromkeys(("places", "force", "waterfall", "psd", "histories", "responses", "vehicle"))
    if evidence.responses:
        found["responses"] = plot_histories(evidence.responses, ("measured", "simulated"))
    if evidence.origin is not None and evidence.origin.vehicle:
        found["vehicle"] = _draw(evidence.origin, _marked(diagnosis))
    if evidence.places:
        found["places"] = plot_places(evidence.places)
    if evidence.force is not None:
        found["force"] = plot_force(evidence.force)
    if evidence.psds:
        found["waterfall"] = plot_waterfall(diagnosis)
        labels = ("residual before", "residual after")
        found["psd"] = plot_psds(evidence.psds, evidence.band, labels=labels)
        found["histories"] = plot_histories(evidence.histories, labels)
    return {name: Markup() if figure is None else inline_figure(figure, name, name) for name, figure in found.items()}
