"""Make the phone exports of this folder: `python docs/examples/phones/make_exports.py`.

Two phones lie in a five-axle tractor-semitrailer like the bundled tractor5, whose calibratable parameters are all a few percent off (OFF
below), so that a calibration has something to find. It crosses a half-sine hump of 0.5 m x 0.03 m at 2.0 and at 3.0 m/s, tyres touching
the road in a point, and then drives over a class B road at 3.0 m/s whose profile was measured (road.csv).

The motion is integrated here by scipy's DOP853 from the equations of the vehicle as they stand in print (Wu & Li, Sensors 23(24), 9691,
2023, doi:10.3390/s23249691, with their signs put right), not by vehgen. Then the phones get what phones have: gravity, a tilt,
biases, noise, rounding, clocks of their own that jitter, and a GPS that is a little wrong.

| | phone 1 | phone 2 |
|---|---|---|
| app | phyphox, Android | Sensor Logger, iPhone without 'Standardise Units & Frames' (accelerations reversed) |
| place | L1: tractor, 0.29 m ahead of axle 1 | L2: semitrailer, 9.115 m behind the fifth wheel |
| top edge (y) | points forward | points to the left, so that x points forward |
| clock | its own | 0.18 s late (hump at 2 m/s), 0.35 s early (3 m/s), 0.05 s late (road) |
"""

from __future__ import annotations

import io
import zipfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicSpline

Array = NDArray[np.float64]
HERE = Path(__file__).parent
G = 9.81
MT = 8000.0
FILE = {
    "mS": 4.77, "IT": 45.75, "IS": 95.89, "m1": 0.11, "m2": 0.40, "m3": 0.48, "m4": 0.57, "m5": 0.34,
    "k1": 198.83, "k2": 93.02, "k3": 869.88, "k4": 537.26, "k5": 1313.27, "c1": 12.57, "c2": 33.04, "c3": 6.80, "c4": 36.52, "c5": 23.60,
    "kt1": 1460.53, "kt2": 4488.70, "kt3": 4360.85, "kt4": 2689.24, "kt5": 808.00, "a1": 0.97, "a2": 0.82, "b1": 1.32, "b6": 4.14,
}  # fmt: skip
"""The values of tractor5.yaml, all but the distances over the tractor's mass."""
OFF = {
    "mS": 1.03, "IT": 0.96, "IS": 1.04, "m1": 1.05, "m2": 0.96, "m3": 1.03, "m4": 0.97, "m5": 1.04,
    "k1": 1.04, "k2": 0.96, "k3": 1.03, "k4": 0.95, "k5": 1.04, "c1": 0.95, "c2": 1.06, "c3": 0.95, "c4": 1.05, "c5": 0.96,
    "kt1": 0.97, "kt2": 1.03, "kt3": 0.96, "kt4": 1.04, "kt5": 0.97, "a1": 0.98, "a2": 1.02, "b1": 1.02, "b6": 0.98,
}  # fmt: skip
"""The true vehicle's parameters over those of the file."""
L12, L13, L1H, LH4, LH5 = 3.46, 4.80, 3.75, 8.50, 9.73
WHEELS = np.array([0.0, L12, L13, L1H + LH4, L1H + LH5])
"""Axles behind axle 1 [m]."""
AHEAD_OF_AXLE1, BEHIND_HINGE = 0.29, 9.115
HUMP_AT, HUMP_LENGTH, HUMP_HEIGHT = 12.0, 0.5, 0.03
ACCELERATION_NOISE, ROTATION_NOISE = 0.012, 0.0007
"""Standard deviation of a sample [m/s^2], [rad/s]."""
ACCELERATION_STEP, ROTATION_STEP = 0.0024, 0.00027
"""Rounding of a sample."""


