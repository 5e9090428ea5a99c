"""A response over time, one panel for each kind of quantity."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from vehgen.report.drawing import INK

COLOURS = ("#0b5fa5", "#d55e00", "#1b9e77", "#7b3294", "#555555", "#b8860b")
STYLES = ("-", "--", "-.", ":", "-", "--")


def plot_response(
    time: NDArray[np.float64], channels: Sequence[tuple[str, str, str]], values: NDArray[np.float64], title: str = ""
) -> Figure:
    """Plot channels (name, quantity, unit) with `values shape (n_samples, n_channels)` over `time shape (n_samples,)` [s]."""
    kinds = list(dict.fromkeys((quantity, unit) for _, quantity, unit in channels))
    figure = Figure(figsize=(9.0, 1.0 + 2.1 * len(kinds)), layout="constrained")
    panels = figure.subplots(len(kinds), 1, sharex=True, squeeze=False)[:, 0]
    for axes, (quantity, unit) in zip(panels, kinds, strict=True):
        members = [i for i, channel in enumerate(channels) if channel[1:] == (quantity, unit)]
        for count, i in enumerate(members):
            axes.plot(time, values[:, i], color=COLOURS[count % 6], linestyle=STYLES[count % 6], lw=1.2, label=channels[i][0])
        axes.set_ylabel(f"{quantity.replace('_', ' ')}\n[{unit}]")
        axes.grid(color="#e3e7ea", lw=0.6)
        axes.spines[["top", "right"]].set_visible(False)
        axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False, fontsize=8.5)
        axes.margins(x=0)
    panels[-1].set_xlabel("time [s]")
    if title:
        figure.suptitle(title, x=0.01, ha="left", fontsize=11, color=INK)
    return figure
