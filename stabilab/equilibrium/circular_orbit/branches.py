"""The equilibria on a circular orbit followed as the momentum of the wheels grows, for pictures.

At each of some momenta between two changes of their number all are found, exactly, each with its verdict.
What belongs together at two neighbouring momenta is what lies nearest, of all their pairs the nearest first.
"""
from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from math import cos, dist, pi

from ...numbers.vectors import nearest_first
from ...physics.circular_orbit import Satellite
from .momenta import MomentumSpan
from .result import OrbitEquilibrium
from .solve import orbit_equilibria

POINTS = 24  # of a span: close at its ends, where branches meet as square roots do
BITS = 24  # of all numbers, far more than a picture shows: short ones are eliminated soon
FINE = 1 << 16  # the share of a span, far above what `BITS` leave open, that momenta are whole numbers of


@dataclass
class Branch:
    """verdict: of all its equilibria; momenta: rising, in units of the satellite's own; points: one of each
    pair that a half turn about the orbit normal leads into each other."""

    verdict: str
    momenta: list[float] = field(default_factory=list)
    points: list[OrbitEquilibrium] = field(default_factory=list)

    def add(self, momentum: float, point: OrbitEquilibrium) -> Branch:
        self.momenta.append(momentum)
        self.points.append(point)
        return self


def branches(satellite: Satellite, spans: Iterable[MomentumSpan]) -> list[Branch]:
    """The branches over spans of the momentum; of a satellite without a continuous symmetry. A branch whose
    verdict changes ends and another one begins at its last point."""
    done: list[Branch] = []
    for span in spans:
        going: list[Branch] = []
        for s in _momenta(span):
            momentum = tuple(s * h for h in satellite.momentum)
            found = orbit_equilibria(replace(satellite, momentum=momentum).rounded(BITS)).points[::2]
            going = _joined(going, float(s), found, done)
        done += going
    return done


def _momenta(span: MomentumSpan) -> list[Fraction]:
    low, width = Fraction(span.low), Fraction(span.high) - Fraction(span.low)
    steps = dict.fromkeys(min(FINE - 1, max(1, round(FINE * (1 - cos(pi * n / POINTS)) / 2)))
                          for n in range(POINTS + 1))
    return [low + width * n / FINE for n in steps]


def _joined(going: Sequence[Branch], s: float, found: Sequence[OrbitEquilibrium],
            done: list[Branch]) -> list[Branch]:
    """The branches that go on to the equilibria at the next momentum; those that end are added to `done`."""
    if len(going) != len(found):
        done += going
        return [Branch(one.verdict).add(s, one) for one in found]
    paired = nearest_first((_apart(branch.points[-1], one), i, j) for i, branch in enumerate(going)
                           for j, one in enumerate(found))
    before = {j: i for i, j in paired.items()}
    out = []
    for j, one in enumerate(found):
        branch = going[before[j]]
        if branch.verdict != one.verdict:
            done.append(branch)
            branch = Branch(one.verdict).add(branch.momenta[-1], branch.points[-1])
        out.append(branch.add(s, one))
    return out


def _apart(one: OrbitEquilibrium, other: OrbitEquilibrium) -> float:
    """How far two pairs are apart: by the normal, and by the vertical up or down."""
    down = tuple(-v for v in other.vertical)
    return dist(one.normal, other.normal) + min(dist(one.vertical, other.vertical), dist(one.vertical, down))
