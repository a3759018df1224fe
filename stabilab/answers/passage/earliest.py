"""A time before which no motion can reach a limit, whatever it does on the way: the torque feeds energy at a bounded rate.

Let W = (omega . D omega)^(1/2), the root of twice the kinetic energy. The torque alone does work, so that W W' = M . omega, and with
M . omega <= |D^(-1/2) M| W

    W(t) <= W(0) + |D^(-1/2) M| t.

A quantity sum c (a . omega)^2 is at most q W^2, q the sum of the c a . D^(-1) a, or the greatest of them where the a are different principal axes. It
reaches its limit no earlier than q W^2 does.
"""
from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

from ...numbers.exact import sqrt_fraction
from ...numbers.vectors import Number
from ...physics.scene import AnyScene
from .limit import Limit

LESS = 1 - Fraction(1, 1 << 60)  # the roots are known to 2^-240


def earliest(scene: AnyScene, start: Sequence[Number], limit: Limit) -> Fraction:
    """The time in the scene's unit, exact; 0 where nothing is known (scaled variables, tilts). scene: wheel and torque; start: three exact rates."""
    if scene.variables == "scaled" or limit.kind == "tilt":
        return Fraction(0)
    D = scene.body.exact
    torque = scene.vector("constant_torque")
    push = sqrt_fraction(sum((Fraction(m) ** 2 / d for m, d in zip(torque, D)), Fraction(0)))
    if not push:
        return Fraction(0)
    begun = sqrt_fraction(sum((d * Fraction(w) ** 2 for d, w in zip(D, start)), Fraction(0)))
    least = min(most / _share(terms, D) for terms, most in limit.parts)
    return max(Fraction(0), (sqrt_fraction(least) * LESS - begun) / push * LESS)


def _share(terms: Sequence[Any], D: Sequence[Fraction]) -> Fraction:
    """q of a sum of squares."""
    shares = [c * sum(Fraction(v) ** 2 / d for v, d in zip(vector, D)) for c, vector in terms]
    axes = [[n for n, v in enumerate(vector) if v] for _, vector in terms]
    apart = all(len(one) == 1 for one in axes) and len({one[0] for one in axes}) == len(axes)
    return max(shares) if apart else sum(shares, Fraction(0))
