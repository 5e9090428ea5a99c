"""Effects of measuring: gain, position, tilt and delay of a phone, and a wrong speed."""

from __future__ import annotations

from benchmarks.hidden_effects.generator.effects.kind import EffectKind, Value, Values, channels, everywhere, sensors
from benchmarks.hidden_effects.generator.setup import Setup


def _gain(setup: Setup, place: str, p: Values) -> None:
    sensor, channel = place.rsplit("_", 1)
    setup.readings[sensor].gains[channel] *= 1.0 + p["error"]


def _position(setup: Setup, place: str, p: Values) -> None:
    setup.readings[place].shift += p["shift"]


def _tilt(setup: Setup, place: str, p: Values) -> None:
    setup.readings[place].tilt += p["angle"]


def _delay(setup: Setup, place: str, p: Values) -> None:
    setup.readings[place].delay += p["time"]


def _speed(setup: Setup, place: str, p: Values) -> None:
    setup.speed_error += p["error"]


MEASUREMENT = (
    EffectKind(
        "sensor_gain", "the channel reads (1 + error) times what it should", channels,
        (Value("error", "-", "relative error of the gain", (0.05, 0.1), (0.15, 0.3), neutral=0.0),), _gain,
    ),
    EffectKind(
        "sensor_position", "the phone sits `shift` further ahead than noted", sensors,
        (Value("shift", "m", "ahead of the noted place", (0.1, 0.2), (0.4, 1.0), neutral=0.0),), _position,
    ),
    EffectKind(
        "sensor_tilt", "the phone is tilted nose-down by `angle`: it reads z'' cos(angle) + x'' sin(angle) - g theta sin(angle) "
        "(its reading at rest taken off)", sensors,
        (Value("angle", "rad", "tilt about the pitch axis, nose-down positive", (0.1, 0.2), (0.35, 0.6), neutral=0.0),), _tilt,
    ),
    EffectKind(
        "sensor_delay", "the phone's clock is late: both channels read what was `time` earlier", sensors,
        (Value("time", "s", "delay", (0.002, 0.004), (0.01, 0.03), neutral=0.0),), _delay,
    ),
    EffectKind(
        "speed_error", "the vehicle is faster than noted by the share `error`", everywhere,
        (Value("error", "-", "relative error of the speed", (0.003, 0.006), (0.02, 0.06), neutral=0.0),), _speed,
    ),
)  # fmt: skip
