"""How is it taken away? Equations of motion as files for other programs.

Matrices and names as data, state space, C code of the step that kernels run, co-simulation units, and a vehicle for VBI-2D.
"""

from vehgen.export.exporting import export
from vehgen.export.formats import EXPORT_FORMATS
from vehgen.export.matrix_data import matrix_schema

__all__ = ["EXPORT_FORMATS", "export", "matrix_schema"]
