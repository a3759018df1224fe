"""A limit of a motion, and the time at which an enclosed motion first reaches it.

A limit is one of the rate, from below or from above, of a component, of the kinetic energy, of the angle by
which a body axis has turned, or of its nutation, from either side: the angle to the angular momentum H = D
omega + lambda (and what turns inside). Where H stays the cosine of that is linear in the rates.

The motion is enclosed in integers, of as many bits as are needed, as far as the work allowed reaches;
beyond that by compiled steps. One search finds the crossing in either (`integrate.crossing`)."""
from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import partial
from typing import Any

from ..errors import InputError
from ..integrate.crossing import Crossing, Search, Threshold
from ..integrate.integer_flow import IntegerFlow
from ..numbers.exact import exact, exact_vector, precise, sqrt_fraction, unit_vector
from ..numbers.numba_door import installed
from ..numbers.vectors import Exact3, Float3, Number, dot
from ..physics.coefficients import added_inside, content
from ..physics.own_unit import exact_unit
from ..physics.scene import INSIDE, AnyScene, slices
from ..unreduced.crossing import first_crossing

# --- The limit
AXES = tuple(tuple(Fraction(int(i == j)) for j in range(3)) for i in range(3))
COSINE_BITS = 1200  # of the cosine of a tilt: more than any run has
ANGLES = frozenset(("tilt", "nutation", "nutation_below"))  # kinds of limits
SIGN = " (it is a size: give it without a sign)"


@dataclass(frozen=True)
class Limit:
    """kind: "rate", "component", "energy", "tilt", "nutation", or "below" and "nutation_below", of |omega|
    and of an angle that fall to it. parts: ((weights and vectors, limit), ...): sum c (a . omega)^2 reaches
    the limit's value, the first of the parts counts; for an angle vector and angle, rad. label: for the
    reader, in SI. origin: of a tilt, the direction in space that it counts from; None: that of its body axis
    at the start. momentum: of a nutation."""

    kind: str
    parts: tuple[Any, ...]
    label: str
    origin: Float3 | None = None
    momentum: Momentum | None = None

    def thresholds(self, unit: Fraction, start: Sequence[Number] = ()) -> list[Threshold]:
        """In the motion's own unit, as `crossing` takes them; start: three exact rates, of a nutation of a
        body whose angular momentum stays."""
        if self.momentum is not None:
            ((_, vector),), angle = self.parts[0]
            H, law = self.momentum.of(start), self.momentum
            limit = precise("cos", angle) * sqrt_fraction(dot(H, H)) - dot(vector, law.wheel)
            along = tuple(a * d for a, d in zip(vector, law.D))
            return [Threshold(((Fraction(1), along),), limit / unit, falls=not self.falls, linear=True)]
        if self.kind == "tilt":
            ((_, vector),), angle = self.parts[0]
            zero = (Fraction(0),) * 3
            cosine = precise("cos", angle, bits=COSINE_BITS)
            return [Threshold(((Fraction(1), zero + vector),), cosine, falls=True, linear=True)]
        return [Threshold(terms, largest / (unit * unit), self.falls) for terms, largest in self.parts]

    @property
    def falls(self) -> bool:
        """Whether a size or an angle falls to it."""
        return self.kind in ("below", "nutation_below")

    @property
    def angular(self) -> bool:
        """Whether it is one of an angle."""
        return self.kind in ANGLES

    @property
    def direction(self) -> Exact3 | None:
        """The body axis whose tilt is asked for, a unit vector; None for other limits."""
        return self.parts[0][0][0][1] if self.kind == "tilt" else None

    def reached_by(self, state: Sequence[Number]) -> bool:
        """Whether an exact state has reached it; a tilt is 0 at the start. state: the rates, and what turns
        inside, where there is such a block (`Momentum`)."""
        if self.momentum is not None:
            more = self.cosine(state) - float(precise("cos", self.parts[0][1]))
            return more >= 0 if self.falls else more <= 0
        return self.kind != "tilt" and any(part.passed(state) for part in self.thresholds(Fraction(1)))

    def beyond(self, extremes: Iterable[Iterable[float]], slack: float) -> bool:
        """Whether rates within their extremes, ((least, greatest),) * 3, each wider by the share `slack`,
        stay below it, or above it where it `falls`. Not known here of angles."""
        if self.angular:
            return False
        if self.falls:
            smallest = [Fraction(max(0.0, low, -high) * (1 - slack)) for low, high in extremes]
            return all(sum(c * sum(abs(a) * v for a, v in zip(vector, smallest)) ** 2 for c, vector in terms)
                       > limit for terms, limit in self.parts)
        sizes = [max(abs(low), abs(high)) * (1 + slack) for low, high in extremes]

        def below(terms: Sequence[tuple[Fraction, tuple[Fraction, ...]]], largest: Fraction) -> bool:
            """In exact numbers, as squares of doubles may be none."""
            own = [size if any(vector[n] for _, vector in terms) else 0.0 for n, size in enumerate(sizes)]
            return all(map(math.isfinite, own)) and largest > sum(
                c * sum(abs(a) * Fraction(size) for a, size in zip(vector, own)) ** 2 for c, vector in terms)
        return all(below(terms, largest) for terms, largest in self.parts)

    def least_rate(self) -> float:
        """The largest |omega| below which it is surely not reached."""
        return min(float(sqrt_fraction(Fraction(largest) / max(c for c, _ in terms)))
                   for terms, largest in self.parts)


    def cosine(self, state: Sequence[Number]) -> float:
        """Of the nutation at a state, whose angular momentum is not zero."""
        ((_, vector),), _ = self.parts[0]
        H = self.momentum.of(state)  # type: ignore[union-attr]  # asked of a nutation
        return float(dot(vector, H) / sqrt_fraction(dot(H, H)))

    def nutates_beyond(self, extremes: Iterable[Iterable[float]], start: Sequence[Number], slack: float
                       ) -> bool:
        """Whether the nutation stays on this side of it while rates are within their extremes and the angular
        momentum is that of the start: three exact rates."""
        low, high = self.cosines(extremes, start)
        limit = float(precise("cos", self.parts[0][1]))
        return high + slack < limit if self.falls else low - slack > limit

    def cosines(self, extremes: Iterable[Iterable[float]], start: Sequence[Number]) -> tuple[float, float]:
        """(least, greatest) cosine of the nutation while rates are within their extremes and the angular
        momentum is that of the start, not zero; the two are reached where the axis is a principal one."""
        ((_, vector),), _ = self.parts[0]
        law: Any = self.momentum
        H = law.of(start)
        ends = [sorted(float(a * d) * end if a else 0.0 for end in pair)
                for a, d, pair in zip(vector, law.D, extremes)]
        size = float(sqrt_fraction(dot(H, H)))
        low, high = ((float(dot(vector, law.wheel)) + sum(pair[n] for pair in ends)) / size for n in (0, 1))
        return low, high


