"""Phone exports for tests, written here from plain arrays."""

import io
import zipfile

import numpy as np

SHARED = "shared/data/phone/phyphox_multi_gps_comma_MIT"
SEPARATORS = {"comma": (",", "."), "tab": ("\t", "."), "semicolon": (";", "."), "tab-comma": ("\t", ","), "semicolon-comma": (";", ",")}


def still(n=400, rate=100.0, noise=0.01, seed=0):
    """A phone that lies flat, face up: times, specific force, rotation."""
    random = np.random.default_rng(seed)
    t = np.arange(n) / rate
    force = np.array([0.0, 0.0, 9.81]) + random.normal(0, noise, (n, 3))
    return t, force, random.normal(0, noise / 10, (n, 3))


def table(header, columns, dialect="comma", quote='"'):
    separator, point = SEPARATORS[dialect]
    lines = [separator.join(f"{quote}{name}{quote}" for name in header)]
    for row in np.column_stack(columns):
        cells = ["NaN" if np.isnan(value) else f"{value:.9E}".replace("E+0", "E").replace("E-0", "E-") for value in row]
        lines.append(separator.join(cells).replace(".", point))
    return "\n".join(lines) + "\n"


def phyphox(t, force, rotation, dialect="comma", start=1_700_000_000.0, speed=None):
    separator, point = SEPARATORS[dialect]
    files = {
        "Accelerometer.csv": table(["Time (s)", "X (m/s^2)", "Y (m/s^2)", "Z (m/s^2)"], [t, force], dialect),
        "Gyroscope.csv": table(["Time (s)", "X (rad/s)", "Y (rad/s)", "Z (rad/s)"], [t, rotation], dialect),
    }
    if start is not None:
        rows = [["START", "0.000E0", f"{start:.3f}", "text"], ["PAUSE", f"{t[-1]:.3f}", f"{start + t[-1]:.3f}", "text"]]
        head = separator.join(f'"{name}"' for name in ("event", "experiment time", "system time", "system time text"))
        files["meta/time.csv"] = "\n".join([head, *(separator.join(row).replace(".", point) for row in rows)]) + "\n"
    if speed is not None:
        moments = np.arange(0.5, t[-1], 1.0)
        columns = [moments, *(np.broadcast_to(value, len(moments)) for value in (48.0, 11.0, 500.0, speed, 90.0))]
        header = ["Time (s)", "Latitude (°)", "Longitude (°)", "Height (m)", "Velocity (m/s)", "Direction (°)"]
        files["Location.csv"] = table(header, columns, dialect)
    return files


def sensor_logger(t, force, rotation, start=1_700_000_000.0, names=("TotalAcceleration", "Gyroscope"), metadata=None):
    files = {}
    for name, values in zip(names, (force, rotation), strict=True):
        lines = ["time,seconds_elapsed,z,y,x"]
        lines += [
            f"{round((start + moment) * 1e9)},{moment:.6f},{z:.6f},{y:.6f},{x:.6f}" for moment, (x, y, z) in zip(t, values, strict=True)
        ]
        files[f"{name}.csv"] = "\n".join(lines) + "\n"
    if metadata is not None:
        files["Metadata.csv"] = f"version,device name,platform,standardisation\n1,phone,{metadata[0]},{metadata[1]}\n"
    return files


def write_zip(path, files, method=zipfile.ZIP_DEFLATED):
    data = io.BytesIO()
    with zipfile.ZipFile(data, "w", method) as archive:
        for name, text in files.items():
            archive.writestr(name, text)
    path.write_bytes(data.getvalue())
    return path


def write_folder(path, files):
    for name, text in files.items():
        (path / name).parent.mkdir(parents=True, exist_ok=True)
        (path / name).write_text(text, encoding="utf-8")
    return path
