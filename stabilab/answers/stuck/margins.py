"""What is found of a stuck thruster, and how little must change for its fate to change.

Rows are frozen and say how well they are known. A change is one of the rate, of the wheel's momentum or of
the torque, each with its direction, where a separatrix is there."""
from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any, NamedTuple, cast

import numpy as np

from ...errors import Caveat
from ...numbers.bracket import LAST_PLACE, Bracket, first_bracket, narrowed
from ...numbers.exact import unit_vector
from ...numbers.polynomial import golden_section
from ...numbers.vectors import Float3, Number
from ...orbit.reduction import Reduction
from ...orbit.result import Fate, Motion
from ...physics.scene import Scene
from ...reasons import DIGITS, Momentum, Quantity, Rate, Reason, Reasoned, Sentence, Torque, as_reason
from ...representation import Shown
from ..caveats import STEADY
from ..tilt import Spread, Tilt
from ..uncertain.fate import Uncertainty
from .fate import Outcome, Scenario, across, loose
from .line import Family, Line, candidates, family_of, nearest_change, pieces, rise


# --- The answer
class Principal(NamedTuple):
    """Moments (kg m^2) of the principal axes 1, 2, 3 of the case; axes: rows, unit vectors in the frame of
    the file, right-handed."""

    moments: Float3
    axes: tuple[Float3, ...]


@dataclass(frozen=True)
class Margin(Reasoned):
    """The smallest change that changes the fate: its size, its direction (unit vector, frame of the file);
    None where none is known.

    reason: why it is not known, or what it holds for. until: the greater change along the direction from
    which on the fate is again what it was: the size itself where it is another on the separatrix alone, inf
    where no greater change leads back, None where that is not known.
    """

    size: float | None = None
    direction: Float3 | None = None
    until: float | None = None

    @property
    def beyond(self) -> bool:
        """Whether a somewhat greater change along the direction changes the fate too."""
        return self.until is None or self.size is None or self.until > self.size


@dataclass(frozen=True)
class WheelAnswer(Reasoned):
    """Which momenta of one wheel keep the motion bounded.

    keeps_bounded: (least, greatest) momentum along its axis, N m s, of every interval, -inf and inf where it
    has no end. best: where there is no interval, the momentum within `searched` that delays the limit most;
    best_time: (low, high), s, None where the limit is not reached within the time followed; gain: by how much
    later, s (low end against low end). most: whether the runs that are compared came to the limit: else
    another momentum may delay it more. reason: how this is known.
    """

    wheel: str
    axis: Float3
    now: float
    keeps_bounded: tuple[tuple[float, float], ...]
    best: float | None = None
    best_time: tuple[float, float] | None = None
    gain: float | None = None
    searched: tuple[float, float] | None = None
    most: bool = True


@dataclass(frozen=True)
class Helper:
    """Other thrusters fired together with the stuck ones, each for a share of the time (`duty`, 0 to 1), as a
    mean torque.

    effect: "zero" (no torque is left), "bounded" (what is left keeps the motion bounded), "slower" (the limit
    comes later; without a limit: less torque is left), "none" (it is not known to come later: no help).
    torque_left: N m. fate: of the motion under what is left. time_to_limit: (low, high), s, or None.
    """

    thrusters: tuple[str, ...]
    duty: tuple[float, ...]
    effect: str
    torque_left: float
    fate: str
    time_to_limit: tuple[float, float] | None


