"""Find a building module's mass, stiffness and damping by finite elements, as a cargo file."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from vehgen.commands.results import add_out, file_named, tell_written
from vehgen.commands.terminal import add_json, number_text, print_json, print_table, warn
from vehgen.files import check_results, write_text

if TYPE_CHECKING:
    from vehgen.cargo.module_model import ModuleModel

EXAMPLE = "vehgen module steel_module.yaml --out module_cargo.yaml --plot module.png"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the command's arguments."""
    parser.add_argument("frame", metavar="FRAME", help="a frame file: dimensions, members, panels")
    add_out(parser, "FILE", "where to write the cargo file (default: FRAME_cargo.yaml here)")
    parser.add_argument("--plot", metavar="FILE", help="draw mesh and mode shape (.png, .svg or .pdf)")
    parser.add_argument("--mass", choices=("total", "effective"), help="what sits on the spring (default: the file's)")
    parser.add_argument("--convergence", action="store_true", help="solve at four mesh sizes and compare")
    add_json(parser)


def run(options: argparse.Namespace) -> None:
    """Solve the module, print it and write its cargo file."""
    from vehgen.cargo.frame_file import load_frame
    from vehgen.cargo.module_model import cargo_text, convergence, module_model

    frame = load_frame(options.frame)
    path = Path(f"{frame.path.stem}_cargo.yaml") if options.out is None else file_named(options.out)
    picture = None if options.plot is None else file_named(options.plot, "--plot")
    written = [path] if picture is None else [path, picture]
    check_results(written)
    if picture is not None:
        from vehgen.report import figure_format

        figure_format(picture)
    model = module_model(frame, mass=options.mass)
    study = convergence(frame) if options.convergence else []
    write_text(path, cargo_text(model))
    if picture is not None:
        from vehgen.report import save_figure
        from vehgen.report.drawing.module_picture import plot_module

        save_figure(plot_module(model), picture)
    if options.json:
        print_json({**_data(model), "convergence": [_level(item) for item in study], "files": [str(item) for item in written]})
        return
    _print_model(model)
    if study:
        _print_study(study)
    warn(model.warnings)
    tell_written(written)


def _data(model: ModuleModel) -> dict[str, object]:
    modes, body = model.modes, model.body
    return {
        "total_mass": body.mass,
        "mass": model.mass,
        "fixed_mass": model.fixed_mass,
        "stiffness": model.stiffness,
        "damping": model.damping,
        "frequency": model.frequency,
        "damping_ratio": model.damping_ratio,
        "effective_mass": model.effective_mass,
        "effective_share": model.effective_share,
        "cog": {"behind_front": float(body.cog[0]), "from_left": float(body.cog[1]), "above_floor": float(body.cog[2])},
        "pitch_inertia": body.pitch_inertia,
        "nodes": len(model.mesh.nodes),
        "modes": [
            {
                "frequency": float(modes.frequency[i]),
                "effective_share": float(modes.effective_mass[i] / body.mass),
                "hourglass_share": float(modes.hourglass[i]),
                "genuine": bool(modes.genuine[i]),
            }
            for i in range(len(modes.frequency))
        ],
        "warnings": list(model.warnings),
    }


def _level(model: ModuleModel) -> dict[str, float]:
    return {
        "mesh_size": model.mesh_size,
        "nodes": len(model.mesh.nodes),
        "frequency": model.frequency,
        "effective_share": model.effective_share,
    }


def _print_model(model: ModuleModel) -> None:
    body, modes = model.body, model.modes
    fixed = [("fixed mass, moves with the carrier", f"{number_text(model.fixed_mass)} kg")] if model.fixed_mass > 0 else []
    rows = [
        ("total mass", f"{number_text(body.mass)} kg"),
        ("m0, mass on the spring", f"{number_text(model.mass)} kg"),
        *fixed,
        ("f0, principal vertical mode", f"{model.frequency:.4f} Hz"),
        ("effective mass of that mode", f"{number_text(model.effective_mass)} kg = {model.effective_share:.1%} of the total"),
        ("k0", f"{number_text(model.stiffness / 1e3)} kN/m"),
        ("damping ratio", f"{model.damping_ratio:.4f}"),
        ("c0", f"{number_text(model.damping / 1e3, 3)} kN s/m"),
        ("COG behind the front", f"{body.cog[0]:.4f} m"),
        ("COG above the floor", f"{body.cog[2]:.4f} m"),
        ("pitch inertia about the COG", f"{number_text(body.pitch_inertia)} kg m^2"),
    ]
    print_table(model.frame.file.title or model.frame.path.stem, ("", "value"), rows)
    strongest = sorted(range(len(modes.frequency)), key=lambda i: -modes.effective_mass[i])[:6]
    mode_rows = [
        (
            f"{modes.frequency[i]:.4f}",
            f"{modes.effective_mass[i] / body.mass:.1%}",
            f"{modes.hourglass[i]:.1%}",
            "principal" if i == modes.principal else "" if modes.genuine[i] else "artefact of the mesh, excluded",
        )
        for i in sorted(strongest)
    ]
    title = f"Modes that move most mass vertically, of {len(modes.frequency)} up to {modes.frequency[-1]:.1f} Hz"
    print_table(title, ("Hz", "effective mass", "hourglass energy", ""), mode_rows, right=(0, 1, 2))


def _print_study(study: list[ModuleModel]) -> None:
    rows = []
    for i, item in enumerate(study):
        change = f"{item.frequency / study[i - 1].frequency - 1:+.2%}" if i else ""
        size, nodes = f"{item.mesh_size:.3g}", f"{len(item.mesh.nodes)}"
        rows.append((size, nodes, f"{item.mesh.n_dof}", f"{item.frequency:.4f}", change, f"{item.effective_share:.1%}"))
    columns = ("mesh size, m", "nodes", "degrees of freedom", "f0, Hz", "change", "effective mass")
    print_table("Convergence", columns, rows, right=(0, 1, 2, 3, 4, 5))