def pointing_bound(begun: float, least: float, greatest: float) -> float:
    """The angle, rad, beyond which a body axis does not turn from its direction at the start, where it is at
    `begun` from a direction that stays in space, and between `least` and `greatest` from it at all times:
    the largest of min(begun + angle, 2 pi - begun - angle)."""
    if least <= math.pi - begun <= greatest:
        return math.pi
    return max(min(begun + angle, 2 * math.pi - begun - angle) for angle in (least, greatest))


@dataclass(frozen=True)
class Momentum:
    """H = D omega + lambda of a scene, and what moves inside: effects with a part, and places (name, first,
    end) of their blocks in the state. stays: whether no torque changes it."""

    D: Exact3
    wheel: Exact3
    inside: tuple[Any, ...] = ()
    places: tuple[tuple[str, int, int], ...] = ()
    stays: bool = True

    @classmethod
    def made(cls, scene: Any) -> Momentum:
        """Of a scene in SI."""
        parts, at = content(scene), slices(scene.blocks)
        outside = any(effect.takes == "outside" for effect in scene.effects) or (
            parts is None or any(parts.M) or parts.directed)
        inside = tuple(effect for effect in scene.effects if not set(effect.needs).isdisjoint(INSIDE))
        places = tuple((name, part.start, part.stop) for name, part in at.items() if name in INSIDE)
        return cls(scene.body.exact, scene.vector("gyrostat"), inside, places, not outside)

    def of(self, state: Sequence[Number]) -> Exact3:
        """H, exact; state: the rates, and the blocks behind them."""
        blocks = {name: tuple(map(Fraction, state[first:end])) for name, first, end in self.places}
        return self.components(tuple(map(Fraction, state[:3])), blocks)

    def components(self, omega: Any, blocks: Mapping[str, Any],
                   number: Callable[[Fraction], Any] = Fraction) -> Any:
        """H in the arithmetic of these rates, and blocks by name; number: what the numbers of the scene
        become."""
        H = [number(d) * w + number(l) for d, w, l in zip(self.D, omega, self.wheel)]
        added, _ = added_inside(self.inside, omega, blocks, number)
        return tuple(h + v for h, v in zip(H, added))


