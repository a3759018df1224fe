"""Are these all the equilibria, and are the verdicts on them right? Exact algebra for how many, Krawczyk's test for where."""
from __future__ import annotations

from fractions import Fraction
from itertools import combinations

from .complete import whole_conic, whole_torque_free
from .curves import check_curve, curve_of, identically_zero, judged
from .degenerate import leaves_double_root
from .numbers import Malformed, bracket, entries, exact_sign, field, hull, sign
from .planes import check_plane, plane_of
from .rates import characteristic
from .zeros import above, below

BITS, MOST_BITS = 128, 1 << 14


def check_equilibria(rates, claims, note):
    """Findings on the certificate's part `equilibria`."""
    kind = field(claims, "kind", "equilibria", str)
    points = [_Point(p, f"equilibria.points[{i}]") for i, p in enumerate(entries(claims, "points", "equilibria"))]
    curves = [curve_of(c, f"equilibria.curves[{i}]") for i, c in enumerate(entries(claims, "curves", "equilibria"))]
    planes = [plane_of(c, f"equilibria.planes[{i}]") for i, c in enumerate(entries(claims, "planes", "equilibria"))]
    for point in points:
        _check_point(rates, point, note)
    for curve in curves:
        if not identically_zero(rates, curve):
            note(curve.claim, "refuted", "the rates do not vanish along the curve")
        else:
            check_curve(rates, curve, note)
    for plane in planes:
        check_plane(rates, plane, note)
    _check_complete(rates, kind, points, curves, planes, note)


class _Point:
    """A claimed isolated equilibrium: a box, and what is said of it."""

    def __init__(self, table, where):
        boxes = field(table, "box", where, list)
        if len(boxes) != 3:
            raise Malformed(f"{where}.box: expected three brackets")
        self.box = [bracket(b, f"{where}.box[{i}]") for i, b in enumerate(boxes)]
        self.linear, self.verdict = (field(table, key, where, str) for key in ("linear", "verdict"))
        self.claim = f"equilibrium near ({', '.join(f'{float((a + b) / 2):.9g}' for a, b in self.box)})"
        self.exact = all(a == b for a, b in self.box)


def _check_point(rates, point, note):
    if point.exact:
        x = [a for a, _ in point.box]
        if any(rates.at(x)):
            note(point.claim, "refuted", "the rates do not vanish at this exact point")
            return
        note(point.claim, "proved", "the rates vanish there exactly")
        m, n = characteristic(rates.jacobian(x))
        root = leaves_double_root(rates, x, m) if n == 0 <= m else None
        _judge(point, exact_sign(m), exact_sign(n), root, note)
        return
    found = _only_zero(rates, point.box)
    if found is None:
        note(point.claim, "not checked", "Krawczyk's test did not close on this box")
        return
    note(point.claim, "proved", "Krawczyk's test: one and only one equilibrium in the box")
    _judge(point, *found, None, note)


def _judge(point, m, n, root, note):
    """Verdicts from the signs of m and n; an isolated equilibrium. root: the proof for a double root with n = 0 <= m."""
    linear = "unstable" if n or m == -1 else "stable" if m else "degenerate"
    where = f"signs of m and n give {linear}"
    note(f"{point.claim}: linear {point.linear}", "proved" if point.linear == linear else "refuted", where)
    proof = ("unstable", where) if linear == "unstable" else root
    note(f"{point.claim}: verdict {point.verdict}", *judged(point.verdict, proof, "the leading term vanishes too"))


def _only_zero(rates, box):
    """(sign of m, sign of n) at the one zero in the box, or None where the test does not close."""
    from flint import arb_mat, ctx
    bits = BITS
    while bits <= MOST_BITS:
        with ctx.workprec(bits):
            x = [hull(a, b) for a, b in box]
            for _ in range(60):
                new = _krawczyk(rates, x, arb_mat)
                if new is None or not all(inside(a, b) for a, b in zip(new, x)):
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


