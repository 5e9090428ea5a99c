"""What must hold for a run and its vehicle together; each failure names its place and what would be right."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from vehgen.errors import InputError, did_you_mean, shown
from vehgen.files.checks import check_dimension, check_known, plain_quantity, unit_factor, value_of
from vehgen.files.limits import MOST_CHANNELS, VEHICLE_LENGTH
from vehgen.files.units import LENGTH
from vehgen.simulate.run_file.acquisition import check_acquisition
from vehgen.simulate.run_file.entries import DisplacementEntry, ForceEntry
from vehgen.simulate.run_file.sensors import OfElement, OutputEntry, PlaceEntry
from vehgen.vehicle.checks import check_values
from vehgen.vehicle.parts import GROUND

if TYPE_CHECKING:
    from vehgen.simulate.run_file.loading import Run

MAX_STEPS = 10_000_000
FEWEST_STEPS_OF_A_CYCLE = 2
"""A harmonic of fewer steps a cycle is another one."""
TIME_COLUMN = "t"
"""The heading of the time in recordings and responses."""


def check_run(run: Run) -> None:
    """Check a run's settings, parameters, places, channels and steps against its vehicle; raises InputError at the first fault."""
    _check_settings(run)
    _check_parameters(run)
    _check_vehicle(run)
    for name, entry in run.file.forces.items():
        _check_place(run, entry, "forces", name)
        _check_unit(run, entry, "force", "N", "forces", name)
        _check_harmonic(run, entry, "forces", name)
    _check_displacements(run)
    _check_sensors(run)
    check_acquisition(run)
    for name, output in run.file.outputs.items():
        _check_output(run, name, output)
    _check_channel_names(run)
    _check_steps(run)


def _check_settings(run: Run) -> None:
    """Check the speed, the band, the parameter set, and that no two random roads are one."""
    file, vehicle, document = run.file, run.vehicle, run.document
    if vehicle.axles and "speed" not in file.model_fields_set:
        raise InputError(f"the file lacks the key 'speed': {vehicle.name} has wheels", document.position)
    if file.band is not None and not file.band[0] < file.band[1]:
        raise InputError("`band` is [lowest, highest] frequency compared; the first must be the lower one", document.find(("band",)))
    if file.set is not None:
        check_known(file.set, vehicle.sets, f"{vehicle.name} has no parameter set", document, "set")
    seeds: set[int] = set()
    for number, entry in enumerate(file.road):
        if entry.iso8608 is not None and entry.iso8608.seed in seeds:
            said = "two random roads of one seed go up and down together, as one that is higher; another `seed` was expected"
            raise InputError(said, document.find(("road", number)))
        seeds |= {entry.iso8608.seed} if entry.iso8608 is not None else set()


def _check_parameters(run: Run) -> None:
    """Check that the run's own parameters are free ones of the vehicle, in their units."""
    vehicle, document = run.vehicle, run.document
    dimensions = vehicle.dimensions
    for name, expression in run.file.parameters.items():
        path = ("parameters", name)
        check_known(name, vehicle.free_parameters, f"{vehicle.name} has no parameter with a value", document, *path, key=True)
        plain_quantity(expression, dimensions[name], document, *path)


def _check_vehicle(run: Run) -> None:
    """Check that the vehicle is physical with the run's parameters."""
    file, document = run.file, run.document
    try:
        check_values(run.vehicle, run.values(), " in this run")
        if file.parameters:
            from vehgen.mechanics.law_terms import check_laws

            check_laws(run.vehicle, run.values(), " in this run")
    except InputError as error:
        place = document.find(("parameters" if file.parameters else "set" if file.set else "vehicle",), key=True)
        raise InputError(f"{error.message} ({error.position})" if error.position else error.message, place) from error


def _check_place(run: Run, entry: PlaceEntry, *path: str) -> None:
    """Check that a place is on a body of the vehicle, behind a part of it, or at a length."""
    vehicle, document = run.vehicle, run.document
    check_known(entry.body, vehicle.bodies, f"{vehicle.name} has no body", document, *path, "body")
    if entry.behind is not None:
        parts = (*vehicle.axles, *vehicle.hinges, *vehicle.bodies)
        check_known(entry.behind, parts, f"{vehicle.name} has no axle, hinge or body", document, *path, "behind")
    if entry.x is not None:
        check_dimension(entry.x, LENGTH, vehicle.dimensions, document, *path, "x")
        number = value_of(entry.x, vehicle.all_values(run.values()), document, *path, "x")
        if (reason := VEHICLE_LENGTH.refusal(number)) is not None:
            raise InputError(reason, document.find((*path, "x")))


def _check_displacements(run: Run) -> None:
    """Check that displacements move links to the ground."""
    vehicle = run.vehicle
    grounded = [name for name, link in vehicle.links.items() if GROUND in link.points]
    for name in run.file.displacements:
        check_known(name, grounded, f"{vehicle.name} has no link to the ground", run.document, "displacements", name, key=True)
        _check_unit(run, run.file.displacements[name], "displacement", "m", "displacements", name)
        _check_harmonic(run, run.file.displacements[name], "displacements", name)


