"""Record what a user computes, and compare two records.

`python -m benchmarks.unchanged record NEW.json --silverbox SNLS80mV.csv`, then
`python -m benchmarks.unchanged compare benchmarks/unchanged/results/0.1.0.json NEW.json`.
"""

from __future__ import annotations

import argparse
import json
import os
from pathlib import Path

from benchmarks.unchanged.compare import report
from benchmarks.unchanged.record import SECTIONS, record

HERE = Path(__file__).resolve().parents[2]


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    tasks = parser.add_subparsers(dest="task", required=True)
    recording = tasks.add_parser("record", help="run the command lines and write what they compute")
    recording.add_argument("out", type=Path, help="the JSON file; sections it holds and that are not asked for stay")
    recording.add_argument("--only", metavar="A,B", default=",".join(SECTIONS), help=f"sections (default: {','.join(SECTIONS)})")
    recording.add_argument("--tree", type=Path, default=HERE, help="a clone of the code to be recorded (default: this one)")
    recording.add_argument(
        "--silverbox", type=Path, default=os.environ.get("SILVERBOX"), help="SNLS80mV.csv of that benchmark (default: $SILVERBOX)"
    )
    comparing = tasks.add_parser("compare", help="list what differs; exit code 1 if anything that was computed changed")
    comparing.add_argument("old", type=Path)
    comparing.add_argument("new", type=Path)
    comparing.add_argument("--tolerance", type=float, default=0.0, help="relative, for diagnoses and calibrations (default 0: equal)")
    comparing.add_argument("--wording", action="store_true", help="show sentences that are worded otherwise, too")
    options = parser.parse_args()
    if options.task == "record":
        sections = options.only.split(",")
        if unknown := [name for name in sections if name not in SECTIONS]:
            parser.error(f"no section {unknown[0]}; there are {', '.join(SECTIONS)}")
        if "silverbox" in sections and options.silverbox is None:
            parser.error("the section silverbox needs --silverbox SNLS80mV.csv, or --only without it")
        failed = record(options.out, sections, options.tree, options.silverbox)
        print("\n".join(f"failed: {item}" for item in failed))
        return int(bool(failed))
    old, new = (json.loads(path.read_text(encoding="utf-8")) for path in (options.old, options.new))
    lines, same = report(old, new, options.tolerance, options.wording)
    print("\n".join(lines))
    return int(not same)


if __name__ == "__main__":
    raise SystemExit(main())
