"""Draw silverbox.md's figure: `python docs/generate/silverbox_figure.py SNLS80mV.csv`."""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

sys.path.insert(0, str(Path(__file__).parents[1] / "examples" / "silverbox"))
from free_run import FIRST, Array, fit, free_run, with_cubic_spring
from prepare import DISPLACEMENT, RUNS, STEP, TESTS, noise_levels, read_silverbox, upsample, write_runs

from vehgen.measure import record_psd
from vehgen.report import save_figure
from vehgen.vehicle import load_vehicle

HERE = Path(__file__).parents[1]
MEASURED, LINEAR, CUBIC = "#9aa7b1", "#d55e00", "#0b5fa5"
MILLI = 1e3 / DISPLACEMENT
"""From metres to millivolts of V2."""


def draw(path: Path) -> None:
    """Fit both vehicles, simulate the test splits, draw."""
    force, displacement = read_silverbox(path)
    fine = upsample(force)
    linear = load_vehicle(HERE / "examples" / "silverbox" / "silverbox.yaml")
    cubic = with_cubic_spring(linear)
    with tempfile.TemporaryDirectory() as folder:
        runs = write_runs(path, Path(folder), RUNS)
        values = {"linear": fit(linear, runs), "cubic": fit(cubic, runs)}
    vehicles = {"linear": linear, "cubic": cubic}
    left = {}
    for split in ("arrow_full", "multisine"):
        for name, vehicle in vehicles.items():
            simulated, measured = free_run(vehicle, values[name], fine, displacement, TESTS[split])
            left[split, name] = MILLI * (simulated - measured)
    figure = Figure(figsize=(12, 7.5), layout="constrained")
    grid = figure.add_gridspec(2, 2)
    plot_arrow(figure.add_subplot(grid[0, :]), MILLI * displacement[slice(*TESTS["arrow_full"])][FIRST:], left)
    plot_spring(figure.add_subplot(grid[1, 0]), force, displacement, values["cubic"])
    plot_spectra(figure.add_subplot(grid[1, 1]), displacement, left, noise_levels(force, displacement), values["cubic"])
    save_figure(figure, HERE / "images" / "silverbox.png")


def plot_arrow(axes: Axes, measured: Array, left: dict[tuple[str, str], Array]) -> None:
    """Draw the arrow-shaped test: what was measured and what both models leave."""
    time = STEP * (TESTS["arrow_full"][0] + FIRST + np.arange(len(measured)))
    for values, colour, label in (
        (measured, MEASURED, "measured"),
        (left["arrow_full", "linear"], LINEAR, "left by the linear vehicle"),
        (left["arrow_full", "cubic"], CUBIC, "left with a cubic spring"),
    ):
        axes.plot(time, values, color=colour, linewidth=0.5, label=f"{label}, RMS {np.sqrt(np.mean(values**2)):.3g} mV")
    axes.axvline(STEP * TESTS["arrow_without_extrapolation"][1], color="black", linewidth=0.8, linestyle=":")
    axes.annotate(
        "louder than training",
        (STEP * TESTS["arrow_without_extrapolation"][1], 0.03),
        xycoords=("data", "axes fraction"),
        xytext=(6, 0),
        textcoords="offset points",
    )
    axes.set(
        xlabel="time [s]", ylabel="V2 [mV]", title="Test on the arrow, simulated from its first 50 samples on", xlim=(time[0], time[-1])
    )
    axes.legend(loc="upper left", ncols=3)
    axes.set_ylim(-400, 460)


def plot_spring(axes: Axes, force: Array, displacement: Array, values: dict[str, float]) -> None:
    """Draw what the spring does besides k1: F - m y'' - c y' - k1 y from the record itself, over y."""
    first, last = TESTS["arrow_full"]
    frequency = 2j * np.pi * np.fft.rfftfreq(len(displacement), STEP)
    spectrum = np.fft.rfft(displacement)
    rate, acceleration = (np.fft.irfft(spectrum * frequency**n, len(displacement)) for n in (1, 2))
    spring = force - values["m1"] * acceleration - values["c1"] * rate - values["k1"] * displacement
    travel, own = 1e3 * displacement[first:last], spring[first:last]
    axes.plot(
        travel[::2], own[::2], ".", color=MEASURED, markersize=1, label="measured force less $m\\ddot y + c\\dot y + k y$", rasterized=True
    )
    y = np.linspace(travel.min(), travel.max(), 200)
    axes.plot(y, values["cubic_stiffness_spring_k3"] * (1e-3 * y) ** 3, color=CUBIC, label="$k_3 y^3$")
    axes.set(xlabel="displacement y [mm]", ylabel="force [N]", title="What a linear spring lacks, in the arrow's record")
    axes.legend(loc="upper left", markerscale=8)


def plot_spectra(
    axes: Axes, displacement: Array, left: dict[tuple[str, str], Array], noise: tuple[float, float], values: dict[str, float]
) -> None:
    """Draw the spectra of the multisine test: measured, left by both models, and the noise."""
    first, last = TESTS["multisine"]
    for series, colour, label in (
        (MILLI * displacement[first:last], MEASURED, "measured"),
        (left["multisine", "linear"], LINEAR, "left by the linear vehicle"),
        (left["multisine", "cubic"], CUBIC, "left with a cubic spring"),
    ):
        frequency, density = record_psd(series, STEP)
        smooth = np.convolve(density, np.ones(41) / 41, mode="same")
        axes.semilogy(frequency, smooth, color=colour, linewidth=1, label=label)
    omega = 2 * np.pi * frequency
    response = 1 / (values["k1"] - values["m1"] * omega**2 + 1j * omega * values["c1"])
    density = 2 * STEP * (noise[0] ** 2 * np.abs(response) ** 2 + noise[1] ** 2) * MILLI**2
    axes.semilogy(frequency, density, color="black", linewidth=1, linestyle="--", label="noise, from a weak part behind all splits")
    axes.axvspan(150, 305, color="#eeeeee", zorder=0)
    axes.annotate("not compared", (155, 0.03), xycoords=("data", "axes fraction"))
    axes.set(xlabel="frequency [Hz]", ylabel="PSD of V2 [mV²/Hz]", title="Test on the multisine", xlim=(0, 300), ylim=(1e-7, 1e6))
    axes.legend(loc="upper right", fontsize=8)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: python docs/generate/silverbox_figure.py SNLS80mV.csv")
    draw(Path(sys.argv[1]))
