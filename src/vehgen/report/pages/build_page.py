"""The build folder: kernel, equations, drawings, and one page with all of it."""

from __future__ import annotations

import hashlib
import platform
import re
from collections.abc import Mapping, Sequence
from importlib import metadata
from importlib.resources import files
from pathlib import Path

import sympy as sp
from jinja2 import Environment, StrictUndefined
from markupsafe import Markup, escape

import vehgen
from vehgen.codegen import KernelSource
from vehgen.errors import InputError
from vehgen.files import write_text
from vehgen.files.document import MAX_DOCUMENT_BYTES
from vehgen.files.reading import read_bytes
from vehgen.mechanics import GRAVITY, EquationsOfMotion, StaticLoads
from vehgen.report.drawing.mode_shapes import draw_modes
from vehgen.report.drawing.vehicle import draw_vehicle
from vehgen.report.equations import writing as equations
from vehgen.report.equations.latex import equations_latex
from vehgen.report.equations.notation import tidy
from vehgen.report.figure_files import figure_svg, inline_svg
from vehgen.simulate import Mode

_WIDE_EM = 14.0
"""A drawing wider than this is scrolled on the page instead of shrunk [inches]."""


def write_build_folder(
    folder: Path,
    model: EquationsOfMotion,
    values: Mapping[str, float],
    modes: Sequence[Mode],
    loads: StaticLoads,
    kernel: KernelSource,
    warnings: Sequence[str] = (),
    plots: bool = True,
) -> list[Path]:
    """Write a vehicle's build folder; returns the files written.

    `kernel.py`, `kernel_legend.txt` (what the numbers in it mean), `equations.txt`, `equations.tex`, `index.html` and, with `plots`,
    `drawing.svg` and `modes.svg`. Each file appears whole or not at all.
    """
    texts = {
        "kernel.py": kernel.text,
        "kernel_legend.txt": kernel.legend,
        "equations.txt": equations.equations_text(model),
        "equations.tex": equations_latex(model),
    }
    if plots:
        texts["drawing.svg"] = figure_svg(draw_vehicle(model, values))
        texts["modes.svg"] = figure_svg(draw_modes(model, modes, values))
    texts["index.html"] = _page(model, values, modes, loads, warnings, texts)
    written = build_files(folder, plots)
    for path in written:
        write_text(path, texts[path.name])
    return written


def build_files(folder: Path, plots: bool = True) -> list[Path]:
    """Return the files that :func:`write_build_folder` writes."""
    drawings = ("drawing.svg", "modes.svg") if plots else ()
    return [folder / name for name in ("kernel.py", "kernel_legend.txt", "equations.txt", "equations.tex", *drawings, "index.html")]


def _page(
    model: EquationsOfMotion,
    values: Mapping[str, float],
    modes: Sequence[Mode],
    loads: StaticLoads,
    warnings: Sequence[str],
    texts: Mapping[str, str],
) -> str:
    environment = Environment(autoescape=True, trim_blocks=True, lstrip_blocks=True, undefined=StrictUndefined)
    environment.filters["grouped"] = grouped
    template = environment.from_string((files("vehgen.report") / "templates" / "page.html.j2").read_text(encoding="utf-8"))
    symbols = equations.coordinate_mathml(model)
    return template.render(
        vehicle=model.vehicle,
        title=model.vehicle.title or model.vehicle.name,
        coordinates=[(i, item, Markup(symbols[i - 1])) for i, item in enumerate(model.coordinates, 1)],
        parameters=_parameters(model, values),
        modes=modes,
        axles=_axles(model, loads),
        hinges=loads.hinges,
        total=sum(loads.axles.values()),
        weight=model.total_weight(values),
        gravity=GRAVITY,
        warnings=warnings,
        figures=_figures(model, texts),
        long="drawing.svg" in texts and _width(texts["drawing.svg"]) > _WIDE_EM,
        balance=Markup(equations.balance_mathml(model)),
        vectors=equations.vectors(model),
        sections=[
            (section.symbol, section.meaning, Markup(section.whole), [(Markup(left), Markup(value)) for _, left, value in section.rows])
            for section in equations.equations_mathml(model)
        ],
        laws=_laws(model),
        laws_note=equations.LAWS_NOTE,
        counts=model.operation_counts(),
        kernel=texts["kernel.py"],
        legend=texts["kernel_legend.txt"],
        versions=_versions(),
        inputs=_inputs(model),
    )


