"""The energy integrals G1, G2, G3 of Amer et al. 2024, eqs (25), (66), (79), in their corrected form.

Each is the energy of the reduced motion in the paper's scaled variables. With c = b - a, and with the unit
torque along the minor axis, or along the intermediate axis off and on its invariant planes,

    G1 = 2 x3^2 + x2^2 - (x1 + a)^2 - 4 c (x1 + a) - 4 theta,  theta = atan2(x1 + a, x2)
    G2 = 2 x2^2 + (x1 + b)^2 + x3^2 - 4 c (x1 + b) - 4 theta,  theta = atanh(x3/(x1 + b)), or of the inverse
    G3 = (x2^2 + x3^2)/2 - c x3 - ln|x3|  where x1 + b = x3,
         (x2^2 + x3^2)/2 + c x3 + ln|x3|  where x1 + b = -x3

so that G1 = 4 E + Q and G2 = 4 E + Q with the energy E and the invariant Q of `stabilab.motion`. Derivation,
and what the paper prints instead: docs/mathematics/reduction.md.

The same integrals exist for any wheel across the torque and any order of the moments (`_canonical`): on a
circle G1, on a hyperbola G2, on an invariant plane G3. A torque of negative sign is that of the motion turned
half round axis 1, (x1, -x2, -x3).
"""
from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

from ..numbers.exact import sqrt_fraction
from ..physics.scene import AnyScene
from .reduction import Reduction, reduce


@dataclass(frozen=True)
class EnergyIntegral:
    """One of the paper's energy integrals along a motion, dimensionless (scaled variables).

    name: "G1" (torque on the minor or the major axis), "G2" (on the intermediate axis) or "G3" (there, on
    an invariant plane). on_separatrix: G1s, G2s or G3s, its value at the saddle that decides the fate, None
    where no saddle stands ahead at this value of the other invariant. difference: on_separatrix - value,
    exact however near the two are; positive below the separatrix.
    """

    name: str
    value: float
    on_separatrix: float | None = None
    difference: float | None = None


def energy_integral(scene: AnyScene, state: Sequence[float | Fraction],
                    margin: float | None) -> EnergyIntegral | None:
    """The energy integral of the motion from `state` (three rates of the scene, each taken exactly).

    margin: the motion's margin in energy, in the scene's unit. None where the scene has no such integral:
    no torque along a principal axis, a wheel along the torque, two equal moments (no scaled variables), or a
    pure spin in the centre of the conic, where the angle is undefined; and where it is no double.
    """
    r = reduce(scene)
    if r is None or not r.sense or not r.geometry.centred:
        return None
    try:
        found = _canonical(r, [Fraction(v) for v in state])
        if found is None:
            return None
        name, value = found
        if margin is None:
            return EnergyIntegral(name, value)
        times = 1 if name == "G3" else 4
        difference = float(times * Fraction(margin) / (r.exact_energy_unit * r.exact_constants["mu"]))
    except OverflowError:  # squares of rates that are no doubles
        return None
    return EnergyIntegral(name, value, value + difference, difference)


def _canonical(r: Reduction, state: list[Fraction]) -> tuple[str, float] | None:
    """(name, value) from the canonical variables of `reduction`; None where the angle is undefined.

    Dividing energies by mu makes the torque 1, and X, Z times sqrt(|G|/mu) the paper's scaled components.
    """
    g = r.exact_constants
    x, z, w = r.canonical_exact(state)
    energy = 4 * (w * w / 2 - g["G"] * x * x / 2 - g["c"] * x - r.e * g["d"] * z) / g["mu"]
    if x == z == 0:
        return None
    if r.exact_invariant_sign(state) == 0:  # a plane X = Z or X = -Z: theta = ln|x|, or -ln|x|
        scaled = x * sqrt_fraction(abs(g["G"]) / g["mu"])
        return "G3", float(energy / 4) - math.copysign(1, x * z) * _log(abs(scaled))
    invariant = z * z - r.e * x * x
    quadratic = float(energy - r.e * g["G"] * invariant / g["mu"])
    if r.e > 0:
        quotient = abs((z + x) / (z - x))
        return "G2", quadratic - 2 * _log(quotient)
    # the sine is the component about the larger of the two other moments, x1 + a, with its own sign
    sine, cosine, sign = (x, z, g["flip"]) if g["G"] > 0 else (z, -x, math.copysign(1, g["rz"]))
    size = sign * max(abs(sine), abs(cosine))
    return "G1", quadratic - 4 * math.atan2(sine / size, cosine / size)


def _log(value: Fraction) -> float:
    """ln of a positive fraction of any size."""
    if 1e-3 < value < 1e3:
        return math.log(value)
    return math.log(value.numerator) - math.log(value.denominator)
