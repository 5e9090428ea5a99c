"""What is exported: equations of motion at values of their parameters, and what an export may leave out of them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from vehgen.errors import ArgumentError
from vehgen.mechanics import EquationsOfMotion, NumericModel, StaticLoads, static_loads


@dataclass(frozen=True)
class ExportSource:
    """A model with channels, the value of every column of its parameters [SI], and choices.

    Attributes
    ----------
    model, values
        What is written.
    linear
        Whether a format without force laws may leave them out.
    step
        Time step of exported programs [s].
    stem
        The name of the file or folder to write, without its suffix.
    """

    model: EquationsOfMotion
    values: Mapping[str, float]
    linear: bool
    step: float
    stem: str

    @cached_property
    def numeric(self) -> NumericModel:
        """The matrices in numbers."""
        return self.model.numeric(self.values)

    @cached_property
    def loads(self) -> StaticLoads:
        """The static loads."""
        return static_loads(self.model, self.values)

    @property
    def static_outputs(self) -> NDArray[np.float64]:
        """What each output has of the static loads, `shape (n_outputs,)` [N]: the whole load of a tyre or hinge, else nothing."""
        return np.array([self.loads.within(item.quantity, item.owner) for item in self.model.channels], dtype=np.float64)

    @cached_property
    def all_values(self) -> dict[str, float]:
        """The value of every parameter of the vehicle [SI], those that follow from others too."""
        vehicle = self.model.vehicle
        return vehicle.all_values({name: self.values[name] for name in vehicle.free_parameters})

    def refuse_laws(self, format_name: str) -> None:
        """Refuse a vehicle with force laws for a format that has no place for them, unless they may be left out.

        Raises
        ------
        InputError
            With the law and the element that carries it.
        """
        carried = [(element, term) for element in self.model.elements for term in element.laws]
        if carried and not self.linear:
            element, term = carried[0]
            others = f" (and {len(carried) - 1} more)" if len(carried) > 1 else ""
            raise ArgumentError(
                f"{self.model.vehicle.name}: the force law {term.law.name} of {element.kind} {element.name}{others} cannot be carried by "
                f"{format_name}, which is linear; c, fmu and fmu3 carry it, json describes it, and `linear` leaves it out",
                "linear",
            )
