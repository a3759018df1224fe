"""The orbit of one state, built once in each kind of number that its questions ask for."""
from __future__ import annotations

from ..numbers.balls import START_BITS, settled
from .ball_base import BallOrbit
from .ball_geometry import ball_orbit

MOST_BITS = 1 << 17  # where balls end
TIE_BITS = 4096  # with so many the extremes of a motion on the separatrix are worked out


class Orbit:
    """The orbit of one state (three doubles or Fractions, taken exactly), built once in each kind of number that a question asks for."""

    def __init__(self, reduction, state):
        self.reduction, self.state, self._built = reduction, state, {}

    def settled(self, question, bits: int = START_BITS, most: int = MOST_BITS):
        """question(orbit) of its `BallOrbit`, as `balls.settled` asks: with more bits as long as it is `Unclear`."""
        return settled(lambda numbers: question(self._in(numbers)), bits, most)

    def _in(self, numbers) -> BallOrbit:
        if numbers not in self._built:
            self._built[numbers] = ball_orbit(self.reduction, self.state, numbers)
        return self._built[numbers]
