"""Run the diagnosis on hidden cases and score it: `python -m benchmarks.hidden_effects --set scored --out FOLDER`."""

from __future__ import annotations

import argparse
import json
import tempfile
import time
import warnings
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path

from benchmarks.hidden_effects.cases import DEVELOP_SEED, SCORED_SEED, HiddenCase, draw_cases
from benchmarks.hidden_effects.score import score, table


def solve(item: HiddenCase) -> dict:
    """Write a case, diagnose it, return what came out beside the truth."""
    from benchmarks.hidden_effects.generator import write_case
    from vehgen.diagnose.pipeline import diagnose
    from vehgen.identify.trial import load_trials

    warnings.simplefilter("ignore")
    start = time.perf_counter()
    record = {
        "case": item.name,
        "kind": item.kind,
        "vehicle": item.vehicle,
        "truth": [{"name": effect.name, "place": effect.place, "values": dict(effect.values)} for effect in item.effects],
    }
    with tempfile.TemporaryDirectory() as seen, tempfile.TemporaryDirectory() as hidden:
        write_case(item.case, Path(seen), Path(hidden))
        try:
            found = diagnose(load_trials(sorted(Path(seen).glob("*.yaml"))))
        except Exception as error:  # a crash is a result too
            return {**record, "verdict": "crash", "error": f"{type(error).__name__}: {error}", "seconds": time.perf_counter() - start}
    data = found.verdict.to_dict()
    data["tried"] = [[fit.label, fit.train, fit.held_out] for fit in found.fits[:5]]
    return {**record, **data, "seconds": time.perf_counter() - start}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--set", choices=("develop", "scored"), default="develop")
    parser.add_argument("--vehicle", choices=("sedan2", "tractor5"), action="append")
    parser.add_argument("--only", metavar="TEXT", help="cases whose name contains this")
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--out", type=Path, required=True, help="a JSON lines file that grows case by case")
    options = parser.parse_args()
    seed = DEVELOP_SEED if options.set == "develop" else SCORED_SEED
    cases = draw_cases(seed, tuple(options.vehicle or ("sedan2", "tractor5")))
    cases = [case for case in cases if options.only is None or options.only in case.name]
    done = {json.loads(line)["case"] for line in options.out.read_text().splitlines()} if options.out.is_file() else set()
    waiting = [case for case in cases if case.name not in done]
    with ProcessPoolExecutor(options.workers, mp_context=get_context("spawn")) as pool, options.out.open("a") as stream:
        for record in pool.map(solve, waiting):
            stream.write(json.dumps(record) + "\n")
            stream.flush()
            named = ", ".join(f"{effect['name']} at {effect['place']}" for effect in record.get("effects", []))
            truth = ", ".join(f"{effect['name']} at {effect['place']}" for effect in record["truth"]) or "nothing"
            print(f"{record['case']:32s} {record['verdict']:20s} {named:60s} truth {truth}  {record['seconds']:.0f} s", flush=True)
    records = [json.loads(line) for line in options.out.read_text().splitlines()]
    print(table(score(records)))


if __name__ == "__main__":
    main()
