"""The rates Omega at which the number of permanent rotations or a sign of their spectrum may change, all of them.

The discriminant in mu of the balance, and resultants of the balance with b and with a^2 - 4 b of the spectrum: polynomials in
Omega with exact coefficients, whose real roots python-flint isolates.
"""
from __future__ import annotations

from fractions import Fraction
from typing import Any

from .balance import groups_at, secular
from .spectrum import Field, coefficients

NEXT_TO = Fraction(1, 2**90)  # of the distance to the next cut: where branches on the two sides of one are compared
SHARED = Fraction(1, 2**200)


def cuts_of(field: Field) -> list[Fraction]:
    """Omega at which the number of rotations or the sign of a coefficient of the spectrum may change."""
    from flint import Ordering, fmpq_mpoly_ctx
    ring = fmpq_mpoly_ctx.get(("mu", "r", "O"), Ordering.lex)
    mu, r, O = ring.gens()
    one = ring.constant(1)
    S, b = [one * v for v in field.stiffness(O)], [one * v for v in field.pull(O)]
    parted = groups_at(S, b)
    acting = [axes for axes, idle in parted if not idle]
    critical = []
    if acting:
        n = {i: S[i] - mu for axes in acting for i in axes}
        q, gamma = _homogeneous(acting, n, b, one)
        P = secular(acting, n, b, one)
        critical.append(P.discriminant("mu"))
        a, c = coefficients(field, O, mu, gamma, q)
        critical += [P.resultant(divmod(f, P)[1], "mu") for f in (c, a * a - 4 * c)]
    for axes, idle in parted:
        if idle:
            n = {i: S[i] - S[axes[0]] for other in acting for i in other}
            q, gamma = _homogeneous(acting, n, b, one)
            square = q * q - sum((g * g for g in gamma), one * 0)
            gamma[axes[0]] = r
            a, c = coefficients(field, O, S[axes[0]], gamma, q)
            critical += [square, q] + [_even(f, r, square) for f in (c, a * a - 4 * c)]
    return [root for f in critical for root in _real_roots(f)]


def _homogeneous(acting, n, b, one):
    """(q, q gamma) with q = prod n_g."""
    q, gamma = one, [one * 0] * 3
    for axes in acting:
        q = q * n[axes[0]]
    for axes in acting:
        rest = -one
        for other in acting:
            if other is not axes:
                rest = rest * n[other[0]]
        for i in axes:
            gamma[i] = rest * b[i]
    return q, gamma


def _even(f, r, square):
    """f with r^2 = square, times its mirror image in r: the same zeros, no r."""
    return f.resultant(r * r - square, "r") if "r" in _used(f) else f


def _used(f) -> set:
    return {name for name, degree in zip(("mu", "r", "O"), f.degrees()) if degree > 0}


def _real_roots(f):
    """Real roots of a polynomial in Omega alone as fractions, rational ones exact; none for a constant or zero."""
    from flint import fmpq_poly
    coefficients = {powers[2]: value for powers, value in f.to_dict().items()}
    if not coefficients or max(coefficients) == 0:
        return
    whole = fmpq_poly([coefficients.get(i, 0) for i in range(max(coefficients) + 1)])
    for factor, _ in whole.numer().factor()[1]:
        if factor.degree() == 1:  # exact
            yield Fraction(-int(factor[0]), int(factor[1]))
        else:
            yield from (_fraction(root.real) for root, _ in factor.complex_roots() if root.imag == 0)


def _fraction(ball) -> Fraction:
    man, exp = ball.mid().man_exp()
    return Fraction(int(man)) * Fraction(2) ** int(exp)


def separated(cuts) -> list[Fraction]:
    """The cuts rising, each once: a root that two polynomials share comes out the same within 2**-200."""
    out: list[Any] = []
    for value in sorted(cuts):
        if not out or value - out[-1] > SHARED * max(abs(value), abs(out[-1])):
            out.append(value)
    return out


def step_at(cuts, cut: Fraction) -> Fraction:
    """How far beside a cut its branches are compared: far below the distance to the next one."""
    others = [abs(cut - other) for other in cuts if other != cut] or [abs(cut) or Fraction(1)]
    return min(others) * NEXT_TO
