"""Endless growth: a torque along a principal axis that carries a gyrostatic component along it, too.

Law (any lambda): (|H|^2/2 - D_i T)' = lambda_i M_i, so there is no equilibrium and no bounded motion. What
remains to be decided is about which axis the body spins up.

Standard form (torque on the major or minor axis i, no gyrostatic component across it; `standard_form`):

    u' = y2 y3 + 1,   y2' = -y3 (u - c/2),   y3' = y2 (u + c/2),      J = y2^2 + y3^2 - 2 c u,   J' = -2c,

and with phi = atan2(y3, y2), P = phi' = u + (c/2) cos 2phi:

    P' = -dV/dphi,   V(phi, J) = -phi - (J/2) sin^2 phi + (c^2/8) sin^2 2phi,   E = P^2/2 + V,   E' = c sin^2
    phi.

y2 = y3 = 0 stays so: spin-up. c > 0: every motion spins up about axis i; only its release from a temporary
capture is left to observe. Certificate "spin-up" (any c): P > 0 and E + phi + min(J, 0)/2 - c^2/8 > c^2/2;
for c > 0 also J < -c^2. Certificate "well" (c < 0): phi mod pi inside (pi - phi_b, phi_b) with E < V(phi_b,
J) for one phi_b in [pi/2, pi]; the motion then grows about axis 3 of the form, like the root of time. Once
one holds it holds for ever, so it may be looked for at any later time. Proofs: docs/mathematics/spin-up.md.

For c < 0 the end of the run that led there decides, and its rounding could carry a motion over the boundary
between the two; so six neighbours, as far away as that rounding could at most have moved it, must end alike,
else the answer is "undecided".
"""
from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ..errors import InputError
from ..numbers.vectors import CYCLE
from ..orbit.fate import Basis, OneFate
from ..orbit.fate_arrays import FateResult, at_rest, in_chunks, write_row
from ..orbit.one_state import in_range
from ..orbit.result import NO_EXTREMES, Fate, Motion, Needs, judged, pairs
from ..physics.coefficients import three_floats
from ..physics.states import three_numbers
from ..reasons import Axis, Quantity, Reasoned, Sentence
from ..validation import reach_of
from .evidence import growth as seen_growth
from .evidence import seen_over, span_needed
from .growth_certificate import (
    angle_of,
    captured_extremes,
    growth_law,
    nearest_other,
    release_estimate,
    search_certificate,
    standard_form,
)

if TYPE_CHECKING:
    from fractions import Fraction

    from ..physics.scene import AnyScene, QuadraticForm, Scene

# How long to look where the caller names no time, in the motion's own unit 1/sqrt(g |m|).
MAX_TIME = 1e6
# How well the axis is known by each kind of certificate; that the motion is unbounded is exact.
LEVEL = {"axis": "exact", "law": "exact", "bound": "exact", "spin-up": "certified", "well": "certified",
         "evidence": "run"}


SPIN_ALONE = Sentence("spin-alone", "pure spin about {axis}, which the torque speeds up for ever")
BETWEEN_TWO_AXES = Sentence(
    "between-two-axes", "unbounded, but between spin-up about {axis} and capture about {other}: a change of "
    "the state by {change} of its size, as rounding of the run may make, turns the one into the other")
CAPTURED = Sentence(
    "captured", "captured about {axis} for ever, where its spin grows like the square root of time: the "
    "energy grows, and the barrier of the reduced potential above it grows faster")
NO_MORE_REVERSAL = Sentence(
    "no-more-reversal", "spin-up about {axis}: the turn about it can reverse no more (proved from {time} on)")
GROWING_BOUND = Sentence(
    "growing-bound", "spin-up about {axis}: its rate is bounded below by a growing line; still captured when "
    "the search ended, release expected after about {time}")
NEITHER_CERTAIN = Sentence(
    "neither-certain", "unbounded, but neither spin-up about {axis} nor capture about {other} was certain "
    "after {steps} steps (the search ends after {time})")
EQUAL_ACROSS = Sentence("equal-moments-across",
                        "the moments across {axis} are equal: its spin grows exactly in proportion to time")
ALONG_WHEEL = Sentence(
    "along-wheel-momentum", "three equal moments: the spin along λ, which is on no axis, grows exactly in "
    "proportion to time, the rest of the motion is bounded")()
UNBOUNDED_BY_LAW = Sentence("unbounded-by-law",
                            "unbounded, because |H|²/2 - D{number} T grows in proportion to time")
RUN_SPINS_UP = Sentence("run-spins-up", "spin-up about {axis} by the evidence of a run of {time} ({seen})")
RUN_NO_AXIS = Sentence("run-no-axis", "no axis of spin-up was clear in a run of {time}")


