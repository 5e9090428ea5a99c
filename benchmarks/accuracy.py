"""Do the 90 % intervals hold the truth 90 times in 100? `python -m benchmarks.accuracy [--replicates 100]` writes into docs/accuracy.md.

Each replicate records a true vehicle over a hump at two speeds, with a road, a phone's noise and an error of the speed of its own, and
calibrates it by the gradient polish alone, from the vehicle file's values: by all sensors at once, or in the two steps of DHCM.
"""

from __future__ import annotations

import argparse
import os
import tempfile
import time
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from multiprocessing import get_context
from pathlib import Path

import numpy as np
import scipy.stats

from benchmarks.pages import ROOT, fill, table
from benchmarks.paper_study.recordings import RIGS, hump_run
from benchmarks.paper_study.truth import drawn
from vehgen.calibrate.calibration import Settings, calibrate_problem
from vehgen.calibrate.genetic import GeneticSearch
from vehgen.calibrate.identifiability import find_structure
from vehgen.calibrate.intervals import LEVEL, Estimate, Uncertainty
from vehgen.calibrate.step_intervals import step_uncertainties
from vehgen.fit.least_squares import fit_least_squares
from vehgen.fit.problem import Problem, make_problem
from vehgen.fit.trial import load_trials

WORKERS = 2
SPEED_ERROR = 0.005
"""Standard deviation of the relative error of the speed that a run file says."""
VEHICLE = 1
"""Which true vehicle of the study."""
COMBINATIONS = {
    "truck": (
        *(f"{kind}{i}/(mT + mS)" for kind in ("m", "k", "c", "kt") for i in range(1, 6)),
        "b7/(mT + mS)",
        "b6*mS/(mT + mS)",
    ),
    "sedan": (),
}
"""What hump data can tell of the truck; of the sedan they can tell all parameters."""
TWO_SENSORS = {"truck": ("L1", "L2"), "sedan": ("F", "R")}
"""Those of DHCM, in its order."""
NO_SEARCH = GeneticSearch(1, 10, 0)
"""Ten individuals drawn at random, of which the best is polished beside the file's values."""
FAMILIES = {
    "truck": {"unsprung masses": "m", "suspension stiffnesses": "k", "dampings": "c", "tyre stiffnesses": "kt", "distances": "b"},
    "sedan": {"unsprung masses": "m", "suspension stiffnesses": "k", "dampings": "c", "tyre stiffnesses": "kt", "Lf and IZ": ""},
}

Row = tuple[str, float, float, float, float]
"""Name, estimate, lower and upper end, truth."""


def replicate(kind: str, method: str, seed: int) -> tuple[list[Row], float, float]:
    """Return what one replicate's intervals say beside the truth, its (last) chi2, and how long its fit took [s]."""
    rig = RIGS[kind]
    truth = drawn(kind, VEHICLE)
    random = np.random.default_rng([seed, 11])
    with tempfile.TemporaryDirectory() as name:
        runs = []
        for i, speed in enumerate(rig.humps):
            told = speed * (1 + SPEED_ERROR * float(random.standard_normal()))
            runs.append(hump_run(Path(name), f"run{i}", rig, truth, speed, 10_000 + 10 * seed + i, told=told))
        problem = make_problem(load_trials(runs))
    start = time.perf_counter()
    known = _joint(problem) if method == "joint" else _in_two_steps(problem, TWO_SENSORS[kind], seed)
    spent = time.perf_counter() - start
    right = np.array([truth[name] for name in problem.space.names])
    rows = [_row(known.combination(text), known.expression(text)(right)) for text in COMBINATIONS[kind]]
    if not rows:
        rows = [_row(item, truth[item.name]) for item in known.parameters()]
    modes = known.mode_table(right)[0]
    rows += [_row(Estimate(f"mode {i + 1}", hz.value, hz.low, hz.high), modes[i]) for i, (hz, _) in enumerate(known.frequencies())]
    return rows, known.fit.chi2, spent


def _joint(problem: Problem) -> Uncertainty:
    fit = fit_least_squares(problem, problem.space.unit(problem.space.start))
    return Uncertainty(fit, find_structure(problem, fit.values))


