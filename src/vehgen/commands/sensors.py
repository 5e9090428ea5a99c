"""Advise how many sensors to mount, and where, by Fisher information."""

from __future__ import annotations

import argparse

from vehgen.commands.option_strings import split_list
from vehgen.commands.terminal import add_json, print_json, print_table

EXAMPLE = "vehgen sensors tractor5.yaml hump_2ms.yaml --count 3"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the command's arguments."""
    parser.add_argument("vehicle", metavar="VEHICLE", help="a vehicle file")
    parser.add_argument("run_file", metavar="RUN", help="the run that would be measured; its own sensors are ignored")
    parser.add_argument("--count", type=int, default=3, metavar="N", help="the largest number of sensors (default 3)")
    parser.add_argument("--parameters", metavar="P,Q", help="parameters that matter (default: all with a range)")
    add_json(parser)


def run(options: argparse.Namespace) -> None:
    """Print the best places for 1, 2, ... sensors."""
    from vehgen.calibrate import advise_sensors
    from vehgen.commands.progress import Bars

    with Bars(quiet=options.json) as bars:
        found = advise_sensors(
            options.run_file, options.count, parameters=split_list(options.parameters), vehicle=options.vehicle, progress=bars.tell
        )
    if options.json:
        print_json(
            {
                "best": [
                    {
                        "places": [{"body": place.body, "x_m": place.x, "words": place.words} for place in layout.places],
                        "mean_error": layout.score**0.5,
                        "errors": dict(zip(found.names, layout.error.tolist(), strict=True)),
                    }
                    for layout in found.best
                ],
                "single": [
                    {"body": place.body, "x_m": place.x, "mean_error": float(score) ** 0.5}
                    for place, score in zip(found.candidates, found.single, strict=True)
                ],
            }
        )
        return
    rows = []
    for size, layout in enumerate(found.best, start=1):
        poorest = sorted(zip(found.names, layout.error, strict=True), key=lambda pair: -pair[1])[:4]
        words = "; ".join(place.words for place in layout.places)
        errors = ", ".join(f"{name} {_percent(error)} %" for name, error in poorest)
        rows.append((str(size), words, _percent(layout.score**0.5), errors))
    title = "best places; errors are standard deviations of ln(parameter), of which 100 % were assumed known beforehand"
    print_table(title, ("sensors", "where", "error [%]", "poorest"), rows, right=(2,))


def _percent(error: float) -> str:
    """Return an error in percent, with two digits that count: of three sensors all may be below a tenth of one."""
    return f"{float(f'{100 * error:.2g}'):g}"
