"""The build folder: kernel, equations, drawings, and one page with all of it."""

from __future__ import annotations

import hashlib
import io
import platform
from collections.abc import Mapping, Sequence
from importlib import metadata
from importlib.resources import files
from pathlib import Path

from jinja2 import Environment
from markupsafe import Markup
from matplotlib.figure import Figure

from vehgen.codegen import write_text
from vehgen.mechanics import LinearModel, StaticLoads
from vehgen.report.drawing import draw_vehicle
from vehgen.report.equations import equations_latex, equations_mathml, equations_text, mathml
from vehgen.report.mode_shapes import draw_modes
from vehgen.simulate import Mode


def write_build_folder(
    folder: Path,
    model: LinearModel,
    values: Mapping[str, float],
    modes: Sequence[Mode],
    loads: StaticLoads,
    kernel_source: str,
    warnings: Sequence[str] = (),
    plots: bool = True,
) -> list[Path]:
    """Write a vehicle's build folder; returns the files written.

    `kernel.py`, `equations.txt`, `equations.tex`, `index.html` and, with `plots`, `drawing.svg` and `modes.svg`. Each file appears whole
    or not at all.
    """
    texts = {"kernel.py": kernel_source, "equations.txt": equations_text(model), "equations.tex": equations_latex(model)}
    if plots:
        texts["drawing.svg"] = figure_svg(draw_vehicle(model, values))
        texts["modes.svg"] = figure_svg(draw_modes(model, modes, values))
    texts["index.html"] = _page(model, values, modes, loads, warnings, texts)
    for name, text in texts.items():
        write_text(folder / name, text)
    return [folder / name for name in texts]


def figure_svg(figure: Figure) -> str:
    """Return a figure as SVG text without the drawing program's date, so that equal figures are equal files."""
    import matplotlib as mpl

    stream = io.StringIO()
    with mpl.rc_context({"svg.hashsalt": "vehgen", "svg.fonttype": "path"}):
        figure.savefig(stream, format="svg", metadata={"Date": None})
    return stream.getvalue()


def save_figure(figure: Figure, path: Path) -> None:
    """Save a figure as PNG or SVG by its suffix, under a temporary name first."""
    temporary = path.with_name(f".{path.stem}.part{path.suffix}")
    try:
        figure.savefig(temporary, dpi=150)
        temporary.replace(path)
    finally:
        temporary.unlink(missing_ok=True)


def _page(
    model: LinearModel,
    values: Mapping[str, float],
    modes: Sequence[Mode],
    loads: StaticLoads,
    warnings: Sequence[str],
    texts: Mapping[str, str],
) -> str:
    vehicle = model.vehicle
    everything = vehicle.all_values({name: values[name] for name in vehicle.free_parameters})
    ranges, dimensions = vehicle.ranges(), vehicle.dimensions
    parameters = [
        {
            "name": name,
            "value": f"{everything[name]:.6g}",
            "unit": str(dimensions[name]).replace("no unit", "–"),
            "range": "{:.4g} to {:.4g}".format(*ranges[name]) if name in ranges else "",
            "equals": str(item.equals or ""),
            "meaning": item.meaning,
        }
        for name, item in vehicle.parameters.items()
    ]
    environment = Environment(autoescape=True, trim_blocks=True, lstrip_blocks=True)
    template = environment.from_string((files("vehgen.report") / "templates" / "page.html.j2").read_text(encoding="utf-8"))
    return template.render(
        vehicle=vehicle,
        coordinates=[(str(i), item.name, mathml(item.symbol), item.unit, item.meaning) for i, item in enumerate(model.coordinates, 1)],
        parameters=parameters,
        modes=modes,
        loads=loads,
        total=sum(loads.axles.values()),
        warnings=warnings,
        figures={key: _inline(texts[f"{key}.svg"]) for key in ("drawing", "modes") if f"{key}.svg" in texts},
        equations=[(name, meaning, [(place, Markup(text)) for place, text in rows]) for name, meaning, rows in equations_mathml(model)],
        counts=model.operation_counts(),
        kernel=texts["kernel.py"],
        versions={name: metadata.version(name) for name in ("vehgen", "sympy", "numpy", "numba")} | {"Python": platform.python_version()},
        inputs=[(path.name, hashlib.sha256(path.read_bytes()).hexdigest()) for path in vehicle.files],
        Markup=Markup,
    )


def _inline(svg: str) -> Markup:
    """Return an SVG file's element for use inside a page."""
    return Markup(svg[svg.index("<svg") :])
