"""Many kernels compiled at once, each in a process of its own."""

from __future__ import annotations

import os
from collections.abc import Iterable
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from pathlib import Path

from vehgen.codegen.cache import import_kernel
from vehgen.codegen.kernel import Kernel
from vehgen.codegen.kernel_store import writable_folder
from vehgen.errors import InputError
from vehgen.process_start import process_context


def compile_all(kernels: Iterable[Kernel], workers: int | None = None) -> None:
    """Fill the cache with the compiled code of all kernels, then load it.

    Compilation holds Python's interpreter lock, so threads would not help. A script that calls this needs the usual
    `if __name__ == "__main__":` around its work (:mod:`vehgen.process_start`).

    Parameters
    ----------
    kernels
        What to compile; what the cache already holds is not compiled again.
    workers
        Processes (default: one per core); 1 compiles in this process.

    Raises
    ------
    InputError
        When a process ends before it has compiled its kernel.
    """
    wanted = {kernel.name: kernel for kernel in kernels}
    missing = [kernel for kernel in wanted.values() if not kernel.is_compiled]
    workers = min(workers or os.cpu_count() or 1, len(missing))
    if workers > 1:
        jobs = [
            (kernel.source.text, writable_folder(kernel.folder)) for kernel in sorted(missing, key=lambda kernel: -len(kernel.source.text))
        ]
        with ProcessPoolExecutor(workers, mp_context=process_context()) as pool:
            try:
                list(pool.map(compile_source, *zip(*jobs, strict=True)))
            except BrokenProcessPool as error:
                raise InputError(
                    "a process ended while it compiled: too little memory, or the calling script lacks `if __name__ == '__main__':`"
                ) from error
    for kernel in wanted.values():
        kernel.compile()


def compile_source(text: str, folder: Path) -> None:
    """Compile a kernel and leave the module behind: it cannot travel between processes."""
    import_kernel(text, folder)
