"""Krawczyk's test: one and only one zero of the rates in a box, and the signs of m and n there."""
from __future__ import annotations

from .numbers import hull, sign
from .precision import working
from .rates import characteristic
from .zeros import above, below

BITS, MOST_BITS = 128, 1 << 14


def only_zero(rates, box):
    """(sign of m, sign of n) at the one zero in the box of three brackets, or None where the test does not close."""
    from flint import arb_mat
    bits = BITS
    while bits <= MOST_BITS:
        with working(bits):
            x = [hull(a, b) for a, b in box]
            for _ in range(60):
                new = _krawczyk(rates, x, arb_mat)
                if new is None or not all(b.contains_interior(a) for a, b in zip(new, x)):
                    break
                x = new
                m, n = (sign(v) for v in characteristic(rates.jacobian(x)))
                if n is not None and (n or m is not None) and all(map(_in_bracket, x, box)):
                    return m, n
        bits *= 4
    return None


def _in_bracket(x, ends) -> bool:
    """Whether the ball lies in the bracket itself: the ball that holds a bracket is a little wider."""
    return ends[0] <= below(x) and above(x) <= ends[1]


def _krawczyk(rates, x, arb_mat):
    """K(x) = c - Y f(c) + (1 - Y J(x)) (x - c); None where the middle Jacobian cannot be inverted."""
    centre = [v.mid() for v in x]
    J = arb_mat(rates.jacobian(x))
    try:
        Y = arb_mat(rates.jacobian(centre)).inv()
    except ZeroDivisionError:
        return None
    Y = arb_mat([[Y[i, j].mid() for j in range(3)] for i in range(3)])
    f = arb_mat([[v] for v in rates.at(centre)])
    rest = arb_mat([[int(i == j) for j in range(3)] for i in range(3)]) - Y * J
    step = rest * arb_mat([[v - c] for v, c in zip(x, centre)]) - Y * f
    return [centre[i] + step[i, 0] for i in range(3)]


def excluded(rates, box) -> bool:
    """Whether a rate has one sign all over the box."""
    return any(sign(v) in (1, -1) for v in rates.at([hull(a, b) for a, b in box]))