def along_axes(terms: Iterable[Any]) -> list[float] | None:
    """Three weights of the squares of the rates; None where a direction is not a principal axis."""
    weights = [0.0, 0.0, 0.0]
    for c, vector in terms:
        entries = [n for n, v in enumerate(vector) if v]
        if len(entries) != 1:
            return None
        weights[entries[0]] += float(c * vector[entries[0]] ** 2)
    return weights


def asked(scene: AnyScene, rate: Any = None, component: Any = None, energy: Any = None, tilt: Any = None,
          below: Any = None, nutation: Any = None, nutation_below: Any = None) -> Limit:
    """The one limit that is given; InputError for none, several, and for numbers that are none."""
    supplied = {name: value for name, value in (("rate", rate), ("component", component), ("energy", energy),
                                             ("tilt", tilt), ("below", below), ("nutation", nutation),
                                             ("nutation_below", nutation_below)) if value is not None}
    if len(supplied) != 1:
        raise InputError("time_to: expected one of rate, component, energy, tilt, below, nutation and "
                         f"nutation_below, got {', '.join(supplied) or 'none'}")
    (name, value), = supplied.items()
    kinds: dict[str, Callable[[AnyScene, Any], Limit]] = {
        "rate": _rate, "component": _component, "energy": _energy, "tilt": _tilt, "below": _below,
        "nutation": _nutation, "nutation_below": partial(_nutation, kind="nutation_below")}
    return kinds[name](scene, value)


def _rate(scene: AnyScene, value: Any) -> Limit:
    unit = _unit(scene)
    if hasattr(value, "__len__") and not isinstance(value, str):
        limits = exact_vector(value, "rate")
        parts = tuple((((Fraction(1), axis),), _positive(limit, "rate") ** 2)
                      for axis, limit in zip(AXES, limits))
        return Limit("component", parts,
                     "|components| " + ", ".join(f"{float(v):.10g}" for v in limits) + f" {unit}")
    largest = _positive(value, "rate")
    letter = "x" if scene.variables == "scaled" else "omega"
    return Limit("rate", ((tuple((Fraction(1), axis) for axis in AXES), largest**2),),
                 f"|{letter}| = {float(largest):.10g} {unit}".rstrip())


def _below(scene: AnyScene, value: Any) -> Limit:
    limit = _positive(value, "below")
    letter = "x" if scene.variables == "scaled" else "omega"
    return Limit("below", ((tuple((Fraction(1), axis) for axis in AXES), limit**2),),
                 f"|{letter}| below {float(limit):.10g} {_unit(scene)}".rstrip())


def _component(scene: AnyScene, value: Any) -> Limit:
    several = isinstance(value, list) and value and all(isinstance(item, tuple) for item in value)
    parts, text = [], []
    for axis, largest in (_pair(item, "component") for item in (value if several else [value])):
        vector, named = _direction(axis, "component")
        largest = _positive(largest, "component")
        parts.append((((Fraction(1), vector),), largest**2))
        text.append(f"|rate about {named}| = {float(largest):.10g} {_unit(scene)}".rstrip())
    return Limit("component", tuple(parts), " or ".join(text))


def _energy(scene: AnyScene, value: Any) -> Limit:
    if scene.variables == "scaled":
        raise InputError("energy: scaled variables know no kinetic energy: give a body")
    largest = _positive(value, "energy")
    return Limit("energy", ((tuple((d / 2, axis) for d, axis in zip(scene.body.exact, AXES)), largest),),
                 f"kinetic energy = {float(largest):.10g} J")


def _tilt(scene: AnyScene, value: Any) -> Limit:
    vector, named, angle = _angle_of_axis(scene, value, "tilt")
    return Limit("tilt", ((((Fraction(1), vector),), angle),), f"tilt of {named} = {float(angle):.10g} rad")


def _nutation(scene: AnyScene, value: Any, kind: str = "nutation") -> Limit:
    vector, named, angle = _angle_of_axis(scene, value, kind)
    sign = "below" if kind == "nutation_below" else "="
    return Limit(kind, ((((Fraction(1), vector),), angle),),
                 f"nutation of {named} {sign} {float(angle):.10g} rad", momentum=Momentum.made(scene))


