"""The report of a diagnosis: one HTML page with its figures inside."""

from __future__ import annotations

from importlib import resources
from pathlib import Path

import numpy as np
from jinja2 import Environment, StrictUndefined
from markupsafe import Markup
from matplotlib.figure import Figure

from vehgen.diagnose.detect.detection import band_gaps, run_gaps
from vehgen.diagnose.detect.harmonics import distortions
from vehgen.diagnose.fits.model_fit import ModelFit
from vehgen.diagnose.localise.free_form import fit_free_form, recover, strongest
from vehgen.diagnose.pipeline import Diagnosis
from vehgen.diagnose.select.estimates import estimate, estimates_by_run
from vehgen.diagnose.select.search import SearchRound
from vehgen.files import write_text
from vehgen.report.figure_files import figure_svg, inline_svg
from vehgen.report.plots.comparison import plot_histories, plot_psds
from vehgen.report.plots.diagnosis_plots import curves, plot_places, plot_waterfall
from vehgen.report.plots.force_plots import plot_force

MAX_ROWS = 12
"""So many candidates are listed at most."""


def write_diagnosis_page(diagnosis: Diagnosis, path: Path) -> None:
    """Write the report of a diagnosis to an HTML file."""
    from vehgen import __version__

    text = resources.files("vehgen.report").joinpath("templates/diagnosis.html.j2").read_text(encoding="utf-8")
    environment = Environment(autoescape=True, trim_blocks=True, lstrip_blocks=True, undefined=StrictUndefined)
    figures, force = _figures(diagnosis)
    floor = diagnosis.detection.floor
    write_text(
        path,
        environment.from_string(text).render(
            vehicle=diagnosis.trials[0].run.vehicle.title or diagnosis.trials[0].run.vehicle.name,
            verdict=diagnosis.verdict,
            stopped=diagnosis.stopped,
            noise=_noise(diagnosis),
            parameters=_parameters(diagnosis),
            conditions=_conditions(diagnosis),
            untouched=len(diagnosis.detection.validation_runs),
            slope=max(noise.slope for noise in floor.noises.values()),
            corrected=list(floor.corrected),
            figures=figures,
            force=force,
            runs=_runs(diagnosis),
            bands=_bands(diagnosis),
            distortions=distortions(diagnosis.detection),
            rounds=[_round(item) for item in diagnosis.rounds],
            alone=_alone(diagnosis),
            meanings={fit.last.effect.name: fit.last.effect.meaning for item in diagnosis.rounds for fit in item.fits},
            version=__version__,
        ),
    )


def _noise(diagnosis: Diagnosis) -> list[str]:
    """Return the noise of every channel that the fits used, from the quietest run to the loudest."""
    units = {"acceleration": "m/s²", "pitch_rate": "rad/s", "displacement": "m"}
    found: dict[str, tuple[str, list[float]]] = {}
    for trial in diagnosis.trials:
        for channel, sigma in zip(trial.recording.channels, diagnosis.detection.floor.noises[trial.name].sigma, strict=True):
            found.setdefault(channel.name, (units.get(channel.quantity, ""), []))[1].append(float(sigma))
    return [f"{name} {min(values):.3g} to {max(values):.3g} {unit}" for name, (unit, values) in found.items()]


def _parameters(diagnosis: Diagnosis) -> list[dict[str, str]]:
    """Return the base parameters: the file's value, the refit of the base, and that with the effects."""
    base, last = diagnosis.detection.base.least_squares, _last(diagnosis).least_squares
    units = {name: str(unit).strip("1") for name, unit in diagnosis.trials[0].run.vehicle.dimensions.items()}
    space = base.misfit.problem.space
    later = last.misfit.problem.best_values(last.values)
    return [
        {
            "name": name,
            "filed": f"{filed:.4g} {units[name]}",
            "refitted": f"{value:.4g} {units[name]}{' (at its bound)' if name in base.on_bound else ''}",
            "last": f"{later[name]:.4g} {units[name]}{' (at its bound)' if name in last.on_bound else ''}",
        }
        for name, filed, value in zip(space.names, space.start, base.values, strict=True)
    ]


def _conditions(diagnosis: Diagnosis) -> list[tuple[str, str, str, str]]:
    """Return what the last fit supposes of every run: the recording's delay, the speed's and the road height's error."""
    fit = _last(diagnosis)
    found = []
    for polished in (fit.least_squares, fit.validation_fit):
        if polished is None:
            continue
        _, errors = polished.misfit.split(polished.x)
        spread = polished.misfit.nuisances
        for trial, error in zip(polished.misfit.problem.trials, errors, strict=True):
            known = {name: float(value) * getattr(spread, name) for name, value in zip(spread.names, error, strict=True)}
            delay, speed, height = (known.get(name, 0.0) for name in ("delay", "speed", "height"))
            found.append((trial.name, f"{1e3 * delay:+.1f} ms", f"{100 * speed:+.2f} %", f"{100 * height:+.2f} %"))
    return found


