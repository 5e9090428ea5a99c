"""What is missing in each of many vehicles? A folder of vehicles with their runs, diagnosed one by one wherever there is room.

What was finished is kept, and not computed again while its inputs stay the same.
"""

from vehgen.diagnose.fleet.diagnosing import diagnose_fleet
from vehgen.diagnose.fleet.result import Fleet, FleetRow

__all__ = ["Fleet", "FleetRow", "diagnose_fleet"]
