"""Measure the kernels on this machine, beside what is installed that one might use instead."""

from __future__ import annotations

import argparse

from vehgen.commands.terminal import add_json, number_text, print_json, print_table

EXAMPLE = "vehgen bench --individuals 300"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the command's arguments."""
    parser.add_argument("--individuals", metavar="N", type=int, default=300, help="size of the population (default 300)")
    parser.add_argument("--seconds", metavar="S", type=float, default=10.0, help="simulated time (default 10 s)")
    add_json(parser)


def run(options: argparse.Namespace) -> None:
    """Print nanoseconds per step and individual of the five-axle vehicle, and how much slower its peers are."""
    from vehgen.errors import InputError
    from vehgen.simulate.benchmark import measure
    from vehgen.simulate.budgets import check_population

    if options.individuals < 1 or not 0.05 <= options.seconds <= 1000:
        raise InputError("--individuals must be at least 1 and --seconds between 0.05 and 1000")
    check_population(options.individuals, 100 * options.seconds, 2)
    result = measure(options.individuals, options.seconds)
    if options.json:
        print_json(result)
        return
    rows = [
        (
            case["name"],
            str(case["threads"]),
            f"{case['ns_per_step_individual']:.2f}",
            number_text(case["individuals_per_second"], 0),
            f"{case['peak_share']:.0%}",
        )
        for case in result["cases"]
    ]
    title = f"tractor5, {options.individuals} individuals, {options.seconds:g} s at 1 ms"
    print_table(
        title,
        ("kernel", "threads", "ns per step and individual", "individuals per second", "share of vector peak"),
        rows,
        right=(1, 2, 3, 4),
    )
    print_table(
        "Peers, times slower than vehgen on one thread",
        ("peer", "ratio"),
        [(name, number_text(ratio, 0)) for name, ratio in result["ratios"].items()],
        right=(1,),
    )
