"""What `calibrate` prints: what is told stands first, and what is not is never the last word."""

from dataclasses import replace

import numpy as np
import pytest

from tests.fit.recordings import sedan_truth, write_run
from vehgen.calibrate.calibration import Settings, calibrate_problem
from vehgen.calibrate.genetic import GeneticSearch
from vehgen.calibrate.result import CombinationSummary, FactAdvice, HeldMasses
from vehgen.calibrate.summary import summarise
from vehgen.commands import sensors
from vehgen.commands.calibration_tables import show_calibration
from vehgen.fit.problem import make_problem
from vehgen.fit.trial import load_trials
from vehgen.report.plots.calibration_plots import plot_intervals

KERB_MASS = FactAdvice("kerb mass", "kerb_mass: ...", 1700.0, 17.3, "kg", 0.2, 0.15, ("kf", "mf"))
FRONT = FactAdvice("load of front", "axle_weights: {front: ...}", 9000.0, 90.0, "N", 0.4, 0.1, ("mf",))


@pytest.fixture(scope="module")
def summary(tmp_path_factory):
    trials = load_trials([write_run(tmp_path_factory.mktemp("run"), "hump", sedan_truth())])
    return summarise(calibrate_problem(make_problem(trials), Settings(search=GeneticSearch(1, 10, 0), starts=1)), combinations=("kf/mf",))


@pytest.fixture(scope="module")
def open_summary(summary):
    """The summary of a vehicle that recordings tell but in part."""
    parameters = {name: replace(item, interval=None, status="unidentifiable") for name, item in summary.parameters.items()}
    directions = (dict.fromkeys(summary.parameters, 1.0),)
    told = {"kf/mH": CombinationSummary(40.0, (39.0, 41.0), "s^-2"), "kf/mf": CombinationSummary(700.0, None, "s^-2")}
    advice = (KERB_MASS, FRONT)
    return replace(
        summary, parameters=parameters, rank=9, pivots=("mf",), null_directions=directions, combinations=told, prior_data_advice=advice
    )


def printed(capsys, summary):
    show_calibration(summary)
    captured = capsys.readouterr()
    return " ".join(f"{captured.out} {captured.err}".split())


def test_runs_are_told_with_what_was_known_of_them(summary, capsys):
    text = printed(capsys, summary)
    speed = next(item for item in summary.conditions if item.name == "speed")
    assert f"{100 * speed.value:+.2f} % 1.00 % {speed.sigmas:+.2f}" in text
    assert f"{summary.run_chi2['hump']:.3f}" in text
    assert "kf/mf" in text


def test_masses_beside_tyres_without_damping_are_doubted(summary, capsys):
    assert "no damping to the tyres of front, rear" in printed(capsys, summary)
    assert "no damping" not in printed(capsys, replace(summary, undamped_tyres=()))


def test_it_is_said_what_hangs_on_masses_without_a_range(summary, capsys):
    text = printed(capsys, summary)
    assert "the file gives mH no range, and these recordings tell the rest only over mH" in text
    assert "1 % more would make mf, mr, IZ, kf, kr, cf, cr, ktf ... 1 % larger, and no interval knows of it" in text
    assert "the rest only over" not in printed(capsys, replace(summary, held_masses=None))
    uneven = HeldMasses(("mT", "mS"), {"kf": 1.0, "kr": -0.5})
    text = printed(capsys, replace(summary, held_masses=uneven))
    assert "1 % more would make other parameters: kf by +1.0 %, kr by -0.5 %" in text


def test_errors_near_what_was_known_are_counted_and_not_listed(summary, capsys):
    near = tuple(replace(item, sigmas=0.99) for item in summary.conditions)
    text = printed(capsys, replace(summary, conditions=near))
    told = {item.name for item in near if item.name in ("delay", "speed", "height", "clock")}
    always = [item for item in near if item.run == "hump" and item.name in told]
    assert "wander" not in text
    assert f"{sum(item.run == 'hump' for item in near) - len(always)} others within 1" in text
    far = (*near[:-1], replace(near[-1], name="wander", sigmas=-1.0))
    assert "wander" in printed(capsys, replace(summary, conditions=far))


