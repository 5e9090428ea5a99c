"""The build folder: kernel, equations, drawings, and one page with all of it."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING

import sympy as sp
from jinja2 import Environment, StrictUndefined
from markupsafe import Markup, escape

from vehgen.codegen import KernelSource, write_kernel
from vehgen.files import write_text
from vehgen.files.results import json_text
from vehgen.mechanics import GRAVITY, EquationsOfMotion, StaticLoads, derive
from vehgen.report.equations import writing as equations
from vehgen.report.equations.latex import equations_latex
from vehgen.report.equations.notation import tidy
from vehgen.report.figure_files import figure_svg, inline_svg
from vehgen.simulate import Mode
from vehgen.simulate.build import Build, body_channels, summarise_build

if TYPE_CHECKING:
    from matplotlib.figure import Figure

GONE = "no longer there when this page was written"
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

    `kernel.py`, `kernel_legend.txt` (what the numbers in it mean), `equations.txt`, `equations.tex`, `build.json`, `index.html` and, with
    `plots`, `drawing.svg` and `modes.svg`. Each file appears whole or not at all.
    """
    return write_build(summarise_build(model, values, modes, loads, warnings, plots), folder, model, kernel)


def build_files(folder: Path, plots: bool = True) -> list[Path]:
    """Return the files that :func:`write_build_folder` writes."""
    drawings = ("drawing.svg", "modes.svg") if plots else ()
    names = ("kernel.py", "kernel_legend.txt", "equations.txt", "equations.tex", *drawings, "build.json", "index.html")
    return [folder / name for name in names]


def redraw_build(build: Build, folder: Path, source: str) -> list[Path]:
    """Write the build folder of a result again but for the result, its kernel and equations from the vehicle's data.

    `source` is what errors call the result.
    """
    vehicle = build.read_vehicle(source)
    model = derive(vehicle, body_channels(vehicle))
    return write_build(build, folder, model, write_kernel(model), again=True)


def draw_built_vehicle(build: Build) -> Figure:
    """Return the drawing of a built vehicle, to scale."""
    from vehgen.report.drawing.vehicle import draw_vehicle

    return draw_vehicle(derive(build.read_vehicle("the build")), build.values)


def write_build(build: Build, folder: Path, model: EquationsOfMotion, kernel: KernelSource, again: bool = False) -> list[Path]:
    """Write the folder of a built vehicle from its equations and kernel; `again` leaves its result as it is."""
    texts = {
        "kernel.py": kernel.text,
        "kernel_legend.txt": kernel.legend,
        "equations.txt": equations.equations_text(model),
        "equations.tex": equations_latex(model),
    }
    if build.plots:
        from vehgen.report.drawing.mode_shapes import draw_modes
        from vehgen.report.drawing.vehicle import draw_vehicle

        texts["drawing.svg"] = figure_svg(draw_vehicle(model, build.values))
        texts["modes.svg"] = figure_svg(draw_modes(model, build.modes, build.values))
    texts |= {"build.json": json_text(build), "index.html": _page(build, model, texts)}
    written = [path for path in build_files(folder, build.plots) if not (again and path.name == "build.json")]
    for path in written:
        write_text(path, texts[path.name])
    return written


def _page(build: Build, model: EquationsOfMotion, texts: Mapping[str, str]) -> str:
    environment = Environment(autoescape=True, trim_blocks=True, lstrip_blocks=True, undefined=StrictUndefined)
    environment.filters["grouped"] = grouped
    template = environment.from_string((files("vehgen.report") / "templates" / "page.html.j2").read_text(encoding="utf-8"))
    symbols = equations.coordinate_mathml(model)
    return template.render(
        vehicle=model.vehicle,
        title=model.vehicle.title or model.vehicle.name,
        coordinates=[(i, item, Markup(symbols[i - 1])) for i, item in enumerate(model.coordinates, 1)],
        parameters=_parameters(build, model),
        modes=build.modes,
        axles=_axles(model, build.loads),
        hinges=build.loads.hinges,
        links=[(name, force) for (kind, name), force in build.loads.elements.items() if kind == "link"],
        total=sum(build.loads.axles.values()),
        weight=build.weight,
        mass=model.total_mass(build.values),
        gravity=GRAVITY if model.vehicle.gravity else 0,
        warnings=build.warnings,
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
        counts=build.operation_counts,
        kernel=texts["kernel.py"],
        legend=texts["kernel_legend.txt"],
        versions=build.versions,
        inputs=[(name, f"SHA-256 {digest}" if digest else GONE) for name, digest in build.inputs.items()],
    )


def _parameters(build: Build, model: EquationsOfMotion) -> list[dict[str, object]]:
    definitions = {symbol.name: expression for symbol, expression in model.definitions}
    rows: list[dict[str, object]] = []
    for name, item in build.parameters.items():
        rows.append(
            {
                "name": name,
                "symbol": Markup(equations.expression_mathml(model, sp.Symbol(name, real=True))),
                "value": grouped(item.value),
                "unit": _unit(item.unit),
                "range": " to ".join(map(grouped, item.range)) if item.range else "",
                "outside": item.range is not None and not item.range[0] <= item.value <= item.range[1],
                "equals": Markup(equations.expression_mathml(model, tidy(definitions[name]))) if name in definitions else "",
                "meaning": model.vehicle.parameters[name].meaning,
            }
        )
    return rows


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
