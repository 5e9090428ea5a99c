"""The source paper's study on synthetic vehicles of which the truth is known: `python -m benchmarks.paper_study [--quick]`."""

import os

# small matrices, many of them: threads of OpenBLAS only wait for each other (before numpy is imported)
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
