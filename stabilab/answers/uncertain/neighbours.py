"""What motions beside an equilibrium do, over a box of uncertain numbers around it.

Every motion of such a box may be bounded while none stays near the equilibrium: beside a rotation about the
intermediate axis a body turns over. So a box around an equilibrium is judged by its stability at the middle,
and by how far motions of the box depart from the rotation they start with. Each is followed over one period
by its power series; the equilibrium's stability is exact (`answers.at_equilibrium`).
"""
from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction

import numpy as np

from ...errors import InputError
from ...integrate.quadratic_series import coefficients, length, summed
from ...numbers.vectors import Float3
from ...orbit.result import Fate
from ...physics.scene import QuadraticForm, rests
from ...reasons import Angle, Quantity, Rate, Reason, Sentence, in_si
from ..at_equilibrium import of_gyrostat
from ..caveats import UNSTABLE, UNSTABLE_SLOWLY
from ..motions.rows import periods
from .boxes import Box, Point
from .result import Over, Witness, corners
from .search import SEED

MAX_CORNERS = DRAWN = 32  # corners, and points drawn at random, at which a motion is followed
STEPS, INSIDE = 4000, 8  # of a motion at most; points a step at which its departure is taken
TERM_TOLERANCE = 1e-13  # of the size of the state: the last terms of a step
STABLE = Sentence("stable-equilibrium", "stable")()
STABILITY_UNDECIDED = Sentence("stability-undecided", "its stability is undecided")()
MIDDLE_AND_ELSEWHERE = Sentence("stability-over-box",
                                "the middle is {middle}, and elsewhere in the box is {elsewhere}")
OF_MOTIONS = Sentence("of-all-motions", "of all motions: {why}")
ONE_DEPARTS = Sentence(
    "one-departs", "the middle is an equilibrium, {stability}; of {number} points of the box one departs by "
    "{departure} from its start; of all of them: {why}")


@dataclass(frozen=True)
class Neighbours:
    """verdict: "stable", "unstable" or "undecided", of the equilibrium at the middle (Lyapunov); growth: the
    largest real part of its eigenvalues, 1/s (1/tau when scaled), 0 where none is positive. number: of points
    of the box whose motion was followed; angle: the most by which the rotation of one of them turns away from
    where it starts, rad, in the body (None at rest, or where none is bounded); rate: the most by which the
    rates change, rad/s (or x). turned: whether the rate along the rotation at the start changes its sign in
    one of them. scaled: whether the variables are."""

    verdict: str
    growth: float
    number: int
    angle: float | None
    rate: float
    turned: bool
    scaled: bool = False

    @property
    def reason(self) -> Reason:
        """How stable the equilibrium is."""
        if self.growth > 0:
            return UNSTABLE(time=Quantity(1 / self.growth, "tau" if self.scaled else "s"))
        return {"unstable": UNSTABLE_SLOWLY(), "undecided": STABILITY_UNDECIDED}.get(self.verdict, STABLE)

    @property
    def stability(self) -> str:
        """The same in words and SI units."""
        return self.reason.text()

    @property
    def departure(self) -> Quantity:
        """How far the motions go: by an angle, or a rate where there is none."""
        if self.scaled:
            return Quantity(self.rate)
        return Rate(self.rate) if self.angle is None else Angle(self.angle)

    @property
    def departs(self) -> str:
        """The same in words and SI units, which follow "departs from this rotation by up to"."""
        return in_si(self.departure)

    @property
    def departing(self) -> bool:
        """Whether motions of the box are seen to leave the equilibrium: it is unstable and they depart from
        it, or one of them turns over."""
        return self.rate > 0 and (self.turned or self.verdict == "unstable")


