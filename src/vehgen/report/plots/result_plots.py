"""Small pictures of results that have no page of their own: modes, static loads, responses, poles, advice on sensors."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from vehgen.calibrate.sensor_placement import SensorAdvice
from vehgen.mechanics import StaticLoads
from vehgen.report.drawing.canvas import INK
from vehgen.report.plots.comparison import SIMULATED
from vehgen.report.plots.response_plot import plot_response
from vehgen.simulate import Response
from vehgen.simulate.frequency_response import FrequencyResponse
from vehgen.simulate.modes import Modes
from vehgen.simulate.state_space import StateSpace


def plot_simulation(response: Response) -> Figure:
    """Plot the first individual's response over time, a panel a quantity."""
    return plot_response(response.time, [(item.name, item.quantity, item.unit) for item in response.channels], response.values[0])


def plot_modes(modes: Modes) -> Figure:
    """Plot every mode's damping ratio over its undamped frequency."""
    figure, axes = _panel(6.4, 3.6)
    axes.plot([mode.undamped_hz for mode in modes], [mode.damping_ratio for mode in modes], "o", color=SIMULATED, ms=5)
    for mode in modes:
        place = (mode.undamped_hz, mode.damping_ratio)
        axes.annotate(mode.name, place, xytext=(5, 4), textcoords="offset points", fontsize=8, color=INK, parse_math=False)
    axes.set_xlabel("undamped natural frequency [Hz]", color=INK)
    axes.set_ylabel("damping ratio", color=INK)
    axes.set_ylim(bottom=0.0)
    return figure


def plot_static_loads(loads: StaticLoads) -> Figure:
    """Plot the axles' loads, then the hinges' forces."""
    forces = {**loads.axles, **{f"hinge {name}": force for name, force in loads.hinges.items()}}
    figure, axes = _panel(6.4, 1.2 + 0.3 * len(forces))
    axes.barh(range(len(forces)), [force / 1e3 for force in forces.values()], color=SIMULATED)
    axes.set_yticks(range(len(forces)), list(forces), fontsize=8.5, parse_math=False)
    axes.invert_yaxis()
    axes.set_xlabel("static force [kN]", color=INK)
    return figure


def plot_sensor_advice(advice: SensorAdvice) -> Figure:
    """Plot the mean standard deviation of ln(parameter) that the best set of each size leaves."""
    figure, axes = _panel(6.4, 3.2)
    counts = [len(layout.places) for layout in advice.best]
    axes.plot(counts, [100 * layout.score**0.5 for layout in advice.best], "o-", color=SIMULATED)
    axes.set_xticks(counts)
    axes.set_ylim(bottom=0.0)
    axes.set_xlabel("sensors", color=INK)
    axes.set_ylabel("mean error of a parameter [%]", color=INK)
    return figure


def plot_poles(system: StateSpace) -> Figure:
    """Plot the poles in the complex plane."""
    figure, axes = _panel(5.2, 4.4)
    poles = system.poles
    axes.plot(poles.real, poles.imag, "x", color=SIMULATED, ms=6)
    axes.axvline(0.0, color="#c3ccd3", lw=0.8, zorder=0)
    axes.set_xlabel("real part [1/s]", color=INK)
    axes.set_ylabel("imaginary part [rad/s]", color=INK)
    return figure


def plot_frequency_response(response: FrequencyResponse) -> Figure:
    """Plot every output's amplitude per unit of each input, a panel an output."""
    count = len(response.outputs)
    figure = Figure(figsize=(8.0, 0.8 + 1.9 * count), layout="constrained")
    amplitude = np.abs(response.values)
    for i, axes in enumerate(figure.subplots(count, 1, sharex=True, squeeze=False)[:, 0]):
        for j, name in enumerate(response.inputs):
            axes.plot(response.frequency, amplitude[:, i, j], lw=1.1, label=f" {name}")
        axes.set_ylabel(f"{response.outputs[i]}\n[{response.units[i]} per unit]", color=INK, parse_math=False, fontsize=8.5)
        axes.grid(color="#e3e7ea", lw=0.6)
        axes.spines[["top", "right"]].set_visible(False)
        axes.margins(x=0)
    for text in axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False, fontsize=8.5).get_texts():
        text.set_parse_math(False)
    axes.set_xlabel("frequency [Hz]", color=INK)
    return figure


def _panel(width: float, height: float) -> tuple[Figure, Axes]:
    figure = Figure(figsize=(width, height), layout="constrained")
    axes = figure.subplots()
    axes.grid(color="#e3e7ea", lw=0.6)
    axes.set_axisbelow(True)
    axes.spines[["top", "right"]].set_visible(False)
    return figure, axes
