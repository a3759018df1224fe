"""What decides where m and n vanish, or where the linear motion is a centre on a line of equilibria that no potential explains.

Each function returns (verdict, reason), or None where it proves nothing. docs/certificate.md has the arguments.
"""
from __future__ import annotations

from fractions import Fraction

from ..numbers import exact_sign, fraction, q
from ..rates import AHEAD


def dot(a, b):
    """Scalar product of two lists of three."""
    return sum(u * v for u, v in zip(a, b))


def cross(a, b):
    """Vector product."""
    return [a[j] * b[k] - a[k] * b[j] for j, k in AHEAD]


def turned(J, e):
    """A matrix times a column."""
    return [dot(row, e) for row in J]


def product(A, B):
    """Matrix product; entries of any kind."""
    return [[sum((A[i][k] * B[k][j] for k in (1, 2)), A[i][0] * B[0][j]) for j in range(3)] for i in range(3)]


# -- without a torque: two quadratic integrals


def on_common_level(rates, x):
    """By the points near an equilibrium that share both integrals with it: none, stable (the sum of the squares of their
    changes is a Lyapunov function); regular branches, unstable (in and out alternate along them)."""
    (B, g), (A, h) = [(quad, [b * v + l for b, v, l in zip(quad, x, linear)]) for quad, linear in rates.integrals]
    if not (any(g) or any(h)):
        mixed = {exact_sign(v) for v in cross(A, B)} >= {1, -1}  # no d_i^2 >= 0 but zero solves both equations
        return ("stable", "a combination of the integrals is definite there") if mixed else None
    if not any(g):
        (B, g), (A, h) = (A, h), (B, g)
    pivot = next(i for i in range(3) if g[i])
    share = h[pivot] / g[pivot]
    if any(u - share * v for u, v in zip(h, g)):
        return None
    return _meets_surface([u - share * v for u, v in zip(A, B)], g, B)


def _meets_surface(A, g, B):
    """Real points near 0 with sum A_i d_i^2 = 0 and g.d + sum B_i d_i^2/2 = 0."""
    alone = "stable", "no other state nearby shares both integrals with it"
    carried = [i for i in range(3) if A[i]]
    if len({exact_sign(A[i]) for i in carried}) == 1:  # a square, or a sum of squares: all these d_i vanish
        rest = [i for i in range(3) if not A[i]]
        if len(rest) == 2:
            i, k = rest
            return alone if not g[i] and not g[k] and B[i] * B[k] > 0 else None
        return alone if all(g[i] or B[i] for i in rest) else None
    free = 3 - sum(carried)
    if len(carried) != 2 or not (g[free] or B[free]):
        return None
    # two planes, and g is not normal to both: in one a regular curve, across which the combination changes sign
    return "unstable", "branches of equal integrals pass through it, along which motions come in and go out in turn"


# -- a reduction to one degree of freedom


def reducing_direction(rates, curve):
    """e with x' = eta J(P x) e across e and eta' = F(P x) along it, P x in a plane that holds the curve; or None."""
    unit = lambda i: [Fraction(int(n == i)) for n in range(3)]
    places = [(rates.m, n, c) for n, c in rates.conditions if any(n)]
    last = curve.bottom.degree()
    for i, top in enumerate(curve.tops):
        value = top[last] / curve.bottom[last]
        if top == value * curve.bottom:
            places.append((unit(i), unit(i), -fraction(value)))
    return next((e for e, n, c in places if _reduces(rates, e, n, c, curve)), None)


