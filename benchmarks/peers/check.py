"""Compare all peers on four individuals over a hump: `python -m benchmarks.peers.check`.

Those that integrate by average-acceleration Newmark must give the dense loop's numbers; those that are exact for piecewise-linear inputs
must give each other's. Between the two groups lies Newmark's own error, which a step of 1 ms keeps small. pyyeti's Newmark is another
member of the family (beta = 1/3, forces and displacements averaged over three steps, as in NASTRAN), so it need only come as close as that.
"""

from __future__ import annotations

import sys

import numpy as np

from benchmarks.peers import cpp_avx, dense_numba, jax_scan, pyyeti_exact, pyyeti_newmark, scipy_lsim
from benchmarks.peers.systems import Array, hump_inputs, tractor5_population

DT, KEEP, N_STEPS = 1e-3, 10, 9_000
GROUPS = {"Newmark": (dense_numba, cpp_avx, jax_scan, pyyeti_newmark), "exact": (scipy_lsim, pyyeti_exact)}
TOLERANCE = {pyyeti_newmark: 5e-3}  # others 1e-9


def distance(found: Array, reference: Array) -> float:
    """Return the largest difference over the largest acceleration."""
    return float(np.abs(found - reference).max() / np.abs(reference).max())


def main() -> int:
    """Print each peer's distance from the first of its group; return 1 where one is too far."""
    systems, inputs = tractor5_population(4, seed=3), hump_inputs(N_STEPS, DT)
    references: dict[str, Array] = {}
    failed = False
    for group, peers in GROUPS.items():
        for peer in peers:
            name = peer.__name__.rsplit(".", 1)[-1]
            if reason := peer.available():
                print(f"{group:8} {name:15} skipped: {reason}")
                continue
            found = peer.run(systems, inputs, DT, KEEP)
            apart = distance(found, references.setdefault(group, found))
            failed |= not apart < TOLERANCE.get(peer, 1e-9)
            print(f"{group:8} {name:15} {apart:.1e}")
    if len(references) == 2:
        print(f"Newmark's error at {DT:g} s: {distance(references['Newmark'], references['exact']):.1e}")
    return int(failed)


if __name__ == "__main__":
    sys.exit(main())