def _in_two_steps(problem: Problem, sensors: tuple[str, ...], seed: int) -> Uncertainty:
    found = calibrate_problem(problem, Settings("dhcm", sensors, search=NO_SEARCH, starts=2, seed=seed))
    known = step_uncertainties(problem, found.steps)[-1]
    assert known is not None
    return known


def _row(estimate: Estimate, truth: float) -> Row:
    low, high = (float("nan") if end is None else end for end in (estimate.low, estimate.high))
    return estimate.name, estimate.value, low, high, float(truth)


def family(kind: str, name: str) -> str:
    """Return which row of the summary a quantity belongs to."""
    if name.startswith("mode"):
        return "natural frequencies"
    letters = name.partition("/")[0].rstrip("0123456789") if kind == "truck" else name[:-1]
    found = [title for title, prefix in FAMILIES[kind].items() if prefix == letters]
    return found[0] if found else list(FAMILIES[kind])[-1]


def summary(kind: str, replicates: Sequence[Sequence[Row]], only_groups: bool = False) -> str:
    """Return coverage, width and bias by quantity, families and all of them pooled below; no interval counts as one that misses."""
    names = [row[0] for row in replicates[0]]
    estimates, low, high, truth = (np.array([[row[i] for row in rows] for rows in replicates]) for i in (1, 2, 3, 4))
    covered = (low <= truth) & (truth <= high)
    quantile = float(scipy.stats.norm.ppf(0.5 + LEVEL / 2))
    deviation = np.log(estimates / truth)
    spread = np.log(high / low) / (2 * quantile)
    groups = {} if only_groups else {name: [i] for i, name in enumerate(names)}
    for title in ["natural frequencies", *FAMILIES[kind]]:
        groups[f"**{title}**"] = [i for i, name in enumerate(names) if family(kind, name) == title]
    groups["**all**"] = list(range(len(names)))
    rows = []
    for title, members in groups.items():
        part, width = deviation[:, members], spread[:, members]
        rows.append(
            (
                title if "**" in title or title.startswith("mode") else f"`{title}`",
                f"{100 * covered[:, members].mean():.0f}",
                f"{100 * np.nanmedian(width):.2f}",
                f"{100 * np.sqrt(np.mean(part**2)):.2f}",
                f"{np.nanmean(part / width):+.2f}",
                str(int(np.isnan(width).sum())),
            )
        )
    header = (
        "quantity",
        "interval holds the truth [%]",
        "standard error given [%]",
        "rms error found [%]",
        "mean error / standard error",
        "without interval",
    )
    return table(header, rows)


def main() -> None:
    """Run both vehicles, or those asked for."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--replicates", type=int, default=100, metavar="N", help="replicates of each vehicle (default 100)")
    parser.add_argument("--vehicle", choices=tuple(RIGS), action="append", help="only this one")
    parser.add_argument("--method", choices=("joint", "dhcm"), default="joint", help="all sensors at once (default), or two steps")
    options = parser.parse_args()
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # for the processes: threads on small matrices only wait for each other
    blocks = {}
    with ProcessPoolExecutor(WORKERS, mp_context=get_context("spawn")) as pool:
        for kind in options.vehicle or RIGS:
            found = list(pool.map(partial(replicate, kind, options.method), range(options.replicates)))
            chi2, spent = (np.array([item[i] for item in found]) for i in (1, 2))
            text = summary(kind, [item[0] for item in found], only_groups=options.method == "dhcm")
            note = (
                f"{options.replicates} replicates; chi2 {chi2.mean():.3f} (largest {chi2.max():.3f}); a fit with its intervals took "
                f"{np.median(spent):.1f} s."
            )
            name = f"{kind} intervals" if options.method == "joint" else f"{kind} {options.method} intervals"
            blocks[name] = f"{text}\n\n{note}"
            print(f"{name}\n{blocks[name]}\n", flush=True)
    fill(ROOT / "docs" / "accuracy.md", blocks)


if __name__ == "__main__":
    main()
