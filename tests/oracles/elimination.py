"""Equilibria by exact rational elimination: Fractions and Euclid's algorithm alone, nothing of the package.

The rates dotted with omega and with H = D omega + lambda (scaled: with (x1 + a, x2, 0) and (x1 + b, 0, -x3))
are two linear conditions. On their common line or plane the three rates are polynomials in one or two
variables; without a torque the conditions are empty, and D omega + lambda = s omega is solved for s an
eigenvalue of D and for other s.
"""
from __future__ import annotations

from dataclasses import dataclass, field
from fractions import Fraction
from math import isqrt

from tests.oracles.model import CYCLE, Model, physical, scaled

S_VALUES = [Fraction(-7, 3), Fraction(11, 5), Fraction(9, 1)]


@dataclass
class Answer:
    """kind: none, points, curves, all. roots: isolated ones; samples: exact points that the curves and planes
    must hold."""

    kind: str
    roots: list = field(default_factory=list)
    curves: int = 0
    planes: int = 0
    samples: list = field(default_factory=list)


# ---- polynomials in one variable, coefficients from degree 0 up


def trim(p):
    p = list(p)
    while p and p[-1] == 0:
        p.pop()
    return p


def value(p, t):
    total = Fraction(0)
    for c in reversed(p):
        total = total * t + c
    return total


def times(p, q):
    out = [Fraction(0)] * (len(p) + len(q) - 1) if p and q else []
    for i, a in enumerate(p):
        for j, b in enumerate(q):
            out[i + j] += a * b
    return out


def plus(*ps):
    out = [Fraction(0)] * max((len(p) for p in ps), default=0)
    for p in ps:
        for i, a in enumerate(p):
            out[i] += a
    return trim(out)


def remainder(p, q):
    p = trim(p)
    while len(p) >= len(q):
        f, shift = p[-1] / q[-1], len(p) - len(q)
        p = trim([a - (f * q[i - shift] if i >= shift else 0) for i, a in enumerate(p[:-1])])
    return p


def gcd(p, q):
    p, q = trim(p), trim(q)
    while q:
        p, q = q, remainder(p, q)
    return [a / p[-1] for a in p] if p else []


def sturm_count(p, low=None, high=None):
    """Distinct real roots in (low, high]; None: infinite."""
    chain = [trim(p), trim([n * a for n, a in enumerate(p)][1:])]
    while chain[-1]:
        chain.append([-a for a in remainder(chain[-2], chain[-1])])
    chain.pop()

    def changes(t, side):
        signs = [(v > 0) - (v < 0)
                 for v in ((value(c, t) if t is not None else c[-1] * (side ** (len(c) - 1))) for c in chain)]
        signs = [s for s in signs if s]
        return sum(a != b for a, b in zip(signs, signs[1:]))
    return changes(low, -1) - changes(high, 1)


class Root:
    """A real root of a squarefree polynomial, in a bracket (low, high] that holds no other."""

    def __init__(self, p, low, high):
        self.p, self.low, self.high = p, low, high

    def versus(self, c) -> int:
        """Sign of root - c."""
        if value(self.p, c) == 0 and self.low < c <= self.high:
            return 0
        if c <= self.low:
            return 1
        return 1 if c < self.high and sturm_count(self.p, c, self.high) else -1

    def sign_of(self, q) -> int:
        """Sign of a polynomial there; p has degree 1 or 2, so the remainder is linear."""
        r = remainder(q, self.p)
        assert len(self.p) <= 3
        if len(r) < 2:
            return (r[0] > 0) - (r[0] < 0) if r else 0
        return self.versus(-r[0] / r[1]) * (1 if r[1] > 0 else -1)


def real_roots(p):
    p = trim(p)
    if len(p) < 2:
        return []
    common = gcd(p, [n * a for n, a in enumerate(p)][1:])
    if len(common) > 1:
        p = [-common[0] / common[1], Fraction(1)] if len(p) == 3 else p
        p = [-a if i == 0 else a for i, a in enumerate(p)]
    bound = 1 + max(abs(a / p[-1]) for a in p[:-1])
    stack, found = [(-bound, bound)], []
    while stack:
        low, high = stack.pop()
        count = sturm_count(p, low, high)
        if count == 1:
            found.append(Root(p, low, high))
        elif count:
            stack += [(low, (low + high) / 2), ((low + high) / 2, high)]
    return found


