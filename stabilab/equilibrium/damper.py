"""Equilibria of a free body with a damper inside, with wheels or without.

At an equilibrium the damper's sphere is at rest in the body: sigma' + omega' = 0 gives c sigma/k = -omega x
sigma, whose product with sigma is c |sigma|^2/k = 0; a damper wheel is, for s' = -c s/J there. So the
equilibria are those of the body alone. The damper keeps |H|, wheels included, and takes energy at every
rotation that is not permanent, so that exactly the strict minima of the energy on the spheres of constant
|H| attract (`momentum_sphere`); without wheels they are the same as with a liquid. The eigenvalues are the
damper's own."""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from functools import partial, reduce
from typing import Any

from ..numbers.polynomial import Poly, real_roots
from ..numbers.vectors import CYCLE, Exact3, dot
from ..physics.body import Body
from ..physics.coefficients import Content, Together, gyrostat_scene
from ..physics.effects import effect_class
from ..physics.equations import derive
from ..physics.scene import Scene
from ..reasons import Reason, Sentence
from .damper_mass import relaxed_equilibria
from .liquid import THE_LIQUID, liquid_equilibria
from .momentum_sphere import MINIMUM, MomentumSphere, nature_at
from .result import (
    CurveSegment,
    Equilibria,
    EquilibriumCurve,
    EquilibriumPoint,
    RationalCurve,
    Verdict,
)
from .stability import Pencil, cuts_of, ordered, pencil
from .torque_free import PARALLEL, plane_of_equal_moments, torque_free_curves

THE_DAMPER = Sentence("the-damper", "the damper")()
DAMPER_FREE_ALONE = Sentence(
    "damper-free-alone",
    "undecided: with a damper the stability of equilibria is known of a free body, with wheels or without")()
DAMPED_IN_PART = Sentence(
    "damper-in-part",
    "undecided: some rotation that is not permanent leaves the damper's wheel at rest in the body, and what "
    "becomes of its neighbours is not known")()
MASS_DISPLACED = Sentence(
    "damper-mass-displaced",
    "undecided: a rotation displaces the damper's mass, and the equilibria of body and mass are not known "
    "in general")()
DAMPED_PARALLEL = Sentence(
    "damped-momentum-along-rotation", "the damper's sphere is at rest in the body at every equilibrium, so "
    "that these are those of the body alone")()
LEAST = Verdict("stable", Sentence(
    "damped-gyrostat-least",
    "asymptotically stable at its |H|: the damper keeps |H|, and on the sphere of constant |H|, wheels "
    "included, the energy has a strict minimum here and falls at every other state nearby (LaSalle)")())
NOT_LEAST = Verdict("unstable", Sentence(
    "damped-gyrostat-not-least",
    "the energy on the sphere of constant |H|, wheels included, has no minimum here, and the damper makes it "
    "fall wherever the motion is no permanent rotation: states of less energy next to this one leave and do "
    "not come back")())
NO_MOMENTUM = Verdict("stable", Sentence(
    "damped-gyrostat-no-momentum",
    "the angular momentum is zero: |H| stays and the energy does not grow, and both together are least "
    "here")())
CIRCLE = Verdict("stable", Sentence(
    "damped-gyrostat-circle",
    "the energy on the sphere of constant |H| is least on a circle of these rotations, which attracts, so "
    "each of them is stable and motions from nearby tend to one of the circle")())


def damped_equilibria(parts: Content) -> Equilibria:
    """Every permanent rotation with its stability; undecided beside a torque, a medium or a liquid."""
    if any(parts.M) or parts.c or parts.damped or parts.kappa:
        return Equilibria("undecided", reason=DAMPER_FREE_ALONE)
    if parts.displaced:
        alone = len(parts.movers) == 1 and not parts.inside
        known = relaxed_equilibria(parts) if alone else None
        return known if known and known.curves else Equilibria("undecided", reason=MASS_DISPLACED)
    if not parts.all_is_damped or parts.rest_of_moments <= 0:
        return Equilibria("undecided", reason=DAMPED_IN_PART)
    if any(parts.Lambda):
        return _with_wheels(parts)
    out = liquid_equilibria(replace(parts, inside=Fraction(0), movers=(), kappa=Fraction(1)))  # any liquid's
    return Equilibria(out.kind, tuple(_with_damper(parts, point) for point in out.points),
                      tuple(_curve_with_damper(parts, curve) for curve in out.curves),
                      reason=_of_damper(out.reason))


# --- With wheels
def _with_wheels(parts: Content) -> Equilibria:
    p = pencil(gyrostat_scene(parts))
    exact, planes = torque_free_curves(p)
    curves = (*(_judged(parts, p, curve) for curve in exact), *(_plane(parts, p, plane) for plane in planes))
    return Equilibria("curves", curves=curves, reason=PARALLEL.then(DAMPED_PARALLEL))


def _judged(parts: Content, p: Pencil, curve: RationalCurve) -> EquilibriumCurve:
    """Segments, folds and samples of one curve, cut where two rotations meet, where it crosses another curve,
    and where H vanishes."""
    tops = [n * d + curve.denominator * l for n, d, l in zip(curve.numerators, parts.D, parts.Lambda)]
    common = reduce(Poly.gcd, [top for top in tops if top])
    empty = [t for t in (real_roots(common) if common.degree > 0 else ()) if t not in curve.poles]
    cuts = sorted({*cuts_of(p.form, curve), *empty})
    return curve.cut(cuts, partial(_segment, parts, curve), partial(_fold, parts, curve, frozenset(empty)))


