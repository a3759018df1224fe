"""What a search for the nearest point of the separatrix answers."""
from __future__ import annotations

import math
from typing import NamedTuple

AGREE = 1e-9  # relative: nearer than that, lower bound and witness are one number


class Apart(NamedTuple):
    """The distance of a state from the separatrix lies in [lower, upper]; witness: a point of it (three rates) at `upper`.

    inf, inf, None where the scene has no separatrix. because: why the two are apart by more than AGREE, else empty.
    """

    lower: float
    upper: float
    witness: tuple[float, float, float] | None
    because: str = ""
    boxes: int = 0

    @property
    def value(self) -> float:
        """The distance where it is known to AGREE, else what it certainly is not below."""
        return self.upper if self.settled else self.lower

    @property
    def settled(self) -> bool:
        return self.upper == self.lower or self.upper - self.lower <= AGREE * self.upper


NO_SEPARATRIX = Apart(math.inf, math.inf, None)
UNKNOWN = Apart(0.0, math.inf, None, "the numbers of this scene are beyond what the search for the nearest point of the separatrix holds")
ENDED = "the search ended before its proved lower bound met the nearest point found"
