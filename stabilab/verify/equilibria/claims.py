"""Are these all the equilibria, and are the verdicts on them right? Exact algebra for how many, Krawczyk's test for where."""
from __future__ import annotations

from dataclasses import dataclass

from ..krawczyk import excluded, only_zero
from ..numbers import LINEAR, VERDICT, Malformed, bracket, brief, entries, exact_sign, field, word
from ..rates import characteristic
from .complete import whole_conic, whole_torque_free
from .curves import check_curve, curve_of, identically_zero, judged
from .degenerate import leaves_double_root
from .line import contradictory, line_of, whole_line
from .planes import check_plane, plane_of

KINDS = ("none", "points", "curves", "all")
BITS = (128, 512, 2048, 8192)  # of the boxes about an exact zero, where the box claimed is too wide for Krawczyk's test


@dataclass(frozen=True)
class Claims:
    """The certificate's part `equilibria`, read."""

    kind: str
    points: list
    curves: list
    planes: list


def equilibria_of(table) -> Claims:
    """The claims on equilibria. Raises `Malformed` before anything is worked out."""
    read = lambda key, made: [made(v, f"equilibria.{key}[{i}]") for i, v in enumerate(entries(table, key, "equilibria"))]
    return Claims(word(table, "kind", "equilibria", KINDS), read("points", _Point), read("curves", curve_of), read("planes", plane_of))


def check_equilibria(rates, claims, note):
    """Findings on the certificate's part `equilibria`."""
    line = line_of(rates)
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

    def __init__(self, table, where):
        boxes = field(table, "box", where, list)
        if len(boxes) != 3:
            raise Malformed(f"{where}.box: expected three brackets")
        self.box = [bracket(b, f"{where}.box[{i}]") for i, b in enumerate(boxes)]
        self.linear, self.verdict = word(table, "linear", where, LINEAR), word(table, "verdict", where, VERDICT)
        self.claim = f"equilibrium near ({', '.join(brief((a + b) / 2) for a, b in self.box)})"
        self.exact = all(a == b for a, b in self.box)


def _check_point(rates, point, line, note):
    if point.exact:
        x = [a for a, _ in point.box]
        if any(rates.at(x)):
            note(point.claim, "refuted", "the rates do not vanish at this exact point")
        else:
            note(point.claim, "proved", "the rates vanish there exactly")
            _judge(rates, point, x, note)
    elif line is None or line.places is None:
        none = excluded(rates, point.box)
        note(point.claim, *(("refuted", "a rate does not vanish in the box") if none else ("not checked", "no isolated equilibrium is known there")))
    else:
        _check_box(rates, point, line.places, note)


def _check_box(rates, point, places, note):
    """Findings on a box of some width, given all equilibria of the scene exactly."""
    held = [place for place in places if place.within(point.box)]
    if len(held) != 1:
        note(point.claim, "refuted", f"the box holds {len(held)} zeros of the rates, not one")
        return
    signs = only_zero(rates, point.box)
    note(point.claim, "proved", "Krawczyk's test: one and only one equilibrium in the box" if signs else "it holds one of the exact zeros of the rates")
    if held[0].rational:
        _judge(rates, point, held[0].rational, note)
        return
    signs = signs or next(filter(None, (only_zero(rates, held[0].box(bits)) for bits in BITS)), None)
    if signs:
        _say(point, *signs, None, note)
    else:
        note(f"{point.claim}: linear {point.linear}, verdict {point.verdict}", "not checked", f"the signs of m and n are not known with {BITS[-1]} bits")


def _judge(rates, point, x, note):
    """Verdicts at an exact equilibrium."""
    m, n = characteristic(rates.jacobian(x))
    _say(point, exact_sign(m), exact_sign(n), leaves_double_root(rates, x, m) if n == 0 <= m else None, note)


def _say(point, m, n, root, note):
    """Verdicts from the signs of m and n; an isolated equilibrium. root: the proof for a double root with n = 0 <= m."""
    linear = "unstable" if n or m == -1 else "stable" if m else "degenerate"
    where = f"signs of m and n give {linear}"
    note(f"{point.claim}: linear {point.linear}", "proved" if point.linear == linear else "refuted", where)
    proof = ("unstable", where) if linear == "unstable" else root
    note(f"{point.claim}: verdict {point.verdict}", *judged(point.verdict, proof, "the leading term vanishes too"))


# -- completeness


def _some(count, noun):
    return f"{count} {noun}{'' if count == 1 else 's'}"


def _check_complete(rates, claims, line, note):
    kind, points, curves, planes = claims.kind, claims.points, claims.curves, claims.planes
    claim = f"the equilibria are complete: {kind}, {len(points)} isolated, {_some(len(curves), 'curve')}"
    claim += f", {_some(len(planes), 'plane')}" if planes else ""
    if not rates.torque:
        status, reason = whole_torque_free(rates, kind, points, curves, planes)
    elif planes:
        status, reason = "refuted", "with a torque no plane of equilibria exists"
    elif contradictory(rates):
        none = kind == "none" and not points and not curves
        status, reason = ("proved" if none else "refuted"), "the two linear conditions contradict each other: there are none"
    elif line is None:
        status, reason = whole_conic(rates, kind, points, curves)
    else:
        status, reason = whole_line(kind, points, curves, line.places)
    note(claim, status, reason)
