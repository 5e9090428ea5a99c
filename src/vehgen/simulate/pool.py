"""Simulators that trials and candidates share: one for each vehicle, set of channels and set of forces."""

from __future__ import annotations

from collections.abc import Iterable

from vehgen.mechanics import Output, Place
from vehgen.simulate.simulator import Simulator
from vehgen.vehicle import Vehicle


class SimulatorPool:
    """Makes a simulator where it has none for what is asked, and returns the same one whenever the same is asked again."""

    def __init__(self) -> None:
        self._simulators: dict[str, list[tuple[Vehicle, Simulator]]] = {}

    def simulator(self, vehicle: Vehicle, outputs: Iterable[Output], forces: Iterable[Place] = ()) -> Simulator:
        """Return the simulator of a vehicle with these channels and forces; equal vehicles share one."""
        channels, acting = tuple(outputs), tuple(forces)
        alike = self._simulators.setdefault(_key(channels, acting), [])
        for known, simulator in alike:
            if known is vehicle or known == vehicle:
                return simulator
        alike.append((vehicle, Simulator(vehicle, channels, acting)))
        return alike[-1][1]

    def add(self, vehicle: Vehicle, outputs: Iterable[Output], forces: Iterable[Place], simulator: Simulator) -> None:
        """Keep a simulator that was made elsewhere for this vehicle, these channels and forces."""
        self._simulators.setdefault(_key(tuple(outputs), tuple(forces)), []).append((vehicle, simulator))


def _key(outputs: tuple[Output, ...], forces: tuple[Place, ...]) -> str:
    """Expressions within places cannot be hashed: their texts can."""
    return repr((outputs, forces))
