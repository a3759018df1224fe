"""Equilibria as a balance of two momentum-like vectors: g x h = M.

Euler's equations D w' = H x w + M and the scaled system x' = h x g + mu (with g = (x1+a, x2, 0), h = (x1+b,
0, -x3)) have one form. Replacing g by g + h leaves g x h alone and turns the scaled system, for every a and
b, into

    (D y + lambda) x y + M = 0,   y = A x + u,   D = (1/2, 0, 1), lambda = ((b-a)/2, 0, 0), A = (2, 1, -1), u
    = (a+b, 0, 0).

So the equilibria of both are those of one Euler balance, with exact coefficients; D need not be positive.
"""
from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import NamedTuple

from ..numbers.vectors import CYCLE, Exact3, Number, Triple, cross, dot
from ..physics.scene import AnyScene, QuadraticForm

ONE, ZERO = Fraction(1), Fraction(0)


class Pencil(NamedTuple):
    """(D y + lam) x y + M = 0 with x_i = (y_i - u_i)/A_i; `form` gives the rates of x."""

    D: Exact3
    lam: Exact3
    M: Exact3
    A: Exact3
    u: Exact3
    form: QuadraticForm
    scaled: bool

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the three components of the state."""
        return tuple(f"{self.form.symbol}{i}" for i in (1, 2, 3))

    def turned(self, y: Sequence[Number]) -> Exact3:
        """D y."""
        return tuple(d * v for d, v in zip(self.D, y))

    def state(self, y: Sequence[Number]) -> Triple:
        """x from y; entries of any exact type."""
        return tuple((v + -u) * (1 / a) for v, u, a in zip(y, self.u, self.A))

    def torque_axis_moment(self) -> Fraction | None:
        """d with D M = d M where M is an eigenvector of D, None where it is not."""
        moments = {d for d, m in zip(self.D, self.M) if m}
        return moments.pop() if len(moments) == 1 else None


def pencil(scene: AnyScene) -> Pencil:
    """The balance of a Scene or ScaledGyrostat. Raises InputError for effects outside gyrostat and constant
    torque."""
    form = scene.quadratic()
    if scene.variables == "scaled":
        a, b = scene.exact_ab
        return Pencil((ONE / 2, ZERO, ONE), ((b - a) / 2, ZERO, ZERO), scene.exact_mu, (2 * ONE, ONE, -ONE),
                      (a + b, ZERO, ZERO), form, True)
    return Pencil(scene.body.exact, scene.vector("gyrostat"), scene.vector("constant_torque"), (ONE,) * 3,
                  (ZERO,) * 3,
                  form, False)


__all__ = ["CYCLE", "ONE", "ZERO", "Pencil", "cross", "dot", "pencil"]


def unit(i: int) -> Exact3:
    """Unit vector of axis i."""
    return tuple(ONE if n == i else ZERO for n in range(3))
