"""The equilibria of a satellite with wheels on a circular orbit; their number over the wheels' momentum."""
from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from fractions import Fraction
from os import PathLike
from typing import Any

from ..case.given import Amount
from ..case.read import Case, load_orbiting
from ..equilibrium.circular_orbit import (
    Branch,
    MomentumSpan,
    OrbitEquilibria,
    branches,
    orbit_equilibria,
    spans,
)
from ..errors import Caveat, InputError, Kind
from ..numbers.exact import sqrt_fraction
from ..numbers.units import MOMENTUM, in_si
from ..numbers.vectors import Float3, dot
from ..physics.circular_orbit import Satellite
from ..reasons import Sentence
from ..validation import came
from .caveats import of_case

MIDDLES = Caveat(Kind.UNCERTAIN,
                 Sentence("of-the-middles-alone", "of the middles of the uncertain numbers")())
LARGEST_SIZE = Fraction(10)**50
# more than doubles have; of 240, as a case has them, elimination makes numbers of pages
ELIMINATION_BITS = 64
ROUNDED = Sentence("numbers-rounded",
                   "as some numbers are irrational ({names}), all are taken to {bits} bits")


@dataclass(frozen=True)
class CircularOrbit:
    """A satellite on a circular orbit; vectors along its principal axes.

    rate: of the orbit, rad/s; period: s. moments: kg m^2; momentum: of the wheels, N m s. equilibria: in the
    orbital frame, all of them. spans: where the wheels' momentum was varied along its direction, intervals of
    it, N m s, with the number of equilibria in each (see `MomentumSpan`); None where it was not. satellite:
    its numbers, exact.
    """

    rate: float
    period: float
    moments: Float3
    momentum: Float3
    equilibria: OrbitEquilibria
    spans: tuple[MomentumSpan, ...] | None = None
    caveats: tuple[Caveat, ...] = ()
    satellite: Satellite | None = field(default=None, repr=False)


def circular_orbit(orbiting: Any, up_to: Amount | None = None) -> CircularOrbit:
    """Every equilibrium, in the orbital frame, of a satellite with wheels on a circular orbit, with its
    stability and its librations.

    orbiting: the path or the text of a case file with [circular_orbit], a dict with its tables, or what
    `stabilab.load_orbiting` gives. up_to: N m s, or text with a unit: the wheels' momentum is varied from 0
    to there along the direction that it has, too. Raises InputError for what is no such case, for a momentum
    that is not positive, and for `up_to` of a satellite without one.
    """
    if isinstance(orbiting, (str, PathLike, Mapping, Case)):
        orbiting = load_orbiting(orbiting)
    if not hasattr(orbiting, "rate_squared"):
        raise InputError(f"circular_orbit: expected a case with [circular_orbit]: the path of its file, its "
                         f"text, a dict, or what stabilab.load_orbiting gives; got {came(orbiting)}")
    case = orbiting.craft
    satellite = Satellite(case.physical.body.exact, case.physical.vector("gyrostat"), orbiting.rate_squared)
    if not _in_range(satellite):
        raise InputError("circular_orbit: the rate of the orbit, a moment, two of them over each other, or "
                         "the momentum over moment and rate, are beyond 1e50 or below 1e-50: are the units "
                         "right?")
    irrational = [*case.inexact, *(["principal axes"] if case.frame and not case.frame.exact else [])]
    if irrational:
        satellite = satellite.rounded(ELIMINATION_BITS)
    equilibria = orbit_equilibria(satellite)
    if irrational:
        equilibria = replace(equilibria, reason=equilibria.reason.then(
            ROUNDED(names=", ".join(irrational), bits=ELIMINATION_BITS)))
    rate = math.sqrt(orbiting.rate_squared)
    return CircularOrbit(rate, 2 * math.pi / rate, tuple(map(float, satellite.moments)),
                         tuple(map(float, satellite.momentum)), equilibria,
                         None if up_to is None else _varied(satellite, in_si(up_to, MOMENTUM, "up_to")),
                         tuple(MIDDLES if item.kind is Kind.UNCERTAIN else item for item in of_case(case)),
                         satellite)


def followed(result: CircularOrbit) -> list[Branch]:
    """The equilibria followed over the spans of an answer, their momenta in N m s. Raises InputError without
    spans, and where equilibria are families."""
    if result.spans is None or result.satellite is None:
        raise InputError("up_to: give the momentum up to which the equilibria are followed")
    if any(span.families for span in result.spans) or result.equilibria.kind == "all":
        raise InputError("circular_orbit: the equilibria of this body are families, which turn about an "
                         "axis: they are described in words, and there are no branches to draw")
    size = math.hypot(*result.momentum)
    own = [replace(span, low=span.low / size, high=span.high / size) for span in result.spans]
    return [replace(x, momenta=[size * s for s in x.momenta]) for x in branches(result.satellite, own)]


def _in_range(satellite: Satellite) -> bool:
    """Whether the numbers of the answer are doubles by far."""
    smallest, greatest = min(satellite.moments), max(satellite.moments)
    fraction = dot(satellite.momentum, satellite.momentum) / satellite.rate_squared / smallest**2
    return (LARGEST_SIZE**-2 < satellite.rate_squared < LARGEST_SIZE**2 and greatest < LARGEST_SIZE * smallest
            and LARGEST_SIZE**-1 < greatest < LARGEST_SIZE and fraction < LARGEST_SIZE**2)


def _varied(satellite: Satellite, up_to: Fraction) -> tuple[MomentumSpan, ...]:
    """The spans in N m s."""
    if up_to <= 0:
        raise InputError(f"up_to: expected a positive momentum, got {float(up_to):.10g} N m s")
    size = sqrt_fraction(dot(satellite.momentum, satellite.momentum))
    if not size:
        raise InputError("up_to: the wheels have no momentum, which is varied along its direction: add "
                         "[[wheels]] or [effects.gyrostat] to the case")
    return tuple(replace(span, low=span.low * float(size), high=span.high * float(size))
                 for span in spans(satellite, up_to / size))