def _angle_of_axis(scene: AnyScene, value: Any, name: str) -> tuple[Exact3, str, Fraction]:
    """(unit vector along the axis, its name, the angle) of an (axis, angle)."""
    if scene.variables == "scaled":
        raise InputError(f"{name}: scaled variables know no attitude: give a body")
    axis, angle = _pair(value, name)
    vector, named = _direction(axis, name)
    angle = _positive(angle, name)
    if not float(angle) < math.pi:
        raise InputError(f"{name}: expected an angle below half a turn (pi rad, 180 deg), got "
                         f"{float(angle):.10g} rad ({math.degrees(angle):.6g} deg)")
    return vector, named, angle


def _unit(scene: AnyScene) -> str:
    return "" if scene.variables == "scaled" else "rad/s"


def starts_above(limit: Limit, case: Any) -> None:
    """Raises InputError where |omega| or the nutation is to fall to a limit that the motion of a case starts
    below, and of a nutation without angular momentum."""
    start = (*(case.exact_state or case.state), *(case.start or ())[3:])
    if limit.momentum is not None and not any(limit.momentum.of(start)):
        raise InputError("state: the angular momentum is zero, so that there is no nutation: give a rate")
    if not limit.falls or not limit.reached_by(start):
        return
    if limit.momentum is not None:
        now, least = math.acos(max(-1.0, min(1.0, limit.cosine(start)))), float(limit.parts[0][1])
        raise InputError(f"state: the nutation is {math.degrees(now):.6g} deg at the start, which is not "
                         f"above {math.degrees(least):.6g} deg, the angle to fall below: give one that is "
                         "less than that of the start")
    in_words = lambda rate: (f"{rate:.6g}" if case.variables == "scaled"
                             else f"{rate:.6g} rad/s ({math.degrees(rate):.6g} deg/s)")
    size, rate = math.hypot(*map(float, start[:3])), limit.least_rate()
    raise InputError(f"state: the motion starts at {in_words(size)}, which is not above {in_words(rate)}, "
                     "the rate to fall below: give one that is less than that of the start")


def _pair(value: Any, name: str) -> tuple[Any, Any]:
    try:
        axis, largest = value
    except (TypeError, ValueError):
        raise InputError(f"{name}: expected (axis, limit), the axis 1, 2, 3 or three numbers along it, got "
                         f"{value!r:.80}") from None
    return axis, largest


def _direction(axis: Any, name: str) -> tuple[Exact3, str]:
    """(unit vector along it, its name)."""
    if isinstance(axis, (int, float, str)) and not isinstance(axis, bool):
        if axis in (1, 2, 3):
            return AXES[int(axis) - 1], f"axis {int(axis)}"
        raise InputError(f"{name}: expected the axis 1, 2 or 3 or three numbers along it, got {axis!r}")
    vector = exact_vector(axis, name)
    if not any(vector):
        raise InputError(f"{name}: expected a direction, got zero: give a vector of any length but that")
    unit = unit_vector(vector)
    return unit, f"({', '.join(f'{float(v):.6g}' for v in unit)})"


def _positive(value: float | Fraction, name: str) -> Fraction:
    try:
        number = exact(value)
    except InputError as error:
        raise InputError(f"{name}: {error}") from None
    if number <= 0:
        raise InputError(
            f"{name}: expected a positive limit, got {float(number):.10g}{SIGN if number < 0 else ''}")
    return number


# --- The first crossing of an enclosed motion
FIRST_BITS, MOST_BITS = 112, 720
KEPT = 58  # bits that the enclosure of the state is to keep
MARGIN = KEPT + 18  # beyond the growth of the error, for the rounding of a longer series
WORK = 30_000_000  # multiplications; two to four seconds
SHORT_WORK = 8_000_000  # likewise, where compiled steps go on: a second, as long as loading these takes
# after this part of the work a way that would take so many times what is left is given up
TRIED, HOPELESS = 16, 8
STEADY = 1.125  # steps that grow faster than this are those of the first search for a length
ENCLOSED_STEPS = 60_000  # validated ones; some two seconds


