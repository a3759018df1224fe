"""What the number, kind and stability of equilibria hang on: quantities that keep their sign as long as these stay the same.

Off the axes: M.y = 0 and M.(D y + lambda) = 0 meet in a line along v = M x D M, on which one quadratic is left
(`isolated_equilibria`); simple roots have n != 0, so they are unstable. On axis i with lambda_i = 0: with s t = K the conic's
two coordinates from its centre, times a positive factor

    -(t^2/kappa) m = p t^4 + P t^3 + Q K t + q K^2,   P = p0 - p sigma/kappa,   Q = q0 - q rho/kappa,

so folds neither meet, nor pass the poles t = 0 and infinity, nor change in number while p, q, K and the discriminant keep
their signs. Numbers are of any kind; one that vanishes for every body of the box is exactly 0 and makes its own case.
"""
from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Any, NamedTuple

from ...numbers.affine import Affine, squared
from ...numbers.vectors import CYCLE, Number, Triple
from ...orbit.reduction import Reduction
from ...physics.quadratic import QuadraticForm
from .box import Box, Numbers
from .orbit import reduction_over


class Condition(NamedTuple):
    """value: keeps its sign where nothing changes; what: what happens where it vanishes. passes: True where the answer is the
    same on both sides of that surface, and only on the surface itself another."""

    value: Number
    what: str
    passes: bool = False


class Unknown(Exception):
    """Scenes whose equilibria have no such list here; the text says which."""


def conditions(box: Box, numbers: Numbers) -> list[Condition]:
    """The conditions of a box, for numbers of any kind (`Box.numbers`). Raises Unknown."""
    form = box.rates(numbers)
    acting = [i for i in range(3) if _there(form.m[i])]
    D, lam, M = _balance(box, numbers, form)
    if not acting:
        return _free(D, lam)
    torque = [Condition(M[i], f"the torque about axis {i + 1} vanishes") for i in acting]
    if len(acting) > 1:
        return _off_axis(D, lam, M, acting)
    axis = acting[0]
    if _there(lam[axis]):
        return torque + [Condition(lam[axis], f"the gyrostatic moment along axis {axis + 1} vanishes")]
    reduction: Any = reduction_over(form, axis)  # a torque on an axis without momentum along it has one
    return torque + (_conic(reduction) if _there(reduction.kappa) else _line(reduction))


def known(found: list[Condition]) -> list[Condition]:
    """Those whose value hangs on uncertain numbers."""
    return [c for c in found if isinstance(c.value, Affine)]


def _there(value: Number) -> bool:
    return isinstance(value, Affine) or value != 0


def _balance(box: Box, numbers: Numbers, form: QuadraticForm) -> tuple[Triple, Triple, Triple]:
    """(D, lambda, M) of (D y + lambda) x y + M = 0 (`pencil`)."""
    if box.variables == "physical":
        return numbers["inertia"], numbers["momentum"], tuple(d * m for d, m in zip(numbers["inertia"], form.m))
    b, a = form.rho[2], -form.sigma[1]
    zero, half = Fraction(0), Fraction(1, 2)
    return (half, zero, Fraction(1)), ((b - a) * half, zero, zero), form.m


def _free(D: Sequence[Number], lam: Sequence[Number]) -> list[Condition]:
    if any(map(_there, lam)):
        raise Unknown("without a torque, and with a gyrostatic moment, the stability along the curve of equilibria is not "
                      "followed over a box")
    pairs = [(i, j) for i, j in ((0, 1), (1, 2), (2, 0)) if _there(D[i] - D[j])]
    return [Condition(D[i] - D[j], f"moments {i + 1} and {j + 1} are equal") for i, j in pairs]


def _dot(u: Sequence[Number], v: Sequence[Number]) -> Number:
    return sum((a * b for a, b in zip(u, v)), Fraction(0))


def _off_axis(D: Sequence[Number], lam: Sequence[Number], M: Sequence[Number], acting: Sequence[int]) -> list[Condition]:
    if not any(_there(D[i] - D[acting[0]]) for i in acting[1:]):
        raise Unknown("the torque lies across the axes in the plane of two equal moments")
    gaps = [D[j] - D[k] for j, k in CYCLE]
    v = [-(M[j] * M[k] * gaps[i]) for i, (j, k) in enumerate(CYCLE)]
    area = sum((squared(c) for c in v), Fraction(0))
    DM, load = [d * m for d, m in zip(D, M)], _dot(lam, M)
    foot = [load * (_dot(M, DM) * m - _dot(M, M) * dm) / area if _there(load) else load for m, dm in zip(M, DM)]
    pair = lambda x, y: sum((M[i] * gaps[i] * x[j] * y[k] for i, (j, k) in enumerate(CYCLE)), Fraction(0))
    turn = lambda x: sum((M[i] * (lam[j] * x[k] - lam[k] * x[j]) for i, (j, k) in enumerate(CYCLE)), Fraction(0))
    q2, q1 = pair(v, v), pair(v, foot) + pair(foot, v) + turn(v)
    q0 = pair(foot, foot) + turn(foot) + sum((squared(m) for m in M), Fraction(0))
    plane = Condition(area, "the torque comes to lie along a principal axis")
    if _there(q2):
        return [plane, Condition(q2, "one of the equilibria passes through infinity", True),
                Condition(squared(q1) - 4 * (q2 * q0), "two equilibria meet in a fold")]
    if _there(q1):
        return [plane, Condition(q1, "the equilibrium passes through infinity", True)]
    return [plane, Condition(q0, "a line of equilibria appears")]


def _conic(r: Reduction) -> list[Condition]:
    """The conic of a torque on a principal axis with two different moments across it."""
    k, p, q = r.kappa, r.p, r.q
    N = r.rho * r.sigma - r.m * k                  # kappa^2 K
    P, Q = k * r.p0 - p * r.sigma, k * r.q0 - q * r.rho   # times kappa
    PQ, P2, Q2 = P * Q, squared(P), squared(Q)
    # discriminant over K^3, times kappa^6
    first = 256 * (p * q) * squared(p * q) * squared(N) - 192 * (squared(p * q) * PQ * N)
    second = 27 * squared(p * Q2) + 6 * (p * q) * (P2 * Q2) + 27 * squared(q * P2)
    disc = (first - second) * N - 4 * PQ * squared(PQ)
    found = [Condition(k, "the two moments across the torque are equal"),
             Condition(N, "the hyperbola of equilibria falls apart into two lines")]
    for lead, low in ((p, P), (q, Q)):
        found += [Condition(value, "a fold passes through infinity" if value is low else "two moments are equal")
                  for value in (lead if _there(lead) else low,) if _there(value)]
    return found + ([Condition(disc, "two folds meet and vanish")] if _there(disc) else [])


def _line(r: Reduction) -> list[Condition]:
    """The line of equilibria where the two moments across the torque are equal (kappa = 0)."""
    across = squared(r.rho) + squared(r.sigma)
    if not _there(across):
        return []
    found = [Condition(across, "the gyrostatic moment across the torque vanishes")]
    if _there(r.p):
        return found + [Condition(r.p, "all three moments are equal")]
    level = r.rho * r.q0 + r.sigma * r.p0
    return found + ([Condition(level, "the whole line changes its stability")] if _there(level) else [])