def test_what_is_told_comes_before_what_is_not(open_summary, capsys):
    text = printed(capsys, open_summary)
    places = [
        text.index(part)
        for part in ("body heave", "39 to 41", "unidentifiable", "help most", "warning: recordings of these sensors can determine 9")
    ]
    assert places == sorted(places)
    assert "kf/mf 700 s^-2 unidentifiable" in text
    low, high = open_summary.parameters["kf"].interval_given_pivots
    assert "if mf were known" in text
    assert f"{low:.4g} to {high:.4g}" in text


def test_the_facts_that_help_most_are_asked_for_with_how_to_give_them(open_summary, capsys):
    text = printed(capsys, open_summary)
    assert "the kerb mass, known to 17 kg" in text
    assert "`kerb_mass: {value: ... kg, uncertainty: 17 kg}`" in text
    assert "then the load of front" in text
    assert "(narrower by half: " in text
    assert "narrower by half" not in printed(capsys, replace(open_summary, prior_data_advice=(replace(KERB_MASS, narrows=()),)))
    assert "help most" not in printed(capsys, replace(open_summary, prior_data_advice=(replace(KERB_MASS, width_left=0.95),)))


def test_channels_that_the_fit_does_not_explain_are_named_though_chi2_is_one(summary, capsys):
    text = printed(capsys, summary)
    assert "not explained" not in text
    assert "rougher than class" not in text
    apart = {**dict.fromkeys(summary.objective, 0.7), "hump: F_az": 0.95, "hump: R_az": 1.34}
    text = printed(capsys, replace(summary, objective=apart, run_chi2={"hump": 1.0}))
    assert "not explained by the fit, by the area between the PSDs: hump: R_az (1.34), hump: F_az (0.95); what the fit leaves" in text


@pytest.mark.parametrize(("level", "told"), [(1.5e-3, False), (3e-3, True)])
def test_a_road_too_rough_for_a_calibration_is_told(summary, capsys, level, told):
    """Class D of ISO 8608 ends at 2048e-6 m^3."""
    noise = tuple(replace(item, road_level_m3=np.array([1e-6, 0.1, 0.2, level, 1e-6])) for item in summary.noise)
    text = printed(capsys, replace(summary, noise=noise))
    assert ("hump: its road was taken to be rougher than class D beside what the run file states (0.003 m^3)" in text) == told


def test_wider_intervals_and_doubtful_runs_are_spoken_of(summary, capsys):
    far = tuple(replace(item, sigmas=-5.0, value=-0.05 if item.name == "speed" else item.value) for item in summary.conditions)
    text = printed(capsys, replace(summary, conditions=far, run_chi2={"hump": 2.25}, interval_inflation=1.5))
    assert "(chi2 2.25): all intervals are wider by the factor 1.50" in text
    assert text.count("hump: fitted far off what was known of it: ") == 1
    assert "speed (-5.0%, 5.0 standard deviations)" in text


def test_intervals_that_go_on_beyond_the_axis_end_in_an_arrow(summary):
    wide, name = dict(summary.parameters), next(iter(summary.parameters))
    wide[name] = replace(wide[name], interval=(0.5 * wide[name].value, 12 * wide[name].value), status="weak")
    for parameters, arrows in ((wide, [(">", 100.0)]), (summary.parameters, [])):
        figure = plot_intervals(replace(summary, parameters=parameters, modes=(), combinations={}))
        lines = [line for axes in figure.axes for line in axes.get_lines()]
        assert [(line.get_marker(), line.get_xdata()[0]) for line in lines if line.get_marker() in "<>"] == arrows


def test_errors_of_sensors_have_two_digits_that_count():
    assert [sensors._percent(error) for error in (0.00048, 0.00079, 0.1234, 1.0, 2.5, 0.0)] == ["0.048", "0.079", "12", "100", "250", "0"]
