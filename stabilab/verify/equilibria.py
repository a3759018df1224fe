"""What a certificate claims of equilibria, checked: each is one, none is missing, its stability. With a
torque they lie on a line or a conic in the plane of the two conditions; without one every s of D x + lambda =
s x must be passed. """
from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import partial
from math import prod
from typing import Any

from flint import fmpq_mat, fmpq_mpoly, fmpq_mpoly_ctx, fmpq_poly

from .curves import (
    Curve,
    Plane,
    check_curve,
    check_plane,
    cross,
    dot,
    identically_zero,
    judged,
    leaves_double_root,
    words,
)
from .numbers import Rates, brackets, brief, characteristic, entries, exact_sign, excluded, field, q, word
from .roots import TOO_LARGE, Root, TooLarge, Work, real_roots


# --- Where the two conditions meet in a line: the exact zeros of the rates on it, and whether the boxes
# hold each of them once
@dataclass(frozen=True)
class Place:
    """An equilibrium on the line, foot + t direction with a zero t of a polynomial."""

    foot: list[Fraction]
    direction: list[Fraction]
    t: Root

    @property
    def rational(self) -> list[Fraction] | None:
        """The three components where t is rational; else None."""
        return ([f + self.t.low * d for f, d in zip(self.foot, self.direction)] if self.t.rational
                else None)

    def within(self, box: Sequence[tuple[Fraction, Fraction]]) -> bool:
        """Whether it lies in the box of three closed brackets, exactly."""
        return all(self.t.within(*sorted(((low - f) / d, (high - f) / d))) if d else low <= f <= high
                   for f, d, (low, high) in zip(self.foot, self.direction, box))

    def signs(self, rates: Rates) -> tuple[int, int]:
        """(sign of m, sign of n) there, exactly."""
        line = [fmpq_poly([q(f), q(d)]) for f, d in zip(self.foot, self.direction)]
        m, n = map(self.t.sign, characteristic(rates.jacobian(line)))
        return m, n


@dataclass(frozen=True)
class Line:
    """The line where the two conditions meet. places: the equilibria on it, or None where all of it is at
    rest."""

    places: tuple[Place, ...] | None


def line_of(rates: Rates) -> Line | None:
    """The equilibria of a torque whose two conditions meet in one line; None where they do not."""
    if not rates.torque or _rank([n for n, _ in rates.conditions]) < 2:
        return None
    foot, v = _line(rates)
    common = fmpq_poly([])
    for rate in rates.at([fmpq_poly([q(f), q(d)]) for f, d in zip(foot, v)]):
        common = common.gcd(rate)
    return Line(None if common == 0 else tuple(Place(foot, v, t) for t in real_roots(common, Work())))


def contradictory(rates: Rates) -> bool:
    """Whether the two linear conditions exclude each other."""
    return _rank([[*n, c] for n, c in rates.conditions]) > _rank([n for n, _ in rates.conditions])


def whole_line(kind: str, points: Sequence[_Point], curves: Sequence[Curve], places: Sequence[Place] | None):
    """(status, reason): equilibria of a torque whose two conditions meet in a line. places: those on it
    (`Line`)."""
    if places is None:
        full = kind == "curves" and len(curves) == 1 and not points and curves[0].straight
        return ("proved" if full
                else "refuted"), "the rates vanish all along the line where the two conditions meet"
    once = (len(points) == len(places)
            and all(sum(location.within(p.box) for p in points) == 1 for location in places))
    right = once and not curves and kind == ("points" if places else "none")
    why = f"on the line where the two conditions meet the rates have {len(places)} common zeros"
    return ("proved" if right else "refuted"), f"{why}, {'' if once else 'not '}each in a box of its own"


def _rank(rows: Sequence[list[Fraction]]):
    """Rank of rows of fractions."""
    return fmpq_mat([[q(v) for v in row] for row in rows]).rank()


