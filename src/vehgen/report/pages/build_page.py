"""The build folder: kernel, equations, drawings, and one page with all of it."""

from __future__ import annotations

import shlex
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import sympy as sp
from markupsafe import Markup, escape

from vehgen.codegen import KernelSource, write_kernel
from vehgen.files import write_text
from vehgen.files.number_text import grouped, kilonewtons, millimetres
from vehgen.files.results import json_text
from vehgen.mechanics import GRAVITY, EquationsOfMotion, StaticLoads, derive
from vehgen.mechanics.static_loads import static_deflections
from vehgen.report.equations import writing as equations
from vehgen.report.equations.latex import equations_latex
from vehgen.report.equations.notation import tidy
from vehgen.report.figure_files import figure_svg, inline_svg, with_titles
from vehgen.report.pages.assets import page_environment, template_text
from vehgen.simulate import Mode
from vehgen.simulate.build import Build, body_channels, summarise_build
from vehgen.simulate.hump_drive import DRIVE_HUMP_HEIGHT, DRIVE_HUMP_LENGTH, DRIVE_SPEED, hump_drive
from vehgen.simulate.mode_groups import alike_modes, group_name

if TYPE_CHECKING:
    from matplotlib.figure import Figure

GONE = "no longer there when this page was written"


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
    environment = page_environment()
    environment.filters |= {"grouped": grouped, "kilonewtons": kilonewtons, "millimetres": millimetres}
    template = environment.from_string(template_text("page.html.j2"))
    symbols = equations.coordinate_mathml(model)
    return template.render(
        vehicle=model.vehicle,
        title=model.vehicle.title or model.vehicle.name,
        coordinates=[(i, item, Markup(symbols[i - 1])) for i, item in enumerate(model.coordinates, 1)],
        parameters=_parameters(build, model),
        modes=[(group_name(group), group[0]) for group in alike_modes(build.modes)],
        moving=_moving(build, model),
        drive=_drive(build, model),
        road=_road(build, model),
        hump=f"A half sine of {1e3 * DRIVE_HUMP_HEIGHT:g} mm over {DRIVE_HUMP_LENGTH:g} m, at {DRIVE_SPEED:g} m/s.",
        axles=_axles(model, build.loads),
        hinges=[(name, model.vehicle.hinges[name].title, force) for name, force in build.loads.hinges.items()],
        springs=_springs(model, build),
        total=sum(build.loads.axles.values()),
        weight=build.weight,
        mass=model.total_mass(build.values),
        gravity=GRAVITY if model.vehicle.gravity else 0,
        warnings=build.warnings,
        figures=_figures(build, model, texts),
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


def _unit(unit: str) -> str:
    return unit.replace("no unit", "–").replace("^2", "²").replace("^3", "³")


def _axles(model: EquationsOfMotion, loads: StaticLoads) -> list[tuple[str, str, float]]:
    return [(name, model.vehicle.axles[name].title, force) for name, force in loads.axles.items()]


def _springs(model: EquationsOfMotion, build: Build) -> list[tuple[str, str, str, float, float]]:
    """Return kind, name, title, force [N] and deflection [m] of suspensions, tyres and links at rest; none without gravity."""
    if not model.vehicle.gravity:
        return []
    deflections = static_deflections(model, build.values, build.loads)
    titles = {name: part.title for parts in (model.vehicle.axles, model.vehicle.links) for name, part in parts.items()}
    return [(*key, titles[key[1]], build.loads.elements[key], deflection) for key, deflection in deflections.items()]


def _moving(build: Build, model: EquationsOfMotion) -> list[tuple[str, Mode, Markup]]:
    """Return name, mode and moving picture, one of every group of modes that are alike."""
    if not build.plots:
        return []
    from vehgen.report.drawing.animation import mode_pictures

    groups = list(alike_modes(build.modes))
    pictures = mode_pictures(model, [group[0] for group in groups], build.values)
    return [(group_name(group), group[0], picture) for group, picture in zip(groups, pictures, strict=True)]


def _drive(build: Build, model: EquationsOfMotion) -> Markup | None:
    """Return the moving picture of a drive; None for a rig without axles."""
    if not (build.plots and model.vehicle.axles):
        return None
    from vehgen.report.drawing.animation import drive_picture

    return drive_picture(model, build.values, hump_drive(model, build.values))


def _road(build: Build, model: EquationsOfMotion) -> dict[str, object] | None:
    """Return what one road does to the vehicle: speed, band, file, peaks and figure; without figure for a rig, None without drawings."""
    if not build.plots:
        return None
    if not model.vehicle.axles:
        return {"figure": None}
    from vehgen.report.curve_values import inline_figure
    from vehgen.report.plots.road_amplitude_plot import plot_road_amplitudes, shown_amplitude
    from vehgen.simulate.frequency import leaves_laws_out
    from vehgen.simulate.road_amplitudes import AMPLITUDE_BAND_HZ, road_amplitudes

    found = road_amplitudes(model.vehicle, {name: build.values[name] for name in model.vehicle.free_parameters})
    peaks = []
    for item in found.curves:
        factor, unit = shown_amplitude(item)
        peak = [f"{value:#.3g}".rstrip(".") for value in (item.peak[0], factor * item.peak[1])] if item.peak else ["none", ""]
        peaks.append((item.group, item.name, *peak, unit))
    title = f"Heave, axle hop and tyre load of {model.vehicle.title or model.vehicle.name} per metre of road, over frequency"
    return {
        "speed": f"{found.speed:g}",
        "band": AMPLITUDE_BAND_HZ,
        "file": shlex.quote(next(iter(build.inputs), model.vehicle.name)),
        "peaks": peaks,
        "laws": leaves_laws_out(model),
        "figure": inline_figure(plot_road_amplitudes(found), "road", title),
    }


def _figures(build: Build, model: EquationsOfMotion, texts: Mapping[str, str]) -> dict[str, Markup]:
    title = str(escape(model.vehicle.title or model.vehicle.name))
    svg = with_titles(texts.get("drawing.svg", ""), _hover(build, model))
    return {"drawing": Markup(inline_svg(svg, "drawing", f"Side view of {title}, to scale") if svg else "")}


def _hover(build: Build, model: EquationsOfMotion) -> dict[str, str]:
    """Return what the parts of a drawing say when pointed at, by their ids."""
    vehicle, said = model.vehicle, {}
    everything = vehicle.all_values({name: build.values[name] for name in vehicle.free_parameters})
    for name, body in vehicle.bodies.items():
        said[f"body-{name}"] = said[f"cog-{name}"] = f"{body.title or name}: {grouped(body.mass.evaluate(everything))} kg"
    for name, force in build.loads.axles.items():
        said[f"wheel-{name}"] = f"{vehicle.axles[name].title or name}: static load {kilonewtons(force)} kN"
    for name, force in build.loads.hinges.items():
        said[f"hinge-{name}"] = f"{vehicle.hinges[name].title or name}: {kilonewtons(force)} kN at rest"
    return said


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
