"""Equilibria of a body with a liquid under a torque, in a resisting medium, or both.

Three polynomials of third degree in omega. With x = sqrt(2 T) the work of all torques gives

    x' <= m - (c - kappa alpha) x + kappa beta x^2,      m = sqrt(M . D^-1 M),

because the liquid's work has a part of fourth degree that is never positive, and parts of second and third degree (from
wheel and charge; none where Lambda = 0) of at most alpha x^2 + beta x^3. Between the roots x1 < x2 of the right side energy
falls: there is no equilibrium, and what starts below x2 stays below max(x, x1). All equilibria below x2 lie in the box of
x1, where exclusion and Krawczyk's test find every one.
"""
from __future__ import annotations

from fractions import Fraction
from math import inf, sqrt
from types import SimpleNamespace

from ...numbers.balls import many_digits, rational
from ...numbers.vectors import cross, dot
from ...physics.coefficients import Content, liquid_torque
from ..result import Equilibria, EquilibriumPoint
from .liquid import validity

ROUND = 1 + 1e-9  # more than all roundings of a bound
RADIUS = 1e-45    # relative radius of the ball in which the sharpened zero is proved to lie
EVERYWHERE = "the kinetic energy T lies below the value from which it falls (above it there is none)"
STABLE = ("asymptotically stable", "p2, p0 > 0 and p2 p1 > p0 in z^3 + p2 z^2 + p1 z + p0 (Routh and Hurwitz): all roots lie on the left")
UNSTABLE = ("unstable", "p0 < 0, p2 < 0 or p2 p1 < p0 in z^3 + p2 z^2 + p1 z + p0 (Routh and Hurwitz): a root with positive real part")
OPEN = ("undecided", "Routh and Hurwitz leave the roots open: one of the conditions is an equality to some forty digits")


def balanced_equilibria(parts: Content) -> Equilibria:
    """Equilibria with a liquid and resistance or torque: all of them below a bound that the reason names."""
    from ...numbers.krawczyk import zeros
    reach, words = _region(parts)
    polynomials = [_dictionary(p) for p in balance(parts)]
    if reach is None:
        rest = () if any(parts.M) else (_point(parts, polynomials, (0.0, 0.0, 0.0)),)
        return Equilibria("undecided", f"{words}; rest is one, as no torque acts on it" if rest else words, rest)
    found = zeros(polynomials, reach)
    points = tuple(_point(parts, polynomials, x) for x in sorted(map(tuple, found.points.tolist())))
    if not found.complete:
        return Equilibria("undecided", f"undecided: {found.boxes} boxes did not settle the search where {words}; the equilibria found are proved, "
                                       "others are not excluded", points)
    everywhere = words == EVERYWHERE
    kind = "points" if points else "none" if everywhere else "undecided"
    return Equilibria(kind, f"every box of angular velocities where {words} was proved empty or to hold exactly one equilibrium (Krawczyk)", points)


def _in_polynomials(parts: Content):
    """(omega as flint polynomials, the coefficients of the liquid's torque as flint's rationals)."""
    from flint import Ordering, fmpq_mpoly_ctx
    omega = fmpq_mpoly_ctx.get(("x", "y", "z"), Ordering.lex).gens()
    return omega, SimpleNamespace(D=tuple(map(rational, parts.D)), Lambda=tuple(map(rational, parts.Lambda)), printed=parts.printed)


def balance(parts: Content):
    """The three torques as flint polynomials in omega."""
    w, exact = _in_polynomials(parts)
    H = [d * x + l for d, x, l in zip(exact.D, w, exact.Lambda)]
    c, kappa = rational(parts.c), rational(parts.kappa)
    return [t + rational(m) - c * d * x + kappa * v
            for t, m, d, x, v in zip(cross(H, w), parts.M, exact.D, w, liquid_torque(exact, w))]


def _dictionary(polynomial) -> dict:
    return {tuple(map(int, powers)): Fraction(int(v.p), int(v.q)) for powers, v in polynomial.to_dict().items()}


def bounds(parts: Content) -> tuple[float, float]:
    """(alpha, beta): |part of degree 2|, |part of degree 3| of omega . (torque of the liquid)/kappa are at most alpha x^2, beta x^3."""
    w, exact = _in_polynomials(parts)
    work, out = _dictionary(dot(w, liquid_torque(exact, w))), {2: 0.0, 3: 0.0}
    for powers, value in work.items():
        if sum(powers) in out:  # on |y| = 1, y_i = sqrt(D_i) omega_i, a monomial is at most prod (k_i/n)^(k_i/2)
            largest = 1.0
            for k, d in zip(powers, parts.D):
                largest *= (k / sum(powers) / float(d)) ** (k / 2) if k else 1.0
            out[sum(powers)] += abs(float(value)) * largest
    return out[2] * ROUND, out[3] * ROUND