def _reduces(rates, e, n, c, curve) -> bool:
    """Whether on the plane n.x + c = 0 the rates point along e and J e lies in it, and e's own quadratic rate is zero."""
    if not dot(n, e) or any(kappa * e[j] * e[k] for kappa, (j, k) in zip(rates.kappa, AHEAD)):
        return False
    if sum((q(v) * top for v, top in zip(n, curve.tops)), q(c) * curve.bottom) != 0:
        return False
    spare = min(range(3), key=lambda i: abs(n[i]))
    u = cross(n, [Fraction(int(i == spare)) for i in range(3)])
    w, foot = cross(n, u), [-c * v / dot(n, n) for v in n]
    for p, r in ((0, 0), (1, 0), (-1, 0), (0, 1), (0, -1), (1, 1)):  # six points settle a quadratic function
        x = [f + p * a + r * b for f, a, b in zip(foot, u, w)]
        if any(cross(rates.at(x), e)) or dot(n, turned(rates.jacobian(x), e)):
            return False
    return True


TERMS = 6  # F along an orbit combines exp(+-2 n alpha), exp(+-n alpha) and 1: its first five coefficients decide


def on_own_orbit(rates, x, e):
    """By the first coefficient of the force F along dx/dalpha = J(x) e: odd and negative a strict minimum of the potential."""
    from flint import fmpq_poly
    base = turned(rates.jacobian([Fraction(0)] * 3), e)
    series = [list(x)]
    for n in range(TERMS):
        step = turned(rates.jacobian(series[-1]), e)
        series.append([(s - b * (n > 0)) / (n + 1) for s, b in zip(step, base)])
    if not any(series[1]):
        return None
    along = rates.at([fmpq_poly([q(s[i]) for s in series]) for i in range(3)])
    F = sum((q(v) * p for v, p in zip(e, along)), fmpq_poly([]))
    power = next((n for n in range(TERMS) if F[n] != 0), None)
    if power is None:
        return None
    if power % 2 and F[power] < 0:
        return "stable", f"on its own orbit the potential rises like alpha^{power + 1}: a strict minimum"
    return "unstable", f"on its own orbit the potential goes like alpha^{power + 1}: no minimum"


# -- an oblique torque


def drift(rates, J, m):
    """A polynomial whose sign is that of the mean motion along a line of equilibria, at second order in a disturbance; times a
    power of m. J, m: along the line. 0, +-i sqrt(m): P = J^2 + m projects on the line, and J J^T m + J^2 J^2^T holds the means
    of d_i d_j over a turn."""
    square = product(J, J)
    turn = lambda M: [list(row) for row in zip(*M)]
    once, twice = product(J, turn(J)), product(square, turn(square))
    means = [[m * a + b for a, b in zip(r, s)] for r, s in zip(once, twice)]
    lead = next((i for i in range(3) if any(square[i][j] + (m if i == j else 0) != 0 for j in range(3))), 0)
    left = [square[lead][j] + (m if lead == j else 0) for j in range(3)]
    return sum((left[i] * q(rates.kappa[i]) * means[j][k] for i, (j, k) in enumerate(AHEAD) if rates.kappa[i]), m * 0)


def leaves_fold(J, zero):
    """At a simple zero of m on a line of equilibria where J^2 is not zero: z' = y, y' = w, w' = b z y + ..., b = -dm/dz."""
    whole = zero.order == 1 and any(entry % zero.factor != 0 for row in product(J, J) for entry in row)
    return ("unstable", "m changes sign on a line of equilibria: z ~ 12/(b t^2) leaves the point") if whole else None


def leaves_double_root(rates, x, m):
    """At an isolated equilibrium with n = 0 <= m: z' = a z^2 + ... with a not 0 (m > 0), z''' = a z^2 + ... (m = 0)."""
    J = rates.jacobian(x)
    square = product(J, J)
    along = [[v + m * (i == j) for j, v in enumerate(row)] for i, row in enumerate(square)]  # v w^T, J v = 0 = w J
    row = next((r for r in along if any(r)), None)
    if row is None:
        return None
    v = [r[next(i for i in range(3) if row[i])] for r in along]
    bend = sum(row[i] * rates.kappa[i] * v[j] * v[k] for i, (j, k) in enumerate(AHEAD))
    why = "z' = a z^2 + b r^2, r' = -a z r with a not 0" if m else "z''' = a z^2 with a not 0: z ~ -60/(a t^3) leaves the point"
    return ("unstable", f"a double root: {why}") if bend else None
