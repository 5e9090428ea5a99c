"""Draw the figures of docs/diagnose.md from docs/examples/hidden."""

from __future__ import annotations

from pathlib import Path

from vehgen.diagnose.pipeline import diagnose_trials
from vehgen.fit.trial import load_trials
from vehgen.report import save_figure
from vehgen.report.plots.diagnosis_plots import plot_places, plot_waterfall

HERE = Path(__file__).resolve().parents[1]
IMAGES = HERE / "images" / "diagnose"


def main() -> None:
    """Diagnose the hidden case and draw where, and how far."""
    found = diagnose_trials(load_trials(sorted((HERE / "examples" / "hidden").glob("*.yaml"))))
    IMAGES.mkdir(parents=True, exist_ok=True)
    save_figure(plot_places(found.evidence.places), IMAGES / "places.svg")
    save_figure(plot_waterfall(found), IMAGES / "steps.svg")


if __name__ == "__main__":
    main()
