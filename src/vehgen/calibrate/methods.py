"""Methods of calibration: which sensors are compared and which parameters searched, step by step.

- `shcm`: one sensor, all parameters (Wu & Li 2023, Sect. 2.1).
- `dhcm`: two sensors, two steps (Sect. 2.4): all parameters from the first sensor, of which those of its axle and its body's pitch inertia
  are kept and frozen; then the rest from the second sensor.
- `joint`: all sensors of all runs at once. Far better conditioned than two steps, which freeze the first one's errors into the second.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from vehgen.errors import ArgumentError, did_you_mean, shown
from vehgen.files.expressions import Expression
from vehgen.fit.problem import Problem
from vehgen.vehicle import Vehicle

METHODS = ("shcm", "dhcm", "joint")


@dataclass(frozen=True)
class Step:
    """One search: the sensors compared, the parameters searched, and those that stay frozen afterwards."""

    label: str
    sensors: tuple[str, ...]
    searched: tuple[str, ...]
    kept: tuple[str, ...]


def plan(problem: Problem, method: str, sensors: Sequence[str] = (), frozen: Sequence[str] = ()) -> tuple[Step, ...]:
    """Return the steps of a method.

    Parameters
    ----------
    problem
        All trials and parameters.
    method
        One of METHODS.
    sensors
        The sensors to use, in order (default: those of the runs, in the first run's order).
    frozen
        For dhcm: the parameters kept from the first step (default: :func:`near_parameters` of the first sensor).

    Raises
    ------
    InputError
        For an unknown method or sensor, or a number of sensors that the method cannot use.
    """
    if method not in METHODS:
        raise ArgumentError(f"`method`: no method {shown(method)}; {did_you_mean(method, METHODS)}", "method")
    known = [name for name in problem.trials[0].run.file.sensors if all(name in trial.run.file.sensors for trial in problem.trials)]
    every = list(dict.fromkeys(name for trial in problem.trials for name in trial.run.file.sensors))
    for name in sensors:
        if name not in every:
            raise ArgumentError(f"`sensors`: no run has a sensor {shown(name)}; {did_you_mean(name, every)}", "sensors")
    chosen = tuple(sensors) or tuple(every if method == "joint" else known)
    names = problem.space.names
    if method == "joint":
        return (Step("all sensors", chosen, names, names),)
    if method == "shcm":
        if len(chosen) != 1:
            raise ArgumentError(f"shcm uses one sensor; choose it with `sensors`, one of {', '.join(every)}", "sensors")
        return (Step(f"sensor {chosen[0]}", chosen, names, names),)
    if len(chosen) != 2:
        raise ArgumentError(
            f"dhcm uses two sensors, found {', '.join(chosen) or 'none'}; choose first and second with `sensors`", "sensors"
        )
    for name in frozen:
        if name not in names:
            message = f"`freeze`: {shown(name)} is not searched and cannot be kept from the first step; {did_you_mean(name, names)}"
            raise ArgumentError(message, "freeze")
    kept = tuple(frozen) or near_parameters(problem, chosen[0])
    rest = tuple(name for name in names if name not in kept)
    if not kept or not rest:
        raise ArgumentError("dhcm needs parameters of its own for both steps: name those to keep from the first with `freeze`", "freeze")
    return (Step(f"sensor {chosen[0]}", (chosen[0],), names, kept), Step(f"sensor {chosen[1]}", (chosen[1],), rest, rest))


def near_parameters(problem: Problem, sensor: str) -> tuple[str, ...]:
    """Return the searched parameters of the axle nearest to a sensor on its body, and of that body's pitch inertia."""
    trial = problem.trials[0]
    vehicle, place = trial.run.vehicle, trial.run.file.sensors[sensor].place(sensor)
    if not place.body:
        return ()
    model = trial.simulator.model
    axles = [name for name, axle in vehicle.axles.items() if axle.body == place.body]
    if not axles:
        return ()
    own = place.locate(vehicle, model.layout) + model.layout.bodies[place.body][0]
    x, *theirs = model.evaluate_list([own, *(model.layout.axles[name] for name in axles)], trial.values)
    nearest = axles[min(range(len(axles)), key=lambda i: abs(theirs[i] - x))]
    axle = vehicle.axles[nearest]
    expressions = [axle.mass, vehicle.bodies[place.body].pitch_inertia, axle.tyre.k, axle.tyre.c]
    if axle.suspension is not None:
        expressions += [axle.suspension.k, axle.suspension.c]
    used = _free_names(vehicle, [item for item in expressions if item is not None])
    return tuple(name for name in problem.space.names if name in used)


def _free_names(vehicle: Vehicle, expressions: Sequence[Expression]) -> set[str]:
    found: set[str] = set()
    waiting = [name for expression in expressions for name in expression.names]
    while waiting:
        name = waiting.pop()
        equals = vehicle.parameters[name].equals
        if equals is None:
            found.add(name)
        else:
            waiting.extend(equals.names)
    return found