def inside(inner, outer):
    """Strictly: the inner ball in the interior of the outer one."""
    return outer.contains_interior(inner)


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


# -- completeness


def _rank(rows):
    """Rank of rows of fractions."""
    rows, rank = [list(r) for r in rows], 0
    for column in range(len(rows[0])):
        pivot = next((r for r in rows[rank:] if r[column]), None)
        if pivot is None:
            continue
        rows.remove(pivot)
        rows.insert(rank, pivot)
        for i in range(rank + 1, len(rows)):
            factor = rows[i][column] / pivot[column]
            rows[i] = [a - factor * b for a, b in zip(rows[i], pivot)]
        rank += 1
    return rank


def _check_complete(rates, kind, points, curves, planes, note):
    claim = f"the equilibria are complete: {kind}, {len(points)} isolated, {len(curves)} curves"
    claim += f", {len(planes)} planes" if planes else ""
    boxes_apart = all(any(a[1] < b[0] or b[1] < a[0] for a, b in zip(p.box, q.box)) for p, q in combinations(points, 2))
    if not boxes_apart:
        note(claim, "refuted", "two boxes overlap")
        return
    normals = [n for n, _ in rates.conditions]
    if not rates.torque:
        status, reason = whole_torque_free(rates, kind, points, curves, planes)
    elif _rank([[*n, c] for n, c in rates.conditions]) > _rank(normals):
        none = kind == "none" and not points and not curves
        status, reason = ("proved" if none else "refuted"), "the two linear conditions contradict each other: there are none"
    elif _rank(normals) == 1:
        status, reason = whole_conic(rates, kind, points, curves)
    else:
        status, reason = _on_a_line(rates, kind, points, curves)
    note(claim, status, reason)


def _on_a_line(rates, kind, points, curves):
    """The conditions meet in a line: count the common zeros of the rates on it."""
    g = _common_factor(rates)
    if not g:
        whole = kind == "curves" and len(curves) == 1 and not points and _is_line(curves[0])
        return ("proved" if whole else "refuted"), "the rates vanish all along the line where the two conditions meet"
    count = _real_roots(g)
    right = not curves and len(points) == count and kind == ("points" if count else "none")
    return ("proved" if right else "refuted"), f"on the line where the two conditions meet the rates have {count} common zeros"


def _is_line(curve):
    return curve.degree == 1 and curve.bottom.degree() == 0  # a pole would leave out one point


def _common_factor(rates) -> list[Fraction]:
    """Coefficients, lowest first, of the greatest common divisor of the rates on the line; [] where all vanish."""
    from flint import fmpq_poly

    from .numbers import q
    (a, ca), (b, cb) = rates.conditions
    v = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    size = sum(c * c for c in v)
    # the foot of the line: x = (ca (v x b) + cb (a x v)) / |v|^2 with a . x = -ca, b . x = -cb
    vb = [v[1] * b[2] - v[2] * b[1], v[2] * b[0] - v[0] * b[2], v[0] * b[1] - v[1] * b[0]]
    av = [a[1] * v[2] - a[2] * v[1], a[2] * v[0] - a[0] * v[2], a[0] * v[1] - a[1] * v[0]]
    foot = [(ca * s + cb * t) / size for s, t in zip(vb, av)]
    assert all(sum(n * x for n, x in zip(normal, foot)) + c == 0 for normal, c in rates.conditions)
    line = [fmpq_poly([q(f), q(d)]) for f, d in zip(foot, v)]
    total = fmpq_poly([])
    for p in rates.at(line):
        total = total.gcd(p)
    return [Fraction(int(c.p), int(c.q)) for c in total.coeffs()]


def _real_roots(g) -> int:
    """Distinct real roots of a polynomial of degree 2 or less."""
    if len(g) < 3:
        return len(g) - 1
    return exact_sign(g[1] * g[1] - 4 * g[2] * g[0]) + 1
