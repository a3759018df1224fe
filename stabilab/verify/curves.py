"""Curves, lines and planes of equilibria: where they are, and how stable. What decides where m and n vanish,
or on a line of equilibria that no potential explains, returns (verdict, reason), or None where it proves
nothing; the arguments are in docs/certificate.md."""
from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from typing import Any

from flint import fmpq_poly

from .numbers import (
    AHEAD,
    LINEAR,
    VERDICT,
    Malformed,
    Rates,
    bracket,
    brief,
    characteristic,
    entries,
    exact_sign,
    field,
    fraction,
    numbers,
    q,
    word,
)
from .roots import TOO_LARGE, Root, TooLarge, Work, real_roots


def dot(a: Sequence[Fraction], b: Sequence[Fraction | int]):
    """Scalar product of two lists of three."""
    return sum(u * v for u, v in zip(a, b))


def cross(a: Sequence[Fraction], b: Sequence[Fraction]):
    """Vector product."""
    return [a[j] * b[k] - a[k] * b[j] for j, k in AHEAD]


def turned(J: Sequence[list[Fraction]], e: Sequence[int | Fraction]):
    """A matrix times a column."""
    return [dot(row, e) for row in J]


def product(A: Sequence[list[Fraction]], B: Sequence[list[Fraction]]):
    """Matrix product; entries of any kind."""
    return [[sum((A[i][k] * B[k][j] for k in (1, 2)), A[i][0] * B[0][j]) for j in range(3)] for i in range(3)]


# -- without a torque: two quadratic integrals


def on_common_level(rates: Rates, x: Sequence[Fraction]):
    """By the points near an equilibrium that share both integrals with it: none, stable (the sum of the
    squares of their changes is a Lyapunov function); regular branches, unstable (in and out alternate along
    them)."""
    (B, g), (A, h) = [(quad, [b * v + l for b, v, l in zip(quad, x, linear)])
                      for quad, linear in rates.integrals]
    if not (any(g) or any(h)):
        # no d_i^2 >= 0 but zero solves both equations
        mixed = {exact_sign(v) for v in cross(A, B)} >= {1, -1}
        return ("stable", "a combination of the integrals is definite there") if mixed else None
    if not any(g):
        (B, g), (A, h) = (A, h), (B, g)
    pivot = next(i for i in range(3) if g[i])
    part = h[pivot] / g[pivot]
    if any(u - part * v for u, v in zip(h, g)):
        return None
    return _meets_surface([u - part * v for u, v in zip(A, B)], g, B)


def _meets_surface(A: Sequence[Fraction], g: Sequence[Fraction], B: Sequence[Fraction]):
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
    # two planes, and g is not normal to both: in one a regular curve, across which the combination changes
    # sign
    return ("unstable",
            "branches of equal integrals pass through it, along which motions come in and go out in turn")


# -- a reduction to one degree of freedom


def reducing_direction(rates: Rates, curve: Curve):
    """e with x' = eta J(P x) e across e and eta' = F(P x) along it, P x in a plane that holds the curve; or
    None."""
    unit = lambda i: [Fraction(int(n == i)) for n in range(3)]
    places = [(rates.m, n, c) for n, c in rates.conditions if any(n)]
    last = curve.bottom.degree()
    for i, top in enumerate(curve.tops):
        value = top[last] / curve.bottom[last]
        if top == value * curve.bottom:
            places.append((unit(i), unit(i), -fraction(value)))
    return next((e for e, n, c in places if _reduces(rates, e, n, c, curve)), None)


def _reduces(rates: Rates, e: Sequence[Fraction], n: Sequence[Fraction], c: Fraction, curve: Curve) -> bool:
    """Whether on the plane n.x + c = 0 the rates point along e and J e lies in it, and e's own quadratic rate
    is zero."""
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


# F along an orbit combines exp(+-2 n alpha), exp(+-n alpha) and 1: its first five coefficients decide
TERMS = 6


def on_own_orbit(rates: Rates, x: Sequence[Fraction], e: Sequence[Fraction]):
    """By the first coefficient of the force F along dx/dalpha = J(x) e: odd and negative a strict minimum of
    the potential."""
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
    """A polynomial whose sign is that of the mean motion along a line of equilibria, at second order in a
    disturbance; times a power of m. J, m: along the line. 0, +-i sqrt(m): P = J^2 + m projects on the line,
    and J J^T m + J^2 J^2^T holds the means of d_i d_j over a turn."""
    square = product(J, J)
    turn = lambda M: [list(row) for row in zip(*M)]
    once, twice = product(J, turn(J)), product(square, turn(square))
    means = [[m * a + b for a, b in zip(r, s)] for r, s in zip(once, twice)]
    lead = next((i for i in range(3) if any(square[i][j] + (m if i == j else 0) != 0 for j in range(3))), 0)
    left = [square[lead][j] + (m if lead == j else 0) for j in range(3)]
    return sum((left[i] * q(rates.kappa[i]) * means[j][k]
                for i, (j, k) in enumerate(AHEAD) if rates.kappa[i]), m * 0)


