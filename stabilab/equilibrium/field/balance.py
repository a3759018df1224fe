"""All permanent rotations at one rate Omega: (S - mu) gamma = -b, |gamma| = 1, by one polynomial in mu."""
from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from ...numbers.balls import BITS, rational, working
from ...numbers.vectors import Number
from .spectrum import Field


@dataclass(frozen=True)
class Rotation:
    """One solution at one Omega: mu and gamma as balls; circle: it stands for all its turns about axis 3 (or its own)."""

    mu: Number
    gamma: tuple
    circle: tuple = ()


def groups_at(S, b):
    """[(axes of one value of S, whether b vanishes there)] for exact S, b."""
    values = list(dict.fromkeys(S)) if not hasattr(S[0], "to_dict") else _unique(S)
    return [(axes, not any(b[i] != 0 for i in axes)) for axes in ([i for i in range(3) if S[i] == v] for v in values)]


def _unique(values):
    out = []
    for v in values:
        if not any(v == w for w in out):
            out.append(v)
    return out


def rotations_at(field: Field, Omega: Fraction) -> list[Rotation]:
    """All permanent rotations with this Omega (exact), those of the polynomial first, rising in mu."""
    from flint import arb, fmpq, fmpq_poly
    O = rational(Omega)
    S, b = field.stiffness(O), field.pull(O)
    parted = groups_at(S, b)
    acting = [axes for axes, idle in parted if not idle]
    found = []
    if acting:
        mu = fmpq_poly([0, 1])
        n = {axes[0]: S[axes[0]] - mu for axes in acting}
        P = secular(acting, n, b, fmpq_poly([1]))
        found += _directions(P, S, b, acting)
    for axes, idle in parted:
        if idle:
            found += _free_part(axes, acting, S, b, fmpq(1), arb)
    return found


def _directions(P, S, b, acting) -> list[Rotation]:
    """gamma_i = -b_i/(S_i - mu) at every real root mu of P, rising; with more digits where b is so small that S_i - mu has none left."""
    from flint import arb
    for bits in (BITS, 4 * BITS, 16 * BITS):
        with working(bits):
            found = []
            for root in sorted((r.real for r, _ in P.numer().complex_roots() if r.imag == 0), key=lambda r: r.mid()):
                gamma = [arb(0)] * 3
                for axes in acting:
                    for i in axes:
                        gamma[i] = -b[i] / (S[i] - root)
                found.append(Rotation(root, tuple(gamma)))
        if all(g.is_finite() and g.rad() < 1e-40 for rotation in found for g in rotation.gamma):
            return found
    raise ArithmeticError("a permanent rotation was not told from another in a thousand digits")


def secular(acting, n, b, one):
    """prod n_g^2 - sum B_g prod_(h != g) n_h^2."""
    total = one
    for axes in acting:
        total = total * n[axes[0]] * n[axes[0]]
    for axes in acting:
        term = sum((b[i] * b[i] for i in axes[1:]), b[axes[0]] * b[axes[0]]) * one
        for other in acting:
            if other is not axes:
                term = term * n[other[0]] * n[other[0]]
        total = total - term
    return total


def _free_part(axes, acting, S, b, one, arb):
    """Rotations with mu = S_g of a group without b."""
    gamma, rest = [arb(0)] * 3, one
    for other in acting:
        for i in other:
            value = -b[i] / (S[i] - S[axes[0]])
            gamma[i], rest = arb(value), rest - value * value
    if rest < 0:
        return
    size = arb(rest).sqrt()
    mu = arb(S[axes[0]])
    signs = (1,) if len(axes) > 1 else (1, -1) if rest else (1,)
    for sign in signs:
        gamma[axes[0]] = size * sign
        yield Rotation(mu, tuple(gamma), tuple(axes) if len(axes) > 1 and rest else ())


def rounded_gamma(rotation):
    return tuple(float(g.mid()) for g in rotation.gamma)