# ---- the elimination


def linear_solution(rows):
    """(point, directions) of the affine space normal.x + c = 0 for rows (normal, c); None where they
    contradict."""
    rows = [[*n, c] for n, c in rows]
    pivots = []
    for column in range(3):
        at = next((r for r in range(len(pivots), len(rows)) if rows[r][column]), None)
        if at is None:
            continue
        here = len(pivots)
        rows[here], rows[at] = rows[at], rows[here]
        rows[here] = [v / rows[here][column] for v in rows[here]]
        for r in range(len(rows)):
            if r != here and rows[r][column]:
                rows[r] = [a - rows[r][column] * b for a, b in zip(rows[r], rows[here])]
        pivots.append(column)
    if any(not any(r[:3]) and r[3] for r in rows):
        return None
    point = [Fraction(0)] * 3
    for r, column in enumerate(pivots):
        point[column] = -rows[r][3]
    directions = []
    for free in (i for i in range(3) if i not in pivots):
        v = [Fraction(int(i == free)) for i in range(3)]
        for r, column in enumerate(pivots):
            v[column] = -rows[r][free]
        directions.append(v)
    return point, directions


def m_and_n(model: Model, x, mul=lambda a, b: a * b, add=lambda *a: sum(a), one=Fraction(1)):
    """Coefficients of z^3 + m z + n at x: minus the sum of J_ij J_ji, and minus the determinant (zero
    diagonal)."""
    J = [[None] * 3 for _ in range(3)]
    for i, (j, k) in enumerate(CYCLE):
        J[i][j] = add(mul(model.kappa[i] * one, x[k]), model.sigma[i] * one)
        J[i][k] = add(mul(model.kappa[i] * one, x[j]), model.rho[i] * one)
    minus = lambda v: mul(-1 * one, v)
    m = minus(add(mul(J[0][1], J[1][0]), mul(J[0][2], J[2][0]), mul(J[1][2], J[2][1])))
    n = minus(add(mul(J[0][1], mul(J[1][2], J[2][0])), mul(J[0][2], mul(J[2][1], J[1][0]))))
    return m, n


class _P(list):
    """A polynomial that a Fraction may multiply from the left."""

    def __rmul__(self, c):
        return _P(c * a for a in self)


def m_and_n_on_line(model, point, v):
    """The same as polynomials along a line."""
    x = [[p, d] for p, d in zip(point, v)]
    return m_and_n(model, x, lambda a, b: times(a, b), lambda *a: plus(*a), _P([Fraction(1)]))


def of_body(D, lam, M) -> tuple[Model, Answer]:
    D, lam, M = ([Fraction(v) for v in row] for row in (D, lam, M))
    model = physical(D, lam, M)
    if any(M):
        rows = [(M, Fraction(0)), ([d * t for d, t in zip(D, M)], sum(l * t for l, t in zip(lam, M)))]
        return model, _with_torque(model, rows)
    return model, _free(D, lam)


def of_scaled(a, b, mu) -> tuple[Model, Answer]:
    a, b, mu, zero = Fraction(a), Fraction(b), [Fraction(v) for v in mu], Fraction(0)
    model = scaled(a, b, mu)
    if any(mu):
        return model, _with_torque(model,
                                   [([mu[0], mu[1], zero], mu[0] * a), ([mu[0], zero, -mu[2]], mu[0] * b)])
    samples = ([[t, zero, zero] for t in S_VALUES] + [[-b, t, zero] for t in S_VALUES]
               + [[-a, zero, t] for t in S_VALUES])
    return model, Answer("curves", curves=3, samples=samples)  # x2 x3 = x3 (x1 + a) = x2 (x1 + b) = 0


def _free(D, lam):
    if not any(lam) and len(set(D)) == 1:
        return Answer("all")
    found = Answer("curves")
    if any(lam):
        found.curves, found.samples = 1, [[l / (s - d) for l, d in zip(lam, D)] for s in S_VALUES
                                          if s not in D]
    for s in set(D):
        space = linear_solution([([Fraction(int(i == j)) * (D[i] - s) for j in range(3)], lam[i])
                                 for i in range(3)])
        if space is not None:
            point, ways = space
            found.curves += len(ways) == 1
            found.planes += len(ways) == 2
            for t in S_VALUES:
                found.samples.append([p + sum(c * v[i] for c, v in zip((t, 2 - t), ways)) for i,
                                      p in enumerate(point)])
    return found