def leaves_fold(J, zero):
    """At a simple zero of m on a line of equilibria where J^2 is not zero: z' = y, y' = w, w' = b z y + ...,
    b = -dm/dz."""
    full = any(entry % zero.polynomial != 0 for row in product(J, J) for entry in row)
    return ("unstable",
            "m changes sign on a line of equilibria: z ~ 12/(b t^2) leaves the point") if full else None


def leaves_double_root(rates: Rates, x: Sequence[Fraction], m: Fraction):
    """At an isolated equilibrium with n = 0 <= m: z' = a z^2 + ... with a not 0 (m > 0), z''' = a z^2 + ...
    (m = 0)."""
    J = rates.jacobian(x)
    square = product(J, J)
    # v w^T, J v = 0 = w J
    along = [[v + m * (i == j) for j, v in enumerate(row)] for i, row in enumerate(square)]
    row = next((r for r in along if any(r)), None)
    if row is None:
        return None
    v = [r[next(i for i in range(3) if row[i])] for r in along]
    bend = sum(row[i] * rates.kappa[i] * v[j] * v[k] for i, (j, k) in enumerate(AHEAD))
    why = ("z' = a z^2 + b r^2, r' = -a z r with a not 0" if m
           else "z''' = a z^2 with a not 0: z ~ -60/(a t^3) leaves the point")
    return ("unstable", f"a double root: {why}") if bend else None


# --- Curves of equilibria, rational in a parameter: the rates vanish along them, and m changes sign where
# it is said to
PAIRS = ((0, 1), (0, 2), (1, 2))