def _parameters(model: EquationsOfMotion, values: Mapping[str, float]) -> list[dict[str, object]]:
    vehicle = model.vehicle
    everything = vehicle.all_values({name: values[name] for name in vehicle.free_parameters})
    ranges, dimensions = vehicle.ranges(), vehicle.dimensions
    definitions = {symbol.name: expression for symbol, expression in model.definitions}
    return [
        {
            "name": name,
            "symbol": Markup(equations.expression_mathml(model, sp.Symbol(name, real=True))),
            "value": grouped(everything[name]),
            "unit": _unit(str(dimensions[name])),
            "range": " to ".join(map(grouped, ranges[name])) if name in ranges else "",
            "outside": name in ranges and not ranges[name][0] <= everything[name] <= ranges[name][1],
            "equals": Markup(equations.expression_mathml(model, tidy(definitions[name]))) if name in definitions else "",
            "meaning": item.meaning,
        }
        for name, item in vehicle.parameters.items()
    ]


def grouped(value: float) -> str:
    """Write a number with six digits that count, thousands apart."""
    short = float(f"{value:.6g}")
    if short and not 1e-4 <= abs(short) < 1e10:
        return f"{short:.6g}"
    return (f"{short:,.0f}" if short.is_integer() else f"{short:,.10f}".rstrip("0")).replace(",", "\u202f").replace("-", "\u2212")


def _unit(unit: str) -> str:
    return unit.replace("no unit", "–").replace("^2", "²").replace("^3", "³")


def _axles(model: EquationsOfMotion, loads: StaticLoads) -> list[tuple[str, str, float]]:
    return [(name, model.vehicle.axles[name].title, force) for name, force in loads.axles.items()]


def _figures(model: EquationsOfMotion, texts: Mapping[str, str]) -> dict[str, Markup]:
    title = str(escape(model.vehicle.title or model.vehicle.name))
    said = {"drawing": f"Side view of {title}, to scale", "modes": f"Mode shapes of {title}"}
    there = {name: texts.get(f"{name}.svg", "") for name in said}
    return {name: Markup(inline_svg(svg, name, said[name]) if svg else "") for name, svg in there.items()}


def _width(svg: str) -> float:
    """Return the width of an SVG file [inches]."""
    found = re.search(r'width="([\d.]+)pt"', svg)
    return float(found[1]) / 72 if found else 0.0


def _laws(model: EquationsOfMotion) -> list[tuple[str, Markup, list[tuple[str, str, list[tuple[str, Markup, str]]]]]]:
    return [
        (
            where,
            Markup(equations.expression_mathml(model, travel)),
            [
                (
                    title,
                    equation,
                    [(key, Markup(equations.expression_mathml(model, value)), _unit(unit)) for key, value, unit in parameters],
                )
                for title, equation, parameters in laws
            ],
        )
        for where, travel, laws in equations.law_rows(model)
    ]


def _versions() -> dict[str, str]:
    others = {name: metadata.version(name) for name in ("sympy", "numpy", "numba", "matplotlib")}
    return {"vehgen": vehgen.__version__, **others, "Python": platform.python_version()}


def _inputs(model: EquationsOfMotion) -> list[tuple[str, str]]:
    """Return name and SHA-256 of each of the vehicle's files."""
    found = []
    for path in model.vehicle.files:
        try:
            found.append((path.name, f"SHA-256 {hashlib.sha256(read_bytes(path, MAX_DOCUMENT_BYTES)).hexdigest()}"))
        except InputError:
            found.append((path.name, "no longer there when this page was written"))
    return found
