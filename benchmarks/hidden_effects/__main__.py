"""Run the diagnosis on hidden cases and score it: `python -m benchmarks.hidden_effects --set scored --out FOLDER`."""

from __future__ import annotations

import argparse
import json
from concurrent.futures import ProcessPoolExecutor, as_completed
from multiprocessing import get_context
from pathlib import Path

from benchmarks.hidden_effects.cases import DEVELOP_SEED, FIRST_SEED, SCORED_SEED, draw_cases
from benchmarks.hidden_effects.score import score, table
from benchmarks.hidden_effects.solve import solve


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--set", choices=("develop", "first", "scored"), default="develop")
    parser.add_argument("--vehicle", choices=("sedan2", "tractor5"), action="append")
    parser.add_argument("--only", metavar="TEXT", help="cases whose name contains this")
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--out", type=Path, required=True, help="a JSON lines file that grows case by case")
    options = parser.parse_args()
    seed = {"develop": DEVELOP_SEED, "first": FIRST_SEED, "scored": SCORED_SEED}[options.set]
    cases = draw_cases(seed, tuple(options.vehicle or ("sedan2", "tractor5")))
    cases = [case for case in cases if options.only is None or options.only in case.name]
    known = {json.loads(line)["case"] for line in options.out.read_text().splitlines()} if options.out.is_file() else set()
    waiting = [case for case in cases if case.name not in known]
    with ProcessPoolExecutor(options.workers, mp_context=get_context("spawn")) as pool, options.out.open("a") as stream:
        for done in as_completed([pool.submit(solve, case) for case in waiting]):
            record = done.result()
            stream.write(json.dumps(record) + "\n")
            stream.flush()
            named = ", ".join(f"{effect['name']} at {effect['place']}" for effect in record.get("effects", []))
            truth = ", ".join(f"{effect['name']} at {effect['place']}" for effect in record["truth"]) or "nothing"
            print(f"{record['case']:32s} {record['verdict']:20s} {named:60s} truth {truth}  {record['seconds']:.0f} s", flush=True)
    records = [json.loads(line) for line in options.out.read_text().splitlines()]
    print(table(score(records)))


if __name__ == "__main__":
    main()
