"""Co-simulation units in tests: unpacked, loaded with ctypes, and called as an importer calls them."""

from __future__ import annotations

import ctypes
import zipfile
from xml.etree import ElementTree

import numpy as np

from tests.export.c_code import doubles

FOLDERS = {2: "linux64", 3: "x86_64-linux"}
VOID, REAL, TEXT, SIZE, FLAG = ctypes.c_void_p, ctypes.c_double, ctypes.c_char_p, ctypes.c_size_t, ctypes.c_int
LOGGER2 = ctypes.CFUNCTYPE(None, VOID, TEXT, ctypes.c_int, TEXT, TEXT)
LOGGER3 = ctypes.CFUNCTYPE(None, VOID, ctypes.c_int, TEXT, TEXT)


class Callbacks2(ctypes.Structure):
    """What an importer of FMI 2.0 hands over."""

    _fields_ = (("logger", LOGGER2), ("allocate", VOID), ("free", VOID), ("finished", VOID), ("environment", VOID))


class Unit:
    """A unit whose description is read and whose binary is loaded."""

    def __init__(self, path, folder):
        with zipfile.ZipFile(path) as archive:
            archive.extractall(folder)
        self.folder = folder
        self.root = ElementTree.parse(folder / "modelDescription.xml").getroot()
        self.version = int(self.root.get("fmiVersion")[0])
        self.token = self.root.get("guid" if self.version == 2 else "instantiationToken")
        self.variables = {item.get("name"): item for item in self.root.find("ModelVariables")}
        self.references = {name: int(item.get("valueReference")) for name, item in self.variables.items()}
        identifier = self.root.find("CoSimulation").get("modelIdentifier")
        self.library = ctypes.CDLL(str(folder / "binaries" / FOLDERS[self.version] / f"{identifier}.so"))
        self.messages = []
        self.keep = None

    def names(self, causality):
        return [name for name, item in self.variables.items() if item.get("causality") == causality]

    def function(self, name):
        return getattr(self.library, f"fmi{self.version}{name}")

    def call(self, name, *arguments):
        return self.function(name)(self.component, *arguments)

    def instantiate(self, token=None):
        """Return whether an instance was made."""
        token = (self.token if token is None else token).encode()
        if self.version == 2:
            logger = LOGGER2(lambda *message: self.messages.append(message[4]))
            self.keep = Callbacks2(logger, None, None, None, None)
            make = self.function("Instantiate")
            make.restype = VOID
            found = make(TEXT(b"unit"), FLAG(1), TEXT(token), TEXT(b""), ctypes.byref(self.keep), FLAG(0), FLAG(1))
        else:
            self.keep = LOGGER3(lambda _environment, _status, _category, message: self.messages.append(message))
            make = self.function("InstantiateCoSimulation")
            make.restype = VOID
            no = ctypes.c_bool(False)
            found = make(TEXT(b"unit"), TEXT(token), TEXT(b""), no, no, no, no, VOID(), SIZE(0), VOID(), self.keep, VOID())
        self.component = VOID(found)
        return found is not None

    def initialise(self, **parameters):
        assert self.instantiate()
        if self.version == 2:
            assert self.call("SetupExperiment", FLAG(0), REAL(0), REAL(0), FLAG(0), REAL(0)) == 0
            assert self.call("EnterInitializationMode") == 0
        else:
            no = ctypes.c_bool(False)
            assert self.call("EnterInitializationMode", no, REAL(0), REAL(0), no, REAL(0)) == 0
        if parameters:
            assert self.set(list(parameters), list(parameters.values())) == 0
        return self.call("ExitInitializationMode")

    def _exchange(self, verb, names, values):
        references = (ctypes.c_uint * len(names))(*(self.references[name] for name in names))
        more = () if self.version == 2 else (SIZE(len(names)),)
        return self.call(f"{verb}{'Real' if self.version == 2 else 'Float64'}", references, SIZE(len(names)), doubles(values), *more)

    def set(self, names, values):
        return self._exchange("Set", names, np.ascontiguousarray(values, dtype=np.float64))

    def get(self, names):
        values = np.full(len(names), np.nan)
        assert self._exchange("Get", names, values) == 0
        return values

    def step(self, now, duration):
        if self.version == 2:
            return self.call("DoStep", REAL(now), REAL(duration), FLAG(1))
        event, terminate, early = (ctypes.c_bool(True) for _ in range(3))
        last = REAL(-1)
        flags = (ctypes.byref(event), ctypes.byref(terminate), ctypes.byref(early), ctypes.byref(last))
        status = self.call("DoStep", REAL(now), REAL(duration), ctypes.c_bool(True), *flags)
        assert (event.value, terminate.value, early.value) == (False, False, False)
        assert status or last.value == now + duration
        return status

    def drive(self, excitation, model, every=1):
        """Return the outputs at every communication point of `every` steps; heights move at their rates between them."""
        outputs, heights, forces = self.names("output"), list(model.inputs), [f"force.{name}" for name in model.forces]
        rates = [f"{name}.rate" for name in heights]
        found = [self.get(outputs)]
        duration = every * excitation.dt
        points = range(0, excitation.n_steps, every)
        for n in points:
            slope = (excitation.inputs[n + every] - excitation.inputs[n]) / duration
            force = 0.5 * (excitation.forces[n] + excitation.forces[n + 1])
            assert self.set([*heights, *rates, *forces], [*excitation.inputs[n], *slope, *force]) == 0
            assert self.step(n * excitation.dt, duration) == 0
            assert self.set([*heights, *forces], [*excitation.inputs[n + every], *excitation.forces[n + every]]) == 0
            found.append(self.get(outputs))
        return np.array(found)