@dataclass(frozen=True)
class Row(Reasoned):
    """What becomes of the body while some thrusters fire for ever.

    torque: N m, frame of the file; torque_principal: along `Stuck.principal`. fate: a word of `Fate`; level:
    "proved", "certified", "exact" or "run". axis: 1, 2 or 3 of `Stuck.principal`, sense along its unit
    vector; None where it spins up about none. direction: unit vector along which the rate grows, frame of the
    file, or None. limit: rad/s, of |omega|, or three numbers of its components in the frame of the file, or
    None. time_to_limit: (low, high), s, of the first time at the limit; None where it is never within what is
    known. never: whether it is known never to be reached. largest_rate: of |omega|, rad/s, up to that time or
    for ever. followed: s, up to where the limit is known not to be reached. tilt: what becomes of a bounded
    motion when the torque is a little off its axis (`answers.tilt`), where a limit or a misalignment is
    stated. box: what uncertain numbers do to the fate under a torque along an axis, None where none is.
    caveats: all that limits the row. reason: why it has this fate.
    """

    thrusters: tuple[str, ...]
    torque: Float3
    torque_principal: Float3
    fate: str
    level: str
    axis: int | None
    sense: int | None
    direction: Float3 | None
    limit: float | Float3 | None
    time_to_limit: tuple[float, float] | None
    time_level: str
    never: bool
    largest_rate: float | None
    followed: float
    margins: dict[str, Margin]
    wheels: tuple[WheelAnswer, ...] = ()
    helpers: tuple[Helper, ...] = ()
    tilt: Tilt | Spread | None = None
    caveats: tuple[Caveat, ...] = ()
    box: Uncertainty | None = None


@dataclass(frozen=True, repr=False)
class Stuck(Shown):
    """The answer for one case: a row a combination of thrusters (see `stuck`), in one set of principal axes.
    """

    case: str
    rows: tuple[Row, ...]
    principal: Principal
    ranked: bool = False

    @property
    def caveats(self) -> tuple[Caveat, ...]:
        """Those of all rows, each once."""
        return tuple(dict.fromkeys(caveat for row in self.rows for caveat in row.caveats))


# --- How little must change
TURN = 2000  # places on the turn at which the rise of the potential is looked at, to find a direction
MAX_CHANGE = 1000  # of the body's own momentum: changes of the wheel as great are not given
# of a turn: directions beside that of a circle that is a point
PHASES_BESIDE = 2 * math.pi * np.geomspace(1e-4, 1e-2, 5)
FEW = 5  # nearest places that are looked at in exact numbers
# of a change of wheel momentum, at first; steps nearer and nearer to the best of them
DIRECTIONS, CLOSER = 180, 26
# rad: the nearest place may be the tip where two separatrices meet, with nothing straight behind it
TURNS = (0.0, 1e-5, -1e-5, 1e-4, -1e-4, 1e-3, -1e-3)
FREE = Sentence(
    "measure-zero", "the motion spins up on a set of measure zero: nearly every change, however small, makes "
    "it bounded")()
ALONE = Sentence(
    "on-separatrix-alone", "to the separatrix, where alone the fate is another: beyond it the motion is "
    "bounded again")()
ON_SEPARATRIX = Sentence("is-on-separatrix", "the motion is on the separatrix")()
NO_SEPARATRIX_KNOWN = Sentence(
    "off-axis-no-separatrix", "the torque is off the principal axes: no separatrix is known")()
NO_SEPARATRIX_NEAR = Sentence("no-separatrix-near", "no separatrix stands near it")()
BOUNDED_AGAIN = Sentence("bounded-again", "beyond {change} along the same line it is bounded again")
SPINS_UP_AGAIN = Sentence("spins-up-again", "beyond {change} along the same line it spins up again")
WHATEVER_WHEEL = Sentence(
    "bounded-without-torque", "no torque acts: the motion is bounded whatever the wheel does")()
WHEEL_ALONG = Sentence(
    "wheel-along-torque", "the wheel has momentum along the torque: no motion is bounded, and no separatrix "
    "divides them")()
EVERY_BOUNDED = Sentence(
    "all-bounded", "every motion is bounded but for a set of measure zero: the fate does not change")()
NO_TORQUE_CHANGES = Sentence("no-torque-changes", "no torque along this axis changes the fate")()
TORQUE_ON_AXIS = Sentence("torque-on-axis", "for a torque along the same axis")()
TO_NO_TORQUE = Sentence("to-no-torque", "to no torque at all: along this axis any torque spins it up")()
NO_WHEEL_CHANGES = Sentence(
    "no-wheel-changes", "no wheel momentum across the torque is known to change the fate, up to a thousand "
    "times the body's own")()
WHEEL_ACROSS = Sentence(
    "wheel-across", "for a change of wheel momentum perpendicular to the torque, the least found over all "
    "directions")()
# of a change: how near the exact one is to that of doubles; changes back so soon are no use to anybody
CLOSE = 1e-6


