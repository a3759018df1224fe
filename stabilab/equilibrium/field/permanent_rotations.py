"""Permanent rotations omega = Omega gamma of a body in a field (gravity, Newtonian, charge that follows the attitude; gyrostat).

gamma' = 0 makes omega parallel to gamma, and the rest is (S - mu) gamma = -b with the diagonal S(Omega) and b(Omega) of
`rotation_spectrum`: for each Omega the real roots mu of

    P(mu, Omega) = prod n_g^2 - sum B_g prod_(h != g) n_h^2,    n_g = S_g - mu,  B_g = sum of b_i^2 in g

over the groups g of equal S, gamma_i = -b_i/n_g; and, for a group whose b vanishes, mu = S_g with the part of gamma in it free up to
|gamma| = 1. The number of roots changes at zeros of the discriminant of P alone, and the signs that the verdicts rest on change at zeros of
resultants: polynomials in Omega with exact coefficients, all of whose real roots are isolated (python-flint). So the branches
are complete, and a verdict in the middle of an interval holds all over it.
"""
from __future__ import annotations

from fractions import Fraction
from typing import Any

from ...errors import InputError
from ...numbers.balls import many_digits
from ...physics.coefficients import Content
from ..curve import sample_parameters, values_inside
from ..result import CurveSegment, Equilibria, EquilibriumCurve, EquilibriumPoint
from .balance import rotations_at, rounded_gamma
from .bifurcations import cuts_of, separated, step_at
from .circles import circles
from .spectrum import Field
from .verdict import judged

SAME = 2.0**-30  # far above the 2**-45 by which a branch differs on the two sides of a cut, far below the distance of two branches
REASON = ("omega = Omega gamma, and (S - mu) gamma = -b with S = (Omega^2 - N) D - Omega E e3 e3^T, b = Omega Lambda + s: for each Omega one "
          "polynomial in mu; its discriminant and all its real roots are certified")


def permanent_rotations(parts: Content) -> Equilibria:
    """Every permanent rotation as curves over Omega (rad/s, any sign; a point is omega, gamma), with spectrum and verdicts."""
    with many_digits():
        field = Field.of(parts)
        cuts = separated(cuts_of(field))
        curves = tuple(_curve(field, number, branch, cuts) for number, branch in enumerate(_branches(field, cuts), 1))
        curves += circles(field, parts)
    return Equilibria("curves", REASON, curves=curves)


def _branches(field, cuts):
    """[[(lo, hi, index in rotations_at)]]: pieces between neighbouring cuts, joined across them by continuity of gamma."""
    ends = [None, *cuts, None]
    size = max(map(abs, cuts), default=Fraction(1)) or Fraction(1)
    open_, done = [], []
    for lo, hi in zip(ends, ends[1:]):
        found = rotations_at(field, values_inside(lo, hi, size))
        joined = {}
        if lo is not None:
            step = step_at(cuts, lo)
            before, after = rotations_at(field, lo - step), rotations_at(field, lo + step)
            if len(after) != len(found):
                raise ArithmeticError("the branches of permanent rotations were not told apart")
            joined = _matching(before, after)
        fresh = [None] * len(found)
        for branch in open_:
            index = joined.get(branch[-1][2])
            if index is None:
                done.append(branch)
            else:
                fresh[index] = [*branch, (lo, hi, index)]
        open_ = [branch or [(lo, hi, index)] for index, branch in enumerate(fresh)]
    return done + open_


def _matching(before, after) -> dict[int, int]:
    """Index before -> index after for rotations at the same place, nearest first."""
    pairs = []
    for i, u in enumerate(before):
        for j, v in enumerate(after):
            apart = max(abs(float((x - y).mid())) for x, y in zip(u.gamma, v.gamma))
            if apart < SAME and bool(u.circle) == bool(v.circle):
                pairs.append((apart, i, j))
    out: dict[int, int] = {}
    for _, i, j in sorted(pairs):
        if i not in out and j not in out.values():
            out[i] = j
    return out


def _sample(field, Omega: Fraction, index: int) -> EquilibriumPoint:
    return judged(field, Omega, rotations_at(field, Omega)[index])


def _curve(field, number, branch, cuts) -> EquilibriumCurve:
    """Segments of one verdict, changes of verdict and samples of one branch."""
    size = max(map(abs, cuts), default=Fraction(1)) or Fraction(1)
    pieces = [(lo, hi, index, _sample(field, values_inside(lo, hi, size), index)) for lo, hi, index in branch]
    runs: list[list[Any]] = []
    for piece in pieces:
        same = runs and _words(runs[-1][-1][3]) == _words(piece[3])
        runs[-1].append(piece) if same else runs.append([piece])
    segments, samples, changes = [], [], []
    for run in runs:
        lo, hi, middle = run[0][0], run[-1][1], run[len(run) // 2][3]
        where = (float("-inf") if lo is None else float(lo), float("inf") if hi is None else float(hi))
        segments.append(CurveSegment(where, middle.linear, middle.verdict, middle.because))
        samples += [_at(field, branch, t) for t in _chosen(lo, hi, size, cuts)]
        if run is not runs[-1]:
            changes.append(_at(field, branch, hi - step_at(cuts, hi)).at)
    circle = rotations_at(field, values_inside(*branch[0][:2], size))[branch[0][2]].circle  # type: ignore[call-arg]
    name = f"branch {number}" + (f", a circle about axis {6 - sum(i + 1 for i in circle)}" if circle else "")
    first, last = segments[0].t[0], segments[-1].t[1]
    return EquilibriumCurve(
        name, "omega = Omega gamma, ((Omega^2 - N) D gamma + Omega Lambda + s) x gamma = 0" + (" with the charge's term" if field.E != 0 else ""),
        f"t = Omega from {first:.6g} to {last:.6g} rad/s; gamma_i = -b_i/(S_i - mu)" + (", and all its turns in the circle" if circle else ""),
        _point_function(field, branch), tuple(segments), tuple(changes), tuple(samples))


def _words(sample):
    return sample.linear, sample.verdict, sample.because


def _chosen(lo, hi, size, cuts):
    """Three values of Omega of a segment, and 0 (rest) where it is inside; none on a cut."""
    some = [t for t in sample_parameters(lo, hi, size) if t not in cuts] or [values_inside(lo, hi, size)]
    some = [some[0], some[len(some) // 2], some[-1]]
    if (lo is None or lo < 0) and (hi is None or hi > 0) and 0 not in cuts:
        some.append(Fraction(0))
    return sorted(set(some))


def _at(field, branch, Omega: Fraction) -> EquilibriumPoint:
    for lo, hi, index in branch:
        if (lo is None or lo <= Omega) and (hi is None or Omega <= hi):
            return _sample(field, Omega, index)
    raise InputError(f"Omega = {float(Omega)!r} lies outside this branch of permanent rotations")


def _point_function(field, branch):
    def point(t: float):
        Omega = Fraction(t)
        with many_digits():
            for lo, hi, index in branch:
                if (lo is None or lo < Omega) and (hi is None or Omega < hi):
                    gamma = rounded_gamma(rotations_at(field, Omega)[index])
                    return (*(float(t) * g for g in gamma), *gamma)
        raise InputError(f"Omega = {t!r} lies at an end of this branch of permanent rotations or outside it")
    return point
