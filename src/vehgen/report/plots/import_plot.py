"""An import for the eye: what each phone recorded, what came out, and where the front wheel reached the hump."""

from __future__ import annotations

from matplotlib.figure import Figure

from vehgen.phones import PhoneImport
from vehgen.report.drawing.canvas import INK


def plot_import(found: PhoneImport) -> Figure:
    """Draw an import: a panel a channel, with the phone's samples, the even channel, the quiet stretch, and when the axles crossed."""
    crossings = [] if found.at is None else [(name, (found.at + offset) / found.speed) for name, offset in found.wheels.items()]
    arrival = None if found.at is None else found.at / found.speed
    figure = Figure(figsize=(11.0, 1.1 + 2.1 * len(found.samples)), layout="constrained")
    rows = figure.subplots(len(found.samples), 1, sharex=True, squeeze=False)[:, 0]
    for column, (axes, panel) in enumerate(zip(rows, found.samples, strict=True)):
        if panel.quiet[1] > panel.quiet[0]:
            axes.axvspan(*panel.quiet, color="#e8f0e4", lw=0, label="quiet stretch")
        axes.plot(panel.time, panel.values, ".", color="#d55e00", ms=2.2, label="samples of the phone, turned upright")
        axes.plot(found.time, found.values[:, column], color="#0b5fa5", lw=0.9, label="recording of the run")
        for _, moment in crossings:
            axes.axvline(moment, color="#8a949c", lw=0.7, ls=(0, (2, 2)))
        if arrival is not None:
            axes.axvline(arrival, color=INK, lw=1.2, label="front wheel at the hump")
        if panel.onset is not None:
            axes.axvline(panel.onset, color="#7b3294", lw=1.0, ls=(0, (5, 2)), label="energy sets in")
        axes.set_ylabel(f"{panel.channel}\n[{panel.unit}]", color=INK, parse_math=False)
        if panel.channel in found.noise:
            sigma = found.noise[panel.channel].sigma
            axes.text(0.995, 0.95, f"noise sigma {sigma:.2g}", transform=axes.transAxes, ha="right", va="top", fontsize=8, color=INK)
        axes.grid(color="#e3e7ea", lw=0.6)
        axes.spines[["top", "right"]].set_visible(False)
        axes.margins(x=0)
    for name, moment in crossings:
        rows[0].annotate(
            name,
            (moment, 1.0),
            xycoords=("data", "axes fraction"),
            xytext=(2, 2),
            textcoords="offset points",
            fontsize=7.5,
            color="#5b6770",
        )
    figure.legend(*rows[0].get_legend_handles_labels(), loc="outside lower left", fontsize=8.5, frameon=False, ncols=5)
    rows[-1].set_xlabel("time of the run [s]", color=INK)
    figure.align_ylabels()
    figure.suptitle(found.title, x=0.01, ha="left", fontsize=11, color=INK, parse_math=False)
    return figure
