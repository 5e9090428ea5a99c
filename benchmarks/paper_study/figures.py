"""The study's figures, as the paper's Figs. 5, 11, 13, 14 and 16 to 18."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from benchmarks.paper_study.fits import Fit
from benchmarks.paper_study.judging import Judgement
from benchmarks.paper_study.printed import FREQUENCY, Printed
from benchmarks.paper_study.recordings import RIGS, Rig
from benchmarks.paper_study.roads import LEVELS
from benchmarks.paper_study.sensitivity import HIGHEST, KINDS, PLACES, TITLES, Sensitivities
from vehgen.measure import SPECTRA
from vehgen.report.figure_files import save_figure
from vehgen.report.plots.comparison import MEASURED
from vehgen.report.plots.response_plot import COLOURS, STYLES

INK, GRID = "#1b2733", "#e3e7ea"
MODELS = (*COLOURS, "#c2185b")
"""A colour for each model."""
MODES = {
    "truck": {"body1": "body 1", "body2": "body 2", "body3": "body 3", **{f"hop{i}": f"hop {i}" for i in range(1, 6)}},
    "sedan": {"body1": "body 1", "body2": "body 2", "hop1": "hop front", "hop2": "hop rear"},
}
LIMITS = {"truck": (1.0, 25.0), "sedan": (0.3, 25.0)}
"""Frequencies drawn [Hz]."""


def _grid(rows: int, columns: int, width: float = 3.6, height: float = 2.6) -> tuple[Figure, list[Axes]]:
    figure = Figure(figsize=(width * columns, height * rows + 0.4), layout="constrained")
    panels = list(figure.subplots(rows, columns, squeeze=False).ravel())
    for axes in panels:
        axes.grid(color=GRID, lw=0.6)
        axes.set_axisbelow(True)
        axes.spines[["top", "right"]].set_visible(False)
    return figure, panels


def _legend(figure: Figure, axes: Axes, columns: int = 6) -> None:
    handles, labels = axes.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=min(columns, len(labels)), frameon=False, fontsize=9)


def _title(axes: Axes, text: str) -> None:
    axes.set_title(text, fontsize=9.5, loc="left", color=INK, parse_math=False)


def plot_frequencies(judged: dict[str, Sequence[Judgement]]) -> Figure:
    """Plot natural frequencies of all models beside the truth, a panel for bodies and one for hops of each vehicle (Fig. 14)."""
    figure, panels = _grid(2, 2, 5.0, 2.7)
    for row, (kind, found) in enumerate(judged.items()):
        for column, part in enumerate(("body", "hop")):
            axes = panels[2 * row + column]
            modes = [name for name in MODES[kind] if name.startswith(part)]
            for i, mode in enumerate(modes):
                label = "truth" if i == 0 else "_nolegend_"
                axes.hlines(found[0].frequencies[mode], i - 0.4, i + 0.4, color=INK, lw=1.6, label=label)
            for j, item in enumerate(found[1:]):
                places = np.arange(len(modes)) + 0.66 * (j / max(len(found) - 2, 1) - 0.5)
                heights = [item.frequencies[mode] for mode in modes]
                axes.plot(places, heights, "osD^vPX"[j], color=MODELS[j], ms=5, mfc="none" if j % 2 else None, label=item.name)
            axes.set_xticks(range(len(modes)), [MODES[kind][mode] for mode in modes])
            axes.set_ylabel("undamped frequency [Hz]", color=INK)
            _title(axes, f"{kind}, {'bodies' if part == 'body' else 'axle hop'}")
            if part == "hop":
                axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False, fontsize=8.5)
    return figure


def plot_fits(fits: Sequence[Fit]) -> Figure:
    """Plot PSDs of the hump run that was fitted, a column a method, a row a channel of its sensors (Figs. 11 and 13)."""
    shown = [item for item in fits if item.method.runs == 1]
    rows = max(len(item.psd) for item in shown)
    figure, panels = _grid(rows, len(shown), 2.5, 1.7)
    for column, item in enumerate(shown):
        column_axes = panels[column :: len(shown)]
        _title(column_axes[0], item.method.name)
        for axes in column_axes[len(item.psd) :]:
            axes.set_axis_off()
        for axes, (channel, (frequency, measured, simulated)) in zip(column_axes, item.psd.items(), strict=False):
            inside = (frequency >= 0.3) & (frequency <= 25)
            axes.semilogy(frequency[inside], measured[inside], color=MEASURED, lw=2.2, label="recorded")
            axes.semilogy(frequency[inside], simulated[inside], color=COLOURS[0], lw=1.0, label="calibrated")
            axes.set_ylim(measured.max() * 1e-5, measured.max() * 3)
            axes.set_ylabel(f"{channel.partition('_')[0]} {'acceleration' if channel.endswith('az') else 'pitch rate'}", fontsize=8.5)
            axes.tick_params(labelsize=8)
        column_axes[len(item.psd) - 1].set_xlabel("frequency [Hz]", color=INK, fontsize=8.5)
    _legend(figure, panels[0])
    return figure


def plot_unseen(rig: Rig, judged: Sequence[Judgement]) -> Figure:
    """Plot PSDs on the unseen class B road at the paper's place, a panel a model (Figs. 16 and 17)."""
    channel = f"{next(iter(rig.validation))}_az"
    columns = 3 if len(judged) <= 7 else 4
    figure, panels = _grid(-(-(len(judged) - 1) // columns), columns)
    low, high = LIMITS[rig.kind]
    for axes, item in zip(panels, judged[1:], strict=False):
        found = item.channel(channel)
        inside = (found.frequency >= low) & (found.frequency <= high)
        axes.semilogy(found.frequency[inside], found.measured_psd[inside], color=MEASURED, lw=2.2, label="recorded")
        axes.semilogy(found.frequency[inside], found.simulated_psd[inside], color=COLOURS[0], lw=1.0, label="calibrated")
        axes.set_xlim(low, high)
        axes.set_xlabel("frequency [Hz]", color=INK)
        axes.set_ylabel("PSD [(m/s²)²/Hz]", color=INK)
        _title(axes, item.name)
    for axes in panels[len(judged) - 1 :]:
        axes.set_visible(False)
    _legend(figure, panels[0])
    return figure


def plot_bands(rig: Rig, judged: Sequence[Judgement]) -> Figure:
    """Plot band RMS on the unseen road at the paper's place, and its relative errors (Fig. 18)."""
    channel = f"{next(iter(rig.validation))}_az"
    figure, (top, bottom) = _grid(2, 1, 9.5, 2.5)
    bands = judged[0].validation.bands
    place, width = np.arange(len(bands)), 0.8 / len(judged)
    top.bar(place - 0.4 + width / 2, judged[0].channel(channel).measured_rms, width, color=MEASURED, label="recorded")
    for j, item in enumerate(judged[1:], start=1):
        found, colour = item.channel(channel), MODELS[j - 1]
        style = {"color": colour, "alpha": 0.45, "hatch": "///", "edgecolor": colour} if j % 2 else {"color": colour}
        top.bar(place - 0.4 + (j + 0.5) * width, found.simulated_rms, width, label=item.name, **style)
        bottom.bar(place - 0.4 + (j + 0.5) * width, 100 * found.errors, width, **style)
    top.set_ylabel("rms [m/s²]", color=INK)
    bottom.set_ylabel("relative error [%]", color=INK)
    bottom.axhline(0, color=INK, lw=0.8)
    bottom.set_xlabel("band [Hz]", color=INK)
    for axes in (top, bottom):
        axes.set_xticks(place, [f"{low:g}-{high:g}" for low, high in bands])
        axes.grid(visible=False, axis="x")
    _legend(figure, top, 4)
    return figure


def plot_printed(found: dict[str, Sequence[Printed]]) -> Figure:
    """Plot what the paper's printed tables give on a class B road, and DHCM-1&2 on a class D road beside ASTM D4169 (Fig. 17f)."""
    figure, panels = _grid(1, 3, 4.2, 3.0)
    for axes, (kind, rows) in zip(panels, found.items(), strict=False):
        for j, item in enumerate(rows):
            axes.semilogy(FREQUENCY, item.density, color=COLOURS[j], linestyle=STYLES[j % len(STYLES)], lw=1.2, label=item.name)
        low, high = LIMITS[kind]
        axes.set_xlim(low, high)
        _title(axes, f"{kind}, class B road at {RIGS[kind].cruise:g} m/s")
        axes.legend(frameon=False, fontsize=8.5)
    last = found["truck"][-1]
    axes = panels[2]
    axes.semilogy(FREQUENCY, last.density * LEVELS["D"] / LEVELS["B"], color=COLOURS[2], lw=1.2, label=f"{last.name}, class D")
    for name, style in (("level II", STYLES[1]), ("2016 medium", STYLES[3])):
        axes.semilogy(FREQUENCY, SPECTRA[name].at(FREQUENCY), color=INK, linestyle=style, lw=1.0, label=f"ASTM D4169 truck, {name}")
    axes.set_xlim(*LIMITS["truck"])
    _title(axes, "truck, class D road beside ASTM D4169")
    axes.legend(frameon=False, fontsize=8.5)
    for axes in panels:
        axes.set_ylim(1e-5, None)
        axes.set_xlabel("frequency [Hz]", color=INK)
        axes.set_ylabel("PSD [(m/s²)²/Hz]", color=INK)
    return figure


def plot_sensitivities(found: Sensitivities) -> Figure:
    """Plot sensitivity indices, a row a place, a column a kind of parameter; one scale a column (Fig. 5)."""
    figure, panels = _grid(len(PLACES), len(KINDS), 3.2, 2.2)
    for column, (kind, title) in enumerate(KINDS.items()):
        top = max(found.index[place][f"{kind}{i}"].max() for place in PLACES for i in range(1, 6))
        for row, place in enumerate(PLACES):
            axes = panels[row * len(KINDS) + column]
            for i in range(1, 6):
                curve = found.index[place][f"{kind}{i}"]
                axes.semilogy(
                    found.frequency, curve, color=COLOURS[i - 1], linestyle=STYLES[(i - 1) % len(STYLES)], lw=1.1, label=f"axle {i}"
                )
            axes.set_ylim(top * 1e-6, 3 * top)
            axes.set_xlim(0, HIGHEST)
            _title(axes, f"{title} at {TITLES[place].partition(',')[0]}")
    for axes in panels[-len(KINDS) :]:
        axes.set_xlabel("frequency [Hz]", color=INK)
    for axes in panels[:: len(KINDS)]:
        axes.set_ylabel("index", color=INK)
    _legend(figure, panels[0])
    return figure


def save(figure: Figure, folder: Path, name: str) -> None:
    """Save one figure as PNG."""
    save_figure(figure, folder / f"{name}.png")
