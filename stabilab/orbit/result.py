"""What the analyses answer: frozen results that say how well they are known."""
from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from enum import Flag, IntEnum
from typing import TYPE_CHECKING, Any, NamedTuple

from ..numbers.vectors import Float3, Number
from ..reasons import Axis, Quantity, Reason, Reasoned, Sentence
from ..representation import Answer

if TYPE_CHECKING:  # a scene of exact laws does not load it
    from ..physics.law_limits import Validity
    from ..physics.symmetric_top import TopRates
    from .reduction import EnergyIntegral


SPINS_ABOUT = Sentence("spins-up-about", "it spins up about {axis}")
SPINS_ABOUT_TORQUE = Sentence("spins-up-about-torque", "it spins up about the torque")()
# over what extremes are known
ALL_TIME = Sentence("all-time", "all time")()
AS_BOUNDS = Sentence("all-time-as-bounds", "all time, as bounds")()  # wider than those of the motion
OVER_SPAN = Sentence("over-span", "{span}")
NO_EXTREMES = Sentence("no-extremes", "none: {why}")


class Fate(IntEnum):
    """What becomes of a state as time goes on; `word` is the word of reports and JSON.

    BOUNDED: every rate stays within bounds for ever. SPIN_UP: one grows without bound. SEPARATRIX: exactly
    between the two. EQUILIBRIUM: the state does not change. UNDECIDED: nothing is proved, and the reason is
    told.
    """

    BOUNDED = 0
    SPIN_UP = 1
    SEPARATRIX = 2
    EQUILIBRIUM = 3
    UNDECIDED = 4

    @property
    def word(self) -> str:
        """The word used in reports and JSON."""
        return OUTCOMES[self].word


class Outcome(NamedTuple):
    """What a fate is called. word: in JSON, CSV and case files; head: at the head of an answer; does, do: of
    one motion and of several; legend: of a picture; no_period: why it has no period, where it has none."""

    word: str
    head: str
    does: str
    do: str
    legend: str
    no_period: Reason


NEVER_AGAIN = Sentence("motion-not-repeating", "the motion does not repeat")()
# every view takes its words from here
OUTCOMES = {
    Fate.BOUNDED: Outcome("bounded", "BOUNDED for ever", "stays bounded", "stay bounded", "bounded",
                          Sentence("no-period-known", "no period is known of this motion")()),
    Fate.SPIN_UP: Outcome("spin-up", "SPINS UP", "spins up", "spin up", "spins up", NEVER_AGAIN),
    Fate.SEPARATRIX: Outcome("separatrix", "ON THE SEPARATRIX", "lies on the separatrix",
                             "lie on the separatrix", "on the separatrix", NEVER_AGAIN),
    Fate.EQUILIBRIUM: Outcome("equilibrium", "STEADY ROTATION", "is an equilibrium", "are equilibria",
                              "equilibrium", Sentence(
                                  "no-period-of-equilibrium",
                                  "the state is an equilibrium and has no period")()),
    Fate.UNDECIDED: Outcome("undecided", "UNDECIDED", "is undecided", "are undecided", "undecided",
                            Sentence("period-of-undecided",
                                     "the period is not known: the fate is undecided")())}
HEADS = {outcome.word: outcome.head for outcome in OUTCOMES.values()}


class Order(IntEnum):
    """What is seen of a motion that is followed; `word` is the word of reports and JSON."""

    REGULAR = 0
    CHAOTIC = 1
    SPIN_UP = 2
    UNDECIDED = 3

    @property
    def word(self) -> str:
        """The word used in reports and JSON."""
        return ("regular", "chaotic", "spin-up", "undecided")[self]


class Needs(Flag):
    """What of a `Motion` is worked out where a question prints it, each at a price; the fate, its reason and
    the margin in energy always are. LARGEST: of |omega|; DISTANCE: from the separatrix; QUICK: all but what
    takes tens of milliseconds."""

    FATE = 0
    EXTREMES = 1
    PERIOD = 2
    LARGEST = 4
    FLIPS = 8
    DISTANCE = 16
    INVARIANTS = 32
    ENDING = 64
    RETURN = EXTREMES | PERIOD
    QUICK = RETURN | LARGEST | FLIPS
    ALL = QUICK | DISTANCE | INVARIANTS | ENDING


