"""Print a response bit for bit, as JSON: run as a script by the recorder, with the code to be recorded on the path.

The CSV file of `simulate` has nine digits of each value; a response has sixteen, so this asks the Python API.
`response.py run RUN.yaml` or `response.py population VEHICLE.yaml double|single`.
"""

from __future__ import annotations

import hashlib
import json
import sys
from typing import Any

import numpy as np

import vehgen

N_INDIVIDUALS, N_STEPS, DT, KEEP = 13, 4000, 1e-3, 10
"""An odd number of vehicles, so that the last lanes of a vector are filled in part; 4 s."""


def fingerprint(values: np.ndarray) -> dict[str, Any]:
    """Return the hash of an array's bytes, and its peak and rms, which tell how far another one is off."""
    flat = np.ascontiguousarray(values)
    peak, rms = np.abs(flat).max(), np.sqrt(np.mean(np.square(flat, dtype=np.float64)))
    return {"sha256": hashlib.sha256(flat.tobytes()).hexdigest()[:16], "peak": float(peak), "rms": float(rms)}


def of_run(path: str) -> dict[str, Any]:
    """Return the fingerprints of a run's channels."""
    simulate = getattr(vehgen, "simulate", None)
    if not callable(simulate):
        from vehgen.simulate import simulate  # before it was a name of `vehgen` itself
    response = simulate(vehgen.load_run(path))
    channels = {channel.name: fingerprint(response.values[0, :, i]) for i, channel in enumerate(response.channels)}
    return {"shape": list(response.values.shape), "time": fingerprint(response.time), "channels": channels}


def of_population(vehicle_file: str, precision: str) -> dict[str, Any]:
    """Return the fingerprints of vehicles whose parameters are up to 10 % off the file's, over bumps under each wheel."""
    vehicle = vehgen.load_vehicle(vehicle_file)
    first = vehgen.Place("COG", next(iter(vehicle.bodies)))
    outputs = [vehgen.PointOutput(kind, first, kind) for kind in ("acceleration", "displacement")]
    outputs += [vehgen.ElementOutput(f"tyre of {name}", name, "tyre_force") for name in vehicle.axles]
    simulator = vehgen.Simulator(vehicle, outputs)
    centre = simulator.parameters()
    parameters = centre * np.random.default_rng(1).uniform(0.9, 1.1, (N_INDIVIDUALS, centre.shape[1]))
    time = np.arange(N_STEPS + 1) * DT
    phase = np.clip((time[:, None] - 0.2 * (1 + np.arange(len(simulator.model.inputs)))) / 0.25, 0, 1)
    heights = 0.015 * (1 - np.cos(2 * np.pi * phase))
    rates = 0.015 * 2 * np.pi / 0.25 * np.sin(2 * np.pi * phase)
    excitation = getattr(vehgen, "Excitation", None) or vehgen.Excitation
    kernel = vehgen.Kernel(simulator.model, precision=precision)
    result = kernel.run(parameters, excitation(DT, heights, rates, np.zeros((N_STEPS + 1, 0))), KEEP)
    return {"shape": list(result.responses.shape), "failures": len(result.failures), "responses": fingerprint(result.responses)}


if __name__ == "__main__":
    print(json.dumps(of_run(*sys.argv[2:]) if sys.argv[1] == "run" else of_population(*sys.argv[2:])))
