"""Whether a state of equilibrium is stable, and how fast a disturbance of it grows.

Of a gyrostat under a constant torque the signs of m and n in z^3 + m z + n are exact
(`equilibrium.stability`); what they leave open, and all other scenes, is looked up among the scene's
equilibria, whose verdicts have their proofs. The growth of other scenes is that of the Jacobian of the full
equations, in doubles."""
from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction

from ..equilibrium.result import Equilibria, EquilibriumCurve, EquilibriumPoint, Verdict
from ..equilibrium.stability import POSITIVE_EIGENVALUE, eigenvalues, invariants, isolated_verdict, pencil
from ..errors import InputError
from ..numbers.polynomial import compass_search
from ..numbers.vectors import Number
from ..orbit.result import Motion, Stability
from ..physics.coefficients import effective
from ..physics.scene import AnyScene
from ..reasons import Sentence
from .equilibria import equilibria

SAME_STATE = 1e-9  # of the size of a state: an equilibrium that is found in doubles is the same as the state
ON_CURVE = 1e-7  # the same for a curve, along which the nearest place is searched
LOOKS, HALVINGS = 400, 60  # along a piece of a curve of equilibria; of the interval round the nearest look
GROWS = 1e-7  # of the size of the Jacobian: a real part below it may be rounding
GROWS_LINEARLY = Verdict("unstable", Sentence(
    "grows-linearly", "an eigenvalue of the Jacobian of the full equations has a positive real part")())
NOT_FOUND = Verdict("undecided", Sentence(
    "not-among-equilibria",
    "the state was not found among the equilibria that are known of this scene")())


def with_stability(scene: AnyScene, result: Motion, exact: Sequence[Number] | None = None) -> Motion:
    """The motion of an equilibrium with its stability. exact: the three rates exactly."""
    twin = effective(scene)
    stability = (of_gyrostat(twin, exact or tuple(map(Fraction, result.at[:3]))) if twin.plain
                 else of_scene(scene, result.at))
    return replace(result, stability=stability)


def of_gyrostat(scene: AnyScene, x: Sequence[Number]) -> Stability:
    """Of an exact state x of equilibrium of a gyrostat under a constant torque."""
    p = pencil(scene)
    m, n = (Fraction(v) for v in invariants(p.form, tuple(map(Fraction, x))))
    if n or m < 0:
        verdict = isolated_verdict((m > 0) - (m < 0), (n > 0) - (n < 0)) if n else POSITIVE_EIGENVALUE
        try:
            growth = max(z.real for z in eigenvalues(m, n))
        except OverflowError:
            growth = math.inf
        return Stability("unstable", growth, reason=verdict.reason)
    result = equilibria(scene)
    if result.kind == "all":
        return Stability("stable", reason=result.reason)
    return _stability(_without_growth(result, tuple(map(float, x)), "stable" if m else "degenerate"))


def of_scene(scene: AnyScene, at: Sequence[float]) -> Stability:
    """Of a state of equilibrium, its blocks in a row, whatever acts."""
    verdict = _looked_up(equilibria(scene), at)
    if verdict.word in ("stable", "asymptotically stable"):
        return _stability(verdict)
    growth = _growth(scene, at)
    return _stability(GROWS_LINEARLY if verdict.word == "undecided" and growth is not None else verdict,
                      growth)


def _stability(verdict: Verdict, growth: float | None = None) -> Stability:
    return Stability(verdict.word, growth, reason=verdict.reason)


def _growth(scene: AnyScene, at: Sequence[float]) -> float | None:
    """The largest real part of the eigenvalues of the full equations, where it is more than rounding."""
    import numpy as np

    from ..physics.to_numpy import to_numpy
    try:
        jacobian = to_numpy(scene).jacobian(np.array(at, float))
    except (InputError, ValueError):
        return None
    if not np.isfinite(jacobian).all():
        return None
    largest = float(np.linalg.eigvals(jacobian).real.max())
    return largest if largest > GROWS * float(np.abs(jacobian).max()) else None


def _without_growth(out: Equilibria, at: Sequence[float], linear: str) -> Verdict:
    """The verdict where no eigenvalue has a positive real part: that of the same state, else of the pieces of
    curves of the same linear kind, where these agree."""
    nearby = _nearest((*out.points, *(sample for curve in out.curves for sample in curve.samples)), at)
    if nearby is not None:
        return Verdict(nearby.verdict, nearby.reason)
    similar = {x.verdict: Verdict(x.verdict, x.reason) for curve in out.curves for x in curve.segments
             if x.linear == linear}
    return similar.popitem()[1] if len(similar) == 1 else NOT_FOUND


def _looked_up(result: Equilibria, at: Sequence[float]) -> Verdict:
    """The verdict on the equilibrium that is at the state."""
    if result.kind == "all":
        return Verdict("stable", result.reason)
    samples = [*result.points, *(sample for curve in result.curves for sample in curve.samples)]
    nearby = _nearest(samples, at)
    if nearby is not None:
        return Verdict(nearby.verdict, nearby.reason)
    pieces = [(_beside(curve, piece.t, at), piece) for curve in result.curves for piece in curve.segments]
    apart = min((distance for distance, _ in pieces), default=math.inf)
    if apart <= ON_CURVE:  # where curves meet, of all that do
        touching = {piece.verdict: piece for distance, piece in pieces if distance == apart}
        (_, piece), *others = touching.items()
        return NOT_FOUND if others else Verdict(piece.verdict, piece.reason)
    return Verdict("undecided", result.reason) if result.kind == "undecided" else NOT_FOUND


def _apart(item: Sequence[float], at: Sequence[float]) -> float:
    """The distance of a state from the first components of another, in units of its size."""
    here = at[:len(item)]
    return math.dist(item, here) / (math.hypot(*here) or 1.0) if len(item) <= len(at) else math.inf


def _nearest(samples: Sequence[EquilibriumPoint], at: Sequence[float]) -> EquilibriumPoint | None:
    nearby = min(samples, key=lambda sample: _apart(sample.at, at), default=None)
    return nearby if nearby is not None and _apart(nearby.at, at) <= SAME_STATE else None


def _beside(curve: EquilibriumCurve, piece: tuple[float, float], at: Sequence[float]) -> float:
    """How near a piece of a curve comes to the state."""
    low, high = (math.atan(end) for end in piece)

    def apart(u: float) -> float:
        try:
            return _apart(curve.point(math.tan(u)), at)
        except InputError:  # an end of the piece
            return math.inf
    looks = [low + (high - low) * (n + 0.5) / LOOKS for n in range(LOOKS)]
    tried = [(apart(u), u) for u in looks]
    closer = compass_search(apart, tried, (high - low) / LOOKS, HALVINGS, lambda u: min(max(u, low), high))
    return min(closer)[0]