# what the numbers that are read off the extremes, or off them and the period, are made of
BOX, ROUND = Needs.EXTREMES | Needs.LARGEST | Needs.FLIPS, Needs.PERIOD | Needs.LARGEST | Needs.FLIPS


@dataclass(frozen=True)
class Stability(Reasoned):
    """Of a state of equilibrium. verdict: "stable", "asymptotically stable", "unstable" or "undecided"
    (Lyapunov, for the full nonlinear motion); reason: its proof, because: the same in words; growth: rate of
    the fastest growing disturbance, 1/s (1/tau when scaled), None where none grows exponentially."""

    verdict: str
    growth: float | None = None

    @property
    def stable(self) -> bool:
        """Whether it is proved that disturbances stay small."""
        return self.verdict in ("stable", "asymptotically stable")

    @property
    def unstable(self) -> bool:
        """Whether disturbances leave it."""
        return self.verdict == "unstable"


@dataclass(frozen=True)
class Flips:
    """How often a periodic motion turns over (`unreduced.flips`). axis: 1, 2, 3, of the body, that its
    angular momentum lies along at one time and against at another; times: from one flip to the next, s, in
    the order in which they repeat; free: whether no torque acts, so that the momentum is fixed in space and
    the body turns over."""

    axis: int
    times: tuple[float, ...]
    free: bool


@dataclass(frozen=True, repr=False)
class Motion(Answer, Reasoned):
    """Everything known about the motion from one state.

    axis: 1, 2, 3 of the spin-up, 0 otherwise; sense: +1 or -1 of the spin-up, 0 otherwise. margin_energy:
    height of the barrier ahead minus energy (negative above it; None where no barrier stands ahead at
    this value of the invariant); without a torque the kinetic energy of the nearest saddle of the same
    momentum minus the motion's. margin_velocity: smallest change of the state that reaches the
    separatrix, at whatever value of the invariant, to 1e-6, or where that is not reached a number that it
    is proved not to be below (None where the scene has none, or nothing is known: then velocity_reason
    says why). velocity_bounds: (proved lower bound, distance of velocity_witness), velocity_witness: a
    state on the separatrix as near as that; velocity_reason: why the two bounds are apart. period: None
    where the motion does not repeat, or is undecided. extremes: ((min, max),) * 3 over t >= 0, entries
    +-inf where unbounded, None where unknown; over: all time, or the span they were searched over, or why
    there are none; velocity_because, extremes_over: these two in words, in SI units. validity: of an
    approximate law (`stabilab.physics.law_limits`), with its largest value along
    the motion; None where all laws are exact. tilt: what a tilt of its torque off the axis does to a
    bounded motion (`answers.tilt`), where that was asked; first: the limit of its case and its
    `TimeTo`, likewise; caveats: all that limits the answer (`answers.caveats`). largest: |omega| at the
    most, over all time, where a motion repeats or rests, to eight digits. flips: how often it turns over;
    None where it does not, or where that is not known (`unreduced.flips`). energy_integral: the paper's
    G1, G2 or G3 (`orbit.reduction`), under a torque along a principal axis with no wheel along it.
    ending: how a motion that loses energy ends, and when (`answers.dissipation.ending`), where it does.
    top: of a symmetric top its rates of steady precession and their stability (`physics.symmetric_top`).
    level: of the fate, "exact", "certified" (a theorem applied to a run of machine precision) or
    "undecided". reason: why it has this fate, of which words are taken as they are; because: the same in
    words, in SI units. Of motions that were followed until a certificate held, or as long as was asked:
    finding: what the run has shown, cause: the same in words; bounds: ((low, high),) * 3 of the rates at
    all t >= 0, wider than the extremes, +-inf where unbounded (None where not known). stability: of an
    equilibrium. margin, code, returns: the margin, the number of the reason and the period as arrays have
    them (`orbit.fate_arrays`): infinite, NaN and -1 where there is none.
    """

    at: Float3
    fate: Fate
    axis: int = 0
    sense: int = 0
    margin_energy: float | None = None
    margin_velocity: float | None = None
    velocity_bounds: tuple[float, float] | None = None
    velocity_witness: Float3 | None = None
    velocity_reason: Reason | None = None
    period: float | None = None
    extremes: tuple[tuple[float, float], ...] | None = None
    over: Reason = ALL_TIME
    invariants: dict[str, float] = field(default_factory=dict)
    evidence: dict[str, Any] = field(default_factory=dict)
    tolerance: float | None = None
    level: str = "exact"
    finding: Reason | None = None
    bounds: tuple[tuple[float, float], ...] | None = None
    validity: Validity | None = None
    tilt: object = None
    first: tuple[Quantity | Reason, Any] | None = None
    largest: float | None = None
    flips: Flips | None = None
    energy_integral: EnergyIntegral | None = None
    stability: Stability | None = None
    ending: Any = None
    top: TopRates | None = None
    margin: float = field(default=math.nan, repr=False, compare=False)
    code: int = field(default=-1, repr=False, compare=False)
    returns: float = field(default=math.nan, repr=False, compare=False)

    @property
    def velocity_because(self) -> str:
        """`velocity_reason` in words and SI units; empty where there is nothing to explain."""
        return "" if self.velocity_reason is None else self.velocity_reason.text()

    @property
    def extremes_over(self) -> str:
        """`over` in words and SI units: "all time", "s in [0, 5]"."""
        return self.over.text()

    @property
    def for_all_time(self) -> bool:
        """Whether its extremes, where they are known, are those over all time."""
        return self.over == ALL_TIME

    @property
    def extremes_side(self) -> int:
        """1 where its extremes are bounds, which are rounded outward; 0 where they are values."""
        return int(self.over == AS_BOUNDS)

    @property
    def cause(self) -> str:
        """What a run has shown, in words and SI units; empty where none was needed."""
        return "" if self.finding is None else self.finding.text()


