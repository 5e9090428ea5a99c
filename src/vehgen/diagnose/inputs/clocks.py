"""Clocks that are wrong: two sensors' apart, in one run or by more than any sensor delays."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from vehgen.diagnose.inputs.adjustments import RunDelay
from vehgen.diagnose.inputs.comparison import Comparison
from vehgen.diagnose.inputs.fault import Hypothesis, MeasurementFault, place_words
from vehgen.diagnose.inputs.refits import BaseRefits
from vehgen.fit.trial import Trial

Array = NDArray[np.float64]
APART_NOTICED = 0.008
"""Sensors whose clocks seem this far apart [s] are fitted."""
HONEST_DELAY = 0.3
"""A delay of up to this [s], the same in all runs, is an effect of the sensor (`sensor_delay`)."""
FAR_IN_SOME = 0.05
"""Delays beyond this [s], in some of the runs only, are plain."""
SAME_DELAY = 0.006
"""Delays within this of one another [s] are one."""
CLEARLY = 0.3
"""A sensor's clock is judged where its correlation with the prediction reaches this."""
CLOCK_LEFT = 0.25
"""Largest share of the excess that another clock may leave."""


@dataclass(frozen=True)
class _Late:
    run: str
    sensor: str
    delay: float


def clock_hypotheses(case: BaseRefits, decisive: bool) -> Iterator[Hypothesis]:
    """Yield that the clocks of sensors are apart; `decisive`: where by more than any effect may be, else also by less in some runs."""
    late = [item for trial, own in zip(case.trials, case.comparisons, strict=True) for item in _apart(trial, own)]
    noticed = [item for item in late if abs(item.delay) > APART_NOTICED]
    if not noticed:
        return
    by_sensor = {sensor: [item.delay for item in late if item.sensor == sensor] for sensor in dict.fromkeys(item.sensor for item in late)}
    honest = all(np.ptp(delays) < SAME_DELAY and max(map(abs, delays)) < HONEST_DELAY for delays in by_sensor.values())
    far = max(abs(item.delay) for item in noticed) > (HONEST_DELAY if len(noticed) == len(late) else FAR_IN_SOME)
    if honest or (decisive and not far):
        return

    def describe(numbers: Array) -> tuple[MeasurementFault, ...]:
        fitted = numbers[len(numbers) - len(noticed) :]
        return tuple(
            MeasurementFault(
                "clocks_apart",
                (item.run,),
                (item.sensor,),
                f"the clock of {item.sensor} is {abs(value):.3g} s {'late' if value > 0 else 'early'} against the other sensors' "
                f"{place_words((item.run,), case.runs)}",
                "put all recordings on one clock, by a knock that all sensors feel, or import them together",
                float(value),
                "s",
            )
            for item, value in zip(noticed, fitted, strict=True)
            if abs(value) > APART_NOTICED / 2
        )

    shared = tuple(RunDelay(item.sensor, 0.01, run=item.run) for item in noticed)
    yield Hypothesis(case.trials, describe, CLOCK_LEFT, shared, tuple(item.delay for item in noticed))


def _apart(trial: Trial, item: Comparison) -> Iterator[_Late]:
    """Yield how late every sensor but the first is, in a run that shows it."""
    sensors = list(dict.fromkeys(channel.sensor for channel in trial.recording.channels))
    lags = []
    for sensor in sensors:
        own = [i for i, channel in enumerate(trial.recording.channels) if channel.sensor == sensor]
        curve = item.own[:, own].mean(axis=1)
        lags.append(item.seconds(curve) if curve.max() > CLEARLY else np.nan)
    for sensor, lag in zip(sensors[1:], lags[1:], strict=True):
        if np.isfinite(lag - lags[0]):
            yield _Late(trial.name, sensor, float(lag - lags[0]))
