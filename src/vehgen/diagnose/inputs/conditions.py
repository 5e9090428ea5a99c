"""What a fit had to suppose of the runs: a speed, a height or a clock far beyond its prior is a finding, however well the fit is."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import combinations

import numpy as np

from vehgen.diagnose.inputs.fault import MeasurementFault, place_words
from vehgen.fit.nuisances import Condition

BEYOND = 3.9
"""A condition of so many standard deviations of its prior, at the end of its range, is a finding."""
TOGETHER = 6.0
"""Speeds, or one sensor's clocks, whose sum over the runs is so many of its standard deviations off are a finding, each small as it is."""
AGREE = 0.15
"""Conditions of two runs that undo one another within this share of themselves are an exchange; of all runs, one cause."""
LEAST_OTHERS = 2
"""A run's start is compared with those of so many others at least."""
STANDS_OUT, CLOCKS_SPREAD_S, LEAST_SHIFT_M = 6.0, 0.01, 0.3
"""A start off by so many times the others' spread, which is no less than this [s], and a road off by so much [m], are findings."""
OF_ALL_RUNS, LEAST_ALIKE, ALIKE_SIGMAS, ALIKE_SPREAD = ("clock", "speed", "height", "length"), 3, 1.0, 0.5
"""Conditions that all runs, so many at least, suppose alike are told: so many standard deviations off at least in each run,
within so many from the least to the largest."""
FAR_TOGETHER = 4.0
"""Conditions of all runs, all off the same way, whose sum is so many of its standard deviations off are so by no chance."""
EITHER_WAY = 2.0
"""Whether a clock tells the starts or the way does, a start that is a finding is off by so many times the others' spread."""
FAR_APART, TIMED_SPREAD_S = 5.0, 0.005
"""Unless by the way the others are spread so many times as far as by the clock: then a clock has told them, and they stray by less [s]."""
_FAULT_OF = {
    "delay": ("clock", "the recording {where} starts {amount} {early} than the file says, or the road lies elsewhere along the way"),
    "speed": ("speed", "the speed {where} was {amount} {more} than stated"),
    "height": ("hump_height", "the road {where} is {amount} {more} than stated, or all channels read as much {more}"),
    "length": ("hump_length", "the hump {where} is {amount} {longer} than stated"),
    "wander": ("wander", "the speed {where} wandered by {amount}"),
    "clock": ("clocks_apart", "the clock of {place} {where} is {amount} {late}"),
    "gain": ("gain", "{place} reads {amount} {more} {where} than it should"),
    "form": ("hump_form", "the hump {where} is of another form than stated"),
    "skew": ("hump_form", "the hump {where} leans as none that was stated"),
    "wear": ("hump_form", "the edges of the hump {where} are of another roundness than stated"),
    "lag": ("clocks_apart", "the pitch rate of {place} comes {amount} {late} than its acceleration"),
    "tilt": ("tilt", "{place} sits tilted by {amount} {where}"),
    "position": ("position", "{place} sits {amount} off {where}"),
    "axle_position": ("axle_position", "{place} runs {amount} {farther} behind the first axle than the vehicle file says"),
    "odometer": ("profile_length", "the way over the profile {where} is {amount} {longer} than stated"),
    "force_gain": ("gain", "the force {place} is {amount} {more} {where} than recorded"),
    "displacement_gain": ("gain", "the displacement {place} is {amount} {more} {where} than recorded"),
    "initial_displacement": ("initial", "{place} begins {amount} {higher} {where} than stated"),
    "initial_velocity": ("initial", "{place} begins {amount} {more} upwards {where} than stated"),
    "initial_pitch": ("initial", "{place} begins {amount} {more} nose-down {where} than stated"),
    "initial_pitch_rate": ("initial", "{place} begins to turn {amount} {more} nose-down {where} than stated"),
    "force_offset": ("force_offset", "a constant force of {amount} acts beside {place} {where}"),
}
"""The kind of fault, and what is wrong, by the condition's name."""
_CURES = {
    "delay": "state when the recording starts, or measure where the road begins",
    "speed": "measure the speed by GPS or by the time between the axles' arrivals, and put it right",
    "height": "measure the height of the road and check that the channels' gain is that of the other runs",
    "length": "measure the hump's length and put the run file right",
    "wander": "record again at a steadier speed, or give the run a measured speed",
    "clock": "record both sensors by one clock, or let both feel a knock at a known time",
    "gain": "check the sensor's calibration and the column's unit",
    "form": "measure the hump's form and state it as points",
    "skew": "measure the hump's form and state it as points",
    "wear": "measure the hump's form and state it as points",
    "lag": "state what both recorders do (`acquisition`), or record both by one clock",
    "tilt": "mount the sensor level, or import the recording so that its axes are turned upright",
    "position": "measure where the sensor sits and put the run file right",
    "axle_position": "measure the distance between the axles and put the vehicle file right",
    "odometer": "check the profiler's odometer against a measured distance",
    "force_gain": "check the force sensor's calibration and the column's unit",
    "displacement_gain": "check the displacement sensor's calibration and the column's unit",
    "force_offset": "take the force sensor's zero while nothing pushes, or state how well it is known (`uncertainty: {force_offset: 5 N}`)",
}
_CURES |= dict.fromkeys(
    (name for name, (kind, _) in _FAULT_OF.items() if kind == "initial"), "measure how the rig is released, and put `initial` right"
)


