"""What does a run do? The run file: its entries, its checks, and the run that it declares."""

from vehgen.simulate.run_file.entries import RunFile
from vehgen.simulate.run_file.loading import Run, load_run

__all__ = ["Run", "RunFile", "load_run"]
