"""What ends a search early costs: `python -m benchmarks.settling FOLDER...`.

Each folder is a case of the measured world (`make --kind coverage`; OUT/cases/NAME), which is calibrated twice: its search with all
generations, and ended once it has settled. The table tells CPU seconds, and how far results moved in half widths of their intervals.
"""

from __future__ import annotations

import argparse
import time
import warnings
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any
from unittest import mock

import vehgen
from benchmarks.measured_world.solve import COMBINATIONS, imported, vehicle_file, workplace
from vehgen.calibrate.genetic import SearchState


def told(result: Mapping[str, Any]) -> Iterator[tuple[str, float, tuple[float, float]]]:
    """Yield name, value and interval of all that a calibration tells."""
    modes = {mode["name"]: {"value": mode["undamped_hz"], **mode} for mode in result["modes"]}
    for name, item in {**result["parameters"], **result["combinations"], **modes}.items():
        if item["interval"] is not None and item["interval"][0] < item["interval"][1]:
            yield name, item["value"], item["interval"]


def calibrated(folder: Path) -> tuple[dict[str, Any], float]:
    """Return what a calibration of a case's runs tells, and its CPU seconds."""
    runs, _ = imported(folder)
    vehicle = vehicle_file(folder)
    start = time.process_time()
    result = vehgen.calibrate(vehicle, runs, combinations=COMBINATIONS[vehicle.stem]).to_dict()
    return result, time.process_time() - start


def compare(case: Path) -> str:
    """Return a case's row of the table."""
    with workplace(case) as folder, mock.patch.object(SearchState, "is_settled", False):
        whole, before = calibrated(folder)
    with workplace(case) as folder:
        early, after = calibrated(folder)
    values = {name: value for name, value, _ in told(early)}
    moved = {name: 2 * abs(values[name] - value) / (high - low) for name, value, (low, high) in told(whole) if name in values}
    most = max(moved, key=moved.__getitem__)
    cells = (
        f"{case.name}, {vehicle_file(case).stem}",
        str(len(early["history"][0]) - 1),
        f"{before:.1f} → {after:.1f}",
        f"{after / before:.2f}",
        f"{whole['chi2']:.4f} → {early['chi2']:.4f}",
        f"{moved[most]:.3f} ({most})",
    )
    return f"| {' | '.join(cells)} |"


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("cases", nargs="+", type=Path, metavar="FOLDER")
    warnings.simplefilter("ignore")
    print("| case | generations | CPU [s] | ratio | chi squared | moved most |")
    print("| --- | --- | --- | --- | --- | --- |")
    for case in parser.parse_args().cases:
        print(compare(case), flush=True)


if __name__ == "__main__":
    main()
