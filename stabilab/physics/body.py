"""The rigid body: three principal moments of inertia, and what its numbers tell of it."""
from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cached_property

from ..errors import Caveat, InputError, Kind
from ..numbers.exact import exact, floats
from ..numbers.principal import PrincipalAxes, entries, evened, principal_axes, rounding
from ..numbers.units import INERTIA, MASS, RATE, half_digit, in_si, vector_in_si
from ..numbers.vectors import Exact3, Float3, Given
from ..reasons import Inertia, Length, Mass, Quantity, Sentence
from ..validation import Asked

TOO_THIN = Sentence("size-too-thin",
                    "the radius of gyration is {radius} beside a mass of {mass}, beyond all reason: less "
                    "than 1 g to a cubic metre of that size; is the tensor in kg mm^2 or another unit that "
                    "the file leaves out")
TOO_DENSE = Sentence("size-too-dense",
                     "the radius of gyration is {radius} beside a mass of {mass}, beyond all reason: matter "
                     "so dense there is none (a ball of osmium has a trace of the tensor of {trace}); is the "
                     "mass in g, or the tensor in another unit that the file leaves out")
NO_BODY = Sentence("no-body-has-this-tensor",
                   "no rigid body has this tensor: the largest principal moment, {largest}, exceeds the sum "
                   "of the other two, {others}, by {excess} ({percent} % of it); Euler's equations are "
                   "solved as they stand")
ROUNDING = Fraction(1, 1 << 48)  # of the largest moment: what a routine of eigenvalues in doubles leaves
# kg to the cube of the largest radius of gyration in m: a solar sail of 10 g/m^2 and 100 m has 1.5e-3, the
# space station 40, a CubeSat 6000; a tensor in kg mm^2 that is taken for kg m^2 makes all of these 1e-9 of it
THINNEST = 1e-3
DENSEST = 22_600.0  # kg/m^3, of osmium


def slack_of(halves: Sequence[Sequence[Fraction]]) -> Fraction:
    """How far half units e_ij of the entries of a tensor leave open by how much its largest moment exceeds
    the sum of the others.

    At most e_11 + e_22 + e_33 + 2 max_i sum_(j != i) e_ij: the trace changes by the first, and an eigenvalue
    of the tensor less half its trace by at most the largest sum of a row (Gershgorin).
    """
    return sum((halves[i][i] for i in range(3)), Fraction(0)) + 2 * max(
        sum(row, Fraction(0)) - row[i] for i, row in enumerate(halves))


@dataclass(frozen=True)
class Body(metaclass=Asked):
    """A rigid body seen from its principal axes 1, 2, 3.

    inertia: three principal moments of inertia about the centre of mass or a fixed point, kg m^2, in any
    order, equal ones allowed, or the whole tensor, 3 x 3, in any frame fixed in the body, whose principal
    moments are then found, and its principal axes (`axes`); numbers, exact strings, or text with a unit
    ("12 kg m^2"). `exact` keeps the moments unrounded. mass: kg, only where the body also travels. slack:
    kg m^2, by how much rounding may let the largest moment exceed the sum of
    the other two, which those of no mass distribution do; None for half a unit of the last digit of each. A
    larger excess is a caveat of every answer: Euler's equations hold for any positive moments. Raises
    InputError for a moment that is not positive.
    """

    inertia: Sequence[Given]
    mass: Given | None = None
    slack: Given | None = field(default=None, repr=False, compare=False)
    exact: Exact3 = field(init=False, repr=False)
    axes: PrincipalAxes | None = field(init=False, repr=False, compare=False, default=None)

    def __post_init__(self) -> None:
        halves, moments = self._moments()
        for number, moment in enumerate(moments, 1):
            if moment <= 0:
                raise InputError(
                    f"inertia: moment {number} is {float(moment):g}; principal moments are positive")
        if self.mass is not None:
            mass = in_si(self.mass, MASS, "mass")
            if mass <= 0:
                raise InputError(f"mass: expected a positive number of kg, got {float(mass):g}")
            object.__setattr__(self, "mass", float(mass))
        object.__setattr__(self, "slack", halves if self.slack is None else exact(self.slack, "slack"))
        object.__setattr__(self, "exact", moments)
        object.__setattr__(self, "inertia", floats(moments))

    def _moments(self) -> tuple[Fraction, Exact3]:
        """(how far the digits that were given leave the moments open, principal moments); keeps the axes of a
        tensor."""
        rows = list(self.inertia) if hasattr(self.inertia, "__iter__") else []
        if isinstance(self.inertia, str) or len(rows) != 3 or not all(
                hasattr(row, "__len__") and not isinstance(row, str) for row in rows):
            moments = vector_in_si(self.inertia, INERTIA, "inertia")
            return sum((half_digit(value, INERTIA) for value in self.inertia), Fraction(0)), moments
        supplied = [vector_in_si(row, INERTIA, f"inertia: row {n}") for n, row in enumerate(rows, 1)]
        try:
            axes = principal_axes(evened(supplied, ROUNDING), rounding(entries(supplied)))
        except InputError as error:
            raise InputError(f"inertia: {error}") from None
        object.__setattr__(self, "axes", axes)
        return slack_of([[half_digit(value, INERTIA) for value in row] for row in rows]), axes.moments

    def turned(self, vector: Sequence[Given]) -> Float3:
        """Components along the principal axes of a vector in the frame that the tensor was given in: an
        angular velocity (rad/s, or text with its unit), say."""
        supplied = vector_in_si(vector, RATE, "vector")
        return floats(supplied if self.axes is None else self.axes.turned(supplied))

    @property
    def excess(self) -> Fraction:
        """The largest moment less the sum of the other two, kg m^2: not positive for the moments of a mass
        distribution."""
        return 2 * max(self.exact) - sum(self.exact)

    @cached_property
    def caveats(self) -> tuple[Caveat, ...]:
        """That no rigid body has these moments, where their digits do not allow for one, and that its mass
        and its moments do not belong together."""
        return (*self._no_body, *self._no_size)

    @property
    def gyration(self) -> float | None:
        """The largest radius of gyration, m; None without a mass."""
        return None if self.mass is None else math.sqrt(float(max(self.exact)) / float(self.mass))

    @property
    def _no_size(self) -> tuple[Caveat, ...]:
        """Of a body too thin or too dense for anything built or found. Its least extent follows from the
        moments: of all bodies of a mass and a density a ball has the least trace, 6/5 m R^2."""
        radius = self.gyration
        if radius is None or self.mass is None:
            return ()
        mass, moments = float(self.mass), {"radius": Length(radius, digits=4), "mass": Mass(self.mass)}
        if mass < THINNEST * radius * radius * radius:
            return (Caveat(Kind.SIZE, TOO_THIN(**moments)),)
        ball = 1.2 * mass * (3 * mass / (4 * math.pi * DENSEST)) ** (2 / 3)
        if float(sum(self.exact)) < ball:
            return (Caveat(Kind.SIZE, TOO_DENSE(**moments, trace=Inertia(ball, digits=4))),)
        return ()

    @property
    def _no_body(self) -> tuple[Caveat, ...]:
        largest, excess = max(self.exact), self.excess
        if excess <= max(exact(self.slack), ROUNDING * largest):
            return ()
        return (Caveat(Kind.UNPHYSICAL, NO_BODY(
            largest=Inertia(largest, digits=12), others=Quantity(largest - excess, digits=12),
            excess=Quantity(excess), percent=Quantity(100 * excess / largest, digits=2))),)