def spins_about(label: int, axis: int, sense: int) -> Reason | None:
    """About what a motion with this fate spins up, a clause of its reason; None where it does not, or where
    that is not known."""
    if label != Fate.SPIN_UP or not (axis or sense):
        return None
    return SPINS_ABOUT(axis=Axis(axis)) if axis else SPINS_ABOUT_TORQUE


def judged(state: Float3, decided: Any) -> dict[str, Any]:
    """The fields of a Motion that its decided fate fills: label, reason, axis and sense."""
    reason = decided.reason.then(spins_about(decided.label, decided.axis, decided.sense))
    level = "undecided" if decided.label == Fate.UNDECIDED else "exact"
    return {"at": state, "fate": decided.label, "reason": reason, "axis": decided.axis,
            "sense": decided.sense, "level": level, "margin": float(decided.margin),
            "code": int(decided.basis),
            "returns": math.nan if decided.label == Fate.BOUNDED else without_return(decided.label)}


def finite(value: Number) -> float | None:
    """The number as a float; None where it is infinite or no number."""
    return float(value) if math.isfinite(value) else None


def repeats(time: float) -> float | None:
    """The period; None where there is none (at rest, or a motion that does not repeat), or none is known."""
    return time if 0 < time < math.inf else None


def without_return(label: int) -> float:
    """What stands for the period of a motion that is not known to be bounded: 0 at rest, inf where it does
    not repeat, NaN where its fate is undecided, as it may repeat or not."""
    return {Fate.EQUILIBRIUM: 0.0, Fate.UNDECIDED: math.nan}.get(Fate(int(label)), math.inf)


def no_period(fate: Fate) -> Reason:
    """Why a motion with this fate has no period, in words."""
    return OUTCOMES[fate].no_period


def pairs(array: Iterable[Sequence[Number]]) -> tuple[tuple[float, float], ...]:
    """((least, greatest), ...) in plain floats."""
    return tuple((float(low), float(high)) for low, high in array)
