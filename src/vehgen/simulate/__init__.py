"""What does it do? Modes, and responses of one vehicle or a population over a run.

Run files, scenarios, the simulator, frequency responses, exact references, and what makes an answer doubtful.
"""

from vehgen.simulate.exact import exact_response, newmark_response
from vehgen.simulate.frequency_response import FrequencyResponse, frequency_response
from vehgen.simulate.lint import lint
from vehgen.simulate.modes import Mode, Modes, natural_modes
from vehgen.simulate.pool import SimulatorPool
from vehgen.simulate.response import Response, write_csv
from vehgen.simulate.road_response import RoadResponse, road_response
from vehgen.simulate.run_file import Run, load_run
from vehgen.simulate.run_like import RunLike, as_run
from vehgen.simulate.run_scenario import make_scenario
from vehgen.simulate.scenario import Scenario
from vehgen.simulate.signals import Signal
from vehgen.simulate.simulator import Simulator, simulate
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
