"""Plain functions of loops over arrays become machine code, kept and loaded as kernels are."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from functools import cache
from typing import Any

from vehgen.codegen.cache import import_kernel

_HEAD = '''"""{name} of {module}, compiled; written by vehgen.codegen.compiled_loops."""

from __future__ import annotations

import numba
import numpy as np
{imports}

@numba.njit("{signature}", nogil=True, cache=True, fastmath={{"contract", "nsz"}}, error_model="numpy")
'''


@cache
def compile_loops(function: Callable[..., Any], signature: str, imports: str = "") -> Callable[..., Any]:
    """Return a function compiled for arguments of one signature.

    Parameters
    ----------
    function
        Of a module's own level: its source is compiled as it stands, so that it may use numpy as `np`, and nothing else of its module.
    signature
        What it takes and returns, in numba's words.
    imports
        A line that imports what else it uses.
    """
    head = _HEAD.format(name=function.__name__, module=function.__module__, signature=signature, imports=imports)
    compiled: Callable[..., Any] = getattr(import_kernel(head + inspect.getsource(function)), function.__name__)
    return compiled
