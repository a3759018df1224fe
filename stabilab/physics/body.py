"""The rigid body: three principal moments of inertia."""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import field

from ..asked import Asked
from ..errors import InputError
from ..numbers.exact import exact, exact_vector, floats
from ..numbers.vectors import Exact3, Given
from ..record import record


@record
class Body(metaclass=Asked):
    """A rigid body seen from its principal axes 1, 2, 3.

    inertia: three principal moments of inertia about the centre of mass or a fixed point, kg m^2, in any order,
    equal ones allowed; numbers or exact strings. `exact` keeps them unrounded. mass: kg, only where the body also
    travels. Raises InputError for a moment that is not positive and where the largest exceeds the sum of the other
    two (no mass distribution does that).
    """

    inertia: Sequence[Given]
    mass: Given | None = None
    exact: Exact3 = field(init=False, repr=False)

    def __post_init__(self) -> None:
        moments = exact_vector(self.inertia, "inertia")
        for number, moment in enumerate(moments, 1):
            if moment <= 0:
                raise InputError(f"inertia: moment {number} is {float(moment):g}; principal moments are positive")
        largest = max(moments)
        if 2 * largest > sum(moments):
            raise InputError(
                f"inertia: the triangle inequality is broken: {float(largest):.17g} exceeds the sum of the other two, "
                f"{float(sum(moments) - largest):.17g}, by {float(2 * largest - sum(moments)):.6g}; no rigid body has these moments")
        if self.mass is not None:
            mass = exact(self.mass, "mass")
            if mass <= 0:
                raise InputError(f"mass: expected a positive number of kg, got {float(mass):g}")
            object.__setattr__(self, "mass", float(mass))
        object.__setattr__(self, "exact", moments)
        object.__setattr__(self, "inertia", floats(moments))
