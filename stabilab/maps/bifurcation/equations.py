"""Which equilibria a diagram counts, as equations in one or two unknowns with polynomial coefficients in the
numbers that vary.

Off the principal axes they are isolated: on the line where the two linear conditions meet, y = (P + x v)/w,
one quadratic remains (`equilibrium.gyrostat`). A torque on principal axis i, with no wheel along it, has a
whole conic of them, and a motion keeps to its own curve across that axis, W = const: the equilibria on this
curve are where two conics meet. Without a motion the points of the conic where stability changes are counted,
m = 0, another two conics. All unknowns are components of y (`equilibrium.balance.Pencil`).
"""
from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import reduce
from typing import Any

from flint import fmpq_mpoly

from ...numbers.balls import rational
from ...numbers.vectors import CYCLE, cross, dot
from .family import CURVES, Family

ISOLATED, LEAF, BORDERS = "isolated", "motion", "borders"
# X = x - lean y
LEANS = tuple(Fraction(*parts) for parts in ((0, 1), (1, 1), (-1, 1), (2, 1), (1, 2), (-3, 1), (1, 3), (3, 1),
                                             (-2, 1), (5, 2)))


@dataclass(frozen=True)
class OnLine:
    """One quadratic c[0] + c[1] x + c[2] x^2 = 0 on the line y = (start + x along)/below. special: zero where
    the torque falls on a principal axis."""

    coefficients: tuple[fmpq_mpoly, ...]
    start: tuple[fmpq_mpoly, ...]
    along: tuple[fmpq_mpoly, ...]
    below: fmpq_mpoly
    special: fmpq_mpoly
    load: fmpq_mpoly
    kind: str = ISOLATED

    def m(self, family: Family) -> fmpq_mpoly:
        """m of z^3 + m z + n along the line, times below^2 and the positive moments: a quadratic polynomial
        of y, made homogeneous."""
        x, zero = family.ring.gens()[0], family.ring.constant(0)
        y = [s + x * a for s, a in zip(self.start, self.along)]
        there, mirrored = _linear_m(family, y), _linear_m(family, [-c for c in y])
        middle = _linear_m(family, [zero] * 3)
        mean, half = (there + mirrored) / 2, (there - mirrored) / 2
        return mean - middle + half * self.below + middle * self.below * self.below


@dataclass(frozen=True)
class Conics:
    """Two conics f = g = 0 in the components x = y_j and y = y_k of the state, the third being zero; axis: i
    of the torque. special: zero where the equations do not hold all equilibria of the kind (along a curve of
    them: where the torque vanishes)."""

    f: fmpq_mpoly
    g: fmpq_mpoly
    axis: int
    kind: str
    special: fmpq_mpoly
    load: fmpq_mpoly

    def leant(self, lean: Fraction) -> tuple[fmpq_mpoly, fmpq_mpoly]:
        """Both in X = x - lean y and y: points one above another move apart."""
        ring = self.f.context()
        x, y, p, q = ring.gens()
        moved = (x + y * rational(lean), y, p, q)
        return self.f.compose(*moved, ctx=ring), self.g.compose(*moved, ctx=ring)


def fixed_axis(family: Family) -> int | None:
    """The principal axis that carries the torque all over the range; None where there is none."""
    M = family.numbers["M"]
    along = [i for i in range(3) if not M[i].is_zero()]
    return along[0] if len(along) == 1 else None


def on_line(family: Family) -> OnLine:
    """The isolated equilibria of a torque off the principal axes; `special` is zero where none of the range
    has one."""
    n = family.numbers
    D, lam, M = n["D"], n["lam"], n["M"]
    turned = lambda v: tuple(d * c for d, c in zip(D, v))
    v = cross(M, turned(M))
    shared = common_divisor(v)
    if shared.is_zero():
        return OnLine((shared,) * 3, v, v, shared, shared, dot(lam, M))
    v = tuple(c / shared for c in v)
    load, below = dot(lam, M), shared * dot(v, v)
    start = tuple(load * c for c in cross(M, v))
    det = lambda a, b: dot(cross(a, b), M)
    Dv, H = turned(v), tuple(a + below * b for a, b in zip(turned(start), lam))
    rows = [det(H, start) + dot(M, M) * below * below, det(Dv, start) + det(H, v), det(Dv, v)]
    content = common_divisor(rows)
    if not content.is_zero():
        rows = [c / content for c in rows]
        shared *= content
    return OnLine(tuple(rows), start, v, below, shared, load)


def across(family: Family, axis: int, kind: str) -> Conics:
    """The equilibria on the curve that the motion keeps to (LEAF), or where stability changes along the conic
    (BORDERS)."""
    n = family.numbers
    j, k = CYCLE[axis]
    x, y = family.ring.gens()[:2]
    D, lam, M = n["D"], n["lam"], n["M"]
    f = (D[j] * x + lam[j]) * y - (D[k] * y + lam[k]) * x + M[axis]
    if kind == LEAF:
        keeps = _kept(family, axis)
        g = keeps(x, y) - keeps(n["y"][j], n["y"][k])
    else:
        place: list[Any] = [None] * 3
        place[axis], place[j], place[k] = family.ring.constant(0), x, y
        g = _linear_m(family, place)
    one, zero = family.ring.constant(1), family.ring.constant(0)
    return Conics(f, g, axis, kind, M[axis] if kind == BORDERS else one, zero)