def matrices() -> tuple[Array, Array, Array, Array, dict[str, float]]:
    """Return M, C, K `shape (8, 8)`, the tyres' stiffnesses `shape (5,)` and the true parameters, for q = [z_T, th_T, th_S, z1..z5]."""
    p = {name: value * OFF[name] * (1.0 if name in ("a1", "a2", "b1", "b6") else MT) for name, value in FILE.items()}
    b1, b6, a1, a2, mass_s = p["b1"], p["b6"], p["a1"], p["a2"], p["mS"]
    b7 = L1H - b1
    mu = MT * mass_s / (MT + mass_s)
    M = np.zeros((8, 8))
    M[0, 0], M[0, 1], M[0, 2] = MT + mass_s, b7 * mass_s, b6 * mass_s
    M[1, 1] = p["IT"] + b7**2 * mass_s + mu * a1**2
    M[1, 2] = b6 * b7 * mass_s - mu * a1 * a2
    M[2, 2] = p["IS"] + b6**2 * mass_s + mu * a2**2
    M[:3, :3] = np.triu(M[:3, :3]) + np.triu(M[:3, :3], 1).T
    M[range(3, 8), range(3, 8)] = [p[f"m{i}"] for i in range(1, 6)]
    # rise of the bodies over each axle: [1, -(ahead of the tractor's COG), 0], or [1, b7, behind the hinge]
    rows = np.zeros((5, 8))
    rows[:, 0] = 1.0
    rows[:3, 1] = -b1, L12 - b1, L13 - b1
    rows[3:, 1] = b7
    rows[3:, 2] = LH4, LH5
    rows[range(5), range(3, 8)] = -1.0
    C = rows.T @ np.diag([p[f"c{i}"] for i in range(1, 6)]) @ rows
    K = rows.T @ np.diag([p[f"k{i}"] for i in range(1, 6)]) @ rows
    tyres = np.array([p[f"kt{i}"] for i in range(1, 6)])
    K[range(3, 8), range(3, 8)] += tyres
    return M, C, K, tyres, p


def drive(road: Callable[[Array], Array], speed: float, duration: float) -> dict[str, dict[str, CubicSpline]]:
    """Return what each phone's place does over time: rise `az`, fore-aft `ax` [m/s^2], `pitch` [rad] and `rate` [rad/s]."""
    M, C, K, tyres, p = matrices()
    inverse = np.linalg.inv(M)
    system = np.block([[np.zeros((8, 8)), np.eye(8)], [-inverse @ K, -inverse @ C]])
    push = np.zeros((16, 5))
    push[8:] = inverse[:, 3:] * tyres

    def slope(t: float, x: Array) -> Array:
        return system @ x + push @ road(speed * t - WHEELS)

    times = np.arange(0.0, duration, 0.002)
    solution = solve_ivp(slope, (0.0, duration), np.zeros(16), "DOP853", times, rtol=1e-8, atol=1e-11, max_step=0.002)
    x = solution.y
    acceleration = (system @ x + push @ np.array([road(speed * t - WHEELS) for t in times]).T)[8:]
    share = p["mS"] / (MT + p["mS"])
    fore = p["a1"] * acceleration[1] - p["a2"] * acceleration[2]
    b7 = L1H - p["b1"]
    places = {
        "L1": (acceleration[0] - (p["b1"] + AHEAD_OF_AXLE1) * acceleration[1], -share * fore + 0.3 * acceleration[1], 1),
        "L2": (acceleration[0] + b7 * acceleration[1] + BEHIND_HINGE * acceleration[2], (1 - share) * fore - 0.4 * acceleration[2], 2),
    }
    return {
        name: {key: CubicSpline(times, values) for key, values in (("az", az), ("ax", ax), ("pitch", x[body]), ("rate", x[8 + body]))}
        for name, (az, ax, body) in places.items()
    }


def hump(s: Array) -> Array:
    """Return the hump's height [m]."""
    local = (s - HUMP_AT) / HUMP_LENGTH
    return np.where((local > 0) & (local < 1), HUMP_HEIGHT * np.sin(np.pi * np.clip(local, 0, 1)), 0.0)


