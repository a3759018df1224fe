"""Torque-free motion of a body, with a gyrostatic moment or without: the saddles on its momentum sphere, and the margin in energy.

H = s omega at a permanent rotation. Where no component of lambda vanishes omega_i = lambda_i/(s - D_i), and on the sphere |H| = h the
speeds s are the roots of the sextic

    P(s) = (h(s)^2 - h^2) prod (s - D_i)^2,     h(s)^2 = sum s^2 lambda_i^2/(s - D_i)^2;

components that vanish, and the shared factors of equal moments, drop out of both products. A root is a saddle iff
s P'(s) prod (s - D_i) > 0, at a multiple root with the sign of P beyond it; one of even multiplicity is a fold. Where lambda_i = 0 there
are the rotations s = D_i as well; they are saddles iff D_i lies strictly between the other moments. A state lies on a separatrix iff its
energy is a saddle's, which a greatest common divisor decides exactly. Proofs: docs/mathematics/separatrix.md.

The margin is the nearest saddle's energy minus the motion's, at the same momentum: no choice of axes enters. It is positive where the motion
has less energy than the saddle (without a wheel: turns about the major axis), and negative where it has more.
"""
from __future__ import annotations

from fractions import Fraction
from math import isinf, nan
from typing import NamedTuple

from ...numbers.balls import FIRST_BITS, START_BITS, Unclear, polynomial, settled, shares_root, sign
from ...numbers.polynomial import Poly
from ...numbers.vectors import Number

EQUAL_BITS = 512  # two distances in energy that agree to so many bits count as equal
SHARE = 1e-12  # of the margin: with less certainty 64 bits do not settle it


def is_free(scene) -> bool:
    """Whether a scene is a body with its moments and no torque; scaled variables have no moments, and no sphere."""
    return scene.variables == "physical" and not any(scene.vector("constant_torque"))


def free_middle(D, lam) -> Fraction | None:
    """The moment strictly between the other two, where the gyrostatic moment has no component about it; else None."""
    middle = sorted(D)[1]
    return middle if D.count(middle) == 1 and not lam[D.index(middle)] else None


class FreeMargin(NamedTuple):
    """Energy of the saddle nearest in energy on the momentum sphere, minus the state's; of two as near the one above. ball: None
    where the sphere has no saddle; tie: the two are equal, by algebra."""

    ball: Number
    tie: bool

    def __float__(self):
        return float("inf") if self.ball is None else float(self.ball.mid())

    @property
    def double(self) -> float:
        """The margin as a double; NaN where it is none, or would be 0 without a tie."""
        height = float(self)
        return nan if self.ball is not None and not self.tie and (height == 0 or isinf(height)) else height


def free_margin(scene, state, digits: int = 17, doubles: bool = False) -> FreeMargin:
    """The margin of one state (three floats or Fractions, taken exactly) to `digits` decimal digits, in J.

    scene: physical, with no torque. doubles: 64 bits will do where the margin is certain to twelve digits.
    """
    body = _Momenta(scene, state)

    def question(numbers):
        bits = numbers.bits
        sharp = 10**digits if bits > FIRST_BITS else 1 / SHARE
        excesses = [(height - numbers.ball(body.energy), same) for height, same in body.saddles(numbers)]
        for excess, same in excesses:
            if 0 in excess:
                if bits == FIRST_BITS:
                    raise Unclear
                if same():
                    return FreeMargin(excess * 0, True)
                raise Unclear
        if not excesses:
            return FreeMargin(None, False)
        nearest = _nearest([excess for excess, _ in excesses], bits)
        if not abs(nearest) > sharp * nearest.rad():
            raise Unclear
        return FreeMargin(nearest, False)
    return settled(question, FIRST_BITS if doubles else START_BITS)


def _nearest(excesses, bits):
    """The one of least size; the greater where `EQUAL_BITS` do not tell two sizes apart."""
    best = excesses[0]
    for other in excesses[1:]:
        apart = abs(other) - abs(best)
        if 0 in apart and bits < EQUAL_BITS and sign(other) != sign(best):
            raise Unclear
        if apart < 0 or (0 in apart and other > best):
            best = other
    return best


class _Momenta:
    """The momentum sphere of one state: moments D, squares w of the gyrostatic moment about each different moment, h^2 and energy."""

    def __init__(self, scene, state):
        self.D, lam = scene.body.exact, scene.vector("gyrostat")
        self.middle = free_middle(self.D, lam)
        omega = [Fraction(v) for v in state]
        self.energy = sum(d * v * v for d, v in zip(self.D, omega)) / 2
        self.squared = sum((d * v + l) ** 2 for d, v, l in zip(self.D, omega, lam))
        self.w = {}
        for d, l in zip(self.D, lam):
            if l:
                self.w[d] = self.w.get(d, 0) + l * l
        self.sphere = self._numerator(self.w, Poly((0, 0, 1)), self.squared)

    def _numerator(self, weights, top, value) -> Poly:
        """sum weights_d top/(s - d)^2 - value, times prod (s - d)^2 over the moments d with a gyrostatic moment."""
        square = {d: Poly((d * d, -2 * d, 1)) for d in self.w}
        whole = Poly((-value,))
        for d in square:
            whole = whole * square[d]
        for d, weight in weights.items():
            part = top * weight
            for other in square:
                part = part if other == d else part * square[other]
            whole = whole + part
        return whole

    def saddles(self, numbers):
        """[(energy as a ball, whether it is the motion's)], the second a function without arguments."""
        level = self._numerator({d: d * w for d, w in self.w.items()}, Poly((1,)), 2 * self.energy)
        same = lambda s: lambda: shares_root(polynomial(*self.sphere.c), polynomial(*level.c), s)
        found = [(self._height(s, numbers.ball), same(s)) for s in self._speeds(numbers)]
        middle = self._about_middle()
        return found if middle is None else [*found, (numbers.ball(middle), lambda: middle == self.energy)]

    def _about_middle(self) -> Fraction | None:
        """Energy of the rotations s = D_i about a middle axis without a gyrostatic moment; None where the sphere has none."""
        middle = self.middle
        if middle is None or not self.squared:
            return None
        across = sum(w * (middle / (middle - d)) ** 2 for d, w in self.w.items())
        if across > self.squared:
            return None
        along = (self.squared - across) / middle  # D_i omega_i^2
        return (along + sum(d * w / (middle - d) ** 2 for d, w in self.w.items())) / 2

    def _speeds(self, numbers) -> list:
        """The speeds s of the other saddles, as balls."""
        roots = numbers.real_roots(self.sphere.c) if self.w else []
        gaps = [b - a for (a, _), (b, _) in zip(roots, roots[1:])]
        if not all(gap > 0 for gap in gaps):
            raise Unclear
        found, beyond = [], 1 if not roots else sign(numbers.ball(self.sphere.c[-1]))
        for s, many in reversed(roots):
            if many % 2:
                found += [s] if self._is_saddle(s, beyond, numbers.ball) else []
                beyond = -beyond
        return found

    def _is_saddle(self, s, beyond, ball) -> bool:
        if s.is_zero():
            return False
        side = beyond * sign(s)
        for d in self.D:
            gap = s - ball(d)
            if 0 in gap and not self.sphere(d):
                return False  # where the rotations s = D_i begin: those count, and only about a middle axis
            side *= sign(gap)
        return side > 0

    def _height(self, s, ball):
        """Kinetic energy of the permanent rotation of speed s."""
        gaps = [(s - ball(d), d * w) for d, w in self.w.items()]
        return sum((ball(weight) / (gap * gap) for gap, weight in gaps), ball(0)) / 2