def _line(rates: Rates):
    """(foot, direction) of the line where the two conditions meet."""
    (a, ca), (b, cb) = rates.conditions
    v = cross(a, b)
    # the foot of the line: x = (ca (v x b) + cb (a x v)) / |v|^2 with a . x = -ca, b . x = -cb
    foot = [(ca * s + cb * t) / dot(v, v) for s, t in zip(cross(v, b), cross(a, v))]
    if any(sum(n * x for n, x in zip(normal, foot)) + c for normal, c in rates.conditions):
        raise ArithmeticError("the foot of the line where the two conditions meet is not on both")
    return foot, v


def whole_conic(rates, kind, points, curves):
    """(status, reason): equilibria of a torque whose two conditions are one plane."""
    conic = _conic(rates)
    if conic is None:
        return "not checked", "in the plane the rates are not multiples of one conic"
    if conic.is_constant():
        right = kind == "none" and not curves and not points
        return ("proved" if right
                else "refuted"), "in the plane one condition is left, and it is a constant that is not zero"
    if points or kind != "curves":
        return "refuted", "the equilibria are a conic: curves, without isolated points"
    A, B, C, D, E, F = (conic[powers] for powers in ((2, 0), (1, 1), (0, 2), (1, 0), (0, 1), (0, 0)))
    degenerate = 4 * A * C * F + B * D * E - A * E * E - C * D * D - B * B * F == 0
    if not degenerate:
        item = curves[0] if len(curves) == 1 else None
        proper = item is not None and item.degree == 2 and item.bottom.degree() < 2
        return ("proved" if proper else "refuted",
                "a conic that does not fall apart; a parametrisation of degree 2 runs over all of it")
    if not all(curve.straight for curve in curves):
        return "refuted", "the conic falls apart into lines; a curve is none"
    lines = [_line_in_plane(rates, curve) for curve in curves]
    twice = len(lines) == 2 and _proportional(*lines)
    right = not twice and _proportional(prod(lines, start=PLANE.constant(1)), conic)
    right = right or (len(lines) == 1 and _proportional(lines[0] ** 2, conic))
    return ("proved" if right
            else "refuted"), "the conic falls apart into lines, whose product is the condition"


def _free(rates: Rates):
    """(pivot, free coordinates, normal, constant) of the plane."""
    normal, constant = next((n, c) for n, c in rates.conditions if any(n))
    pivot = max(range(3), key=lambda i: abs(normal[i]))
    return pivot, [i for i in range(3) if i != pivot], normal, constant


PLANE = fmpq_mpoly_ctx.get(("p", "r"), "lex")


def _conic(rates: Rates):
    """The one condition in the plane, a polynomial in the two free coordinates; None where the rates are not
    multiples of one."""
    pivot, free, normal, constant = _free(rates)
    x = [PLANE.constant(0)] * 3
    for i, coordinate in zip(free, PLANE.gens()):
        x[i] = coordinate
    x[pivot] = -(sum(q(normal[i]) * x[i] for i in free) + q(constant)) / q(normal[pivot])
    rows = [rate for rate in rates.at(x) if rate != 0]
    return rows[0] if rows and all(_proportional(rate, rows[0]) for rate in rows) else None


def _proportional(f: fmpq_mpoly, g: fmpq_mpoly) -> bool:
    """Whether two polynomials that are not zero are multiples of each other."""
    return f * g.leading_coefficient() == g * f.leading_coefficient()


def _line_in_plane(rates: Rates, curve: Curve):
    """The polynomial that is zero on a straight line of the plane."""
    _, (i, j), *_ = _free(rates)
    (p, r), a, b = PLANE.gens(), curve.at(Fraction(0)), curve.at(Fraction(1))
    return q(b[j] - a[j]) * (p - q(a[i])) - q(b[i] - a[i]) * (r - q(a[j]))


def whole_torque_free(rates, kind, points, curves, planes):
    """(status, reason): equilibria without a torque, where momentum and rotation are parallel."""
    if points:
        return "refuted", "without a torque no equilibrium is isolated"
    free = rates.parallel is not None and not any(rates.parallel[1]) and len(set(rates.parallel[0])) == 1
    if kind != ("all" if free else "curves"):
        return ("refuted",
                "without a torque they are curves, or every rate of rotation for a sphere that carries no "
                "gyrostatic moment")
    if free:
        alone = not curves and not planes
        return ("proved" if alone
                else "refuted"), "every rate of rotation is constant: there are no curves or planes to list"
    missing, spare = _matched(_parts(rates), curves, planes)
    if missing:
        return "refuted", f"{missing[0]} is missing"
    if spare:
        return "refuted", f"{spare[0]} is listed twice, or is no part of its own"
    if rates.parallel is None:
        return "proved", "x2 x3 = x3 (x1 + a) = x2 (x1 + b) = 0 are three lines"
    return ("proved",
            "every s of D x + lambda = s x is passed, and each axis that carries no gyrostatic moment "
            "is there")


