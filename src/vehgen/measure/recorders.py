"""Recorders by name: what is publicly known of the sensor chips in phones, as chains of acquisition.

Makers state where a chip's digital low-pass is 3 dB down, as a share of the rate at which it delivers; they seldom state its order, which
is therefore a guess that reproduces the stated delay where there is one. What an app or a system does between the chip and the file, such
as dropping samples, is not in it: where it matters, say `unknown` and let the recording tell. See docs/measurement.md.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from vehgen.measure.acquisition import UNKNOWN, AcquisitionChain, FilterKind


@dataclass(frozen=True)
class Recorder:
    """What is known of a recorder.

    Attributes
    ----------
    title
        What it is.
    filter, order
        Kind and order of its low-pass.
    share
        Its cut-off over the rate at which samples are delivered.
    source
        Where that is stated, and what is guessed.
    """

    title: str
    filter: FilterKind
    order: int
    share: float
    source: str

    def chain(self, rate: float) -> AcquisitionChain:
        """Return its chain where it delivers at `rate` [Hz]."""
        return AcquisitionChain(self.filter, self.order, self.share * rate) if self.filter != "unknown" else UNKNOWN


_APP = "hands on what the system delivers and filters nothing itself; the phone's chip decides, and the export may name it"
RECORDERS: Mapping[str, Recorder] = {
    "bosch_bmi160": Recorder(
        "Bosch BMI160, BMI260, BMI270 in normal filter mode",
        "butterworth",
        2,
        0.405,
        "data sheet: -3 dB at 40.5 Hz for 100 Hz, a quarter of it with fourfold oversampling; order guessed",
    ),
    "st_lsm6ds": Recorder(
        "ST LSM6DSM, LSM6DSO and relatives in high-performance mode",
        "butterworth",
        2,
        0.5,
        "data sheet: first digital low-pass at half of the output rate, at a quarter where the driver asks for it; order guessed",
    ),
    "invensense_icm206": Recorder(
        "InvenSense MPU-6500, ICM-20602, ICM-20690 with the low-pass that their Android drivers choose",
        "butterworth",
        2,
        0.448,
        "data sheet: 44.8 Hz with 4.88 ms of delay, the setting next below half of 100 Hz; a second order delays by 5.0 ms",
    ),
    "resampled": Recorder(
        "resampled in software behind a zero-phase low-pass at half of the new rate, as `vehgen import` does",
        "ideal",
        1,
        0.5,
        "what vehgen.phones.resampling does to a sensor that is faster than the recording",
    ),
    "phyphox_android": Recorder("phyphox on Android", "unknown", 1, 0.0, _APP),
    "phyphox_ios": Recorder("phyphox on iOS", "unknown", 1, 0.0, _APP),
    "sensor_logger": Recorder("Sensor Logger", "unknown", 1, 0.0, _APP),
    "matlab_mobile": Recorder("MATLAB Mobile", "unknown", 1, 0.0, _APP),
}
"""Recorders by the names that a run file may give as `acquisition`."""
