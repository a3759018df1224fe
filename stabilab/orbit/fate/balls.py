"""The margin of one state decided in balls, with as many digits as it takes."""
from __future__ import annotations

from typing import NamedTuple

from ...numbers.balls import DOUBLE_BITS, START_BITS, sign
from ...numbers.double_ball import Unclear
from ..ball_orbit import MOST_BITS, Orbit
from .tie import exact_tie

DOUBLE_SHARE = 1e-12  # of a margin: with less certainty balls of doubles do not settle it
EXACT_BITS = 512  # from these bits on algebra is asked whether two energies are equal


class Tie(NamedTuple):
    """Sign of a margin, settled with `bits` bits; 0 on the separatrix itself (by algebra: `exact_tie`)."""

    sign: int
    margin: float
    bits: int


def decide(orbit: Orbit, bits: int = START_BITS) -> Tie:
    """Sign of the margin of one state, doubling the bits until it is clear; sign -1 with margin -inf: no barrier.

    bits: at first; from DOUBLE_BITS the margin comes with at least twelve digits.

    Margin: the highest barrier minus the energy on a circle, else that of the barrier nearest in height.
    """
    def question(orbit):
        margin, bits = _margin(orbit), orbit.numbers.bits
        if margin is None:
            return Tie(-1, float("-inf"), bits)
        if _ties(orbit, margin):
            return Tie(0, 0.0, bits)
        if bits == DOUBLE_BITS and not DOUBLE_SHARE * abs(margin) > margin.rad():
            raise Unclear
        return Tie(sign(margin), float(margin.mid()), bits)
    return orbit.settled(question, bits)


def _margin(orbit):
    """The margin that `decide` speaks of, as a ball in canonical units; None where there is no barrier."""
    margins = orbit.margins()
    if not margins:
        return None
    margin = margins[0]
    for other in margins[1:]:
        margin = margin.max(other) if orbit.r.e < 0 else min(margin, other, key=lambda v: abs(float(v.mid())))
    return margin


def _ties(orbit, margin) -> bool:
    """Whether a margin that cannot be told from zero is zero; where algebra denies it, the most bits settle the matter.

    Without a torque a motion tends to whichever barrier its energy equals, be another one higher or not.
    """
    if not any(0 in m for m in ([margin] if orbit.r.e >= 0 or orbit.r.sense else orbit.margins())):
        return False
    if orbit.numbers.bits < EXACT_BITS:
        raise Unclear
    return exact_tie(orbit) or (0 in margin and orbit.numbers.bits >= MOST_BITS)


def precise_margin(orbit: Orbit, digits: int):
    """The margin of one state to `digits` decimal digits, as a ball in the scene's energy; None where there is no barrier,
    and on the separatrix, where no digit of it is known but that all vanish."""
    r = orbit.reduction

    def question(orbit):
        margin = _margin(orbit)
        if margin is None or _ties(orbit, margin):
            return None
        if not 10 ** digits * margin.rad() < abs(margin):
            raise Unclear
        return margin * orbit.numbers.ball(r.weight / (abs(r.p * r.q) if r.e else 1))
    return orbit.settled(question)