def margins(scenario: Scenario, scene: Scene, visited: Outcome) -> dict[str, Margin]:
    """The margins of one outcome, by name: "rate" (rad/s), "wheel" (N m s), "torque" (N m)."""
    if visited.fate == Fate.SEPARATRIX:
        return {name: Margin(0.0, None, reason=ON_SEPARATRIX)
                for name in ("rate", "wheel", "torque")}
    family = family_of(scene, scenario.state)
    if visited.motion is None or (family is None and any(scene.vector("constant_torque"))):
        return {name: Margin(reason=NO_SEPARATRIX_KNOWN) for name in ("rate", "wheel", "torque")}
    if family is not None and visited.fate == Fate.SPIN_UP and _walled(family):
        any_change = Margin(0.0, None, math.inf, reason=FREE)
        return {"rate": any_change, "wheel": any_change, "torque": _torque(scenario, family, False)}
    return {"rate": _rate(scenario, visited.motion, family), **_parameters(scenario, family)}


def _rate(scenario: Scenario, motion: Motion, family: Family | None) -> Margin:
    """To the nearest separatrix as the motion knows it, and how far beyond it the fate is another."""
    if motion.margin_velocity is None or motion.velocity_witness is None:
        return Margin(reason=motion.velocity_reason or NO_SEPARATRIX_NEAR)
    change = [b - a for a, b in zip(scenario.start, motion.velocity_witness)]
    direction = _unit(scenario.in_file(change)) if any(change) else None
    reason = as_reason(motion.velocity_reason)
    if _walled(family):
        return Margin(motion.margin_velocity, direction, motion.margin_velocity,
                      reason=reason.then(ALONE) if reason else ALONE)
    if family is None or not any(change):
        return Margin(motion.margin_velocity, direction, reason=as_reason(reason))
    until = _rate_again(family, change, Fraction(motion.margin_velocity))
    if until is not None and until < math.inf:
        again = _again(Rate(until, digits=DIGITS), family.fate() in STEADY)
        reason = reason.then(again) if reason else again
    return Margin(motion.margin_velocity, direction, until, reason=as_reason(reason))


def _rate_again(family: Family, change: Sequence[Number], size: Fraction) -> float | None:
    """The greater change of rate along a direction from which on the fate is again what it was; None where
    balls or the place of the first do not tell."""
    reduction = family.reduction(family.wheel)
    if reduction is None:
        return None
    route = family.turned([Fraction(v) for v in change])
    step = unit_vector(route)
    cuts = candidates(Line(reduction, reduction, family.state, family.along(family.state, step, Fraction(1))))
    if cuts is None:
        return None
    clearly = lambda s: replace(family, state=family.along(family.state, step, s)).clearly()
    first, until = nearest_change(pieces(clearly, size, sorted(set(cuts))), family.fate() in STEADY)
    return until if abs(first - size) <= CLOSE * size else None


def _again(until: Quantity, steady: bool) -> Reason:
    return (BOUNDED_AGAIN if steady else SPINS_UP_AGAIN)(change=until.upper)


def _walled(family: Family | None) -> bool:
    """Whether every motion but those on a separatrix is bounded."""
    reduction = None if family is None else family.reduction(family.wheel)
    return reduction is not None and reduction.geometry.walled


def _parameters(scenario: Scenario, family: Family | None) -> dict[str, Margin]:
    """Those of torque and wheel momentum."""
    reduction = None if family is None else family.reduction(family.wheel)
    if family is not None and reduction is not None and not reduction.geometry.walled:
        steady = family.fate() in STEADY
        return {"wheel": _wheel(scenario, family, steady), "torque": _torque(scenario, family, steady)}
    reason = WHATEVER_WHEEL if family is None else WHEEL_ALONG if reduction is None else EVERY_BOUNDED
    entries = {name: Margin(reason=reason) for name in ("wheel", "torque")}
    if family is not None and reduction is not None and not any(loose(reduction, family.state)):
        entries["torque"] = _torque(scenario, family, True)  # no wall need hold the start: it may be let go
    return entries