def _check_unit(run: Run, entry: ForceEntry | DisplacementEntry, quantity: str, usual: str, *path: str) -> None:
    """Check the unit of a measured column; beside a recording, where a wrong one would be fitted, it must be stated."""
    document = run.document
    if entry.unit is not None:
        if entry.file is None:
            raise InputError("a harmonic is written with its unit; `unit` belongs to a `file`", document.find((*path, "unit"), key=True))
        unit_factor(entry.unit, usual, quantity, document.find((*path, "unit")))
    elif entry.file is not None and run.file.recording is not None:
        column = entry.force if isinstance(entry, ForceEntry) else entry.displacement
        raise InputError(
            f"the {quantity} in the column {shown(column)} has no unit; write the one it was recorded in, e.g. `unit: {usual}`",
            document.find((*path, "file"), key=True),
        )


def _check_harmonic(run: Run, entry: ForceEntry | DisplacementEntry, *path: str) -> None:
    """Check that the step can tell a harmonic from a slower one."""
    if entry.harmonic is not None and (steps := 1 / (entry.harmonic.frequency * run.file.step)) < FEWEST_STEPS_OF_A_CYCLE:
        raise InputError(
            f"a cycle takes {steps:.3g} steps of {run.file.step:g} s; at least {FEWEST_STEPS_OF_A_CYCLE} were expected: a lower frequency "
            "(is it in Hz?) or a shorter `step`",
            run.document.find((*path, "harmonic", "frequency")),
        )


def _check_sensors(run: Run) -> None:
    """Check that sensors sit on parts of the vehicle and record what there is to be recorded there."""
    for name, sensor in run.file.sensors.items():
        if sensor.element is not None:
            _check_element(run, sensor, "sensors", name)
        else:
            _check_place(run, sensor, "sensors", name)
        for quantity in sensor.channels:
            if quantity not in sensor.quantities:
                raise InputError(
                    f"unknown quantity {shown(quantity)} of a sensor; {did_you_mean(quantity, sensor.quantities)}",
                    run.document.find(("sensors", name, "channels", quantity), key=True),
                )
            if sensor.element is not None:
                _check_axle_has(run, sensor, quantity, "sensors", name, "channels", quantity)
            place = run.document.find(("sensors", name, "channels", quantity, "unit"))
            unit_factor(sensor.unit(quantity), sensor.quantities[quantity], quantity, place)
            sensor.noise(quantity, run.document.find(("sensors", name, "channels", quantity, "noise")))


def _check_element(run: Run, entry: OfElement, *path: str) -> None:
    """Check that the vehicle has the axle, link or hinge that a sensor or output belongs to."""
    vehicle = run.vehicle
    assert entry.element is not None
    group, name = entry.element
    parts: dict[str, Mapping[str, object]] = {"axles": vehicle.axles, "links": vehicle.links, "hinges": vehicle.hinges}
    kind = group.removesuffix("s")
    check_known(name, parts[group], f"{vehicle.name} has no {kind}", run.document, *path, kind)


def _check_output(run: Run, name: str, output: OutputEntry) -> None:
    """Check that an output is a quantity of an axle, link or hinge of the vehicle."""
    _check_element(run, output, "outputs", name)
    if output.quantity not in output.quantities:
        owner = {"axles": "an axle", "links": "a link", "hinges": "a hinge"}[output.element[0] if output.element else "axles"]
        raise InputError(
            f"unknown quantity {shown(output.quantity)} of {owner}; {did_you_mean(output.quantity, output.quantities)}",
            run.document.find(("outputs", name, "quantity")),
        )
    _check_axle_has(run, output, output.quantity, "outputs", name, "quantity")


def _check_axle_has(run: Run, entry: OfElement, quantity: str, *path: str) -> None:
    """Check that an axle whose quantity is asked for has the suspension that it is of."""
    assert entry.element is not None
    group, name = entry.element
    if group != "axles":
        return
    axle, at = run.vehicle.axles[name], run.document.find(path)
    if quantity.startswith("suspension_") and axle.suspension is None:
        raise InputError(f"{name} has no suspension of its own: it is fixed to {shown(axle.body)}", at)


def _check_channel_names(run: Run) -> None:
    """Check that no two channels share a name, nor one with the time; each where it is named."""
    document, sensors = run.document, run.file.sensors.items()
    if (count := len(run.outputs())) > MOST_CHANNELS:
        raise InputError(f"{count} channels; a run has at most {MOST_CHANNELS}", document.find(("sensors",), key=True))
    named = [(item.channel(name, key), ("sensors", name, "channels", key, "column")) for name, item in sensors for key in item.channels]
    known: set[str] = set()
    for name, path in (*named, *((name, ("outputs", name)) for name in run.file.outputs)):
        where = document.find(path, key=True)
        if name == TIME_COLUMN:
            raise InputError(f"a channel cannot be named {name!r}, as the column of the time is; choose another name", where)
        if name in known:
            raise InputError(f"two channels are named {shown(name)}; each column needs a name of its own", where)
        known.add(name)


def _check_steps(run: Run) -> None:
    """Check the number of steps and that samples are whole numbers of them."""
    file, document = run.file, run.document
    if file.duration is not None and file.duration > MAX_STEPS * file.step:
        raise InputError(
            f"a run has at most {MAX_STEPS} steps; {file.duration:g} s in steps of {file.step:g} s are more",
            document.find(("duration",)),
        )
    if file.sample is not None and (run.decimation < 1 or abs(run.decimation * file.step - file.sample) > 1e-9 * file.sample):
        raise InputError(
            f"`sample` must be a whole number of steps of {file.step:g} s, found {file.sample:g} s",
            document.find(("sample",)),
        )