def findings_of_conditions(
    conditions: Sequence[Condition], runs: Sequence[str], heights: Mapping[str, float] | None = None
) -> tuple[MeasurementFault, ...]:
    """Return what conditions beyond BEYOND standard deviations tell.

    Parameters
    ----------
    conditions
        All conditions of a fit.
    runs
        The names of all runs.
    heights
        The heights of humps [m] by run, as stated (default: unknown): two runs whose heights suit each other's were exchanged.
    """
    beyond = [item for item in conditions if abs(item.sigmas) > BEYOND and item.name in _FAULT_OF]
    for name, place in dict.fromkeys((item.name, item.place) for item in conditions if item.name in ("speed", "clock")):
        same = [item for item in conditions if (item.name, item.place) == (name, place)]
        if len(same) > 1 and abs(sum(item.sigmas for item in same)) > TOGETHER * len(same) ** 0.5:
            beyond = [*(item for item in beyond if item not in same), *same]
    found: list[MeasurementFault] = []
    known = {run: height for run, height in (heights or {}).items() if height > 0}
    for one, other in combinations([item for item in beyond if item.name == "height" and item.run in known and item.value > -1], 2):
        ratio = known[other.run] / known[one.run]
        differ = abs(np.log(ratio)) > AGREE  # what is alike cannot be exchanged
        if differ and abs(np.log((1 + one.value) / ratio)) < AGREE and abs(np.log((1 + other.value) * ratio)) < AGREE:
            beyond = [item for item in beyond if item not in (one, other)]
            message = (
                f"the hump heights of {one.run} and {other.run} have been exchanged: each suits the other's recording "
                f"({100 * one.value:+.0f} % and {100 * other.value:+.0f} %)"
            )
            cure = "put the humps of the two run files right, or exchange their recordings"
            found.append(MeasurementFault("exchanged_heights", (one.run, other.run), (), message, cure))
    for name, place in dict.fromkeys((item.name, item.place) for item in beyond):
        left = [item for item in beyond if (item.name, item.place) == (name, place)]
        while left:
            alike = [item for item in left if abs(item.value - left[0].value) <= max(AGREE * abs(left[0].value), item.sigma)]
            found.append(_fault(alike, tuple(runs)))
            left = [item for item in left if item not in alike]
    return tuple({item.message: item for item in found}.values())  # a speed that wanders may do so at several times


def alike_conditions(
    conditions: Sequence[Condition], runs: Sequence[str], spread: float = ALIKE_SPREAD, least: float = ALIKE_SIGMAS
) -> tuple[tuple[Condition, ...], ...]:
    """Return what all `runs` suppose alike, an error of each: the same way by `least` standard deviations, within `spread` of them."""
    found = []
    for name, place in dict.fromkeys((item.name, item.place) for item in conditions if item.name in OF_ALL_RUNS):
        same = tuple(item for item in conditions if (item.name, item.place) == (name, place))
        sigmas = [item.sigmas for item in same]
        off = min(sigmas) >= least or max(sigmas) <= -least
        every = len(same) >= LEAST_ALIKE and {item.run for item in same} == set(runs)
        if every and off and max(sigmas) - min(sigmas) <= spread:
            found.append(same)
    return tuple(found)


def far_together(alike: Sequence[Condition]) -> bool:
    """Return whether conditions, all off the same way, are so far off together that it is no chance."""
    return bool(abs(sum(item.sigmas for item in alike)) >= FAR_TOGETHER * len(alike) ** 0.5)


