"""Do the curves cover everything? In the plane of the two conditions they are a conic; without a torque every s of
D x + lambda = s x must be passed."""
from __future__ import annotations

from fractions import Fraction
from functools import partial

from ..numbers import q
from .curves import Curve
from .planes import Plane


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
    twice = len(lines) == 2 and _proportional(*lines)
    right = product is not None and not twice and _proportional(product, conic)
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
    if not curve.straight:
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
    if free:
        alone = not curves and not planes
        return ("proved" if alone else "refuted"), "every rate of rotation is constant: there are no curves or planes to list"
    missing, spare = _matched(_parts(rates), curves, planes)
    if missing:
        return "refuted", f"{missing[0]} is missing"
    if spare:
        return "refuted", f"{spare[0]} is listed twice, or is no part of its own"
    if rates.parallel is None:
        return "proved", "x2 x3 = x3 (x1 + a) = x2 (x1 + b) = 0 are three lines"
    return "proved", "every s of D x + lambda = s x is passed, and each axis that carries no gyrostatic moment is there"


def _matched(parts, curves, planes):
    """(names of parts that nothing claimed is, claims that are no part or one that is taken already)."""
    spare, missing = [*curves, *planes], []
    for name, is_it in parts:
        found = next((claimed for claimed in spare if is_it(claimed)), None)
        if found is None:
            missing.append(name)
        else:
            spare.remove(found)
    return missing, [claimed.claim for claimed in spare]


def _parts(rates):
    """(name, test of a claimed curve or plane) of each part of the equilibria without a torque."""
    if rates.parallel is None:
        return [(f"the line along x{i + 1}", partial(_is_the_line, *line)) for i, line in enumerate(_scaled_lines(rates))]
    D, lam = rates.parallel
    parts = [("the curve that passes every s of D x + lambda = s x", partial(_passes_every_s, D, lam))] if any(lam) else []
    for d in sorted(set(D)):
        axes = [i for i in range(3) if D[i] == d]
        if any(lam[i] for i in axes):
            continue
        if len(axes) > 1:
            across = 3 - sum(axes)
            parts.append((f"the plane across axis {across + 1}", partial(_is_the_plane, across, lam[across] / (d - D[across]))))
            continue
        base = [Fraction(0) if i in axes else lam[i] / (d - D[i]) for i in range(3)]
        parts.append((f"the line along axis {axes[0] + 1}", partial(_is_the_line, base, [Fraction(int(i in axes)) for i in range(3)])))
    return parts


def _scaled_lines(rates):
    """(base, direction) of the three lines of the scaled system without torque."""
    a, b = -rates.sigma[1], rates.rho[2]
    o, one = Fraction(0), Fraction(1)
    return [([o, o, o], [one, o, o]), ([-b, o, o], [o, one, o]), ([-a, o, o], [o, o, one])]


def _is_the_plane(axis, height, claimed) -> bool:
    return isinstance(claimed, Plane) and claimed.lies(axis, height)


def _is_the_line(base, direction, claimed) -> bool:
    if not isinstance(claimed, Curve) or not claimed.straight:
        return False
    points = [claimed.at(Fraction(t)) for t in (0, 1)]
    return all(u[i] * direction[j] == u[j] * direction[i]
               for p in points for u in [[a - b for a, b in zip(p, base)]] for i in range(3) for j in range(3))


def _passes_every_s(D, lam, curve) -> bool:
    """Whether s = (D_l x_l + lambda_l)/x_l is of degree 1 in t, and infinite t is where the curve itself is infinite."""
    if not isinstance(curve, Curve):
        return False
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
