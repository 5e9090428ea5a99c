"""How does it run? From EquationsOfMotion to a compiled kernel that advances whole populations.

A straight-line program of the model, its sparse factorisation, the condensation of force laws, kernel source, machine code, the cache.
"""

from vehgen.codegen.cache import cache_folder
from vehgen.codegen.kernel import Excitation, Kernel, KernelResult
from vehgen.codegen.kernel_source import KernelSource, write_kernel
from vehgen.codegen.parallel import compile_all

__all__ = ["Excitation", "Kernel", "KernelResult", "KernelSource", "cache_folder", "compile_all", "write_kernel"]
