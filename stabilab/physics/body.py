"""The rigid body: three principal moments of inertia."""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import field
from fractions import Fraction

from ..asked import Asked
from ..caveat import Caveat
from ..errors import InputError
from ..numbers.exact import exact, exact_vector, floats, half_unit
from ..numbers.vectors import Exact3, Given
from ..record import record

ROUNDING = Fraction(1, 1 << 48)  # of the largest moment: what a routine of eigenvalues in doubles leaves


@record
class Body(metaclass=Asked):
    """A rigid body seen from its principal axes 1, 2, 3.

    inertia: three principal moments of inertia about the centre of mass or a fixed point, kg m^2, in any order,
    equal ones allowed; numbers or exact strings. `exact` keeps them unrounded. mass: kg, only where the body also
    travels. slack: kg m^2, by how much rounding may let the largest moment exceed the sum of the other two, which those
    of no mass distribution do; None for half a unit of the last digit of each. A larger excess is a caveat of every
    answer: Euler's equations hold for any positive moments. Raises InputError for a moment that is not positive.
    """

    inertia: Sequence[Given]
    mass: Given | None = None
    slack: Given | None = field(default=None, repr=False, compare=False)
    exact: Exact3 = field(init=False, repr=False)

    def __post_init__(self) -> None:
        moments = exact_vector(self.inertia, "inertia")
        for number, moment in enumerate(moments, 1):
            if moment <= 0:
                raise InputError(f"inertia: moment {number} is {float(moment):g}; principal moments are positive")
        if self.mass is not None:
            mass = exact(self.mass, "mass")
            if mass <= 0:
                raise InputError(f"mass: expected a positive number of kg, got {float(mass):g}")
            object.__setattr__(self, "mass", float(mass))
        slack = sum(map(half_unit, self.inertia)) if self.slack is None else exact(self.slack, "slack")
        object.__setattr__(self, "slack", slack)
        object.__setattr__(self, "exact", moments)
        object.__setattr__(self, "inertia", floats(moments))

    @property
    def excess(self) -> Fraction:
        """The largest moment less the sum of the other two, kg m^2: not positive for the moments of a mass distribution."""
        return 2 * max(self.exact) - sum(self.exact)

    @property
    def caveats(self) -> tuple[Caveat, ...]:
        """That no rigid body has these moments, where their digits do not allow for one; else nothing."""
        largest, excess = max(self.exact), self.excess
        if excess <= max(exact(self.slack), ROUNDING * largest):
            return ()
        return (Caveat("unphysical", f"no rigid body has this tensor: the largest principal moment, {float(largest):.12g} kg m^2, exceeds "
                       f"the sum of the other two, {float(largest - excess):.12g}, by {float(excess):.6g} "
                       f"({float(100 * excess / largest):.2g} % of it); Euler's equations are solved as they stand"),)
