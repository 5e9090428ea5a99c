"""How does it run? From EquationsOfMotion to a compiled kernel that advances whole populations.

A straight-line program of the model, its sparse factorisation, the condensation of force laws, kernel source, machine code, the cache.
"""

from typing import TYPE_CHECKING

from vehgen.late_imports import import_late

if TYPE_CHECKING:
    from vehgen.codegen.cache import cache_folder
    from vehgen.codegen.kernel import Kernel, KernelResult
    from vehgen.codegen.kernel_source import KernelSource, write_kernel
    from vehgen.codegen.parallel import compile_all
    from vehgen.codegen.population_run import Excitation

__all__ = ["Excitation", "Kernel", "KernelResult", "KernelSource", "cache_folder", "compile_all", "write_kernel"]

import_late(
    __name__,
    {
        "vehgen.codegen.cache": ("cache_folder",),
        "vehgen.codegen.population_run": ("Excitation",),
        "vehgen.codegen.kernel": (
            "Kernel",
            "KernelResult",
        ),
        "vehgen.codegen.kernel_source": (
            "KernelSource",
            "write_kernel",
        ),
        "vehgen.codegen.parallel": ("compile_all",),
    },
)
