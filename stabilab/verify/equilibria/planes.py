"""Planes of equilibria: a body with two equal moments and no torque, its gyrostatic moment along the axis of symmetry."""
from __future__ import annotations

from ..numbers import LINEAR, VERDICT, Malformed, brief, field, numbers, word
from ..rates import AHEAD, characteristic
from .curves import judged
from .degenerate import cross, turned


class Plane:
    """base + p u + r v with what is said of its points, and of one centre that may differ."""

    def __init__(self, table, where):
        self.base = numbers(field(table, "base", where), f"{where}.base", 3)
        rows = field(table, "directions", where, list)
        if len(rows) != 2:
            raise Malformed(f"{where}.directions: expected two")
        self.u, self.v = (numbers(row, f"{where}.directions[{i}]", 3) for i, row in enumerate(rows))
        self.normal = cross(self.u, self.v)
        if not any(self.normal):
            raise Malformed(f"{where}.directions: expected two directions that are not parallel")
        self.linear, self.verdict = word(table, "linear", where, LINEAR), word(table, "verdict", where, VERDICT)
        centre = field(table, "centre", where, dict)
        self.centre = numbers(field(centre, "at", f"{where}.centre"), f"{where}.centre.at", 3)
        self.centre_verdict = word(centre, "verdict", f"{where}.centre", VERDICT)
        self.claim = f"plane through ({', '.join(map(brief, self.base))})"

    def grid(self, size):
        """size x size of its points."""
        return [[b + p * u + r * v for b, u, v in zip(self.base, self.u, self.v)] for p in range(size) for r in range(size)]

    def lies(self, axis, height) -> bool:
        """Whether it is the plane x_axis = height."""
        return self.base[axis] == height and not self.u[axis] and not self.v[axis]


def plane_of(table, where) -> Plane:
    """A claimed plane."""
    return Plane(table, where)


def check_plane(rates, plane, note):
    """Findings on a plane: all of it at rest, all of it with three zero eigenvalues, and left by a drift but at the centre."""
    if any(any(rates.at(x)) for x in plane.grid(3)):  # a quadratic function that vanishes on a 3 x 3 grid vanishes
        note(plane.claim, "refuted", "the rates do not vanish all over the plane")
        return
    note(plane.claim, "proved", "the rates vanish all over it")
    zero = not any(v for x in plane.grid(4) for v in characteristic(rates.jacobian(x)))  # m, n: of degree 3 at most
    note(f"{plane.claim}: linear {plane.linear}", "proved" if zero and plane.linear == "degenerate" else "refuted",
         "m and n vanish all over it" if zero else "m or n does not vanish all over it")
    proof = _turning(rates, plane)
    if proof is not None and not _at(rates, proof, plane.centre, plane):
        note(f"{plane.claim}: centre", "refuted", "the turning does not vanish there")
        return
    for where, verdict, true in (("but its centre", plane.verdict, "unstable"), ("its centre", plane.centre_verdict, "stable")):
        why = proof and (true, f"beside the plane x' = d J(x) e turns about the centre, d the distance along e, axis {proof.index(1) + 1}")
        note(f"{plane.claim}: {where} {verdict}", *judged(verdict, why, "no axis of symmetry was found"))


def _turning(rates, plane):
    """The axis e with x_e constant whose J(x) e turns x in the plane (so that beside it states run round circles); or None."""
    for i, (j, k) in enumerate(AHEAD):
        still = not any((rates.kappa[i], rates.rho[i], rates.sigma[i], rates.m[i]))
        if still and plane.lies(i, plane.base[i]) and rates.kappa[j] * rates.kappa[k] < 0:
            return [int(n == i) for n in range(3)]
    return None


def _at(rates, e, centre, plane) -> bool:
    """Whether a point of the plane is where J(x) e vanishes."""
    on = sum(n * (c - b) for n, c, b in zip(plane.normal, centre, plane.base)) == 0
    return on and not any(turned(rates.jacobian(centre), e))
