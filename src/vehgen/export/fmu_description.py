"""The description of a co-simulation unit (FMI 2.0.4 and 3.0.1, fmi-standard.org): modelDescription.xml and its companions."""

from __future__ import annotations

from collections.abc import Sequence
from xml.etree import ElementTree

from vehgen.errors import escaped
from vehgen.export.fmu_variables import FmuVariable, base_unit
from vehgen.export.source import ExportSource
from vehgen.files.provenance import versions

STOP_TIME = 3.0
"""How long a unit is suggested to run [s]."""


def describe_fmi2(source: ExportSource, variables: Sequence[FmuVariable], identifier: str, token: str, files: Sequence[str]) -> bytes:
    """Return modelDescription.xml of FMI 2.0.

    Parameters
    ----------
    source, variables
        What is described.
    identifier
        The name of its binary.
    token
        The GUID that the binary asks for.
    files
        Its sources.
    """
    root = _root(source, "2.0")
    root.set("guid", token)
    root.set("numberOfEventIndicators", "0")
    simulation = ElementTree.SubElement(
        root,
        "CoSimulation",
        modelIdentifier=identifier,
        canHandleVariableCommunicationStepSize="true",
        canGetAndSetFMUstate="true",
        canNotUseMemoryManagementFunctions="true",
    )
    listed = ElementTree.SubElement(simulation, "SourceFiles")
    for name in files:
        ElementTree.SubElement(listed, "File", name=name)
    _common(root, source, variables)
    held = ElementTree.SubElement(root, "ModelVariables")
    for reference, item in enumerate(variables):
        scalar = ElementTree.SubElement(held, "ScalarVariable", {"valueReference": str(reference), **_attributes(item)})
        ElementTree.SubElement(scalar, "Real", _numbers(item))
    structure = ElementTree.SubElement(root, "ModelStructure")
    for key in ("Outputs", "InitialUnknowns"):
        unknowns = ElementTree.SubElement(structure, key)
        for place, item in enumerate(variables, 1):
            if item.causality == "output":
                ElementTree.SubElement(unknowns, "Unknown", index=str(place))
    return _xml(root)


def describe_fmi3(source: ExportSource, variables: Sequence[FmuVariable], identifier: str, token: str) -> bytes:
    """Return modelDescription.xml of FMI 3.0; arguments as for :func:`describe_fmi2`."""
    root = _root(source, "3.0")
    root.set("instantiationToken", token)
    ElementTree.SubElement(
        root,
        "CoSimulation",
        modelIdentifier=identifier,
        canHandleVariableCommunicationStepSize="true",
        canGetAndSetFMUState="true",
    )
    _common(root, source, variables)
    held = ElementTree.SubElement(root, "ModelVariables")
    for reference, item in enumerate(variables):
        ElementTree.SubElement(held, "Float64", {"valueReference": str(reference), **_attributes(item), **_numbers(item)})
    last = str(len(variables))
    ElementTree.SubElement(
        held, "Float64", name="time", valueReference=last, causality="independent", variability="continuous", description="time"
    )
    structure = ElementTree.SubElement(root, "ModelStructure")
    for key in ("Output", "InitialUnknown"):
        for reference, item in enumerate(variables):
            if item.causality == "output":
                ElementTree.SubElement(structure, key, valueReference=str(reference))
    return _xml(root)


def describe_build(identifier: str, files: Sequence[str]) -> bytes:
    """Return sources/buildDescription.xml of FMI 3.0: how the binary is made of its sources."""
    root = ElementTree.Element("fmiBuildDescription", fmiVersion="3.0")
    configuration = ElementTree.SubElement(root, "BuildConfiguration", modelIdentifier=identifier)
    listed = ElementTree.SubElement(configuration, "SourceFileSet", language="C99")
    for name in files:
        ElementTree.SubElement(listed, "SourceFile", name=name)
    return _xml(root)


def _root(source: ExportSource, version: str) -> ElementTree.Element:
    vehicle = source.model.vehicle
    return ElementTree.Element(
        "fmiModelDescription",
        fmiVersion=version,
        modelName=escaped(vehicle.name),
        description=escaped(vehicle.title),
        generationTool=f"vehgen {versions(())['vehgen']}",
        variableNamingConvention="flat",
    )


def _common(root: ElementTree.Element, source: ExportSource, variables: Sequence[FmuVariable]) -> None:
    """Add the units, the log categories and the suggested run."""
    units = sorted({item.unit for item in variables if item.unit is not None} | {"s"})
    defined = ElementTree.SubElement(root, "UnitDefinitions")
    for unit in units:
        element = ElementTree.SubElement(defined, "Unit", name=unit)
        if (powers := base_unit(unit)) is not None:
            ElementTree.SubElement(element, "BaseUnit", powers)
    categories = ElementTree.SubElement(root, "LogCategories")
    ElementTree.SubElement(categories, "Category", name="logStatusError")
    ElementTree.SubElement(root, "DefaultExperiment", startTime="0.0", stopTime=repr(STOP_TIME), stepSize=repr(source.step))


def _attributes(item: FmuVariable) -> dict[str, str]:
    found = {"name": item.name, "causality": item.causality, "variability": item.variability, "description": item.meaning}
    return found if item.causality == "input" else {**found, "initial": "calculated" if item.start is None else "exact"}


def _numbers(item: FmuVariable) -> dict[str, str]:
    unit = {} if item.unit is None else {"unit": item.unit}
    return unit if item.start is None else {**unit, "start": repr(item.start)}


def _xml(root: ElementTree.Element) -> bytes:
    ElementTree.indent(root)
    text: str = ElementTree.tostring(root, encoding="unicode")
    return f'<?xml version="1.0" encoding="UTF-8"?>\n{text}\n'.encode()
