"""What a run may cost, computed before the work: steps, numbers in memory, and the reach of its roads."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from vehgen.errors import InputError
from vehgen.road.track import GRID
from vehgen.simulate.run_file import Run
from vehgen.simulate.run_file.checks import MAX_STEPS

MAX_RESPONSE_NUMBERS = 8_000_000
"""So many numbers may describe what excites one vehicle and what it answers: 64 MB, and four times that while they are made."""
MOST_RESPONSES = 250_000_000
"""So many numbers may a population's answers hold: 2 GB."""
MOST_LOOKUPS = 100_000_000
"""So often may the height of one entry of the road be looked up, by wheels and where a footprint averages: about a second of work."""
MOST_AVERAGED = 7_000.0
"""Over no longer way [m] is a road averaged over a footprint."""


@contextmanager
def placed(run: Run, *path: str | int, key: bool = False) -> Iterator[None]:
    """Give an InputError without a place that of a value (or key) of the run file, and tell it with one of another file."""
    try:
        yield
    except InputError as error:
        place, other = run.document.find(path, key=key), error.position
        if other is None:
            raise InputError(error.message, place) from error
        if other.file == place.file:
            raise
        raise InputError(f"{error.message} (asked for by {place})", other) from error


def check_run(run: Run, duration: float, way: float, n_wheels: int) -> None:
    """Refuse a run that keeps no sample, and one whose steps, numbers or ways are beyond what is worth computing.

    Parameters
    ----------
    run
        The run.
    duration
        How long it is [s], whether its file says so or the road does.
    way
        How far the vehicle comes [m].
    n_wheels
        How many axles and moving links are excited.

    Raises
    ------
    InputError
        At the quantity of the run file that decides, with the number found and the limit.
    """
    file = run.file
    steps = duration / file.step
    said = ("duration",) if file.duration is not None else ("speed",)
    if steps < run.decimation:
        raise InputError(
            f"a run of {duration:g} s keeps no sample: they are {run.decimation * file.step:g} s apart", run.document.find(said)
        )
    numbers = excitation_numbers(steps, n_wheels, len(file.forces))
    numbers += steps / run.decimation * (len(run.outputs()) + len(run.vehicle.axles))
    reason = None
    if steps > MAX_STEPS:
        reason = f"a run has at most {MAX_STEPS} steps; {duration:g} s in steps of {file.step:g} s are more"
    elif numbers > MAX_RESPONSE_NUMBERS:
        reason = (
            f"{steps:.0f} steps of this vehicle are {numbers:.3g} numbers in memory; at most {MAX_RESPONSE_NUMBERS:.3g} were expected: "
            "a shorter run, or a longer `step` and `sample`"
        )
    elif (steps * n_wheels + (way / GRID if file.footprint is not None else 0.0)) * len(file.road) > MOST_LOOKUPS:
        reason = f"{steps:.0f} steps over {way:.3g} m of a road of {len(file.road)} entries; a shorter run or fewer entries were expected"
    if reason is not None:
        where = "" if file.duration is not None else " (until the last wheel has left the last hump; `duration` may end the run before)"
        raise InputError(f"{reason}{where}", run.document.find(said))
    if file.footprint is not None and way > MOST_AVERAGED:
        raise InputError(
            f"a road is averaged over a footprint for at most {MOST_AVERAGED:g} m; this run covers {way:.3g} m",
            run.document.find(("footprint",)),
        )


def excitation_numbers(steps: float, n_wheels: int, n_forces: int) -> float:
    """Return how many numbers excite a vehicle in so many steps: the road's height and rise at each wheel, forces, and times."""
    return steps * (2 * n_wheels + n_forces + 1)


def check_population(n_individuals: int, n_samples: float, n_channels: int) -> None:
    """Refuse a population whose answers would fill the memory.

    Raises
    ------
    InputError
        With the number found and the limit.
    """
    if (numbers := n_individuals * n_samples * n_channels) > MOST_RESPONSES:
        raise InputError(
            f"{n_individuals} individuals with {n_samples:.0f} samples of {n_channels} channels are {numbers:.3g} numbers; "
            f"at most {MOST_RESPONSES:.3g} fit: take fewer individuals, a shorter run or fewer samples"
        )