def enclosed(scene: AnyScene, start: Sequence[Number], limit: Limit, t_max: Fraction | None = None,
             work: int = WORK,
             earliest: Fraction = Fraction(0), later: Sequence[tuple[Fraction, AnyScene]] = ()) -> Crossing:
    """The first crossing of the motion of a plain scene from three rationals, proved; or until when there is
    none.

    t_max: None where only the work is to end the search. earliest: a time before which it is known not to
    happen: a way that would not come so far with the work is given up soon. later: times, in order, from
    which on another scene holds, of the same body and wheels. A first attempt, at few bits, is carried on
    beyond what its bits can prove, to learn how many it takes.
    """
    unit = max(exact_unit(item, start) for item in (scene, *(item for _, item in later)))
    switches = [(time * unit, item.quadratic()) for time, item in later]
    bits, best, spent = FIRST_BITS, Crossing(None, None, Fraction(0), False), 0
    while True:
        attempt = _Attempt(flow_of(scene, start, bits, unit, limit.direction), limit, unit, start, t_max,
                           earliest, switches)
        result = attempt.run(work - spent)
        spent += attempt.flow.work
        best = result if result.high is not None or result.until > best.until or result.done else best
        if best.high is not None or best.done or attempt.needs is None or spent > work:
            return best
        bits = max(attempt.needs, bits + KEPT)


def flow_of(scene: AnyScene, start: Sequence[Number], bits: int, unit: Fraction,
            direction: Exact3 | None = None) -> IntegerFlow:
    """The motion of a plain scene from three rationals; bits, unit, direction: as of IntegerFlow."""
    weights = (Fraction(1), Fraction(2), Fraction(1)) if scene.variables == "scaled" else scene.body.exact
    return IntegerFlow(scene.quadratic(), weights, start, bits, unit, direction)


class _Attempt:
    """One run at a number of bits. needs: the bits that a proof would have taken, where these were too few;
    None otherwise."""

    def __init__(self, flow: IntegerFlow, limit: Limit, unit: Fraction, start: Sequence[Number],
                 t_max: Fraction | None, earliest: Fraction,
                 switches: Sequence[tuple[Fraction, Any]]) -> None:
        self.flow, self.unit, self.switches = flow, unit, [*switches]
        self.needs: int | None = None
        self.end = None if t_max is None else t_max * unit
        self.earliest = (earliest if t_max is None else min(earliest, t_max)) * unit
        self.thresholds = limit.thresholds(unit, start)
        self.proved = [Search(threshold) for threshold in self.thresholds]

    def run(self, work: int) -> Crossing:
        """Proved as far as the bits reach, then on, unproved, to where a proof would end."""
        until, lost, flow = Fraction(0), 0, self.flow
        searches, proving, length = self.proved, True, math.inf
        while True:
            needs = lost + flow.error.bit_length() + MARGIN
            if flow.work * (1 if proving else 1 + (needs / flow.bits) ** 2) > work or needs > MOST_BITS:
                return self._answer(until, False)
            if proving and flow.error.bit_length() > flow.bits - KEPT:
                proving, searches = False, [Search(threshold, exactly=False) for threshold in self.thresholds]
            before = flow.work
            try:
                piece = flow.step(self.switches[0][0] if self.switches else None)
            except OverflowError:  # the error of one step is beyond doubles: what was proved before stays
                return self._answer(until, False)
            hit = [search.take(piece) for search in searches]
            now, shorter, length = flow.now, length, float(piece.length)
            if self.switches and now == self.switches[0][0]:
                flow.turn_on(self.switches.pop(0)[1])
            if (flow.work * TRIED > work and length < STEADY * shorter and (self.earliest - piece.start)
                    * (flow.work - before) > HOPELESS * (work - flow.work) * piece.length):
                return self._answer(until, False)  # steps like this one would take much more than is left
            if proving:
                until = now
            elif (excess := flow.error.bit_length() - flow.bits) > 0:
                flow.forget(excess)
                lost += excess
            ended = self.end is not None and now >= self.end
            if any(hit) or ended:
                if proving:
                    return self._answer(until, ended)
                self.needs = needs + 1
                return self._answer(until, False)

    def _answer(self, until: Fraction, done: bool) -> Crossing:
        result = Crossing.of(self.proved, until, done)
        low, high = result.low, result.high
        if self.end is not None and low is not None and low > self.end:
            low = high = None
        scale = lambda t: None if t is None else t / self.unit
        until = min(until, self.end) if done and self.end is not None else until
        return Crossing(scale(low), scale(high), until / self.unit, done)


def banded(scene: AnyScene, start: Sequence[Number], limit: Limit, t_max: float,
           steps: int = ENCLOSED_STEPS) -> Crossing | None:
    """The first crossing of the motion from three rationals by compiled steps; None where numba is not there
    to compile them."""
    if not installed():
        return None
    unit = exact_unit(scene, start)
    return first_crossing(scene, start, limit.thresholds(unit, start), unit, limit.direction, t_max, steps)
