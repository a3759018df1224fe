"""The orbit of one state, built once in each kind of number that its questions ask for."""
from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from ..numbers.balls import FIRST_BITS, START_BITS, settled
from ..numbers.vectors import Number
from .ball_base import BallOrbit
from .ball_geometry import ball_orbit
from .reduction import Reduction

MOST_BITS = 1 << 17  # where balls end
TIE_BITS = 4096  # with so many the extremes of a motion on the separatrix are worked out


class Orbit:
    """The orbit of one state (three doubles or Fractions, taken exactly), built once in each kind of number that a question asks for."""

    def __init__(self, reduction: Reduction, state: Sequence[Number]) -> None:
        self.reduction, self.state = reduction, state
        self._built: dict[Any, BallOrbit] = {}

    def settled(self, question: Callable[[BallOrbit], Any], bits: int = START_BITS, most: int = MOST_BITS) -> Any:
        """question(orbit) of its `BallOrbit`, as `balls.settled` asks: with more bits as long as it is `Unclear`."""
        return settled(lambda numbers: question(self._in(numbers)), bits, most)

    def invariants(self) -> dict[str, float]:
        """Q (the squared radius of the circle, or Z^2 - X^2 on a hyperbola) in canonical units, and the energy W^2/2 + V in
        the scene's, with the turn angle counted from the direction X = 0; nothing on a parabola."""
        return self.settled(lambda found: found.invariants(), FIRST_BITS)

    def _in(self, numbers: Any) -> BallOrbit:
        if numbers not in self._built:
            self._built[numbers] = ball_orbit(self.reduction, self.state, numbers)
        return self._built[numbers]