def beside(box: Box, result: Over) -> Over:
    """The answer over a box whose middle is at rest in the equations of motion, with what its neighbours do;
    any other as it is."""
    n = len(box.places)
    scene, state = box.at(np.zeros(n))
    exact = box.middle["state"] if box.frame is None else tuple(map(Fraction, state or ()))
    if not rests(scene.quadratic(), exact):
        return result
    middle = of_gyrostat(scene, exact)
    verdict, growth = middle.verdict, middle.growth or 0.0
    at_rest = not any(exact)
    best, far, number, turned = (0.0, 0.0), np.zeros(n), 0, False
    other = None  # a point at rest too, and as stable as the middle is not
    points = np.concatenate([corners(n, MAX_CORNERS), np.random.default_rng(SEED).uniform(-1, 1, (DRAWN, n))])
    for point in points[box.rigid(points)]:
        gone = _departure(box, point)
        if gone is None:
            continue
        number += 1
        if other is None and not gone[1] and verdict != "undecided":
            other = point if _verdict_at(box, point) not in (verdict, "undecided") else None
        turned |= gone[0] > math.pi / 2 and not at_rest
        if (gone if not at_rest else gone[::-1]) > (best if not at_rest else best[::-1]):
            best, far = gone, point
    angle = best[0] if number and not at_rest else None
    neighbours = Neighbours(verdict, growth, number, angle, best[1], turned, scene.variables == "scaled")
    result = replace(result, neighbours=neighbours)
    if other is not None and result.answer != "depends":
        phrases = [f"{'an' if item == 'unstable' else 'a'} {item} equilibrium"
                 for item in (verdict, _verdict_at(box, other))]
        return _depends(box, result, phrases, other, float(np.abs(other).max()),
                        MIDDLE_AND_ELSEWHERE(middle=phrases[0], elsewhere=phrases[1]).then(
                            OF_MOTIONS(why=result.reason)))
    if not neighbours.departing or result.answer == "depends":
        return result
    return _depends(box, result, [Fate.EQUILIBRIUM.word, Fate.BOUNDED.word], far,
                    0.0 if verdict == "unstable" else float(np.abs(far).max()),
                    ONE_DEPARTS(stability=neighbours.reason, number=number,
                                departure=neighbours.departure, why=result.reason))


def _depends(box: Box, result: Over, text: Sequence[str], point: Point, changes_at: float,
             reason: Reason) -> Over:
    """The answer with the middle and a point as witnesses of these verdicts."""
    witnesses = tuple(Witness(word, box.values(location))
                      for word, location in zip(text, (np.zeros(len(point)), point)))
    return replace(result, answer="depends", verdict=text[0], reason=reason, proved=0.0,
                   exception=None, changes_at=changes_at, witnesses=witnesses)


def _verdict_at(box: Box, point: Point) -> str:
    """The stability of the equilibrium at a point of the box."""
    scene, state = box.at(point)
    return of_gyrostat(scene, tuple(map(Fraction, state or ()))).verdict


def _departure(box: Box, point: Point) -> tuple[float, float] | None:
    """(angle, rate) by which the motion of a point departs from its start at the most; None where there is no
    such body, or it does not come back."""
    try:
        scene, state = box.at(point)
    except InputError:
        return None
    if state is None:
        return None
    until = float(periods(scene, state))
    return departure(scene.quadratic(), state, until) if math.isfinite(until) else None


def departure(form: QuadraticForm, start: Float3, until: float) -> tuple[float, float] | None:
    """(largest angle, rad, between the state and its start, largest distance of the two) from time 0 to
    `until`; None where that takes too many steps."""
    t, x, size = 0.0, start, math.hypot(*start)
    angle = rate = 0.0
    for _ in range(STEPS):
        if t >= until:
            return angle, rate
        series = coefficients(form, x)
        h = min(length(series, TERM_TOLERANCE * (max(map(abs, x)) or 1.0)), until - t)
        for k in range(1, INSIDE + 1):
            x = tuple(summed(term, h * k / INSIDE) for term in series)
            gap = math.dist(x, start)
            rate = max(rate, gap)
            if both := size * math.hypot(*x):
                cosine = sum(a * b for a, b in zip(x, start)) / both
                angle = max(angle, math.acos(max(-1.0, min(1.0, cosine))))
        t += h
    return None