@dataclass(frozen=True)
class CapturedFate(Reasoned):
    """What becomes of a motion that no bound holds.

    axis, sense: 1, 2, 3 and +-1 of the spin-up (0 where unclear). J0, J_rate: the law J = J0 + J_rate t at
    the state, in the scene's variables (|H|^2/2 - D_i T; x2^2 + x3^2 - 2(b-a) x1 when scaled). release_time:
    last reversal of the turn about axis i, after which it spins up for ever (0: there is none; None: captured
    for ever, or not run to it); release_estimate: about when the barrier will have vanished at the latest
    (None where no capture was seen or it lasts for ever). certificate: "bound", "spin-up",
    "well", "axis", "law", "evidence" or "none"; t_certificate: time at which it was found to hold; times in
    the scene's unit.
    """

    J0: float
    J_rate: float
    fate: Fate = Fate.UNDECIDED
    axis: int = 0
    sense: int = 0
    release_time: float | None = None
    release_estimate: float | None = None
    certificate: str = "none"
    t_certificate: float | None = None
    steps: int = 0


def captured_fate(scene: AnyScene, state: np.ndarray | Sequence[float], t_max: float | None = None,
                  exact: Sequence[Fraction] | None = None) -> CapturedFate:
    """Which axis the motion from `state` (three numbers, the scene's variables) spins up about, and when it
    is released.

    t_max: how long to look for a certificate, in the scene's time (None: a million of the motion's own
    units). exact: the state as it was given (Fractions), which decides whether it is a pure spin. Raises
    InputError for a scene whose torque is not along one principal axis with a gyrostatic component along it.
    """
    state = tuple(three_numbers(state).tolist())
    try:
        law = growth_law(scene)
        start = None if law is None else law[1](state)
    except OverflowError:
        raise InputError(
            "state: the squares of rates this large, or of moments, are beyond the largest double: choose "
            "other units") from None
    if law is None:
        raise InputError("capture needs a torque along one principal axis and a gyrostatic component along "
                         "that axis; "
                         "this scene is for the reduction or for the torque off the axes")
    axis, _, rate = law
    if _is_pure_spin(scene.quadratic(), axis, exact or state):
        reason = SPIN_ALONE(axis=Axis(axis + 1))
        return CapturedFate(start, rate, **_by_law("axis", axis, scene.quadratic(), reason))
    change = standard_form(scene)
    answer = (_by_certificate(change, change.to_standard(state), t_max, scene.time_unit) if change
              else _without_form(scene, state, axis, t_max))
    return CapturedFate(start, rate, **answer)


def _is_pure_spin(form: QuadraticForm, i: int, x: Sequence[float | Fraction]) -> bool:
    """Whether nothing turns but the torque's axis and, with no gyrostatic component across it, nothing else
    ever will."""
    j, k = CYCLE[i]
    return not (x[j] or x[k] or form.rho[j] or form.sigma[k])


def _by_law(certificate, i, form, reason):
    """Fields of CapturedFate of a spin about the torque's axis i that is known exactly for all time."""
    return dict(fate=Fate.SPIN_UP, axis=i + 1, sense=1 if form.m[i] > 0 else -1, release_time=0.0,
                certificate=certificate, t_certificate=0.0, reason=reason)


def _by_certificate(change, y, t_max, second):
    """Fields of CapturedFate from the standard form. second: the scene's unit of time."""
    c, (i, _, q), unit = change.c, change.axes, change.time
    axis, other = Axis(i + 1), Axis(q + 1)
    spin = dict(fate=Fate.SPIN_UP, axis=i + 1, sense=1 if change.rates[0] > 0 else -1)
    vanishing = release_estimate(c, angle_of(c, y)[2]) * unit if c > 0 else None
    t_max = MAX_TIME * unit if t_max is None else t_max
    name, t, end, last, steps = search_certificate(c, y, t_max / unit)
    if c < 0 and steps and name != "none" and (reach := nearest_other(c, y, t_max / unit, name, steps)):
        return dict(steps=steps, reason=BETWEEN_TWO_AXES(axis=axis, other=other,
                                                         change=Quantity(reach, "", 1)))
    estimate = None if name == "spin-up" and not last else vanishing
    when = None if t is None else t * unit
    resolved = dict(release_estimate=estimate, certificate=name, t_certificate=when, steps=steps)
    if name == "well":
        sense = (1 if change.rates[2] > 0 else -1) * (1 if end[2] > 0 else -1)
        return resolved | dict(fate=Fate.SPIN_UP, axis=q + 1, sense=sense, reason=CAPTURED(axis=other))
    if name == "spin-up":
        return spin | resolved | dict(release_time=last * unit,
                            reason=NO_MORE_REVERSAL(axis=axis, time=Quantity(when, second).upper))
    if c > 0:
        return spin | resolved | dict(certificate="bound", t_certificate=0.0, reason=GROWING_BOUND(
            axis=axis, time=Quantity(estimate, second)))
    return resolved | dict(reason=NEITHER_CERTAIN(axis=axis, other=other, steps=steps,
                                               time=Quantity(t_max, second)))


