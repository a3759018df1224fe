"""The certificate of a case: what was found of it, as exact numbers and brackets that separate code can
check.

Equilibria come from exact algebra (rationals and roots of polynomials), fate, extremes and period from ball
arithmetic; nothing here is a rounded guess. What cannot be certified is left out and named in `uncertified`.
docs/certificate.md has the form."""
from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import TYPE_CHECKING, Any

from ..equilibrium.gyrostat import balance_fails, conic_curves, isolated_states
from ..equilibrium.stability import Isolated, Pencil, curve_with_verdicts, cuts_of, isolated_point, pencil
from ..equilibrium.torque_free import (
    DRIFT,
    plane_centre,
    plane_moments,
    plane_of_equal_moments,
    torque_free_curves,
)
from ..numbers.balls import fraction
from ..orbit.extremes import extreme_balls
from ..orbit.fate import fate_of
from ..orbit.one_orbit import Orbit
from ..orbit.period import period_ball
from ..orbit.reduction import reduce
from ..orbit.result import Fate
from ..physics.scene import AnyScene, QuadraticForm
from ..reasons import Sentence
from ..version import __version__

if TYPE_CHECKING:
    from ..equilibrium.result import RationalCurve
    from ..numbers.vectors import Number


NO_REDUCTION = Sentence(
    "certificate-without-reduction", "motion: the scene has no reduction to one degree of freedom")()
MOTION_NOT_CERTIFIED = Sentence("motion-not-certified", "motion: {fate}: {why}")
SCHEMA = "stabilab.certificate/1"
ROOT_BITS = 150  # roots are known to 160 bits and more (`polynomial.real_roots`)
BOX_BITS = 120
TINY = Fraction(1, 2**1074)  # the least double: a decaying plane's end is only approached, to less than this
# of the brackets: another's verified quadrature must have room in the period's
DIGITS, PERIOD_DIGITS = 20, 11


def certificate(scene: AnyScene, state: Sequence[Any] | None = None) -> dict[str, Any]:
    """The certificate of a scene and, if given, of the motion from a state (three numbers, taken exactly).

    Returns the object of `stabilab.certificate/1`. Raises InputError as `equilibria` does for effects it does
    not know.
    """
    out: dict[str, Any] = {"schema": SCHEMA, "program": f"stabilab {__version__}", "scene": None,
                           "equilibria": None, "motion": None,
                           "uncertified": []}
    if not scene.plain:
        out["uncertified"].append("effects beyond the gyrostat and a constant torque: there is no "
                                  "certificate for their equilibria and motions")
        return out
    out["scene"] = _scene(scene)
    out["equilibria"] = _equilibria(scene)
    if state is not None:
        out["motion"] = _motion(scene, tuple(Fraction(v) for v in state), out["uncertified"])
    return out


def subject(scene: AnyScene, state: Sequence[Any] | None = None) -> dict[str, Any]:
    """What the certificate of this scene and state is about, as `verify.form` tells it; empty for a scene
    that has none."""
    if not scene.plain:
        return {}
    return _scene(scene) | ({} if state is None else {"state": [_text(v) for v in state]})


def _text(value: Fraction) -> str:
    return str(Fraction(value))


def _bracket(value: Fraction, reach: Fraction) -> list[str]:
    return [_text(value - reach), _text(value + reach)]


def _scene(scene: AnyScene) -> dict[str, Any]:
    if scene.variables == "scaled":
        a, b = scene.exact_ab
        return {"variables": "scaled", "a": _text(a), "b": _text(b), "mu": list(map(_text, scene.exact_mu))}
    return {"variables": "physical", "inertia": list(map(_text, scene.body.exact)),
            "momentum": list(map(_text, scene.vector("gyrostat"))),
            "torque": list(map(_text, scene.vector("constant_torque")))}


# -- equilibria


def _equilibria(scene: AnyScene) -> dict[str, Any]:
    p = pencil(scene)
    kind, states, curves = _exact_equilibria(p)
    return {"kind": kind,
            "points": sorted((_point(p.form, x) for x in states), key=lambda e: Fraction(e["box"][0][0])),
            "curves": [_curve(p.form, c) for c in curves],
            "planes": [_plane(p, d) for d in ([] if any(p.M) else plane_moments(p))]}


