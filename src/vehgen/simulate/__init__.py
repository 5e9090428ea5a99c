"""What does it do? Modes, and responses of one vehicle or a population over a run.

Run files, scenarios, the simulator, frequency responses, exact references, and what makes an answer doubtful.
"""

from vehgen.simulate.exact import exact_response, newmark_response
from vehgen.simulate.lint import lint
from vehgen.simulate.modes import Mode, natural_modes
from vehgen.simulate.pool import SimulatorPool
from vehgen.simulate.run_file import Run, load_run
from vehgen.simulate.scenario import Scenario, Signal, make_scenario
from vehgen.simulate.simulator import Response, Simulator, simulate, write_csv

__all__ = [
    "Mode",
    "Response",
    "Run",
    "Scenario",
    "Signal",
    "Simulator",
    "SimulatorPool",
    "exact_response",
    "lint",
    "load_run",
    "make_scenario",
    "natural_modes",
    "newmark_response",
    "simulate",
    "write_csv",
]
