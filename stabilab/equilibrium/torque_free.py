"""Equilibria without a torque: momentum parallel to rotation, D y + lambda = s y.

Curve: y(s) = lambda/(s - D) between its poles, through y = 0 at s = infinity and, for each D_i with lambda_i = 0, a line
y_i arbitrary at s = D_i. With s = D_p + 1/t for one axis p that carries lambda the curve is rational and whole: t = 0 is
rest, and t = infinity is the pole at D_p. lambda = 0: the principal axes, planes for equal moments, everything for a sphere.

Stable exactly where m > 0, by energy and Casimir; where a line meets the curve in a pitchfork, exactly where m > 0 on the rest of the line
(proofs: docs/mathematics/stability.md).
"""
from __future__ import annotations

from fractions import Fraction

from ..numbers.polynomial import Poly
from ..numbers.vectors import CYCLE, Exact3
from .balance import ONE, ZERO, Pencil, unit
from .curve import Grounds, RationalCurve, T, Verdict, sample_parameters, size_of, straight_line
from .curve_text import decimal, line_text
from .result import CurveSegment, EquilibriumCurve, EquilibriumPoint

CASIMIR = Grounds(
    positive=("stable", "energy-Casimir: on its momentum sphere the energy has a non-degenerate extremum (m > 0); where the "
                        "momentum or the rotation vanishes, that integral is itself definite"),
    odd=("unstable", "fold: on its momentum sphere the energy has an inflection here, no extremum, and motions leave along it"),
    minimum=("stable", "energy-Casimir: on its momentum sphere the energy has a degenerate but strict extremum (m > 0 on both "
                       "sides along the curve)"),
    maximum=("unstable", "on its momentum sphere the energy has a degenerate saddle (m < 0 on both sides along the curve)"))
CROSSING = {
    1: ("stable", "crossing of two curves of equilibria; energy-Casimir: on its momentum sphere the energy has a quartic but "
                  "strict extremum"),
    -1: ("unstable", "crossing of two curves of equilibria; on its momentum sphere the energy has a degenerate saddle")}
REST = ("stable", "a positive definite combination of the integrals is stationary here (for a body at rest: the energy)")
SYMMETRY_AXIS = ("stable", "the rate about the axis of symmetry and the size of the rate across it are both constant")
DRIFT = ("unstable", "m = n = 0: with any small change of the rate along the symmetry axis the state runs round the circle of "
                     "equilibria, so neighbours leave")


def torque_free_curves(p: Pencil) -> tuple[list[RationalCurve], list[EquilibriumCurve]]:
    """(exact curves, planes of equilibria) for M = 0, for anything but lambda = 0 on a sphere."""
    axes = [_axis_line(p, i) for i in range(3) if not p.lam[i] and p.D.count(p.D[i]) == 1]
    planes = [_plane(p, d) for d in plane_moments(p)]
    if not any(p.lam):
        return axes, planes
    return [_main_curve(p), *axes], planes


def _projection(p: Pencil, d: Fraction) -> bool:
    """Whether lambda has a part in the eigenspace of d."""
    return any(l for l, m in zip(p.lam, p.D) if m == d)


def _sign(value: Fraction) -> int:
    return (value > 0) - (value < 0)


def _line_sign(p: Pencil, i: int) -> int:
    """Sign of m on the line y_i arbitrary, s = D_i, away from the crossing: that of (D_j - D_i)(D_k - D_i) up to the
    sign that the change of variables x -> y carries."""
    j, k = CYCLE[i]
    e = p.form
    return -_sign(e.kappa[j] * e.kappa[k])


def _axis_line(p: Pencil, i: int) -> RationalCurve:
    """The line y_i arbitrary, D_i simple and lambda_i = 0."""
    y = tuple(ZERO if n == i else p.lam[n] / (p.D[i] - p.D[n]) for n in range(3))
    start = tuple(ZERO if n == i else v for n, v in enumerate(p.state(y)))
    meeting = -p.u[i] / p.A[i]
    return RationalCurve(f"line along {p.names[i]}", *line_text(p.names, start, unit(i)), straight_line(start, unit(i)), CASIMIR,
                         crossings={meeting: _crossing(p, i)}, scale=size_of(start, (meeting,)))


def _crossing(p: Pencil, i: int) -> Verdict:
    return CROSSING[_line_sign(p, i)] if any(p.lam) else REST