def _matched(parts, curves, planes):
    """(names of parts that nothing claimed is, claims that are no part or one that is taken already)."""
    spare, missing = [*curves, *planes], []
    for name, is_it in parts:
        result = next((claimed for claimed in spare if is_it(claimed)), None)
        if result is None:
            missing.append(name)
        else:
            spare.remove(result)
    return missing, [claimed.claim for claimed in spare]


def _parts(rates: Rates):
    """(name, test of a claimed curve or plane) of each part of the equilibria without a torque."""
    if rates.parallel is None:
        return [(f"the line along x{i + 1}", partial(_is_the_line, *line))
                for i, line in enumerate(_scaled_lines(rates))]
    D, lam = rates.parallel
    parts = ([("the curve that passes every s of D x + lambda = s x", partial(_passes_every_s, D, lam))]
             if any(lam) else [])
    for d in sorted(set(D)):
        axes = [i for i in range(3) if D[i] == d]
        if any(lam[i] for i in axes):
            continue
        if len(axes) > 1:
            across = 3 - sum(axes)
            parts.append((f"the plane across axis {across + 1}",
                          partial(_is_the_plane, across, lam[across] / (d - D[across]))))
            continue
        base = [Fraction(0) if i in axes else lam[i] / (d - D[i]) for i in range(3)]
        parts.append((f"the line along axis {axes[0] + 1}",
                      partial(_is_the_line, base, [Fraction(int(i in axes)) for i in range(3)])))
    return parts


def _scaled_lines(rates: Rates):
    """(base, direction) of the three lines of the scaled system without torque."""
    a, b = -rates.sigma[1], rates.rho[2]
    o, item = Fraction(0), Fraction(1)
    return [([o, o, o], [item, o, o]), ([-b, o, o], [o, item, o]), ([-a, o, o], [o, o, item])]


def _is_the_plane(axis: int, height: Fraction, claimed: Plane) -> bool:
    return isinstance(claimed, Plane) and claimed.lies(axis, height)


def _is_the_line(base: Sequence[Fraction], direction: Sequence[Fraction], claimed: Curve) -> bool:
    if not isinstance(claimed, Curve) or not claimed.straight:
        return False
    points = [claimed.at(Fraction(t)) for t in (0, 1)]
    return all(u[i] * direction[j] == u[j] * direction[i]
               for p in points for u in [[a - b for a, b in zip(p, base)]] for i in range(3)
               for j in range(3))


def _passes_every_s(D: Sequence[Fraction], lam: Sequence[Fraction], curve: Curve) -> bool:
    """Whether s = (D_l x_l + lambda_l)/x_l is of degree 1 in t, and infinite t is where the curve itself is
    infinite."""
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


# --- Are these all the equilibria, and are the verdicts on them right?
KINDS = ("none", "points", "curves", "all")


@dataclass(frozen=True)
class Claims:
    """The certificate's part `equilibria`, read."""

    kind: str
    points: list
    curves: list
    planes: list


def equilibria_of(table: Mapping[str, Any]) -> Claims:
    """The claims on equilibria. Raises `Malformed` before anything is worked out."""
    read = lambda key, built: [built(v, f"equilibria.{key}[{i}]")
                              for i, v in enumerate(entries(table, key, "equilibria"))]
    return Claims(word(table, "kind", "equilibria", KINDS), read("points", _Point), read("curves", Curve),
                  read("planes", Plane))


def check_equilibria(rates: Rates, claims: Claims, note: Callable[[str, str], None]):
    """Findings on the certificate's part `equilibria`."""
    try:
        _check_all(rates, claims, line_of(rates), note)
    except TooLarge:
        note("the other equilibria", "not checked", TOO_LARGE)


