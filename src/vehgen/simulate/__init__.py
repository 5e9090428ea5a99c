"""What does it do? Modes, and responses of one vehicle or a population over a run.

Run files, scenarios, the simulator, frequency responses, exact references, and what makes an answer doubtful.
"""

from typing import TYPE_CHECKING

from vehgen.late_imports import import_late

if TYPE_CHECKING:
    from vehgen.simulate.exact import exact_response, newmark_response
    from vehgen.simulate.frequency_response import FrequencyResponse, frequency_response
    from vehgen.simulate.lint import lint
    from vehgen.simulate.modes import Mode, Modes, natural_modes
    from vehgen.simulate.response import Response, write_csv
    from vehgen.simulate.road_response import RoadResponse, road_response
    from vehgen.simulate.run_file import Run, load_run
    from vehgen.simulate.run_file.loading import RunLike, as_run
    from vehgen.simulate.run_scenario import make_scenario
    from vehgen.simulate.scenario import Scenario
    from vehgen.simulate.signals import Signal
    from vehgen.simulate.simulator import Simulator, SimulatorPool, simulate
    from vehgen.simulate.state_space import StateSpace, state_space

__all__ = [
    "FrequencyResponse",
    "Mode",
    "Modes",
    "Response",
    "RoadResponse",
    "Run",
    "RunLike",
    "Scenario",
    "Signal",
    "Simulator",
    "SimulatorPool",
    "StateSpace",
    "as_run",
    "exact_response",
    "frequency_response",
    "lint",
    "load_run",
    "make_scenario",
    "natural_modes",
    "newmark_response",
    "road_response",
    "simulate",
    "state_space",
    "write_csv",
]

import_late(
    __name__,
    {
        "vehgen.simulate.exact": (
            "exact_response",
            "newmark_response",
        ),
        "vehgen.simulate.frequency_response": (
            "FrequencyResponse",
            "frequency_response",
        ),
        "vehgen.simulate.lint": ("lint",),
        "vehgen.simulate.modes": (
            "Mode",
            "Modes",
            "natural_modes",
        ),
        "vehgen.simulate.response": (
            "Response",
            "write_csv",
        ),
        "vehgen.simulate.road_response": (
            "RoadResponse",
            "road_response",
        ),
        "vehgen.simulate.run_file": (
            "Run",
            "load_run",
        ),
        "vehgen.simulate.run_file.loading": (
            "RunLike",
            "as_run",
        ),
        "vehgen.simulate.run_scenario": ("make_scenario",),
        "vehgen.simulate.scenario": ("Scenario",),
        "vehgen.simulate.signals": ("Signal",),
        "vehgen.simulate.simulator": (
            "Simulator",
            "SimulatorPool",
            "simulate",
        ),
        "vehgen.simulate.state_space": (
            "StateSpace",
            "state_space",
        ),
    },
)
