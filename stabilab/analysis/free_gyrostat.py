"""Torque-free motion with a gyrostatic moment that has no zero component: the saddles on its momentum sphere.

H = s omega at a permanent rotation, so omega_i = lambda_i/(s - D_i), and on the sphere |H| = h the speeds s are the roots of

    P(s) = (h(s)^2 - h^2) prod (s - D_i)^2,     h(s)^2 = sum s^2 lambda_i^2/(s - D_i)^2,

a sextic. The kinetic energy restricted to the sphere has the second derivative diag(1/D_i - 1/s) across H, whose determinant has
the sign of prod (s - D_i) sum lambda_i^2 D_i/(s - D_i)^3; and (h^2)'/2 = -s sum lambda_i^2 D_i/(s - D_i)^3. So a root is a saddle iff
s P'(s) prod (s - D_i) > 0, at a multiple root with the sign of P beyond it; one of even multiplicity is a fold.

A state lies on a separatrix iff its energy is a saddle's: the level line of the saddle is a quartic with a node, so either
rational, and then its real points are the two loops alone, or two conics through two saddles. Both energies are rational
functions of one root, so a greatest common divisor decides exactly.
"""
from __future__ import annotations

from fractions import Fraction
from typing import NamedTuple

from .balls import START_BITS, Unclear, settled, sign
from .exact_tie import polynomial, shares_root
from .polynomials import Poly


class FreeMargin(NamedTuple):
    """Energy of the saddle nearest in energy on the momentum sphere, minus the state's. ball: python-flint's, None where the
    sphere has no saddle; tie: the two are equal, by algebra."""

    ball: object
    tie: bool

    def __float__(self):
        return float("inf") if self.ball is None else float(self.ball.mid())


def free_margin(scene, state, digits: int = 17) -> FreeMargin:
    """The margin of one state (three floats or Fractions, taken exactly) to `digits` decimal digits, in J.

    scene: physical, with no torque and a gyrostatic moment with no zero component.
    """
    D, lam = scene.body.exact, scene.vector("gyrostat")
    w = [Fraction(v) for v in state]
    energy = sum(d * v * v for d, v in zip(D, w)) / 2
    squared = sum((d * v + l) ** 2 for d, v, l in zip(D, w, lam))
    sphere = _numerator(D, [l * l for l in lam], Poly((0, 0, 1)), squared)
    level = _numerator(D, [d * l * l for d, l in zip(D, lam)], Poly((1,)), 2 * energy)

    def question(numbers):
        saddles = _saddles(sphere, D, numbers)
        excesses = [_height(s, D, lam, numbers.ball) - numbers.ball(energy) for s in saddles]
        for excess, s in zip(excesses, saddles):
            if 0 in excess:
                if shares_root(polynomial(*sphere.c), polynomial(*level.c), s):
                    return FreeMargin(excess * 0, True)
                raise Unclear
        if not excesses:
            return FreeMargin(None, False)
        nearest = min(excesses, key=lambda v: abs(float(v.mid())))
        if not 10**digits * nearest.rad() < abs(nearest):
            raise Unclear
        return FreeMargin(nearest, False)
    return settled(question, START_BITS)


def _numerator(D, weights, top, value) -> Poly:
    """sum weights_i top/(s - D_i)^2 - value, times prod (s - D_i)^2, without roots at the D_i (equal moments leave some)."""
    squares = [Poly((d * d, -2 * d, 1)) for d in D]
    whole = squares[0] * squares[1] * squares[2] * -value
    for i, weight in enumerate(weights):
        whole = whole + top * weight * squares[(i + 1) % 3] * squares[(i + 2) % 3]
    for d in D:
        whole = whole.without_root(d)
    return whole


def _saddles(sphere, D, numbers) -> list:
    """The speeds s of the saddles on the momentum sphere, as balls."""
    roots, ball = numbers.real_roots(sphere.c), numbers.ball
    gaps = [b - a for (a, _), (b, _) in zip(roots, roots[1:])]
    found, beyond = [], sign(ball(sphere.c[-1]))
    for index in range(len(roots) - 1, -1, -1):
        s, many = roots[index]
        if many % 2 and not s.is_zero():
            side = beyond * sign(s)
            for d in D:
                side *= sign(s - ball(d))
            found += [s] if side > 0 else []
            beyond = -beyond
        if index and not gaps[index - 1] > 0:
            raise Unclear
    return found


def _height(s, D, lam, ball):
    """Kinetic energy of the permanent rotation of speed s."""
    return sum(ball(d * l * l) / (s - ball(d)) ** 2 for d, l in zip(D, lam)) / 2