def class_b(random: np.random.Generator) -> tuple[Array, Array]:
    """Return an ISO 8608 class B profile, every 5 cm: even for 3 m, then Gd(n) = 64e-6 (n/0.1)^-2 m^3 from 0.02 to 4 cycles/m."""
    s = np.arange(0.0, 60.0 + 1e-9, 0.05)
    step = 0.01
    n = np.arange(0.02, 4.0, step)
    amplitude = np.sqrt(2 * 64e-6 * (n / 0.1) ** -2 * step)
    height = (amplitude * np.cos(2 * np.pi * n * s[:, None] + random.uniform(0, 2 * np.pi, len(n)))).sum(axis=1)
    ramp = 0.5 - 0.5 * np.cos(np.pi * np.clip((s - 3.0) / 3.0, 0, 1))
    return s, np.round(ramp * height, 5)


def tilted(roll: float, pitch: float, turn: float) -> Array:
    """Return the rotation from the vehicle's axes (forward, left, up) to a phone's, angles in degrees; without any, x points forward."""
    r, p, t = np.radians([roll, pitch, turn])
    about_z = np.array([[np.cos(t), np.sin(t), 0], [-np.sin(t), np.cos(t), 0], [0, 0, 1]])
    about_y = np.array([[np.cos(p), 0, -np.sin(p)], [0, 1, 0], [np.sin(p), 0, np.cos(p)]])
    about_x = np.array([[1, 0, 0], [0, np.cos(r), np.sin(r)], [0, -np.sin(r), np.cos(r)]])
    return about_x @ about_y @ about_z


def clock(duration: float, rate: float, random: np.random.Generator) -> Array:
    """Return a phone's sampling times [s]."""
    count = int(duration * rate)
    return random.uniform(0, 0.02) + np.arange(count) / rate + np.clip(random.normal(0, 0.0008, count), -0.003, 0.003)


def sense(motion: dict[str, CubicSpline], frame: Array, duration: float, rates: tuple[float, float], random: np.random.Generator) -> tuple:
    """Return (times, specific force [m/s^2]) and (times, rotation [rad/s]) as a phone reads them."""
    ta, tg = (clock(duration, rate, random) for rate in rates)
    force = np.column_stack([motion["ax"](ta) - G * motion["pitch"](ta), 0 * ta, motion["az"](ta) + G])
    rotation = np.column_stack([0 * tg, motion["rate"](tg), 0 * tg])
    force = force @ frame.T + random.normal(0, 0.02, 3) + random.normal(0, ACCELERATION_NOISE, force.shape)
    rotation = rotation @ frame.T + random.normal(0, 0.002, 3) + random.normal(0, ROTATION_NOISE, rotation.shape)
    return ta, np.round(force / ACCELERATION_STEP) * ACCELERATION_STEP, tg, np.round(rotation / ROTATION_STEP) * ROTATION_STEP


def number(value: float) -> str:
    """Write a number as phyphox does."""
    mantissa, _, exponent = f"{value:.6e}".partition("e")
    return f"{mantissa}E{int(exponent)}"


def table(header: str, rows: Array, write: Callable[[float], str], separator: str = ",") -> str:
    """Return a CSV table."""
    return "\n".join([header, *(separator.join(write(value) for value in row) for row in rows)]) + "\n"


def phyphox_files(reading: tuple, gps: Array, start: float, duration: float) -> dict[str, str]:
    """Return the files of a phyphox export."""
    ta, force, tg, rotation = reading
    place = np.column_stack([gps[:, 0], 48.1 + 0 * gps[:, 0], 11.5 + 0 * gps[:, 0], 500 + 0 * gps[:, 0], gps[:, 1], 90 + 0 * gps[:, 0]])
    return {
        "Accelerometer.csv": table('"Time (s)","X (m/s^2)","Y (m/s^2)","Z (m/s^2)"', np.column_stack([ta, force]), number),
        "Gyroscope.csv": table('"Time (s)","X (rad/s)","Y (rad/s)","Z (rad/s)"', np.column_stack([tg, rotation]), number),
        "Location.csv": table('"Time (s)","Latitude (°)","Longitude (°)","Height (m)","Velocity (m/s)","Direction (°)"', place, number),
        "meta/time.csv": '"event","experiment time","system time","system time text"\n'
        f'"START",0.000000000E0,{start:.3f},""\n"PAUSE",{number(duration)},{start + duration:.3f},""\n',
    }


