"""Draw transmissibility.md's figure, two phones on a rough road: `python docs/generate/transmissibility_figure.py`."""

from __future__ import annotations

import tempfile
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

import vehgen
from vehgen.fit.transmissibility_result import Transmissibility
from vehgen.report import save_figure

HERE = Path(__file__).parents[1]
PLACES = {"F": 1.1, "R": -1.5}
"""Phones ahead of the sedan's COG [m]."""
RATTLE_BAND_HZ, RATTLE = (11.0, 14.0), 0.5
"""Where the rear phone rattles, and its standard deviation [m/s^2]."""
NOISE = 0.03
"""Standard deviation of both phones' noise [m/s^2]."""
RUN = """\
vehicle: sedan2
speed: 15 m/s
duration: 240 s
road: [{iso8608: {class: C, seed: 7}}]
recording: drive.csv
sensors:
"""
STIFF = "extends: sedan2\nname: stiff\nparameters: {kr: {value: 1.3 * 71655 N/m}}\n"
LIMITS, MEASURED, RIGHT, WRONG = "#b9c7d3", "#1b2733", "#0b5fa5", "#d55e00"


def record(folder: Path) -> Path:
    """Write a run file with what two phones in the sedan would record, and return it."""
    sensors = "".join(f"  {name}: {{body: body, x: {x} m, channels: {{acceleration: {name}_az}}}}\n" for name, x in PLACES.items())
    path = folder / "drive.yaml"
    path.write_text(RUN + sensors, encoding="utf-8")
    found = vehgen.simulate(path)
    random = np.random.default_rng(7)
    values = found.values[0] + NOISE * random.normal(size=found.values[0].shape)
    lines = np.fft.rfft(random.normal(size=len(values)))
    frequency = np.fft.rfftfreq(len(values), 0.01)
    lines[(frequency < RATTLE_BAND_HZ[0]) | (frequency > RATTLE_BAND_HZ[1])] = 0.0
    rattle = np.fft.irfft(lines, len(values))
    values[:, 1] += RATTLE * rattle / rattle.std()
    rows = "\n".join(f"{0.01 * i:.2f},{front:.5f},{rear:.5f}" for i, (front, rear) in enumerate(values))
    (folder / "drive.csv").write_text(f"t,F_az,R_az\n{rows}\n", encoding="utf-8")
    return path


def draw(right: Transmissibility, wrong: Transmissibility) -> Figure:
    """Draw the measured ratio with both models, and the coherence below."""
    item = right.ratios[0]
    figure = Figure(figsize=(9.0, 5.6), layout="constrained")
    above, below = figure.subplots(2, 1, sharex=True, height_ratios=(3, 1))
    above.fill_between(right.frequency, item.lower, item.upper, color=LIMITS, lw=0, label="measured: 95 % limits")
    above.semilogy(right.frequency, np.sqrt(item.h1 * item.h2), color=MEASURED, lw=0.9, label="measured")
    for found, colour, style, label in (
        (right, RIGHT, (0, (5, 1.5)), "right model"),
        (wrong, WRONG, (0, (1.2, 1)), "rear spring 30 % too stiff"),
    ):
        model = found.ratios[0]
        assert model.model_h1 is not None
        assert model.model_h2 is not None
        above.semilogy(right.frequency, np.sqrt(model.model_h1 * model.model_h2), color=colour, lw=1.6, ls=style, label=label)
    for band in wrong.ratios[0].bands:
        text = f"{band.distance:.1f} s.e.\n" + ("apart" if band.is_apart else "within")
        spot = (band.low * band.high) ** 0.5, 1.01
        above.annotate(text, spot, xycoords=("data", "axes fraction"), ha="center", va="bottom", fontsize=8.5, color=MEASURED)
        for axes in (above, below):
            axes.axvline(band.high, color="#c3ccd3", lw=0.7)
    heights = [0.6, 0.8, 1, 1.5, 2, 3]
    above.set(ylabel="rear over front acceleration [-]", ylim=(0.6, 3.2), xscale="log", yticks=heights)
    above.set_yticklabels([f"{height:g}" for height in heights])
    above.minorticks_off()
    above.legend(loc="upper left", fontsize=9)
    below.plot(right.frequency, item.coherence, color=MEASURED, lw=1.0)
    ticks = [0.5, 1, 2, 5, 8, 12, 15, 20]
    below.set(xlabel="frequency [Hz]", ylabel="coherence [-]", ylim=(0.0, 1.03), xlim=(0.5, 20.0), xticks=ticks)
    below.set_xticklabels([f"{tick:g}" for tick in ticks])
    below.minorticks_off()
    return figure


def main() -> None:
    """Record, compare with both models and draw."""
    with tempfile.TemporaryDirectory() as folder:
        path = record(Path(folder))
        right, wrong = (vehgen.transmissibility(path, vehicle=vehicle) for vehicle in ("sedan2", vehgen.parse_vehicle(STIFF)))
    save_figure(draw(right, wrong), HERE / "images" / "transmissibility.svg")


if __name__ == "__main__":
    main()