def _kept(family: Family, axis: int):
    """W(y_j, y_k), which every motion keeps: |H|^2 - 2 D_i T across the torque, or the scaled system's own.
    """
    n = family.numbers
    (j, k), D, lam = CYCLE[axis], n["D"], n["lam"]
    if not family.scaled:
        return lambda x, y: ((D[j] * x + lam[j]) * (D[j] * x + lam[j])
                             + (D[k] * y + lam[k]) * (D[k] * y + lam[k])
                             - D[axis] * (D[j] * x * x + D[k] * y * y))
    half = lambda y1: y1 * family.ring.constant(1) / 2  # x1 + a = y1/2 - lam1, x1 + b = y1/2 + lam1
    if axis == 2:
        return lambda y1, y2: (half(y1) - lam[0]) * (half(y1) - lam[0]) + y2 * y2
    if axis == 1:
        return lambda y3, y1: (half(y1) + lam[0]) * (half(y1) + lam[0]) - y3 * y3
    return lambda y2, y3: y2 * y2 + y3 * y3


def _linear_m(family: Family, y: Sequence[fmpq_mpoly]) -> fmpq_mpoly:
    """m of z^3 + m z + n at y, times the positive moments (all 1 in scaled variables)."""
    n, one = family.numbers, family.ring.constant(1)
    kappa: Sequence[fmpq_mpoly]
    rho: Sequence[fmpq_mpoly]
    sigma: Sequence[fmpq_mpoly]
    if family.scaled:
        u1, l1 = n["u"][0], n["lam"][0]
        a, b = u1 / 2 - l1, u1 / 2 + l1
        x = ((y[0] - u1) / 2, y[1], -y[2])
        weights, kappa = (one,) * 3, (one, -one, one)
        rho, sigma = (0 * one, 0 * one, b), (0 * one, -a, 0 * one)
    else:
        D, lam = n["D"], n["lam"]
        x, weights, kappa = (y[0], y[1], y[2]), (D[0], D[1], D[2]), tuple(D[j] - D[k] for j, k in CYCLE)
        rho, sigma = tuple(lam[j] for j, _ in CYCLE), tuple(-lam[k] for _, k in CYCLE)
    total = 0 * one
    # the pair (j, k): entries row j, column k and row k, column j of the Jacobian
    for i, (j, k) in enumerate(CYCLE):
        row_j = kappa[j] * x[i] + sigma[j]
        row_k = kappa[k] * x[i] + rho[k]
        total -= row_j * row_k * weights[i]
    return total


def common_divisor(parts: Iterable[fmpq_mpoly]) -> fmpq_mpoly:
    """The greatest one of all."""
    return reduce(lambda f, g: f.gcd(g), parts)


WHAT = {ISOLATED: "isolated equilibria (torque off the principal axes)",
        LEAF: "equilibria on the curve that the motion stays on, all branches of it",
        BORDERS: "points where stability changes along the curve of equilibria"}

MORE = "stabilab classify tells their stability at one value"


def chosen(family: Family, borders: bool) -> tuple[str, str, OnLine | Conics | None, tuple[str, ...]]:
    """(kind, in words, the equations or None where all is curves, notes)."""
    n = family.numbers
    axis = fixed_axis(family)
    if all(c.is_zero() for c in n["M"]):
        return CURVES, f"without a torque equilibria form curves for every value; {MORE}", None, ()
    if axis is None:
        line = on_line(family)
        if line.special.is_zero():
            return (CURVES,
                    f"the torque lies along equal moments of inertia, where equilibria form curves; {MORE}",
                    None, ())
        return ISOLATED, WHAT[ISOLATED], line, ()
    if not n["lam"][axis].is_zero():
        one, zero = family.ring.constant(1), family.ring.constant(0)
        load = n["lam"][axis] * n["M"][axis]
        note = (
            f"the torque lies on principal axis {axis + 1} and a wheel carries momentum along it: no "
            "equilibrium wherever neither is zero")
        nowhere = OnLine((one, zero, zero), (zero,) * 3, (zero,) * 3, one, load, load)
        return ISOLATED, WHAT[ISOLATED], nowhere, (note,)
    D = n["D"]
    if borders or "y" not in n:
        return _solvable(BORDERS, WHAT[BORDERS], across(family, axis, BORDERS))
    others = [i for i in range(3) if i != axis]
    if all((D[i] - D[axis]).is_zero() and n["lam"][i].is_zero() for i in others):
        return (CURVES, f"three equal moments of inertia and no wheel: nothing balances a torque; {MORE}",
                None, ())
    return _solvable(LEAF, f"{WHAT[LEAF]} (torque on principal axis {axis + 1})", across(family, axis, LEAF))


def _solvable(kind: str, what: str, conics: Conics) -> tuple[str, str, Conics | None, tuple[str, ...]]:
    """The same, or words where the two conics share a curve."""
    common = conics.f.gcd(conics.g) if not (conics.f.is_zero() or conics.g.is_zero()) else None
    if common is None or max(common.degrees()[:2]) > 0:
        return (CURVES, f"whole curves of equilibria solve what a diagram would count, {what}; {MORE}", None,
                ())
    return kind, what, conics, ()