def alike_in_all_runs(conditions: Sequence[Condition], runs: Sequence[str]) -> tuple[str, ...]:
    """Return what all `runs` suppose alike, in sentences: no finding, but that they agree says more than each of them."""
    known = dict.fromkeys(alike_conditions(conditions, runs), "every run supposes it, and nearly as much")
    for alike in alike_conditions(conditions, runs, np.inf, 0.0):
        if far_together(alike):
            known.setdefault(alike, "every run supposes it, each another amount, in the mean")
    return tuple(f"{words}: {_sentence(alike, tuple(runs))[1]}" for alike, words in known.items())


def moved_roads(
    conditions: Sequence[Condition], speeds: Mapping[str, float], arrivals: Mapping[str, float]
) -> tuple[MeasurementFault, ...]:
    """Return which roads lie elsewhere along the way: their runs' clocks stand out from those of all other runs.

    Parameters
    ----------
    conditions
        All conditions of a fit.
    speeds
        The speed [m/s] of every run over a measured profile, whose place is easily mistaken.
    arrivals
        When [s] after its recording's start each run's road is first met, as stated.
    """
    delays = {item.run: item.value for item in conditions if item.name == "delay" and item.run in arrivals}
    faster = {item.run: item.value for item in conditions if item.name == "speed"}
    # of a start that was measured along the way, a slower run meets its road later; of one that a clock told, not
    after_the_way = {run: value - arrivals[run] * (1 / (1 + faster.get(run, 0.0)) - 1) for run, value in delays.items()}
    found = []
    for run in (name for name in speeds if name in delays):
        if len(delays) <= LEAST_OTHERS:
            continue
        by_clock, by_way = (_stands_out(run, starts) for starts in (delays, after_the_way))
        (late, spread), other = sorted((by_clock, by_way), key=lambda item: item[1])
        timed = by_way[1] >= FAR_APART * by_clock[1]
        shift = late * speeds[run]
        spread = max(spread, TIMED_SPREAD_S if timed else CLOCKS_SPREAD_S)
        clear = abs(late) >= STANDS_OUT * spread and (timed or abs(other[0]) >= EITHER_WAY * max(other[1], CLOCKS_SPREAD_S))
        if not clear or abs(shift) < LEAST_SHIFT_M:
            continue
        message = (
            f"the road of {run} seems to lie {abs(shift):.2f} m {'further along' if late > 0 else 'nearer'} than the file says, or its "
            f"recording starts {abs(late):.2g} s {'earlier' if late > 0 else 'later'}: the other runs' starts agree within {spread:.1g} s"
        )
        cure = "measure where the profile begins, or state when the recording starts"
        found.append(MeasurementFault("road_position", (run,), (), message, cure, shift, "m"))
    return tuple(found)


def _stands_out(run: str, starts: Mapping[str, float]) -> tuple[float, float]:
    """Return how much later [s] a run starts than the others usually do, and how far these are spread [s]."""
    others = np.array([value for name, value in starts.items() if name != run])
    usual = float(np.median(others))
    return starts[run] - usual, float(np.sqrt(np.mean((others - usual) ** 2)))


def _fault(alike: Sequence[Condition], runs: tuple[str, ...]) -> MeasurementFault:
    """Return the fault that conditions of the same name and nearly the same value tell together."""
    item = alike[0]
    own, message = _sentence(alike, runs)
    message += f" ({max(abs(other.sigmas) for other in alike):.0f} standard deviations of what was thought possible)"
    kind, value = _FAULT_OF[item.name][0], float(np.mean([other.value for other in alike]))
    return MeasurementFault(kind, own, (item.place,) if item.place else (), message, _CURES[item.name], value, item.unit)


def _sentence(alike: Sequence[Condition], runs: tuple[str, ...]) -> tuple[tuple[str, ...], str]:
    """Return the runs of conditions of the same name and nearly the same value, and what these say in words."""
    item = alike[0]
    value = float(np.mean([other.value for other in alike]))
    own = tuple(dict.fromkeys(run for other in alike for run in ((other.run,) if other.run else runs)))
    amount = f"{abs(value):.3g} {item.unit}" if item.unit else f"{100 * abs(value):.3g} %"
    up = value > 0
    words = {
        "late": "later" if up else "earlier",
        "early": "earlier" if up else "later",
        "more": "more" if up else "less",
        "higher": "higher" if up else "lower",
        "longer": "longer" if up else "shorter",
        "farther": "farther" if up else "less far",
    }
    words |= {"fast": "too fast" if up else "too slow", "place": item.place or "the recorder"}
    return own, _FAULT_OF[item.name][1].format(where=place_words(own, runs), amount=amount, **words)