def _without_form(scene, state, axis, t_max):
    """Fields of CapturedFate where the standard form does not exist: exact spin of a symmetric body, else
    evidence."""
    form = scene.quadratic()
    if not (form.kappa[axis] or form.rho[axis] or form.sigma[axis]):
        return _by_law("law", axis, form, EQUAL_ACROSS(axis=Axis(axis + 1)))
    if not any(form.kappa):
        return dict(fate=Fate.SPIN_UP, release_time=0.0, certificate="law", t_certificate=0.0,
                    reason=ALONG_WHEEL)
    t_max = MAX_TIME / math.sqrt(abs(form.m[axis])) if t_max is None else t_max
    visited = seen_growth(scene, state, t_max)
    span = Quantity(visited.span, scene.time_unit)
    shown = (RUN_SPINS_UP(axis=Axis(visited.axis), time=span, seen=visited.reason) if visited.axis
             else RUN_NO_AXIS(time=span))
    resolved = dict(fate=Fate.SPIN_UP, certificate="evidence") if visited.axis else {}
    return resolved | dict(axis=visited.axis, sense=visited.sense, steps=visited.steps,
                        reason=UNBOUNDED_BY_LAW(number=axis + 1).then(shown))


def motion(scene, state, span=None, exact=None, needs: Needs = Needs.ALL) -> Motion:
    """See `answers.motion`: unbounded by an exact law; what is seen over the span is told beside it."""
    state = three_floats(state)
    result = captured_fate(scene, state, exact=exact)
    info = {"certificate": result.certificate, "t_certificate": result.t_certificate,
             "release_time": result.release_time,
             "release_estimate": result.release_estimate, "steps": result.steps}
    fields, noted = {**judged(state, unbounded(result)), "reason": result.reason, "returns": math.inf,
                    "level": LEVEL.get(result.certificate, "undecided")}, {}
    if needs & Needs.EXTREMES and (span is not None or _for_ever(result)):
        grown = captured_extremes(scene, state, result, reach_of(span), exact)
        fields |= {"extremes": pairs(grown.box), "over": grown.over}
        noted = ({} if span is None
                else seen_over(scene, state, (0.0, grown.span or reach_of(span)))["evidence"])
    elif needs & Needs.EXTREMES:
        fields["over"] = NO_EXTREMES(why=str(span_needed(scene)))
    return Motion(**fields, invariants={"J": result.J0, "J_rate": result.J_rate}, evidence={**noted, **info})


def _for_ever(result: CapturedFate) -> bool:
    """Whether all extremes of the motion are known for all time."""
    return result.certificate in ("axis", "law")


def extremes(scene, states, span=None, fast: bool | None = None):
    """(n, 3, 2), as of `captured_extremes`, NaN where the run ends before its span does; InputError where
    they are not known for all time and no span is named."""
    rows = [captured_fate(scene, state) for state in states]
    if span is None and not all(map(_for_ever, rows)):
        raise span_needed(scene)
    resolved = [captured_extremes(scene, *row, span) for row in zip(states, rows)]
    return np.array([item.box if item.whole else np.where(np.isinf(item.box), item.box, np.nan)
                     for item in resolved]).reshape(-1, 3, 2)


def periods(scene, states, fast: bool | None = None):
    """(n,): inf, for what grows for ever does not repeat."""
    return np.full(len(states), math.inf)


def unbounded(result: CapturedFate) -> OneFate:
    """The fate that `captured_fate` found under the law: unbounded, about an axis that may be undecided."""
    return OneFate(result.fate, Basis.UNBOUNDED_LAW, -math.inf, result.axis, result.sense)


def fates(scene: Scene, states: np.ndarray, fast: bool | None = None) -> FateResult:
    """Fates of states (n, 3), one by one."""
    def label(rows: np.ndarray, out: Mapping[str, np.ndarray]):
        with in_range():
            for index, state in enumerate(rows):
                write_row(out, index, *unbounded(captured_fate(scene, state)))
        at_rest(scene, rows, out)
        return 0
    return in_chunks(label, states)