def _torque(scenario: Scenario, family: Family, steady: bool) -> Margin:
    """Along the torque's axis: the more torque one way the lower every barrier ahead, so one size each way
    divides the fates."""
    size = abs(family.torque)
    now = 1 if family.torque > 0 else -1
    if steady:
        ends = ((sign, _least_torque(family, sign, size)) for sign in (-now, now))
        changes, until = [sign * end - family.torque for sign, end in ends if end is not None], math.inf
    else:
        clearly = lambda m: -family.clearly(torque=now * m)
        full = Bracket(size, Fraction(0), (clearly(size), clearly(Fraction(0))))
        less = narrowed(clearly, full, scale=size).other
        opposite = _least_torque(family, -now, size)
        changes = [now * less - family.torque]
        until = math.inf if opposite is None else float(size + opposite)
    change = min(changes, key=abs, default=None)
    if change is None:
        return Margin(reason=NO_TORQUE_CHANGES)
    reason = TORQUE_ON_AXIS if family.torque + change else TO_NO_TORQUE
    if abs(change) < until < math.inf:
        reason = reason.then(_again(Torque(until), steady))
    direction = _direction(scenario, family, {family.axis: 1 if change > 0 else -1})
    return Margin(float(abs(change)), direction, until, reason=as_reason(reason))


def _least_torque(family: Family, sign: int, size: Fraction) -> Fraction | None:
    """The least size of a torque in this direction that spins the start up."""
    clearly = lambda m: family.clearly(torque=sign * m)
    result = first_bracket(clearly, size, least=size * LAST_PLACE**2)
    return None if result is None else narrowed(clearly, result, scale=size).other


def _wheel(scenario: Scenario, family: Family, steady: bool) -> Margin:
    """Of a momentum across the torque: the nearest in the plane of the two other axes. Doubles show the way,
    exact fates give the number."""
    j, k = family.across
    # size, from where on it is back, direction
    heights, best = _Rise(family), (math.inf, math.inf, [Fraction(0)] * 3)
    # towards the momentum at which the orbit's circle is a point and nothing stands in the way of a spin-up
    if steady and any(straight := _to_point(family)):
        straight = list(unit_vector(straight))
        best = min(best, (*_along(family, straight, steady), straight))
    for angle, nearby in _nearest(heights, steady):
        for turn in TURNS if nearby < min(MAX_CHANGE * family.momentum_unit, best[0] * (1 + CLOSE)) else ():
            step = [Fraction(0)] * 3
            step[j], step[k] = Fraction(math.cos(angle + turn)), Fraction(math.sin(angle + turn))
            result = _along(family, step, steady)
            if result[0] < 2 * nearby and result[1] > result[0] * (1 + CLOSE):
                best = min(best, (*result, step))
                break
    size, until, step = best
    if size == math.inf:
        return Margin(reason=NO_WHEEL_CHANGES)
    reason = WHEEL_ACROSS.then(_again(Momentum(until), steady) if until < math.inf else None)
    return Margin(size, _direction(scenario, family, {j: step[j], k: step[k]}), until, reason=reason)


def _along(family: Family, step: Sequence[Fraction], steady: bool) -> tuple[float, float]:
    """(the least change along a unit vector at which the fate changes, the greater one from which on it is
    again what it was), inf where there is none."""
    return nearest_change(across(family, family.wheel, step)[0], steady)


def _to_point(family: Family) -> list[Fraction]:
    """The change of the wheel's momentum across the torque with which omega_n = -s_n of the reduction."""
    D = family.body.exact
    return [(D[family.axis] - D[n]) * family.state[n] - family.wheel[n] if n in family.across else Fraction(0)
            for n in range(3)]


def _nearest(heights: _Rise, steady: bool) -> list[tuple[float, float]]:
    """(angle, size) of the least changes of momentum in the plane across the torque, each nearest among its
    neighbours, seen in doubles."""
    # a circle that is a point has no barrier: a small island of spin-up
    centre = heights.centre + np.concatenate([-PHASES_BESIDE[::-1], [0.0], PHASES_BESIDE])
    angles = np.sort(np.concatenate([np.linspace(0, 2 * math.pi, DIRECTIONS, endpoint=False),
                                     centre % (2 * math.pi)]))
    sizes = np.array([heights.first_change(a, steady) for a in angles])
    smallest = [n for n in range(len(angles)) if sizes[n] <= min(sizes[n - 1], sizes[(n + 1) % len(angles)])
             and math.isfinite(sizes[n])]
    round_and_on = np.concatenate([angles[-1:] - 2 * math.pi, angles, angles[:1] + 2 * math.pi])
    rows = []
    for n in sorted(smallest, key=lambda n: sizes[n])[:FEW]:
        closer = golden_section(lambda a: heights.first_change(a, steady), round_and_on[n],
                                round_and_on[n + 2], CLOSER)
        rows.append(min(*closer, (angles[n], sizes[n]), key=lambda item: item[1]))
    return rows