def _main_curve(p: Pencil) -> RationalCurve:
    support = [i for i in range(3) if p.lam[i]]
    if len({p.D[i] for i in support}) == 1:
        return _along_lambda(p, support)
    lead = support[0]
    factors = {i: Poly((1, p.D[lead] - p.D[i])) for i in support}  # s - D_i, times t
    distinct = list({p.D[i]: f for i, f in factors.items() if f.degree}.values())
    bottom = Poly((1,))
    for f in distinct:
        bottom = bottom * f
    tops = tuple(bottom * T * p.lam[i] // factors[i] if i in factors else Poly(()) for i in range(3))
    poles = tuple(sorted({-f.c[0] / f.c[1] for f in distinct}))
    crossings = {1 / (p.D[i] - p.D[lead]): _crossing(p, i) for i in range(3) if not p.lam[i] and p.D.count(p.D[i]) == 1}
    name = p.names[lead]
    return RationalCurve(
        "curve of momentum along rotation", "D omega + lambda = s omega",
        f"omega_i = lambda_i/(s - D_i), s = D{lead + 1} + 1/t, t = {name}/lambda{lead + 1}",
        tops, CASIMIR, bottom, poles, crossings, size_of(tuple(1 / (d - p.D[lead]) for d in p.D if d != p.D[lead])))


def _along_lambda(p: Pencil, support: list[int]) -> RationalCurve:
    """lambda in one eigenspace (moment d): the line through rest along lambda."""
    d, lead = p.D[support[0]], support[0]
    direction = unit(lead) if len(support) == 1 else p.lam
    start = tuple(ZERO if n == lead and len(support) == 1 else v for n, v in enumerate(p.state((ZERO,) * 3)))
    per_t = direction[lead] * p.A[lead]  # y_lead = per_t t + u_lead
    crossings = {}
    for i in range(3):
        if p.D[i] != d:
            where = (p.lam[lead] / (p.D[i] - d) - p.u[lead]) / per_t
            crossings[where] = _crossing(p, i) if p.D.count(p.D[i]) == 1 else SYMMETRY_AXIS
    scale = size_of(tuple(crossings)) if crossings else ONE
    return RationalCurve("line along the gyrostatic moment", *line_text(p.names, start, direction),
                         straight_line(start, direction), CASIMIR, crossings=crossings, scale=scale)


def plane_moments(p: Pencil) -> list[Fraction]:
    """The moments that two axes share and that carry no gyrostatic moment: a plane of equilibria each."""
    return [d for d in sorted(set(p.D)) if p.D.count(d) == 2 and not _projection(p, d)]


def plane_of_equal_moments(p: Pencil, d: Fraction) -> tuple[int, int, int, Exact3]:
    """(i, j, k, centre): axes i and j span the plane of equilibria, k is the axis of symmetry, through the exact centre."""
    i, j = (n for n in range(3) if p.D[n] == d)
    k = 3 - i - j
    return i, j, k, tuple(p.lam[k] / (d - p.D[k]) if n == k else ZERO for n in range(3))


def plane_centre(p: Pencil) -> Verdict:
    """The verdict on the centre of such a plane."""
    return SYMMETRY_AXIS if any(p.lam) else REST


def _plane(p: Pencil, d: Fraction) -> EquilibriumCurve:
    """The plane of equilibria across the symmetry axis k of a body with two moments d. The curve's point(t) runs along one
    straight line through its centre; by the symmetry every other line through the centre is alike (samples lie on three)."""
    i, j, k, start = plane_of_equal_moments(p, d)
    height = start[k]
    centre_verdict = plane_centre(p)
    rays = [unit(i), unit(j), tuple(Fraction(3, 5) * a + Fraction(4, 5) * b for a, b in zip(unit(i), unit(j)))]
    curve = RationalCurve("", "", "", straight_line(start, rays[0]), CASIMIR)
    zero = (0j, 0j, 0j)
    at = lambda ray, t: tuple(float(s + t * r) for s, r in zip(start, ray))
    half = sample_parameters(ZERO, None, size_of((height,)))
    outer = [EquilibriumPoint(at(ray, t), zero, "degenerate", *DRIFT) for ray in rays for t in (*(-v for v in half), *half)]
    middle = EquilibriumPoint(at(rays[0], ZERO), zero, "degenerate", *centre_verdict)
    segments = tuple(CurveSegment(t, "degenerate", *DRIFT) for t in ((float("-inf"), 0.0), (0.0, float("inf"))))
    names = p.names
    return EquilibriumCurve(
        f"plane {names[k]} = {decimal(height)}", f"{names[k]} = {decimal(height)}, {names[i]} and {names[j]} arbitrary",
        f"{names[i]} = t, {names[j]} = 0, {names[k]} = {decimal(height)} and its turns about axis {k + 1}",
        curve.float_point(), segments, (middle.at,), (*outer, middle))