def sensor_logger_files(reading: tuple, gps: Array, start: float) -> dict[str, str]:
    """Return the files of a Sensor Logger export from an iPhone whose accelerations are reversed."""
    ta, force, tg, rotation = reading

    def sensor(t: Array, xyz: Array) -> str:
        lines = ["time,seconds_elapsed,z,y,x"]
        for moment, (x, y, z) in zip(t, xyz, strict=True):
            lines.append(f"{round((start + moment) * 1e6) * 1000},{moment:.6f},{z:.6f},{y:.6f},{x:.6f}")
        return "\n".join(lines) + "\n"

    places = [f"{round((start + t) * 1e6) * 1000},{t:.6f},90,{v:.3f},500,11.5,48.1" for t, v in gps]
    return {
        "TotalAcceleration.csv": sensor(ta, -force),
        "Gyroscope.csv": sensor(tg, rotation),
        "Location.csv": "\n".join(["time,seconds_elapsed,bearing,speed,altitude,longitude,latitude", *places]) + "\n",
        "Metadata.csv": f"version,device name,recording epoch time,platform,standardisation\n3,phone,{round(start * 1e3)},ios,false\n",
    }


def write_zip(path: Path, files: dict[str, str]) -> None:
    """Write a zip file that is the same every time."""
    data = io.BytesIO()
    with zipfile.ZipFile(data, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        for name, text in files.items():
            archive.writestr(zipfile.ZipInfo(name, (2026, 1, 1, 0, 0, 0)), text, zipfile.ZIP_DEFLATED, 9)
    path.write_bytes(data.getvalue())


def main() -> None:
    """Write the exports of the three passes, and the road's profile."""
    random = np.random.default_rng(20260101)
    s, height = class_b(random)
    lines = [f"{a:.2f},{b:.5f}" for a, b in zip(s, height, strict=True)]
    (HERE / "road.csv").write_text("\n".join(["distance,height", *lines]) + "\n", encoding="utf-8")

    def measured(x: Array) -> Array:
        return np.interp(x, s, height)

    frames = tilted(2.0, -3.0, -90.0), tilted(-1.5, 4.0, 0.0)
    epoch = 1_790_000_000.0
    for name, road, speed, duration, late in (
        ("hump_2ms", hump, 2.0, 20.0, 0.18),
        ("hump_3ms", hump, 3.0, 16.0, -0.35),
        ("road_3ms", measured, 3.0, 21.0, 0.05),
    ):
        motion = drive(road, speed, duration + 0.5)
        before = 3.0 if name == "road_3ms" else 0.0
        began = (before, before + 1.7)  # on each phone's clock; phone 2 was started 1.7 s earlier
        epoch += 600.0
        for phone, (place, frame) in enumerate(zip(("L1", "L2"), frames, strict=True)):
            shifted = {key: _later(spline, began[phone]) for key, spline in motion[place].items()}
            reading = sense(shifted, frame, duration, ((100.4, 99.2), (100.0, 100.0))[phone], random)
            seconds = np.arange(0.4, duration, 1.0)
            gps = np.column_stack([seconds, speed + random.normal(0, 0.03, len(seconds))])
            if phone == 0:
                write_zip(HERE / f"{name}_phone1.zip", phyphox_files(reading, gps, epoch, duration))
            else:
                write_zip(HERE / f"{name}_phone2.zip", sensor_logger_files(reading, gps, epoch - 1.7 + late))


def _later(spline: CubicSpline, delay: float) -> Callable[[Array], Array]:
    """Return a motion that begins `delay` later, from rest."""
    return lambda t: np.where(t < delay, 0.0, spline(np.maximum(t - delay, 0.0)))


if __name__ == "__main__":
    main()