def _check_all(rates: Rates, claims: Claims, line: Line | None, note: Callable[[str, str], None]):
    for point in claims.points:
        _check_point(rates, point, line, note)
    for curve in claims.curves:
        if not identically_zero(rates, curve):
            note(curve.claim, "refuted", "the rates do not vanish along the curve")
        else:
            check_curve(rates, curve, note)
    for plane in claims.planes:
        check_plane(rates, plane, note)
    _check_complete(rates, claims, line, note)


class _Point:
    """A claimed isolated equilibrium: a box, and what is said of it."""

    def __init__(self, table: int | Mapping[str, Any] | None, where: str):
        self.box = brackets(field(table, "box", where), f"{where}.box")
        self.linear, self.verdict = words(table, where)
        self.claim = f"equilibrium near ({', '.join(brief((a + b) / 2) for a, b in self.box)})"
        self.exact = all(a == b for a, b in self.box)


def _check_point(rates: Rates, point: _Point, line: Line | None, note: Callable[[str, str], None]):
    if point.exact:
        x = [a for a, _ in point.box]
        if any(rates.at(x)):
            note(point.claim, "refuted", "the rates do not vanish at this exact point")
        else:
            note(point.claim, "proved", "the rates vanish there exactly")
            _judge(rates, point, x, note)
    elif line is None or line.places is None:
        none = excluded(rates, point.box)
        note(point.claim,
             *(("refuted", "a rate does not vanish in the box") if none
               else ("not checked", "no isolated equilibrium is known there")))
    else:
        _check_box(rates, point, line.places, note)


def _check_box(rates: Rates, point: _Point, places: Sequence[Place], note: Callable[[str, str], None]):
    """Findings on a box of some width, given all equilibria of the scene exactly."""
    held = [location for location in places if location.within(point.box)]
    if len(held) != 1:
        note(point.claim, "refuted", f"the box holds {len(held)} zeros of the rates, not one")
        return
    note(point.claim, "proved", "it holds one of the exact zeros of the rates, and no other")
    if held[0].rational:
        _judge(rates, point, held[0].rational, note)
    else:
        _say(point, *held[0].signs(rates), None, note)


def _judge(rates: Rates, point: _Point, x: Sequence[Fraction], note: Callable[[str, str], None]):
    """Verdicts at an exact equilibrium."""
    m, n = characteristic(rates.jacobian(x))
    _say(point, exact_sign(m), exact_sign(n), leaves_double_root(rates, x, m) if n == 0 <= m else None, note)


def _say(point, m, n, root, note):
    """Verdicts from the signs of m and n; an isolated equilibrium. root: the proof for a double root with n =
    0 <= m."""
    linear = "unstable" if n or m == -1 else "stable" if m else "degenerate"
    where = f"signs of m and n give {linear}"
    note(f"{point.claim}: linear {point.linear}", "proved" if point.linear == linear else "refuted", where)
    proof = ("unstable", where) if linear == "unstable" else root
    note(f"{point.claim}: verdict {point.verdict}",
         *judged(point.verdict, proof, "the leading term vanishes too"))


# -- completeness


def _some(count: int, noun: str):
    return f"{count} {noun}{'' if count == 1 else 's'}"


def _check_complete(rates: Rates, claims: Claims, line: Line | None, note: Callable[[str, str], None]):
    kind, points, curves, planes = claims.kind, claims.points, claims.curves, claims.planes
    claim = f"the equilibria are complete: {kind}, {len(points)} isolated, {_some(len(curves), 'curve')}"
    claim += f", {_some(len(planes), 'plane')}" if planes else ""
    if not rates.torque:
        status, reason = whole_torque_free(rates, kind, points, curves, planes)
    elif planes:
        status, reason = "refuted", "with a torque no plane of equilibria exists"
    elif contradictory(rates):
        none = kind == "none" and not points and not curves
        status, reason = ("proved" if none
                          else "refuted"), "the two linear conditions contradict each other: there are none"
    elif line is None:
        status, reason = whole_conic(rates, kind, points, curves)
    else:
        status, reason = whole_line(kind, points, curves, line.places)
    note(claim, status, reason)
