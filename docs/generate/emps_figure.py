"""Draw emps.md's figure: `python docs/generate/emps_figure.py DATA_EMPS.mat VEHICLE.yaml`, with the vehicle that the diagnosis wrote."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

sys.path.insert(0, str(Path(__file__).parents[1] / "examples" / "emps"))
from force_error import read_motion

from vehgen.report import save_figure
from vehgen.vehicle import load_vehicle

HERE = Path(__file__).parents[1]
MEASURED, LAW, VISCOUS = "#9aa7b1", "#0b5fa5", "#d55e00"


def draw(path: Path, vehicle: Path) -> None:
    """Draw the force that is left when the mass is accelerated, over the velocity, with the law that was found."""
    values = load_vehicle(vehicle).values()
    friction = next(value for name, value in values.items() if name.startswith("dry_friction"))
    velocity, acceleration, force = read_motion(path)
    resisting = force - values["M"] * acceleration
    own = values["c"] * velocity + friction * np.sign(velocity)
    constant = float(np.mean(resisting - own))
    viscous = np.polyfit(velocity, resisting, 1)
    figure = Figure(figsize=(9, 5.2), layout="constrained")
    axes = figure.add_subplot()
    axes.plot(velocity, resisting, ".", color=MEASURED, markersize=1.5, rasterized=True, label="motor force less M a, measured")
    grid = np.linspace(velocity.min(), velocity.max(), 400)
    label = f"{values['c']:.0f} N s/m and {friction:.1f} N of dry friction, {constant:+.1f} N beside"
    axes.plot(grid, values["c"] * grid + friction * np.sign(grid) + constant, color=LAW, linewidth=1.6, label=label)
    label = f"{viscous[0]:.0f} N s/m alone"
    axes.plot(grid, np.polyval(viscous, grid), color=VISCOUS, linewidth=1.4, linestyle="--", label=label)
    axes.set(xlabel="velocity [m/s]", ylabel="force [N]", title="What resists the carriage: a jump where its motion turns")
    axes.legend(loc="upper left", markerscale=6)
    save_figure(figure, HERE / "images" / "emps.png")


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit("usage: python docs/generate/emps_figure.py DATA_EMPS.mat VEHICLE.yaml")
    draw(Path(sys.argv[1]), Path(sys.argv[2]))
