"""Panels of several layers as one equivalent layer that stretches, bends and weighs the same.

Wu & Li 2023 (doi:10.3390/s23249691, Fig. 9a) keep sum(t E) only; here the bending stiffness is kept as well: with the plane-stress
membrane stiffness A and bending stiffness D of the stack, a homogeneous layer of thickness t_e = sqrt(12 D/A) and modulus
E_e = (1 - nu_e^2) A/t_e has both.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass


@dataclass(frozen=True)
class Layer:
    """A layer of an isotropic material: thickness [m], modulus [Pa], Poisson's ratio, density [kg/m^3]."""

    thickness: float
    modulus: float
    poisson: float
    density: float


def equivalent_layer(layers: Sequence[Layer], bonded: bool = True) -> Layer:
    """Return one layer with the membrane stiffness A11, bending stiffness D11 and mass of a stack.

    Parameters
    ----------
    layers
        From one side to the other; at least one has a modulus above 0 (a layer without only weighs and keeps distance).
    bonded
        True: the stack bends as one about its neutral axis, D = sum of integral Q z^2. False: the layers slide on each other,
        D = sum Q t^3/12.

    Notes
    -----
    Poisson's ratio is that of the membrane, A12/A11; for layers that differ in it, D12 is only near the stack's. The coupling of stretching
    and bending of an unsymmetric stack vanishes, because A and D are taken about the neutral axis. Shear deformation of a soft core is not
    kept: a sandwich comes out too stiff.
    """
    plane = [layer.modulus / (1 - layer.poisson**2) for layer in layers]
    membrane = sum(q * layer.thickness for q, layer in zip(plane, layers, strict=True))
    coupled = sum(q * layer.poisson * layer.thickness for q, layer in zip(plane, layers, strict=True))
    own = sum(q * layer.thickness**3 / 12 for q, layer in zip(plane, layers, strict=True))
    bending = own
    if bonded:
        heights = []
        height = 0.0
        for layer in layers:
            heights.append(height + layer.thickness / 2)
            height += layer.thickness
        stretches = [q * layer.thickness for q, layer in zip(plane, layers, strict=True)]
        neutral = sum(a * z for a, z in zip(stretches, heights, strict=True)) / membrane
        bending += sum(a * (z - neutral) ** 2 for a, z in zip(stretches, heights, strict=True))
    poisson = coupled / membrane
    thickness = math.sqrt(12 * bending / membrane)
    mass = sum(layer.density * layer.thickness for layer in layers)
    return Layer(thickness, (1 - poisson**2) * membrane / thickness, poisson, mass / thickness)
