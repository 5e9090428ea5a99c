"""A proposal for the next run, as data and in a sentence."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

from vehgen.diagnose.design.candidate_runs import CandidateRun
from vehgen.mechanics.outputs import PointOutput


@dataclass(frozen=True)
class Proposal:
    """What to measure next.

    Attributes
    ----------
    models
        What is to be told apart.
    height, length, speed
        The hump [m] and the speed over it [m/s]; None where no run helps.
    distance
        Expected difference of chi-squared, after a refit of the wrong model to all runs.
    channel, times
        Where the predictions then differ most, and by how many standard deviations of its noise.
    added
        A sensor to add, in words; None where those of the runs suffice.
    separates
        Whether one such run is enough.
    text
        All this in a sentence.
    """

    models: tuple[str, ...]
    height: float | None
    length: float | None
    speed: float | None
    distance: float
    channel: str
    times: float
    added: str | None
    separates: bool
    text: str

    def to_dict(self) -> dict[str, Any]:
        """Return plain data for JSON."""
        return {**asdict(self), "models": list(self.models)}


def drive(run: CandidateRun, added: str | None = None) -> str:
    """Return what to do, in words."""
    which = "the same hump" if run.same else f"a hump {run.length:.3g} m long"
    first = f"add {added} and " if added else ""
    return f"{first}drive over {which}, {run.height:.3g} m high, at {run.speed:.3g} m/s"


def sensor_text(output: PointOutput) -> str:
    """Return a sensor to add, in words."""
    quantity = "an accelerometer" if output.quantity == "acceleration" else "a pitch-rate sensor"
    return f"{quantity} on {output.place.body} at {output.place.behind}"