def _runs(diagnosis: Diagnosis) -> list[dict[str, str]]:
    told = {str(run["run"]): run for run in diagnosis.verdict.gap.runs}
    return [
        {
            "run": gap.run,
            "hump": f"{1e3 * gap.height:.0f} mm" if gap.height else "none",
            "speed": f"{gap.speed:.3g} m/s",
            "use": "checking only" if told[gap.run]["untouched"] else "fitting",
            "share": f"{100 * gap.share:.1f} %",
            "before": f"{float(told[gap.run]['before']):.3f}",
            "after": f"{float(told[gap.run]['after']):.3f}",
        }
        for gap in run_gaps(diagnosis.detection)
    ]


def _bands(diagnosis: Diagnosis) -> dict[str, list[tuple[str, str, str]]]:
    """Return by channel: the band, chi before and chi after, pooled over the untouched runs (over all, where there are none)."""
    wanted = {trial.name for trial in (diagnosis.detection.validation_runs or diagnosis.trials)}
    after = {(item.run, item.channel, item.band): item.chi for item in band_gaps(diagnosis.detection, _last(diagnosis))}
    pooled: dict[tuple[str, tuple[float, float]], list[tuple[float, float]]] = {}
    for item in band_gaps(diagnosis.detection):
        if item.run in wanted:
            pair = item.chi, after.get((item.run, item.channel, item.band), item.chi)
            pooled.setdefault((item.channel, item.band), []).append(pair)
    found: dict[str, list[tuple[str, str, str]]] = {}
    for (channel, band), pairs in pooled.items():
        old, new = np.sqrt(np.mean(np.square(pairs), axis=0))
        found.setdefault(channel, []).append((f"{band[0]:g} to {band[1]:g} Hz", f"{old:.2f}", f"{new:.2f}"))
    return found


def _last(diagnosis: Diagnosis) -> ModelFit:
    return diagnosis.chosen[-1] if diagnosis.chosen else diagnosis.detection.base


def _round(item: SearchRound) -> dict[str, object]:
    """Return one look for one effect: what it was added to, the places that passed and the best candidates."""
    return {
        "footing": item.current.label,
        "chi": f"{item.current.chi:.2f}",
        "places": [f"{place.place.label} (chi {place.chi:.2f})" for place in item.passed[:4]],
        "fits": [_row(fit) for fit in item.fits[:MAX_ROWS]],
        "tried": len(item.fits),
    }


def _row(fit: ModelFit) -> dict[str, str]:
    parameters = ", ".join(f"{name} {item.value:.4g} {item.unit}".strip() for name, item in estimate(fit).items())
    return {
        "label": fit.last.label,
        "train": f"{np.sqrt(fit.training):.3f}",
        "held_out": f"{np.sqrt(fit.validation):.3f}" if np.isfinite(fit.validation) else "",
        "parameters": parameters,
    }


def _alone(diagnosis: Diagnosis) -> list[tuple[str, str, list[str]]]:
    """Return by effect and parameter what every run for fitting alone asks for."""
    if not diagnosis.chosen:
        return []
    last = diagnosis.chosen[-1]
    found = []
    for candidate in last.effects:
        estimates = estimates_by_run(last, candidate)
        for name in dict.fromkeys(item.parameter for item in estimates):
            told = [f"{item.run} {item.value:.4g} ± {item.half_width:.2g}" for item in estimates if item.parameter == name]
            found.append((candidate.label, name, told))
    return found


def _figures(diagnosis: Diagnosis) -> tuple[dict[str, Markup], str]:
    found: dict[str, Figure | None] = dict.fromkeys(("places", "force", "waterfall", "psd", "histories"))
    force = ""
    if diagnosis.places:
        found["places"] = plot_places(diagnosis.places, diagnosis.passed)
    shown = strongest(diagnosis.passed)
    law = diagnosis.law or (None if shown is None else fit_free_form(recover(diagnosis.detection, shown)))
    if law is not None:
        found["force"], force = plot_force(law), law.describe()
    densities, histories = curves(diagnosis)
    if densities:
        found["waterfall"] = plot_waterfall(diagnosis)
        labels = ("residual before", "residual after")
        found["psd"] = plot_psds(densities, diagnosis.detection.band, labels=labels)
        found["histories"] = plot_histories(histories, labels)
    return {
        name: Markup(inline_svg(figure_svg(figure), name, name)) if figure is not None else Markup("") for name, figure in found.items()
    }, force
