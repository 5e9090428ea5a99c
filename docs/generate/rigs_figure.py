"""Draw rigs.md's figure from its examples: `python docs/generate/rigs_figure.py`."""

from __future__ import annotations

from pathlib import Path

from matplotlib.figure import Figure

from vehgen.report import save_figure
from vehgen.simulate import Response, load_run, simulate

HERE = Path(__file__).parents[1]
BLUE, GREY = "#0b5fa5", "#9aa7b1"


def response(name: str) -> Response:
    """Return what the run of a rig gives."""
    return simulate(load_run(HERE / "examples" / "rigs" / f"{name}_run.yaml"))


def draw() -> None:
    """Draw the drop's tyre load and acceleration, and the damper's force over its travel."""
    drop, dyno = response("drop_test"), response("damper_dyno")
    figure = Figure(figsize=(11, 4), layout="constrained")
    left, right = figure.subplots(1, 2)
    left.plot(drop.time, drop.values[0, :, 1] / 1e3, color=BLUE)
    left.axhline(drop.values[0, -1, 1] / 1e3, color=GREY, linewidth=1, linestyle="--")
    left.annotate("at rest", (2.2, drop.values[0, -1, 1] / 1e3 + 0.08))
    left.set(xlabel="time [s]", ylabel="front tyre load [kN]", title="Half a car, dropped by 60 mm", xlim=(0, 3), ylim=(-0.2, 5.3))
    late = dyno.time > 0.5
    right.plot(1e3 * dyno.values[0, late, 1], -1e-3 * dyno.values[0, late, 0], color=BLUE)
    right.set(xlabel="stroke [mm]", ylabel="force at the load cell [kN]", title="A damper at 1.5 Hz")
    save_figure(figure, HERE / "images" / "rigs.png")


if __name__ == "__main__":
    draw()
