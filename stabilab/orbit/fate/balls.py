"""The sign of the margin of one state is decided in balls, with as many digits as that takes."""
from __future__ import annotations

from typing import NamedTuple

from ...numbers.balls import START_BITS, Unclear, sign
from ..ball_orbit import MOST_BITS, Orbit
from .tie import exact_tie

SHARE = 1e-12  # of a margin: with less certainty balls do not settle it
EXACT_BITS = 512  # from these bits on algebra is asked whether two energies are equal


class Tie(NamedTuple):
    """Sign of a margin, settled with `bits` bits; 0 on the separatrix itself (by algebra: `exact_tie`)."""

    sign: int
    margin: float
    bits: int


def decide(orbit: Orbit, bits: int = START_BITS) -> Tie:
    """Sign of the margin of one state, doubling the bits until it is clear; sign -1 with margin -inf: no barrier.

    bits: at first. The margin comes with at least twelve digits, whatever bits settle its sign.

    Margin: see `BallOrbit.margin`.
    """
    def question(orbit):
        margin, bits = orbit.margin(), orbit.numbers.bits
        if margin is None:
            return Tie(-1, float("-inf"), bits)
        if _ties(orbit, margin):
            return Tie(0, 0.0, bits)
        if not SHARE * abs(margin) > margin.rad():
            raise Unclear
        return Tie(sign(margin), float(margin.mid()), bits)
    return orbit.settled(question, bits)


def _ties(orbit, margin) -> bool:
    """Whether a margin that cannot be told from zero is zero; where algebra denies it, the most bits settle the matter."""
    if not any(0 in m for m in orbit.margins_to_tie(margin)):
        return False
    if orbit.numbers.bits < EXACT_BITS:
        raise Unclear
    return exact_tie(orbit) or (0 in margin and orbit.numbers.bits >= MOST_BITS)


def precise_margin(orbit: Orbit, digits: int):
    """The margin of one state to `digits` decimal digits, as a ball in the scene's energy; None where there is no barrier,
    and on the separatrix, where no digit of it is known but that all vanish."""
    unit = orbit.reduction.exact_energy_unit

    def question(orbit):
        margin = orbit.margin()
        if margin is None or _ties(orbit, margin):
            return None
        if not 10 ** digits * margin.rad() < abs(margin):
            raise Unclear
        return margin * orbit.numbers.ball(unit)
    return orbit.settled(question)