def _segment(parts: Content, curve: RationalCurve, lo: Fraction | None,
             hi: Fraction | None) -> tuple[CurveSegment, list[EquilibriumPoint]]:
    def judge(t: Fraction) -> tuple[str, Verdict]:
        nature = nature_at(parts.D, parts.Lambda, curve.exact_point(t))
        return ("stable", LEAST) if nature == MINIMUM else ("unstable", NOT_LEAST)
    return curve.segment(lo, hi, judge, lambda t, *judged: _point(parts, curve.exact_point(t), *judged))


def _fold(parts: Content, curve: RationalCurve, empty: frozenset[Fraction], t: Fraction, before: CurveSegment,
          after: CurveSegment) -> EquilibriumPoint:
    at = curve.exact_point(t)
    if t in empty:
        return _point(parts, at, "degenerate", NO_MOMENTUM)
    least = t in curve.crossings and _nature_at_crossing(parts, at) == MINIMUM
    return _point(parts, at, "degenerate", LEAST if least else NOT_LEAST)


def _nature_at_crossing(parts: Content, omega: Exact3) -> str:
    """Of the energy, by terms of higher order, at a rotation on two curves."""
    H = tuple(d * w + l for d, w, l in zip(parts.D, omega, parts.Lambda))
    return next(item.nature for item in MomentumSphere(parts.D, parts.Lambda, dot(H, H)).rotations
                if item.momentum == H)


def _plane(parts: Content, p: Pencil, plane: EquilibriumCurve) -> EquilibriumCurve:
    """A plane of equilibria (two equal moments, the wheels along the third axis)."""
    d = next(d for d in parts.D if parts.D.count(d) == 2)
    _, _, k, centre = plane_of_equal_moments(p, d)
    word, verdict = ("stable", CIRCLE) if d > parts.D[k] else ("unstable", NOT_LEAST)
    # no minimum of fourth order where no circle beside it is one
    middle = (("degenerate", LEAST) if _nature_at_crossing(parts, centre) == MINIMUM
              else ("degenerate", NOT_LEAST))
    samples = tuple(_point(parts, tuple(map(Fraction, point.at)), *(
        middle if point.at == plane.folds[0] else (word, verdict))) for point in plane.samples)
    segments = tuple(CurveSegment(item.t, word, verdict.word, reason=verdict.reason)
                     for item in plane.segments)
    return replace(plane, segments=segments, samples=samples)


def _point(parts: Content, omega: Exact3, word: str, verdict: Verdict) -> EquilibriumPoint:
    import numpy as np
    at = tuple(float(v) for v in omega)
    return EquilibriumPoint(at, ordered(np.linalg.eigvals(jacobian(parts, at))), word, verdict.word,
                            reason=verdict.reason)


# --- Without
def _of_damper(reason: Reason) -> Reason:
    """The same, where the damper takes the energy."""
    inner = {name: THE_DAMPER if value == THE_LIQUID else value for name, value in reason.filled}
    return reason.sentence(**inner)


def _curve_with_damper(parts: Content, curve: EquilibriumCurve) -> EquilibriumCurve:
    return replace(curve, samples=tuple(_with_damper(parts, point) for point in curve.samples),
                   segments=tuple(replace(item, reason=_of_damper(item.reason)) for item in curve.segments))


def _with_damper(parts: Content, point: EquilibriumPoint) -> EquilibriumPoint:
    import numpy as np
    return replace(point, eigenvalues=ordered(np.linalg.eigvals(jacobian(parts, point.at))),
                   reason=_of_damper(point.reason))


def jacobian(parts: Content, omega: Sequence[float]) -> Any:
    """(n, n) array at a permanent rotation, of omega and what moves inside."""
    import numpy as np
    if not parts.movers:
        return damper_jacobian(parts, omega)
    sphere = [effect_class("viscous_damper")(parts.inside, parts.friction)] if parts.inside else []
    equations = derive(Scene(Body(parts.D), Together(parts.Lambda), *sphere, *parts.movers))
    at = dict(zip(equations.state, (*omega, *[0.0] * (len(equations.state) - 3))))
    return np.array(equations.numeric(equations.jacobian).xreplace(at).tolist(), float)


def damper_jacobian(parts: Content, omega: Sequence[float]) -> Any:
    """(6, 6) array at a permanent rotation, of (omega, sigma)."""
    import numpy as np
    w, D, k = omega, [float(d) for d in parts.D], float(parts.inside)
    wheel = [float(l) for l in parts.Lambda]
    c = float(parts.friction)
    result = np.zeros((6, 6))
    for i, (j, l) in enumerate(CYCLE):
        result[i, j] = ((D[j] - D[l]) * w[l] - wheel[l]) / (D[i] - k)
        result[i, l] = ((D[j] - D[l]) * w[j] + wheel[j]) / (D[i] - k)
        result[i, 3 + i] = c / (D[i] - k)
        result[3 + i, 3 + i], result[3 + i, 3 + l], result[3 + i, 3 + j] = -c / k, -w[j], w[l]
    result[3:] -= result[:3]
    return result