class Curve:
    """x_i(t) = numerators[i](t)/denominator(t) with what is said of its pieces; coefficients lowest first."""

    def __init__(self, table: Mapping[str, Any], where: str):
        rows = field(table, "numerators", where, list)
        if len(rows) != 3:
            raise Malformed(f"{where}.numerators: expected three lists of coefficients")
        tops = [numbers(r, f"{where}.numerators[{i}]") for i, r in enumerate(rows)]
        bottom = numbers(field(table, "denominator", where), f"{where}.denominator")
        self.tops, self.bottom = [fmpq_poly([q(c) for c in row])
                                  for row in tops], fmpq_poly([q(c) for c in bottom])
        if self.bottom == 0:
            raise Malformed(f"{where}.denominator: expected a polynomial that is not zero")
        common = self.bottom
        for top in self.tops:
            common = common.gcd(top)
        self.tops, self.bottom = [top // common for top in self.tops], self.bottom // common
        self.degree = max(p.degree() for p in (*self.tops, self.bottom))
        self.claim = f"{'straight line' if self.straight else f'curve of degree {self.degree}'} ({where})"
        self.segments = [_piece(s, f"{where}.segments[{i}]")
                         for i, s in enumerate(entries(table, "segments", where))]
        self.folds = [(bracket(field(f, "t", w), f"{w}.t"), *words(f, w))
                      for i, f in enumerate(entries(table, "folds", where)) for w in [f"{where}.folds[{i}]"]]

    @property
    def straight(self) -> bool:
        """Whether it runs once along a whole straight line; a pole would leave out one point."""
        return self.degree == 1 and self.bottom.degree() == 0

    def at(self, t: Fraction):
        """The exact point at a rational parameter that is no pole."""
        return [fraction(top(q(t)) / self.bottom(q(t))) for top in self.tops]


def _piece(table: Mapping[str, Any], where: str):
    ends = field(table, "t", where, list)
    if len(ends) != 2:
        raise Malformed(f"{where}.t: expected two ends")
    ends = [None if e is None else bracket(e, f"{where}.t[{i}]") for i, e in enumerate(ends)]
    return ends, *words(table, where)


def words(table: Mapping[str, Any] | int | None, where: str):
    """The claimed linear word and verdict."""
    return word(table, "linear", where, LINEAR), word(table, "verdict", where, VERDICT)


def identically_zero(rates: Rates, curve: Curve) -> bool:
    """Whether the rates vanish all along it."""
    return not any(rate != 0 for rate in rates.at(curve.tops, curve.bottom))


def check_curve(rates: Rates, curve: Curve, note: Callable[[str, str], None]):
    """Findings on the verdicts along a curve on which the rates vanish."""
    note(curve.claim, "proved", "the rates vanish identically along it")
    J = rates.jacobian(curve.tops, curve.bottom)  # times the denominator
    m, n = characteristic(J)
    if n != 0 or m == 0:
        note(f"{curve.claim}: verdicts", "refuted" if n != 0 else "not checked",
             "the Jacobian's determinant does not vanish along it" if n != 0
             else "three zero eigenvalues all along")
        return
    try:
        _check_verdicts(_Along(rates, curve, J, m), note)
    except TooLarge:
        note(f"{curve.claim}: verdicts", "not checked", TOO_LARGE)


def _check_verdicts(along: _Along, note: Callable[[str, str], None]):
    """Findings on every piece and fold."""
    curve, m = along.curve, along.m
    marks = real_roots(m * curve.bottom, along.work)
    inner = [z for z in marks if curve.bottom % z.polynomial != 0]
    if len(curve.segments) != len(marks) + 1 or len(curve.folds) != len(inner):
        note(curve.claim, "refuted",
             f"m has {len(inner)} zeros and the curve {len(marks) - len(inner)} poles: {len(marks) + 1} "
             f"pieces and {len(inner)} folds, not {len(curve.segments)} and {len(curve.folds)}")
        return
    bounds = [None, *marks, None]
    signs = [_sign_between(m, low, high) for low, high in zip(bounds, bounds[1:])]
    for number, (piece, sign) in enumerate(zip(curve.segments, signs)):
        _check_piece(along, note, f"{curve.claim}: piece {number + 1}", piece, bounds[number:number + 2],
                     sign)
    for zero, fold in zip(inner, curve.folds):
        number = marks.index(zero)
        _check_fold(along, note, zero, fold, signs[number:number + 2])


def _check_piece(along: _Along, note: Callable[[str, str], None], where: str,
                 piece: tuple[list[tuple[Fraction, Fraction] | None], str, str],
                 bounds: Sequence[Root | None], sign: int):
    ends, linear, verdict = piece
    claim = f"{where}: linear {linear}, verdict {verdict}"
    if not all(_agrees(end, mark) for end, mark in zip(ends, bounds)):
        note(claim, "refuted", "its ends are not the zeros of m and the poles beside it")
    elif linear != ("stable" if sign > 0 else "unstable"):
        note(claim, "refuted", f"m is {'positive' if sign > 0 else 'negative'} on it")
    else:
        proof = along.centre(bounds) if sign > 0 else ("unstable", "m < 0")
        note(claim, *judged(verdict, proof, "a centre on a line of equilibria"))


def _check_fold(along, note, zero, fold, signs):
    ends, linear, verdict = fold
    claim = f"{along.curve.claim}: fold near t = {brief(sum(ends) / 2)}: linear {linear}, verdict {verdict}"
    if not _agrees(ends, zero) or linear != "degenerate":
        note(claim, "refuted", "m vanishes elsewhere, or does vanish here")
    else:
        note(claim, *judged(verdict, along.fold(zero, signs), "three zero eigenvalues"))


def judged(verdict: str, proof: Sequence[str] | None, otherwise: str):
    """(status, reason) of a claimed verdict, given (verdict, reason) or None."""
    if proof is None:
        return "not checked", f"{otherwise}: no proof is known here"
    if verdict == "undecided":
        return "not checked", f"the certificate leaves open what is proved: {proof[0]}: {proof[1]}"
    return ("proved" if verdict == proof[0] else "refuted"), proof[1]


class _Along:
    """What decides stability along one curve: the integrals without a torque, a reduction, or the drift along
    the line."""

    def __init__(self, rates: Rates, curve: Curve, J: Sequence[list[fmpq_poly]], m: fmpq_poly):
        self.rates, self.curve, self.J, self.m, self.work = rates, curve, J, m, Work()
        self.direction = reducing_direction(rates, curve) if rates.torque else None
        self.settled = not rates.torque or self.direction is not None

    def centre(self, bounds: Sequence[Root | None]):
        """The verdict between two marks where m > 0."""
        if self.settled:
            return "stable", "m > 0: a strict extremum"
        low, high = bounds
        k = drift(self.rates, self.J, self.m) if self.curve.straight else 0
        # those of m bound the piece
        others = [z for z in real_roots(k, self.work) if self.m % z.polynomial != 0] if k != 0 else []
        if k == 0 or any((low is None or low.before(z)) and (high is None or z.before(high)) for z in others):
            return None
        return "unstable", "a slow drift along the line of equilibria, in one direction all along the piece"

    def fold(self, zero: Root, signs: Sequence[int]):
        """The verdict at a zero of m between pieces with these signs of m."""
        minors = [self.J[a][c] * self.J[b][d] - self.J[a][d] * self.J[b][c]
                  for a, b in PAIRS for c, d in PAIRS]
        if all(v % zero.polynomial == 0 for v in minors):
            return self._crossing(zero)
        if self.settled:
            both = signs == [1, 1]
            return "stable" if both else "unstable", f"m is {'' if both else 'not '}positive on both sides"
        simple = self.m.derivative() % zero.polynomial != 0
        return leaves_fold(self.J, zero) if self.curve.straight and simple else None

    def _crossing(self, zero: Root):
        if zero.low != zero.high:
            return None
        x = self.curve.at(zero.low)
        if not self.rates.torque:
            return on_common_level(self.rates, x)
        return on_own_orbit(self.rates, x, self.direction) if self.direction else None

def _agrees(end: Sequence[Fraction] | None, mark: Root | None) -> bool:
    """Whether a claimed end (None: infinity) holds the zero that was found."""
    if end is None or mark is None:
        return end is None and mark is None
    return mark.within(*end)


def _sign_between(m: fmpq_poly, low: Root | None, high: Root | None) -> int:
    """Sign of m between two neighbouring marks (None: infinity)."""
    if low is None or high is None:
        t = Fraction(0) if low is high else high.low - 1 if low is None else low.high + 1
    else:
        t = (low.high + high.low) / 2
    return exact_sign(m(q(t)))


# --- Planes of equilibria: a body with two equal moments and no torque, its gyrostatic moment along the
# axis of symmetry
class Plane:
    """base + p u + r v with what is said of its points, and of one centre that may differ."""

    def __init__(self, table: Mapping[str, Any], where: str):
        self.base = numbers(field(table, "base", where), f"{where}.base", 3)
        rows = field(table, "directions", where, list)
        if len(rows) != 2:
            raise Malformed(f"{where}.directions: expected two")
        self.u, self.v = (numbers(row, f"{where}.directions[{i}]", 3) for i, row in enumerate(rows))
        self.normal = cross(self.u, self.v)
        if not any(self.normal):
            raise Malformed(f"{where}.directions: expected two directions that are not parallel")
        self.linear, self.verdict = word(table, "linear", where,
                                         LINEAR), word(table, "verdict", where, VERDICT)
        centre = field(table, "centre", where, dict)
        self.centre = numbers(field(centre, "at", f"{where}.centre"), f"{where}.centre.at", 3)
        self.centre_verdict = word(centre, "verdict", f"{where}.centre", VERDICT)
        self.claim = f"plane through ({', '.join(map(brief, self.base))})"

    def grid(self, size: int):
        """size x size of its points."""
        return [[b + p * u + r * v for b, u, v in zip(self.base, self.u, self.v)] for p in range(size)
                for r in range(size)]

    def lies(self, axis: int, height: Fraction) -> bool:
        """Whether it is the plane x_axis = height."""
        return self.base[axis] == height and not self.u[axis] and not self.v[axis]


def check_plane(rates: Rates, plane: Plane, note: Callable[[str, str], None]):
    """Findings on a plane: all of it at rest, all of it with three zero eigenvalues, and left by a drift but
    at the centre."""
    # a quadratic function that vanishes on a 3 x 3 grid vanishes
    if any(any(rates.at(x)) for x in plane.grid(3)):
        note(plane.claim, "refuted", "the rates do not vanish all over the plane")
        return
    note(plane.claim, "proved", "the rates vanish all over it")
    # m, n: of degree 3 at most
    zero = not any(v for x in plane.grid(4) for v in characteristic(rates.jacobian(x)))
    note(f"{plane.claim}: linear {plane.linear}",
         "proved" if zero and plane.linear == "degenerate" else "refuted",
         "m and n vanish all over it" if zero else "m or n does not vanish all over it")
    proof = _turning(rates, plane)
    if proof is not None and not _at(rates, proof, plane.centre, plane):
        note(f"{plane.claim}: centre", "refuted", "the turning does not vanish there")
        return
    for where, verdict, true in (("but its centre", plane.verdict, "unstable"),
                                 ("its centre", plane.centre_verdict, "stable")):
        why = (proof
               and (
                   true, f"beside the plane x' = d J(x) e turns about the centre, d the distance along e, "
                         f"axis {proof.index(1) + 1}"))
        note(f"{plane.claim}: {where} {verdict}", *judged(verdict, why, "no axis of symmetry was found"))


def _turning(rates: Rates, plane: Plane):
    """The axis e with x_e constant whose J(x) e turns x in the plane (so that beside it states run round
    circles); or None."""
    for i, (j, k) in enumerate(AHEAD):
        still = not any((rates.kappa[i], rates.rho[i], rates.sigma[i], rates.m[i]))
        if still and plane.lies(i, plane.base[i]) and rates.kappa[j] * rates.kappa[k] < 0:
            return [int(n == i) for n in range(3)]
    return None


def _at(rates: Rates, e: Sequence[int], centre: Sequence[Fraction], plane: Plane) -> bool:
    """Whether a point of the plane is where J(x) e vanishes."""
    on = sum(n * (c - b) for n, c, b in zip(plane.normal, centre, plane.base)) == 0
    return on and not any(turned(rates.jacobian(centre), e))
