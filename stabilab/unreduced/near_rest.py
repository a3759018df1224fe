"""A closed motion that starts next to an equilibrium, seen from its start.

In y = x - x(0) the rates are again a quadratic form, with exact coefficients and y(0) = 0: kappa stays, rho
and sigma take in kappa x(0), and the constant part is the exact rate at the start, however small. So the
digits that x(0) and its neighbour have in common cost nothing, and a swing of 1e-17 is followed as well as
one of 1.
"""
from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import TYPE_CHECKING

from ..integrate.reference import Recursion, one_run
from ..numbers.balls import working
from ..numbers.vectors import CYCLE

if TYPE_CHECKING:
    import numpy as np

    from ..physics.scene import QuadraticForm

# A run in doubles loses the ratio of the terms of the rates to the rates: from here on more than five digits.
REST_WIDTH = 1e-5
RETURN_DIGITS = 24  # of the return, where a saddle costs none
WORK = 6_000_000  # multiplications, about a second


def beside_rest(form: QuadraticForm, state: np.ndarray | Sequence[float | Fraction]) -> bool:
    """Whether the rates at the state (floats or Fractions) are that small against their terms, but not all
    zero."""
    return 0 < smallness(form, state) <= REST_WIDTH


def smallness(form: QuadraticForm, state: np.ndarray | Sequence[float | Fraction]) -> Fraction:
    """The largest rate at the state over the largest sum of the terms that make a rate; 0 at rest."""
    x = [Fraction(v) for v in state]
    terms = max(abs(form.kappa[i] * x[j] * x[k]) + abs(form.rho[i] * x[k]) + abs(form.sigma[i] * x[j])
                + abs(form.m[i])
                for i, (j, k) in enumerate(CYCLE))
    return max(map(abs, form.rate(x))) / terms if terms else Fraction(0)


class FromStart(Recursion):
    """The Taylor recursion of y = x - x(0)."""

    def __init__(self, form, state):
        x, constant = [Fraction(v) for v in state], form.rate([Fraction(v) for v in state])
        self.size, self.products, self.rates = 3, list(CYCLE), []
        for i, (j, k) in enumerate(CYCLE):
            rate = ((3 + i, form.kappa[i]), (k, form.rho[i] + form.kappa[i] * x[j]),
                    (j, form.sigma[i] + form.kappa[i] * x[k]), (-1, constant[i]))
            self.rates.append([(row, c) for row, c in rate if c])


def small_loop(form, state, digits: int = RETURN_DIGITS):
    """(period, [(least, greatest)] * 3) of a closed motion as balls; None where it did not return within the
    work allowed."""
    fraction = smallness(form, state)
    # a saddle so near magnifies by as much on the way out, and on the way back
    lost = len(str(fraction.denominator // fraction.numerator))
    _, result = one_run(FromStart(form, state), (0, 0, 0), [], digits + 2 * lost, [WORK], orbit=True)
    if result is None:
        return None
    period, swings = result
    with working(512) as numbers:
        return period, [tuple(numbers.ball(x) + v for v in pair) for x, pair in zip(state, swings)]
