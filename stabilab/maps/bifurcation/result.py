"""A diagram as data: pieces of the range with so many equilibria each, and the events between them."""
from __future__ import annotations

from dataclasses import dataclass, field
from fractions import Fraction

from ...numbers.vectors import Float3
from ...shown import Shown
from .family import Family

CURVES = "curves"  # the kind of a diagram in words
ENDLESS = -1  # in the place of a count: equilibria without number, curves of them


@dataclass(frozen=True)
class State:
    """An equilibrium: at in the case's variables along the principal axes; times: how many branches meet in it; linear, verdict, because: as those of
    `equilibrium.result.EquilibriumPoint`."""

    at: Float3
    times: int
    linear: str
    verdict: str
    because: str


@dataclass(frozen=True)
class Event:
    """A value at which something happens. value: a double, in the unit of the range; exact: the number itself where it is rational; polynomial:
    whole coefficients, lowest power first, of which it is the real root number `index` (in rising order, from 0); kinds: "fold", "pitchfork",
    "crossing", "touch", "infinity", "axis", "curve" or "connection", as `words` tells; count: equilibria there, ENDLESS for curves of them; states: those
    there."""

    value: float
    exact: Fraction | None
    polynomial: tuple[int, ...]
    index: int
    kinds: tuple[str, ...]
    count: int
    states: tuple[State, ...]
    words: str


@dataclass(frozen=True)
class Piece:
    """An open piece of the range with one number of equilibria. low, high: doubles; sample: a value inside, exact; states: the equilibria there, in the
    order in which their branches are numbered; seams: values inside at which two of them may change places in the component that orders them; words: which
    curves there are, where equilibria form these."""

    low: float
    high: float
    count: int
    sample: Fraction
    states: tuple[State, ...]
    seams: tuple[float, ...] = ()
    words: str = ""


@dataclass(frozen=True, repr=False)
class Diagram(Shown):
    """All equilibria over one number. kind: which are counted ("isolated", "motion", "borders" or "curves"); what: the same in words; pieces and
    events in rising order: event n lies between pieces; an event at an end of the range has a piece on one side only."""

    family: Family = field(repr=False)
    kind: str
    what: str
    pieces: tuple[Piece, ...]
    events: tuple[Event, ...]
    connections: tuple[Event, ...] = ()
    notes: tuple[str, ...] = ()