def _exact_equilibria(p: Pencil) -> tuple[str, list[Any], list[Any]]:
    """(kind, isolated states, exact curves), by the cases of `equilibria`; planes come on their own.
    """
    if not any(p.M):
        if not any(p.lam) and len(set(p.D)) == 1:
            return "all", [], []
        return "curves", [], torque_free_curves(p)[0]
    if p.torque_axis_moment() is None:
        _, states, curves = isolated_states(p)
        return ("curves" if curves else "points" if states else "none"), states, curves
    return ("none", [], []) if balance_fails(p) else ("curves", [], conic_curves(p))


def _point(form: QuadraticForm, x: Isolated) -> dict[str, Any]:
    point, middle = isolated_point(form, x), x.at
    reach = Fraction(0) if x.exact else (max(map(abs, middle)) or Fraction(1)) / 2**BOX_BITS
    return {"box": [_bracket(v, reach) for v in middle], "linear": point.linear, "verdict": point.verdict}


def _curve(form: QuadraticForm, curve: RationalCurve) -> dict[str, Any]:
    result, cuts = curve_with_verdicts(form, curve), cuts_of(form, curve)
    exact = {*curve.poles, *curve.crossings}
    marks = [_bracket(t, Fraction(0) if t in exact else abs(t) / 2**ROOT_BITS) for t in cuts]
    folds = [(t, mark) for t, mark in zip(cuts, marks) if t not in curve.poles]
    at = {point.at: point for point in result.samples}
    return {"numerators": [list(map(_text, p.c)) for p in curve.numerators],
            "denominator": list(map(_text, curve.denominator.c)),
            "segments": [{"t": ends, "linear": s.linear, "verdict": s.verdict}
                         for s, ends in zip(result.segments, map(list, zip([None, *marks], [*marks, None])))],
            "folds": [{"t": mark, "linear": at[fold].linear, "verdict": at[fold].verdict}
                      for (_, mark), fold in zip(folds, result.folds)]}


def _plane(p: Pencil, d: Fraction) -> dict[str, Any]:
    i, j, k, centre = plane_of_equal_moments(p, d)
    unit = lambda axis: [str(int(n == axis)) for n in range(3)]
    at = list(map(_text, centre))
    return {"base": at, "directions": [unit(i), unit(j)], "linear": "degenerate", "verdict": DRIFT[0],
            "centre": {"at": at, "verdict": plane_centre(p)[0]}}


# -- the motion


def _motion(scene: AnyScene, state: tuple[Fraction, ...], uncertified: list[str]) -> dict[str, Any] | None:
    rates = scene.quadratic().rate(state)
    claims = {"state": list(map(_text, state)), "axis": 0, "sense": 0, "extremes": None, "period": None}
    if not any(rates):
        return claims | {"fate": Fate.EQUILIBRIUM.word}
    reduction = reduce(scene)
    if reduction is None:
        return _without_reduction(scene, state, claims, uncertified)
    orbit = Orbit(reduction, state)
    result = fate_of(scene, orbit)
    label = Fate(result.label)
    if label not in (Fate.BOUNDED, Fate.SPIN_UP):
        uncertified.append(MOTION_NOT_CERTIFIED(fate=label.word, why=result.reason).text())
        return None
    extremes = [[_ends(v) for v in pair] for pair in extreme_balls(orbit, label, certain=int(DIGITS * 3.33))]
    period = _ends(period_ball(orbit), PERIOD_DIGITS) if label == Fate.BOUNDED else None
    return claims | {"fate": label.word, "axis": result.axis, "sense": result.sense, "extremes": extremes,
                     "period": period}


def _without_reduction(scene: AnyScene, state: tuple[Fraction, ...], claims: dict[str, Any],
                       uncertified: list[str]) -> dict[str, Any] | None:
    from .certified_motion import certified_spin_up, closed_motion
    if closed := closed_motion(scene, state):
        return claims | closed
    result, why = certified_spin_up(scene, state)
    if result is None:
        uncertified.append(NO_REDUCTION.then(why).text())
        return None
    return (claims | {"fate": Fate.SPIN_UP.word, "axis": result["axis"], "sense": result["sense"],
                      "spin_up": result})


def _ends(value: Number, digits: int = DIGITS) -> Any:
    """A bracket round a ball, twice as wide so that another's ball has room in it; None for what is not
    finite."""
    if isinstance(value, float) or not value.is_finite():
        return None
    middle, reach = (fraction(end.fmpq()) for end in (value.mid(), value.rad()))
    room = 2 * reach + abs(middle) / 10**digits
    if abs(middle) + room < TINY:
        return _bracket(Fraction(0), TINY)
    return _bracket(middle, room)
