"""What sensors read, line by line, and its derivatives by their errors."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.signal

from vehgen.fit.reading import LOW_PASS_POWERS, Reading

FREQUENCY, RATE = np.linspace(0.5, 38.0, 40), 100.0
CHANNELS = (("a1", "a", "acceleration"), ("q1", "a", "pitch_rate"), ("a2", "b", "acceleration"))
ERRORS = {
    ("gain", "a1"): 0.02,
    ("gain", "a2"): -0.01,
    ("tilt", "a"): 0.05,
    ("position", "a"): 0.03,
    ("roll_off", "a"): 0.2,
    ("edge", "a"): 0.5,
    ("dispersion", "a"): 0.4,
    ("edge_dispersion", "b"): 20.0,
    ("dispersion", "b"): 0.1,
    ("lag", "a"): 0.002,
    ("clock", "b"): 0.004,
}


def reading(errors: dict[tuple[str, str], float]) -> Reading:
    """Return what the channels read with these errors."""
    clocks = [errors.get(("clock", sensor), 0.0) for _, sensor, _ in CHANNELS]
    late = np.array([clocks[0], clocks[1] + errors.get(("lag", "a"), 0.0), clocks[2]])
    return Reading.of(FREQUENCY, RATE, CHANNELS, errors, late)


def test_a_tilted_sensor_reads_its_part_of_gravity() -> None:
    """A body that pitches by e^(iwt) tilts its sensor's view of gravity; a place further forward feels the pitch acceleration."""
    omega = 2 * np.pi * FREQUENCY
    motion = np.column_stack([np.ones(40), 1j * omega, np.zeros(40)])
    read = reading({("tilt", "a"): 0.05, ("position", "a"): 0.1}).apply(motion)
    assert np.allclose(read[:, 0], np.cos(0.05) - 9.81 * np.sin(0.05) + 0.1 * omega**2, rtol=1e-3)
    assert np.allclose(read[:, 1:], motion[:, 1:])


def test_a_late_channel_turns_by_its_delay() -> None:
    """A sine that comes 4 ms late is e^(-iw 4 ms) of the one that came in time."""
    read = reading({("clock", "b"): 0.004}).apply(np.ones((40, 3), dtype=np.complex128))
    assert np.allclose(read[:, 2], np.exp(-2j * np.pi * FREQUENCY * 0.004))
    assert np.array_equal(read[:, :2], np.ones((40, 2)))


@pytest.mark.parametrize("error", ERRORS)
def test_derivatives_are_those_of_differences(error: tuple[str, str]) -> None:
    """Moving one error by a little changes what is read as its derivative says."""
    random = np.random.default_rng(3)
    lines = random.normal(size=(40, 3)) + 1j * random.normal(size=(40, 3))
    step = 1e-6
    ahead, behind = (reading(ERRORS | {error: ERRORS[error] + own}).apply(lines) for own in (step, -step))
    middle = reading(ERRORS)
    found = middle.slope(*error, lines, middle.apply(lines))
    assert np.abs(found).max() > 0.01
    assert np.allclose(found, (ahead - behind) / (2 * step), rtol=1e-5, atol=1e-5)


@pytest.mark.parametrize("share", [0.41, 0.46])
@pytest.mark.parametrize("kind", ["butterworth", "bessel"])
@pytest.mark.parametrize("order", [2, 4, 6, 8])
def test_errors_of_a_low_pass_follow_the_usual_ones(kind: str, order: int, share: float) -> None:
    """Within 1.5 % up to a quarter of the rate, whatever delay and gain a fit finds; compared is up to 0.4 of it, as by scipy.signal."""
    frequency = np.linspace(0.01, 0.4, 200)
    design = scipy.signal.butter if kind == "butterworth" else scipy.signal.bessel
    more = {} if kind == "butterworth" else {"norm": "mag"}
    _, factor = scipy.signal.freqs_zpk(*design(order, 2 * np.pi * share, analog=True, output="zpk", **more), 2 * np.pi * frequency)
    x = 2 * frequency
    off = np.ones(len(x))
    for turns, exponent in ((False, np.log(np.abs(factor))), (True, np.unwrap(np.angle(factor)))):
        own = [power for power, way in LOW_PASS_POWERS.values() if (way == 1j) == turns]
        columns = np.column_stack([x**power for power in [turns * 1, *own]])  # beside them a gain, or a delay
        left = exponent - columns @ np.linalg.lstsq(columns, exponent, rcond=None)[0]
        off = off * np.exp(1j * left if turns else left)
    assert np.abs(off - 1)[x < 0.5].max() < 0.015
