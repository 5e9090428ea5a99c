"""Draw measurement.md's figure, what a hump becomes on its way into a file: `python docs/generate/measurement_figure.py`."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from vehgen import Place, PointOutput, Simulator
from vehgen.measure import record_psd
from vehgen.measure.acquisition import AcquisitionChain
from vehgen.report import save_figure
from vehgen.road import ConstantSpeed, Hump, Track
from vehgen.simulate import Scenario

Array = NDArray[np.float64]
HERE = Path(__file__).parents[1]
CHAIN = AcquisitionChain("butterworth", 4, 30.0, delay=0.004)
RESOLUTION, RATE = 0.25, 100.0
"""Coarser than a phone's, so that it shows [m/s^2]; rate of the recording [Hz]."""
SHOWN_S = (1.97, 2.25)
TRUE, FILTERED, SAMPLED, QUANTISED = "#9aa7b1", "#0b5fa5", "#d55e00", "#1a1a1a"


def simulate() -> tuple[Array, Array, Array, Array]:
    """Return fine times and the front axle's acceleration as it is, low-passed and delayed, and the samples of a recorder."""
    output = PointOutput("az", Place("axle", "body", behind="front"), "acceleration")
    simulator = Simulator("sedan2", (output,))
    track = Track((Hump.from_shape("trapezoid", 20.0, 0.15, 0.03, ramp=0.1),))
    motion = Scenario(track, ConstantSpeed(10.0), 4.0, 2.5e-4, 1)
    parameters = simulator.parameters()
    acquired = replace(motion, chains={"az": CHAIN})
    found = [simulator.run(parameters, item).responses[0, :, 0] for item in (motion, acquired)]
    sampled = simulator.run(parameters, replace(acquired, decimation=round(1 / RATE / motion.dt))).responses[0, :, 0]
    return motion.time, found[0], found[1], sampled


def draw() -> None:
    """Simulate and draw both panels."""
    time, true, filtered, sampled = simulate()
    figure = Figure(figsize=(10.0, 4.4), layout="constrained")
    left, right = figure.subplots(1, 2, width_ratios=(3, 2))
    plot_histories(left, time, true, filtered, sampled)
    plot_spectra(right, time, true, sampled)
    save_figure(figure, HERE / "images" / "measurement.svg")


def plot_histories(axes: Axes, time: Array, true: Array, filtered: Array, sampled: Array) -> None:
    """Draw what becomes of the motion."""
    shown = (time >= SHOWN_S[0]) & (time <= SHOWN_S[1])
    clock = np.arange(len(sampled)) / RATE
    kept = (clock >= SHOWN_S[0]) & (clock <= SHOWN_S[1])
    axes.plot(time[shown], true[shown], color=TRUE, lw=1.2, label="the motion")
    axes.plot(
        time[shown], filtered[shown], color=FILTERED, lw=1.5, label=f"low-passed at {CHAIN.cut_off:g} Hz, {1e3 * CHAIN.delay:g} ms late"
    )
    axes.plot(clock[kept], sampled[kept], "o", color=SAMPLED, ms=5, mfc="none", label=f"sampled at {RATE:g} Hz")
    rounded = RESOLUTION * np.round(sampled[kept] / RESOLUTION)
    axes.plot(clock[kept], rounded, ".", color=QUANTISED, ms=4, label=f"rounded to {RESOLUTION:g} m/s²: the file")
    axes.set(xlabel="time [s]", ylabel="acceleration above the front axle [m/s²]")
    axes.legend(fontsize=8, loc="lower right")
    axes.grid(alpha=0.3)


def plot_spectra(axes: Axes, time: Array, true: Array, sampled: Array) -> None:
    """Draw the spectra of the motion, of point samples of it, and of the recording."""
    step = round(1 / RATE / (time[1] - time[0]))
    for values, dt, colour, label in (
        (true, time[1] - time[0], TRUE, "the motion"),
        (true[::step], 1 / RATE, QUANTISED, "point samples: folded"),
        (sampled, 1 / RATE, SAMPLED, "the recording"),
    ):
        frequency, density = record_psd(values, float(dt))
        smooth = np.convolve(density, np.ones(13) / 13, mode="same")
        shown = (frequency > 1) & (frequency < 120)
        axes.loglog(frequency[shown], smooth[shown], color=colour, lw=1.3, label=label)
    axes.axvline(RATE / 2, color="0.5", ls=":", lw=1)
    axes.annotate("half the rate ", (RATE / 2, 1.5e-1), ha="right", va="top", fontsize=8, color="0.4")
    axes.set(xlabel="frequency [Hz]", ylabel="PSD [(m/s²)²/Hz]", ylim=(1e-6, 2e-1))
    axes.legend(fontsize=8, loc="lower left")
    axes.grid(alpha=0.3, which="both")


if __name__ == "__main__":
    draw()