class _Rise:
    """How far the potential rises over the start, less its energy, at many places of one turn, as a quadratic
    of a change of the wheel: doubles."""

    def __init__(self, family: Family) -> None:
        j, k = family.across
        self.unit = family.momentum_unit
        wheels = [[w + Fraction(self.unit) * (m == n) for m, w in enumerate(family.wheel)] for n in (j, k)]
        # none has a part along the torque
        here, *there = (cast(Reduction, family.reduction(wheel)) for wheel in (family.wheel, *wheels))
        lines = [Line(here, item, family.state, family.state) for item in there]
        floats: Any = lambda numbers: np.array([float(v) for v in numbers])
        self.fixed, self.at = floats(lines[0].fixed), floats(lines[0].at)
        self.changes = [floats(line.change) for line in lines]
        straight = _to_point(family)
        self.centre = math.atan2(float(straight[k]), float(straight[j]))
        # a great momentum raises the potential close to the start, before or behind it
        ends = 2 * math.pi * np.geomspace(1e-7, 1 / TURN, TURN // 4)
        self.half = np.concatenate([ends, np.linspace(0, 2 * math.pi, TURN + 1)[1:], 2 * math.pi - ends]) / 2
        self.sine, self.cosine = np.sin(self.half), np.cos(self.half)

    def first_change(self, angle: float, steady: bool) -> float:
        """The least s > 0 at which the fate changes along a direction of the plane; inf where it does not."""
        change = math.cos(angle) * self.changes[0] + math.sin(angle) * self.changes[1]
        C, B, A = rise(self.fixed, self.at, change, self.half, self.sine, self.cosine, True)
        with np.errstate(all="ignore"):
            root = np.sqrt(np.maximum(B * B - 4 * A * C, 0))
            q = -0.5 * (B + np.where(B >= 0, 1, -1) * root)
            low, high = np.sort(np.stack([np.where(C != 0, q / C, np.nan), np.where(q != 0, A / q, np.nan)])
                                / self.sine, axis=0)
        return self.unit * _first_end(C, B * B - 4 * A * C > 0, low, high, steady)


def _first_end(C: np.ndarray, real: Any, low: Number, high: Number, steady: bool) -> float:
    """Of quadratics in s with highest coefficients C, real roots or none, and these: the least s > 0 at which
    one becomes positive; if steady, from which on, for a while, none is."""
    # positive outside the roots where it opens upwards, between them where downwards
    starts = np.concatenate([np.where(C > 0, -np.inf, low), np.where(C > 0, high, np.inf)])
    ends = np.concatenate([np.where(C > 0, low, high), np.where(C > 0, np.inf, -np.inf)])
    real = np.concatenate([real, real])
    if not steady:  # a straight line has no second end
        return float(np.min(starts[real & (starts > 0) & ~(ends <= starts)], initial=np.inf))
    retained = real & (ends > starts)
    order = np.argsort(starts[retained])
    now = math.inf if ((C > 0) & ~real[:len(C)]).any() else 0.0
    for start, end in zip(starts[retained][order], ends[retained][order]):
        if start > now + 1e-9 * abs(now) and now > 0:
            break
        now = max(now, end)
    return float(now) if now > 0 else math.inf


def _direction(scenario: Scenario, family: Family, parts: dict[int, Any]) -> Float3:
    """The unit vector with these parts along the family's axes, in the frame of the file."""
    vector = [Fraction(parts.get(n, 0)) for n in range(3)]
    return _unit(scenario.in_file(family.back(vector)))


def _unit(vector: Sequence[float]) -> Float3:
    size = math.hypot(*vector)
    return tuple(v / size + 0.0 for v in vector)