def _with_torque(model, rows):
    space = linear_solution(rows)
    if space is None:
        return Answer("none")
    point, ways = space
    if len(ways) == 1:
        return _on_line(model, point, ways[0])
    return _on_plane(model, point, *ways)


def _on_line(model, point, v):
    x = [[p, d] for p, d in zip(point, v)]
    g = []
    for i, (j, k) in enumerate(CYCLE):
        rate = plus([model.kappa[i] * c for c in times(x[j], x[k])], [model.rho[i] * c for c in x[k]],
                    [model.sigma[i] * c for c in x[j]], [model.m[i]])
        g = gcd(g, rate)
    if not g:
        return Answer("curves", curves=1, samples=[[p + t * d for p, d in zip(point, v)] for t in S_VALUES])
    roots = real_roots(g)
    return Answer("points" if roots else "none", [(root, point, v) for root in roots])


def _on_plane(model, point, u, w):
    rate = lambda p, r: model.rate([o + p * a + r * b for o, a, b in zip(point, u, w)])
    at = {(p, r): rate(p, r) for p, r in ((0, 0), (1, 0), (-1, 0), (0, 1), (0, -1), (1, 1))}
    rows = []
    for i in range(3):
        o, e, west, n, s, ne = (at[k][i] for k in ((0, 0), (1, 0), (-1, 0), (0, 1), (0, -1), (1, 1)))
        A, C, D, E = (e + west) / 2 - o, (n + s) / 2 - o, (e - west) / 2, (n - s) / 2
        rows.append([A, ne - A - C - D - E - o, C, D, E, o])
    lead = next(r for r in rows if any(r))
    assert all(a * y == b * x for r in rows for a, x in zip(r, lead) for b,
               y in zip(r, lead)), "multiples of one conic"
    A, B, C, D, E, F = lead
    place = lambda p, r: [o + p * a + r * b for o, a, b in zip(point, u, w)]
    if not (A or B or C):
        if not (D or E):
            return Answer("none")
        return Answer("curves", curves=1,
                      samples=[place(-(E * t + F) / D, t) if D else place(t, -F / E) for t in S_VALUES])
    disc = B * B - 4 * A * C
    root = Fraction(isqrt(disc.numerator), isqrt(disc.denominator)) if disc > 0 else None
    assert root is not None and root * root == disc, "a hyperbola or two lines, with rational asymptotes"
    whole = 4 * A * C * F + B * D * E - A * E * E - C * D * D - B * B * F
    samples = []
    ways = ([(Fraction(1), (-B + side * root) / (2 * C)) for side in (1, -1)] if C
            else [(Fraction(0), Fraction(1)), (B, -A)])
    (p1, r1), (p2, r2) = ways  # from o + t way2, along way1: one more point of the conic, if any
    for t in S_VALUES:
        for (a, b), (c, d) in (((p1, r1), (p2, r2)), ((p2, r2), (p1, r1))):
            p0, r0 = t * c, t * d
            slope = 2 * A * p0 * a + B * (p0 * b + r0 * a) + 2 * C * r0 * b + D * a + E * b
            start = A * p0 * p0 + B * p0 * r0 + C * r0 * r0 + D * p0 + E * r0 + F
            if slope:
                samples.append(place(p0 - start / slope * a, r0 - start / slope * b))
    return Answer("curves", curves=1 if whole else 2, samples=samples)


def on_curve(x, tops, bottom) -> bool:
    """Whether a rational point lies on x_i = tops[i](t)/bottom(t), t real and no pole."""
    g = []
    for c, top in zip(x, tops):
        g = gcd(g, plus(top, [-c * b for b in bottom]))
    if not g:
        return True
    shared = gcd(g, bottom)
    while len(shared) > 1:  # divide the poles out
        g = _divided(g, shared)
        shared = gcd(g, bottom)
    return len(g) > 1 and sturm_count(g) > 0


def _divided(p, q):
    out = [Fraction(0)] * (len(p) - len(q) + 1)
    p = list(p)
    while len(p) >= len(q):
        f = p[-1] / q[-1]
        out[len(p) - len(q)] = f
        p = [a - (f * q[i - (len(p) - len(q))] if i >= len(p) - len(q) else 0) for i, a in enumerate(p)][:-1]
    return out
