"""Write models.md and its drawings from the bundled vehicles: `python docs/generate/models_page.py`."""

from __future__ import annotations

from pathlib import Path

from vehgen.mechanics import derive, static_loads
from vehgen.report import draw_vehicle, figure_svg
from vehgen.simulate import natural_modes
from vehgen.vehicle import bundled_models, load_vehicle

HERE = Path(__file__).parents[1]


def main() -> None:
    """Write the page."""
    lines = [
        "# The bundled vehicles and rigs",
        "",
        "Made by `python docs/generate/models_page.py`. `vehgen build NAME` shows one in full; [rigs.md](rigs.md) has runs of the rigs.",
        "",
    ]
    for name, path in bundled_models().items():
        vehicle = load_vehicle(path)
        model = derive(vehicle)
        drawing = HERE / "images" / "models" / f"{name}.svg"
        drawing.parent.mkdir(parents=True, exist_ok=True)
        drawing.write_text(figure_svg(draw_vehicle(model)), encoding="utf-8")
        lines += [f"## {name}", "", f"**{vehicle.title}.** {vehicle.description}", "", f"Source: {vehicle.source}", ""]
        lines += [f"![{vehicle.title}](images/models/{name}.svg)", ""]
        modes = natural_modes(model)
        lines += [
            f"{model.n_dof} degrees of freedom. Undamped modes, Hz: "
            + ", ".join(f"{mode.name} {mode.undamped_hz:.2f}" for mode in modes)
            + ".",
            "",
        ]
        loads = static_loads(model)
        if loads.axles:
            lines += ["Static axle loads, kN: " + ", ".join(f"{axle} {force / 1e3:.1f}" for axle, force in loads.axles.items()) + ".", ""]
        elif vehicle.gravity:
            links = ", ".join(f"{name} {force:.0f}" for (_, name), force in loads.elements.items())
            lines += [f"Static forces in its links, N: {links}.", ""]
        if vehicle.sets:
            lines += ["Parameter sets: " + ", ".join(f"`{item}`" for item in vehicle.sets) + ".", ""]
    (HERE / "models.md").write_text("\n".join(lines).rstrip() + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
