"""Do the curves cover everything? In the plane of the two conditions they are a conic; without a torque every s of
D x + lambda = s x must be passed."""
from __future__ import annotations

from fractions import Fraction

from .numbers import q


def whole_conic(rates, kind, points, curves):
    """(status, reason): equilibria of a torque whose two conditions are one plane."""
    conic = _conic(rates)
    if conic is None:
        return "not checked", "in the plane the rates are not multiples of one conic"
    A, B, C, D, E, F = conic
    if not any((A, B, C, D, E)):
        right = kind == "none" and not curves and not points
        return ("proved" if right else "refuted"), "in the plane one condition is left, and it is a constant that is not zero"
    if points or kind != "curves":
        return "refuted", "the equilibria are a conic: curves, without isolated points"
    degenerate = 4 * A * C * F + B * D * E - A * E * E - C * D * D - B * B * F == 0
    if not degenerate:
        one = curves[0] if len(curves) == 1 else None
        proper = one is not None and one.degree == 2 and one.bottom.degree() < 2
        return ("proved" if proper else "refuted"), "a conic that does not fall apart; a parametrisation of degree 2 runs over all of it"
    lines = [_line_in_plane(rates, c) for c in curves]
    if any(line is None for line in lines):
        return "refuted", "the conic falls apart into lines; a curve is none"
    product = _product(lines)
    right = product is not None and _proportional(product, conic)
    if not right and len(lines) == 1:
        right = _proportional(_product(lines * 2), conic)
    return ("proved" if right else "refuted"), "the conic falls apart into lines, whose product is the condition"


def _free(rates):
    """(pivot, free coordinates, normal, constant) of the plane."""
    normal, constant = next((n, c) for n, c in rates.conditions if any(n))
    pivot = max(range(3), key=lambda i: abs(normal[i]))
    return pivot, [i for i in range(3) if i != pivot], normal, constant


def _conic(rates):
    """Coefficients of p^2, p r, r^2, p, r, 1 of the one condition in the plane; None where the rates are not multiples of one."""
    pivot, (i, j), normal, constant = _free(rates)

    def at(p, r):
        x = [Fraction(0)] * 3
        x[i], x[j] = Fraction(p), Fraction(r)
        x[pivot] = -(constant + normal[i] * x[i] + normal[j] * x[j]) / normal[pivot]
        return rates.at(x)
    o, e, w, n, s, ne = at(0, 0), at(1, 0), at(-1, 0), at(0, 1), at(0, -1), at(1, 1)
    rows = []
    for k in range(3):
        a, c = (e[k] + w[k]) / 2 - o[k], (n[k] + s[k]) / 2 - o[k]
        d, f = (e[k] - w[k]) / 2, (n[k] - s[k]) / 2
        rows.append((a, ne[k] - a - c - d - f - o[k], c, d, f, o[k]))
    leading = next((r for r in rows if any(r)), None)
    if leading is None or not all(_proportional(r, leading) for r in rows):
        return None
    return leading


def _proportional(a, b) -> bool:
    return all(x * v == y * u for x, u in zip(a, b) for y, v in zip(a, b))


def _line_in_plane(rates, curve):
    """(l, m, n) of the line l p + m r + n = 0 that the curve runs along; None where it is no straight line."""
    if curve.degree != 1 or curve.bottom.degree() != 0:
        return None
    _, (i, j), *_ = _free(rates)
    a, b = curve.at(Fraction(0)), curve.at(Fraction(1))
    dp, dr = b[i] - a[i], b[j] - a[j]
    return dr, -dp, dp * a[j] - dr * a[i]


def _product(lines):
    if len(lines) == 1:
        l, m, n = lines[0]
        return (0, 0, 0, l, m, n)
    if len(lines) == 2:
        (a, b, c), (d, e, f) = lines
        return (a * d, a * e + b * d, b * e, a * f + c * d, b * f + c * e, c * f)
    return None


def whole_torque_free(rates, kind, points, curves, planes):
    """(status, reason): equilibria without a torque, where momentum and rotation are parallel."""
    if points:
        return "refuted", "without a torque no equilibrium is isolated"
    free = rates.parallel is not None and not any(rates.parallel[1]) and len(set(rates.parallel[0])) == 1
    if kind != ("all" if free else "curves"):
        return "refuted", "without a torque they are curves, or every rate of rotation for a sphere that carries no gyrostatic moment"
    if rates.parallel is None:
        wanted = _scaled_lines(rates)
        missing = [w for w in wanted if not any(_is_the_line(c, *w) for c in curves)]
        return ("refuted" if missing else "proved"), "x2 x3 = x3 (x1 + a) = x2 (x1 + b) = 0 are three lines"
    D, lam = rates.parallel
    if free:
        return "proved", "every rate of rotation is constant"
    if any(lam) and not any(_passes_every_s(D, lam, c) for c in curves):
        return "refuted", "no curve passes every s of D x + lambda = s x"
    for d in set(D):
        axes = [i for i in range(3) if D[i] == d]
        if any(lam[i] for i in axes):
            continue
        if len(axes) > 1:
            across = 3 - sum(axes)
            if not any(plane.lies(across, lam[across] / (d - D[across])) for plane in planes):
                return "refuted", f"two equal moments: the plane of equilibria across axis {across + 1} is missing"
            continue
        base = [Fraction(0) if i in axes else lam[i] / (d - D[i]) for i in range(3)]
        direction = [Fraction(int(i in axes)) for i in range(3)]
        if not any(_is_the_line(c, base, direction) for c in curves):
            return "refuted", f"the line along axis {axes[0] + 1} is missing"
    return "proved", "every s of D x + lambda = s x is passed, and each axis that carries no gyrostatic moment is there"


def _scaled_lines(rates):
    """(base, direction) of the three lines of the scaled system without torque."""
    a, b = -rates.sigma[1], rates.rho[2]
    o, one = Fraction(0), Fraction(1)
    return [([o, o, o], [one, o, o]), ([-a, o, o], [o, o, one]), ([-b, o, o], [o, one, o])]


def _is_the_line(curve, base, direction) -> bool:
    if curve.degree != 1 or curve.bottom.degree() != 0:
        return False
    points = [curve.at(Fraction(t)) for t in (0, 1)]
    return all(u[i] * direction[j] == u[j] * direction[i]
               for p in points for u in [[a - b for a, b in zip(p, base)]] for i in range(3) for j in range(3))


def _passes_every_s(D, lam, curve) -> bool:
    """Whether s = (D_l x_l + lambda_l)/x_l is of degree 1 in t, and infinite t is where the curve itself is infinite."""
    l = next(i for i in range(3) if lam[i])
    top, bottom = q(D[l]) * curve.tops[l] + q(lam[l]) * curve.bottom, curve.tops[l]
    if bottom == 0:
        return False
    common = top.gcd(bottom)
    top, bottom = top // common, bottom // common
    if max(top.degree(), bottom.degree()) != 1:
        return False
    if bottom.degree() < 1:
        return False  # s would be infinite, and x zero, at t = infinity: rest would be missing
    limit = top[1] / bottom[1]  # s at infinite t: must be a pole of the curve
    return any(lam[i] and limit == q(D[i]) for i in range(3))
