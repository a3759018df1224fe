"""Equilibria of a free body with a damper inside: permanent rotations, and which of them attract.

At an equilibrium the damper's sphere is at rest in the body: sigma' + omega' = 0 gives c sigma/k = -omega x
sigma, whose product with sigma is c |sigma|^2/k = 0. So the equilibria are those of the body alone. The
damper keeps |H| and takes energy at every rotation that is not permanent, as a liquid in a cavity does, so
that the same rotations attract; the eigenvalues are the damper's own.
"""
from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from fractions import Fraction
from typing import Any

from ..numbers.vectors import CYCLE
from ..physics.coefficients import Content
from .liquid import liquid_equilibria
from .result import Equilibria, EquilibriumCurve, EquilibriumPoint
from .stability import ordered


def damped_equilibria(parts: Content) -> Equilibria:
    """Every permanent rotation with its stability; undecided beside a torque, a medium, a liquid or a wheel.
    """
    if any(parts.M) or parts.c or parts.damped or parts.kappa or any(parts.Lambda):
        return Equilibria("undecided",
                          "undecided: with a damper the stability of equilibria is known of a free body "
                          "without wheels")
    found = liquid_equilibria(replace(parts, inside=Fraction(0), kappa=Fraction(1)))  # verdicts of any liquid
    return Equilibria(found.kind, _of_damper(found.reason),
                      tuple(_point(parts, point) for point in found.points),
                      tuple(_curve(parts, curve) for curve in found.curves))


def _of_damper(words: str) -> str:
    return words.replace("the liquid", "the damper")


def _curve(parts: Content, curve: EquilibriumCurve) -> EquilibriumCurve:
    return replace(curve, samples=tuple(_point(parts, point) for point in curve.samples),
                   segments=tuple(replace(one, because=_of_damper(one.because)) for one in curve.segments))


def _point(parts: Content, point: EquilibriumPoint) -> EquilibriumPoint:
    import numpy as np
    return replace(point, eigenvalues=ordered(np.linalg.eigvals(jacobian(parts, point.at))),
                   because=_of_damper(point.because))


def jacobian(parts: Content, omega: Iterable[float]) -> Any:
    """(6, 6) array at a permanent rotation, of (omega, sigma)."""
    import numpy as np
    w, D, k = list(omega), [float(d) for d in parts.D], float(parts.inside)
    c = float(parts.friction)
    found = np.zeros((6, 6))
    for i, (j, l) in enumerate(CYCLE):
        found[i, j], found[i, l] = (D[j] - D[l]) * w[l] / (D[i] - k), (D[j] - D[l]) * w[j] / (D[i] - k)
        found[i, 3 + i] = c / (D[i] - k)
        found[3 + i, 3 + i], found[3 + i, 3 + l], found[3 + i, 3 + j] = -c / k, -w[j], w[l]
    found[3:] -= found[:3]
    return found
