"""An assessment for the eye: PSDs beside truck levels, shock response spectra, tyre loads, and cycles."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Literal

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter

from vehgen.assess import Assessment
from vehgen.files.units import STANDARD_GRAVITY
from vehgen.measure import SPECTRA
from vehgen.report.drawing.canvas import INK
from vehgen.report.plots.response_plot import curve_style

MOST_CURVES_DRAWN = 12
"""More curves make no panel that one reads; the others stand in the JSON file."""
LEVELS_DRAWN = ("level I", "level II", "level III")
DECADES_DRAWN = 6
BAR_FILLS = ("#0b5fa5", "#c3ccd3", "white")
"""Light and dark enough to differ in grey."""


def plot_assessment(found: Assessment) -> Figure:
    """Draw what there is of the four panels on one sheet."""
    panels = [
        (bool(found.transport), _plot_transport),
        (bool(found.shock), _plot_shock),
        (bool(found.tyres), _plot_tyres),
        (any(item.largest > 0 for item in found.cycles), _plot_cycles),
    ]
    drawn = [draw for is_there, draw in panels if is_there]
    figure = Figure(figsize=(12.0, 0.7 + 3.9 * max(1, -(-len(drawn) // 2))), layout="constrained")
    for i, draw in enumerate(drawn):
        axes = figure.add_subplot(-(-len(drawn) // 2), min(2, len(drawn)), i + 1)
        axes.grid(color="#e3e7ea", lw=0.6)
        axes.set_axisbelow(True)
        axes.spines[["top", "right"]].set_visible(False)
        draw(axes, found)
    figure.suptitle(f"{found.title}: {found.source}", x=0.01, ha="left", fontsize=11, color=INK, parse_math=False)
    return figure


def _plot_transport(axes: Axes, found: Assessment) -> None:
    for dashes, name in zip(((0, (1, 1)), (0, (4, 2)), "-"), LEVELS_DRAWN, strict=True):
        spectrum = SPECTRA[name]
        axes.loglog(spectrum.frequency, spectrum.density, color="#9aa5af", lw=1.0, linestyle=dashes, label=f"ASTM D4169 truck {name}")
    for style, item in _styled(found.transport):
        axes.loglog(item.frequency, np.where(item.density > 0, item.density, np.nan), label=f" {item.name}: {item.rms:.3g} g rms", **style)
    top = max(float(item.density.max()) for item in found.transport)
    top = max(top, max(float(SPECTRA[name].density.max()) for name in LEVELS_DRAWN))
    axes.set_ylim(top * 10.0**-DECADES_DRAWN, 100 * top)  # with room for the legend
    axes.set_xlim(found.transport[0].band)
    _label(axes, "frequency [Hz]", "PSD of acceleration [g^2/Hz]", place="upper right")


def _plot_shock(axes: Axes, found: Assessment) -> None:
    for style, item in _styled(found.shock):
        text = f" {item.name}: {item.largest / STANDARD_GRAVITY:.3g} g at {item.largest_hz:.3g} Hz"
        axes.loglog(item.frequency, np.where(item.maximax > 0, item.maximax, np.nan) / STANDARD_GRAVITY, label=text, **style)
    for write in (axes.xaxis.set_major_formatter, axes.yaxis.set_major_formatter, axes.yaxis.set_minor_formatter):
        write(FuncFormatter(lambda value, _: f"{value:g}"))
    _label(axes, "natural frequency [Hz]", f"largest response, Q = {found.shock[0].quality:g} [g]")


def _plot_tyres(axes: Axes, found: Assessment) -> None:
    shown = found.tyres[: 3 * MOST_CURVES_DRAWN]
    place = np.arange(len(shown))
    series = (
        ("95th percentile of load / static", [item.high for item in shown]),
        ("least load / static", [item.least for item in shown]),
        ("dynamic load coefficient", [item.coefficient for item in shown]),
    )
    for i, ((label, values), fill) in enumerate(zip(series, BAR_FILLS, strict=True)):
        axes.bar(place + 0.26 * (i - 1), values, 0.24, color=fill, edgecolor=INK, lw=0.7, label=label)
    axes.axhline(1.0, color=INK, lw=0.8, ls=(0, (4, 2)))
    axes.axhline(0.0, color=INK, lw=0.8)
    names = [f"{item.axle}\ndamage {item.fourth_power:.2f}" if len(shown) <= MOST_CURVES_DRAWN else item.axle for item in shown]
    axes.set_xticks(place, names, fontsize=8.5, parse_math=False, rotation=0 if len(shown) <= MOST_CURVES_DRAWN else 90)
    axes.margins(y=0.25)
    _label(axes, "axle; mean fourth power of load / static", "over static load [-]", place="upper right")


def _plot_cycles(axes: Axes, found: Assessment) -> None:
    moving = [item for item in found.cycles if item.largest > 0]
    quantity = next(
        (name for name in ("suspension_travel", "link_travel") if any(item.quantity == name for item in moving)), moving[0].quantity
    )
    chosen = [item for item in moving if item.quantity == quantity]
    factor, unit = (1e3, "mm") if chosen[0].unit == "m" else (1e-3, "kN")
    for style, item in _styled(chosen):
        text = f" {item.name}: {factor * item.equivalent:.3g} {unit} at 1 Hz, m = {item.slope:g}"
        axes.semilogx(item.cumulative, factor * item.levels, label=text, **style)
    _label(axes, "cycles of at least this range", f"{quantity.replace('_', ' ')}, range [{unit}]")


def _styled(items: Sequence[Any]) -> list[tuple[dict[str, Any], Any]]:
    """Return curves with the styles by which they differ, in colour and in grey."""
    return [(curve_style(i), item) for i, item in enumerate(items[:MOST_CURVES_DRAWN])]


def _label(axes: Axes, across: str, up: str, place: Literal["best", "upper right"] = "best") -> None:
    axes.set_xlabel(across, color=INK)
    axes.set_ylabel(up, color=INK, parse_math=False)
    for text in axes.legend(loc=place, fontsize=7.5, framealpha=0.85, edgecolor="none").get_texts():
        text.set_parse_math(False)
