"""A building module's mesh, and the shape of its principal vertical mode."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib import colormaps
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from mpl_toolkits.mplot3d.art3d import Line3DCollection, Poly3DCollection
from numpy.typing import NDArray

from vehgen.cargo.module_model import ModuleModel
from vehgen.report.drawing.canvas import ACCENT, FAINT, INK

Array = NDArray[np.float64]
MODE_SCALE = 0.12
"""The largest displacement drawn, over the shortest side."""
SURFACE = "#cfe0ee"
MODE_COLOURS = colormaps["viridis"]
VIEW = (22.0, -58.0)
"""Elevation and azimuth, degrees."""


def plot_module(model: ModuleModel) -> Figure:
    """Draw mesh, members and held corners above, the deformed principal mode coloured by vertical displacement below."""
    figure = Figure(figsize=(9.2, 9.8))
    mesh, mode = model.mesh, model.modes.principal
    shape = model.modes.shapes[mode][:, :3]
    vertical = shape[:, 2] / shape[np.argmax(np.abs(shape[:, 2])), 2]
    shape = shape * MODE_SCALE * mesh.nodes.max(axis=0).min() / np.abs(shape).max() * np.sign(shape[np.argmax(np.abs(shape[:, 2])), 2])
    above = _axes(figure, (0.0, 0.49, 0.9, 0.44), mesh.nodes, mesh.nodes)
    faces = Poly3DCollection(mesh.nodes[mesh.quads], facecolors=SURFACE, edgecolors=FAINT, linewidths=0.25, alpha=0.4)
    _add(above, faces)
    _add(above, Line3DCollection(mesh.nodes[mesh.beams], colors=ACCENT, linewidths=1.1, zorder=2))
    above.scatter(
        *mesh.nodes[model.corners].T, s=42, marker="^", color=INK, depthshade=False, clip_on=False, zorder=5, label="held in translation"
    )
    above.scatter(*model.body.cog, s=46, marker="o", color="#d55e00", depthshade=False, clip_on=False, zorder=5, label="centre of gravity")
    above.plot([], [], color=ACCENT, lw=1.3, label="frame members")
    above.legend(loc="upper right", frameon=False, fontsize=9, bbox_to_anchor=(1.12, 1.0))
    above.set_title(f"mesh: {len(mesh.nodes)} nodes, elements up to {model.mesh_size:g} m", fontsize=10.5, color=INK)

    moved = mesh.nodes + shape
    below = _axes(figure, (0.0, 0.03, 0.9, 0.44), moved, mesh.nodes)
    scale = Normalize(float(vertical.min()), float(vertical.max()))
    level = _level(mesh.nodes, mesh.quads)
    for chosen, alpha in ((level, 0.95), (~level, 0.3)):
        if chosen.any():
            colours = MODE_COLOURS(scale(vertical[mesh.quads[chosen]].mean(axis=1)), alpha=alpha)
            _add(below, Poly3DCollection(moved[mesh.quads[chosen]], facecolors=colours, edgecolors=(0, 0, 0, 0.18), linewidths=0.2))
    if len(mesh.beams):
        beam_colours = MODE_COLOURS(scale(vertical[mesh.beams].mean(axis=1)))
        _add(below, Line3DCollection(moved[mesh.beams], colors=beam_colours, linewidths=1.6, zorder=3))
    _add(below, Line3DCollection(_outline(mesh.nodes), colors=INK, linewidths=0.8, zorder=4, linestyles=(0, (4, 3))))
    below.set_title(
        f"principal vertical mode: {model.frequency:.2f} Hz, moves {model.effective_share:.0%} of {model.body.mass:,.0f} kg",
        fontsize=10.5,
        color=INK,
    )
    bar = figure.colorbar(ScalarMappable(scale, MODE_COLOURS), cax=figure.add_axes((0.91, 0.1, 0.016, 0.27)))
    bar.set_label("vertical displacement, largest = 1", color=INK, fontsize=9)
    bar.ax.tick_params(labelsize=8)
    figure.suptitle(model.frame.file.title or model.frame.path.stem, x=0.015, ha="left", fontsize=12, color=INK, parse_math=False)
    return figure


def _add(axes: Any, collection: Any) -> None:
    """Add a collection that may reach beyond the square which matplotlib keeps for three-dimensional axes."""
    collection.set_clip_on(False)
    axes.add_collection3d(collection)


def _axes(figure: Figure, place: tuple[float, float, float, float], points: Array, box: Array) -> Any:
    """Return axes in metres at one scale along x, y and z that hold points and box."""
    axes: Any = figure.add_axes(place, projection="3d", computed_zorder=False)
    both = np.vstack([points, box])
    low, high = both.min(axis=0), both.max(axis=0)
    axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), zlim=(low[2], high[2]))
    axes.patch.set_visible(False)
    axes.set_box_aspect(high - low, zoom=1.38)
    axes.view_init(*VIEW)
    axes.set_xlabel("behind the front [m]", fontsize=9, color=INK, labelpad=18)
    axes.set_ylabel("from the left [m]", fontsize=9, color=INK, labelpad=2)
    axes.set_zlabel("height [m]", fontsize=9, color=INK, labelpad=-2)
    axes.locator_params(axis="y", nbins=4)
    axes.locator_params(axis="z", nbins=4)
    axes.tick_params(labelsize=8)
    for axis in (axes.xaxis, axes.yaxis, axes.zaxis):
        axis.pane.set_visible(False)
    axes.grid(False)
    return axes


def _level(nodes: Array, quads: NDArray[np.int64]) -> NDArray[np.bool_]:
    """Tell which quadrilaterals lie in the floor or the roof, `shape (n_quads,)`; the walls are drawn see-through."""
    found: NDArray[np.bool_] = np.ptp(nodes[quads][:, :, 2], axis=1) == 0
    return found


def _outline(nodes: Array) -> Array:
    """Return the twelve edges of the undeformed box, `shape (12, 2, 3)`."""
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)])
    pairs = [(a, b) for i, a in enumerate(corners) for b in corners[i + 1 :] if np.abs(a - b).sum() == 1]
    edges: Array = nodes.min(axis=0) + np.array(pairs) * np.ptp(nodes, axis=0)
    return edges