def trap(parts: Content) -> tuple[float, float] | None:
    """(x1, x2): sqrt(2 T) falls between them (x2 may be inf); None where the liquid may outweigh the resistance."""
    push = sqrt(sum(float(m) ** 2 / float(d) for m, d in zip(parts.M, parts.D))) * ROUND
    alpha, beta = (float(parts.kappa) * v for v in bounds(parts))
    net = float(parts.c) - alpha
    if net <= 0 or net * net <= 4 * beta * push * ROUND:
        return None
    if beta == 0:
        return push / net * ROUND, inf
    root = sqrt(net * net - 4 * beta * push)
    return 2 * push / (net + root) * ROUND, (net + root) / (2 * beta) / ROUND


def _region(parts: Content):
    """(reach of omega, words), or (None, why not)."""
    found = trap(parts)
    if found is not None:
        x1, x2 = found
        if x1 == 0:
            x1 = min(1.0, x2 / 2)  # rest alone lies below x2; the search proves it again
        words = EVERYWHERE if x2 == inf else f"T < {x2 * x2 / 2:.6g} J (beyond it the torque of the liquid may outweigh the medium's)"
        return [x1 / sqrt(float(d)) * ROUND for d in parts.D], words
    limit = max(float(validity(parts)), 0.0)
    balance = sqrt(sum(float(m / d) ** 2 for m, d in zip(parts.M, parts.D))) / float(parts.c) if parts.c else 0.0
    if not max(limit, balance):
        return None, "undecided: the torque of the liquid may outweigh the body's own at every rate, and nothing bounds the equilibria"
    reach = max(limit, 3 * balance)
    return [reach] * 3, (f"|omega_i| < {reach:.6g} rad/s (where |omega| > {limit:.6g} rad/s the torque of the liquid may be as large as the body's own: "
                         "its derivation does not hold there)")


def _point(parts: Content, polynomials, x) -> EquilibriumPoint:
    """Spectrum and verdict at a proved zero, sharpened to some fifty digits and enclosed in balls."""
    import numpy as np
    with many_digits() as numbers:
        ball = _enclosed(polynomials, x, numbers)
        derivatives = [[_derivative(p, k) for k in range(3)] for p in polynomials]
        J = [[_value(q, ball, numbers) / numbers.ball(d) for q in row] for row, d in zip(derivatives, parts.D)]
        middle = np.array([[float(v.mid()) for v in row] for row in J])
        p2 = -(J[0][0] + J[1][1] + J[2][2])
        p1 = sum(J[i][i] * J[j][j] - J[i][j] * J[j][i] for i, j in ((0, 1), (0, 2), (1, 2)))
        p0 = -(J[0][0] * (J[1][1] * J[2][2] - J[1][2] * J[2][1]) - J[0][1] * (J[1][0] * J[2][2] - J[1][2] * J[2][0])
               + J[0][2] * (J[1][0] * J[2][1] - J[1][1] * J[2][0]))
        if p2 > 0 and p0 > 0 and p2 * p1 > p0:
            word, verdict = "stable", STABLE
        elif p2 < 0 or p0 < 0 or p2 * p1 < p0:
            word, verdict = "unstable", UNSTABLE
        else:
            word, verdict = "degenerate", OPEN
        at = tuple(0.0 if v.contains(0) else float(v.mid()) for v in ball)
    return EquilibriumPoint(at, tuple(complex(z) for z in np.linalg.eigvals(middle)), word, *verdict)


def _derivative(polynomial, k):
    return {tuple(p - (i == k) for i, p in enumerate(powers)): v * powers[k] for powers, v in polynomial.items() if powers[k]}


def _value(polynomial, x, numbers):
    total = numbers.ball(0)
    for powers, value in polynomial.items():
        term = numbers.ball(value)
        for base, n in zip(x, powers):
            for _ in range(n):
                term = term * base
        total = total + term
    return total


def _enclosed(polynomials, x, numbers):
    """A ball around the zero next to x in which Krawczyk's test holds."""
    import numpy as np
    from flint import arb
    derivatives = [[_derivative(p, k) for k in range(3)] for p in polynomials]
    x = [arb(v) for v in x]
    J = np.array([[float(_value(q, x, numbers).mid()) for q in row] for row in derivatives])
    Y = [[arb(v) for v in row] for row in np.linalg.inv(J)]
    for _ in range(12):  # the inverse in doubles gains some thirteen digits a step
        f = [_value(p, x, numbers) for p in polynomials]
        x = [(v - sum(y * r for y, r in zip(row, f))).mid() for v, row in zip(x, Y)]
    size = max(float(abs(v).upper()) for v in x) or 1.0
    radius = arb(0, size * RADIUS)
    X = [v + radius for v in x]
    f = [_value(p, x, numbers) for p in polynomials]
    slope = [[_value(q, X, numbers) for q in row] for row in derivatives]
    for i in range(3):
        step = -sum(Y[i][j] * f[j] for j in range(3))
        for k in range(3):
            step = step + ((1 if i == k else 0) - sum(Y[i][j] * slope[j][k] for j in range(3))) * radius
        if not abs(step) < size * RADIUS:
            raise ArithmeticError("an equilibrium was not enclosed")
    return X
