"""The tables of a case file that few cases have: attitude, circular orbit, burns.

Attitude at t = 0: its angles and its vertical must agree.

[circular_orbit]: the orbit of a satellite, by its rate, its period, or its height or radius about the
Earth.

Burns: when a thruster of a case file fires, as `start`, `stop`, pulses (`period` with `duty` or `on_time`),
`profile` and `propellant` with its `mass_flow` say it; exact times."""
from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import NamedTuple

from ..numbers.units import pi
from ..numbers.vectors import Float3
from ..physics.effects.base import Effect
from ..physics.scene import AnyScene, ordered
from .table import Table, described

# --- The attitude at t = 0
SLACK = 1e-6  # of a component: a direction given to six decimals is consistent


def vertical_of(psi: float, phi: float, theta: float = 0.0) -> Float3:
    """Inertial axis 3 in the body frame at 3-1-2 angles, rad: the third row of R = Rz(theta) Rx(psi) Ry(phi).
    """
    return (-math.cos(psi) * math.sin(phi), math.sin(psi), math.cos(psi) * math.cos(phi))


def attitude_of(vertical) -> Float3:
    """The angles psi, phi, theta = 0 at which inertial axis 3 is `vertical`, a unit vector, body frame."""
    x, y, z = vertical
    return math.atan2(y, math.hypot(x, z)), math.atan2(-x, z), 0.0


def judge_attitude(table: Table, supplied: Mapping[str, Float3], scene: AnyScene | None):
    """Note a vertical and an attitude of [motion] that contradict each other. supplied: the blocks that the
    file gives; the zero angles that an attitude starts at where the file gives none count too."""
    needed = ordered((*getattr(scene, "blocks", ()), *supplied))
    if "gamma" not in supplied or "attitude" not in needed:
        return
    angles, vertical = supplied.get("attitude", (0.0, 0.0, 0.0)), supplied["gamma"]
    if math.dist(vertical_of(*angles), vertical) <= SLACK:
        return
    if "attitude" not in supplied:
        table.fault(f"attitude is missing: zero angles have the vertical [0, 0, 1], not "
                    f"{_written(vertical)}; with theta = 0 that is "
                    f"attitude = {_written(attitude_of(vertical))}", "vertical")
        return
    table.fault(f"contradicts attitude: the angles {_written(angles)} have the vertical "
                f"{_written(vertical_of(*angles))} (inertial axis 3, "
                f"body frame), got {_written(vertical)}; leave one of them as it is and make the other agree",
                "vertical")


def _written(vector) -> str:
    return f"[{', '.join(f'{v + 0.0:.10g}' for v in vector)}]"


# --- [circular_orbit]
ORBIT_KEYS = ("rate", "period", "altitude", "radius")
ATTRACTION = Fraction(398600441800000)  # of the Earth, m^3/s^2 (IERS Conventions 2010, in round numbers)
EARTH = Fraction(6378137)  # its equatorial radius, m (WGS 84)
ORBIT_ONLY = ("a satellite on a circular orbit, and this question takes a body without gravity gradient: ask "
        "`stabilab orbit` (stabilab.circular_orbit), or take away [circular_orbit]")
NONE = ('expected a table [circular_orbit] with rate, period, altitude or radius, such as '
        'altitude = "700 km"')
WHEELS = ("on a circular orbit only wheels are known beside the gravity gradient: take it away, or "
          "take away [circular_orbit]")


def judge_orbit(top: Table, effects: Iterable[Effect], orbiting: bool):
    """Note an orbit where the question knows none; where it asks for one, what acts beside it, or, of a file
    without another fault, that there is none."""
    if not orbiting:
        if "circular_orbit" in top:
            top.fault(ORBIT_ONLY, "circular_orbit")
        return
    if "circular_orbit" not in top:
        if not top.faults.problems:
            top.fault(NONE)
    elif (table := top.table("circular_orbit")) is not None:
        rate_squared(table)
    for key in ("scaled", "sweep"):
        if key in top:
            top.fault(f"a circular orbit takes one body in SI units: take away [{key}]", key)
    for effect in effects:
        if effect.name != "gyrostat":
            supplied = effect.name in top.data.get("effects", {})
            top.fault(WHEELS, *(("effects", effect.name) if supplied else ("thrusters",)))


def rate_squared(table: Table) -> Fraction | None:
    """n^2, 1/s^2, of a circular orbit; None where it is at fault."""
    table.known(ORBIT_KEYS)
    key = table.one_of(*ORBIT_KEYS)
    if key is None:
        if not any(item in table for item in ORBIT_KEYS):
            table.fault(NONE.replace("a table [circular_orbit] with", "one of"))
        return None
    value = table.number(key)
    if value is None:
        return None
    smallest = EARTH if key == "radius" else Fraction(0)
    if value <= smallest:
        cures = {"rate": 'the angular velocity of the orbit is positive, such as rate = "0.06 deg/s"',
                 "period": 'a revolution takes a positive time, such as period = "98 min"',
                 "altitude": 'the height above the equatorial radius of the Earth is positive, such as '
                             'altitude = "700 km"',
                 "radius": 'the distance from the centre of the Earth exceeds its equatorial radius, '
                           '6378.137 km; about another body give the rate or the period'}
        table.fault(f"got {float(value):.10g}: {cures[key]}", key)
        return None
    if key == "rate":
        return value**2
    return ((2 * pi() / value)**2 if key == "period"
            else ATTRACTION / (value + (EARTH if key == "altitude" else 0))**3)


# --- Burns
BURN_KEYS = ("start", "stop", "period", "duty", "on_time", "propellant", "mass_flow",
             "profile")
PULSES = 10_000  # pulses: each is a run of its own
BURN_ONLY = ("this thruster fires on a schedule, and this question takes a torque that never changes: ask "
        "`stabilab burn` (stabilab.burn), or take away its keys {} and write stuck = true for one that fires "
        "for ever")


@dataclass(frozen=True)
class Burn:
    """start, stop: s, from the time of the motion's start; stop None: none is given. period, on: s, of
    pulses, each `on` long; None: it fires without a pause. propellant: kg, None: without end; mass_flow:
    kg/s while it fires with its full force, or None. profile: (s from `start`, share of the force from then
    on), in order of time, () for the full force."""

    start: Fraction
    stop: Fraction | None
    period: Fraction | None
    on: Fraction | None
    propellant: Fraction | None
    mass_flow: Fraction | None
    profile: tuple[tuple[Fraction, Fraction], ...] = ()

    @property
    def endless(self) -> bool:
        """Whether nothing in the file ends it."""
        off = bool(self.profile) and not self.profile[-1][1]
        return self.stop is None and self.propellant is None and not off

    def steps(self, until: Fraction | None = None) -> Iterator[tuple[Fraction, Fraction, Fraction]]:
        """(from, to, share of the force) while it fires, s, in order; until: as of `windows`."""
        if not self.profile:
            yield from ((opens, closes, Fraction(1)) for opens, closes in self.windows(until))
            return
        end = min((t for t in (self.stop, until) if t is not None), default=None)
        left = None if self.propellant is None or not self.mass_flow else self.propellant / self.mass_flow
        after = [begin for begin, _ in self.profile[1:]]
        for (begin, level), following in zip(self.profile, [*after, None]):
            opens = self.start + begin
            ends = [end, None if following is None else self.start + following,
                    None if left is None or not level else opens + left / level]
            closes = min((t for t in ends if t is not None), default=None)
            if not level:
                continue
            if closes is None or closes <= opens:  # closed, used up, or a burn without end that needs `until`
                return
            yield opens, closes, level
            left = None if left is None else left - level * (closes - opens)

    def windows(self, until: Fraction | None = None) -> Iterator[tuple[Fraction, Fraction]]:
        """(opens, closes) of each pulse, s, in order; until: it is closed then. A burn without end needs it.
        """
        end = min((t for t in (self.stop, until) if t is not None), default=None)
        left = None if self.propellant is None or not self.mass_flow else self.propellant / self.mass_flow
        opens = self.start
        while (end is None or opens < end) and (left is None or left > 0):
            closes = min(t for t in (end, self.on and opens + self.on, None if left is None else opens + left)
                         if t is not None)
            yield opens, closes
            if self.period is None:
                return
            left = None if left is None else left - (closes - opens)
            opens += self.period

    def pulses(self) -> Fraction:
        """How many pulses it has at the most, of one that ends."""
        if self.period is None or self.on is None or self.endless:
            return Fraction(1)
        by_stop = None if self.stop is None else (self.stop - self.start) / self.period
        by_mass = (None if self.propellant is None or not self.mass_flow
                   else self.propellant / self.mass_flow / self.on)
        return min(n for n in (by_stop, by_mass) if n is not None)


class Segment(NamedTuple):
    """From `begin` to `end`, s, the thrusters of these indices fire, with these shares of their forces, and
    no other."""

    begin: Fraction
    end: Fraction
    firing: tuple[int, ...]
    levels: tuple[Fraction, ...]


def segments(burns: Sequence[Burn | None], until: Fraction | None = None) -> list[Segment]:
    """From time 0 to the last closing: which of the thrusters fire, between exact switching times. A thruster
    without a burn is None."""
    steps = [(opens, closes, n, level) for n, burn in enumerate(burns) if burn
             for opens, closes, level in burn.steps(until)]
    switches = sorted({Fraction(0), *(t for opens, closes, *_ in steps for t in (opens, closes))})
    firing: dict[Fraction, dict[int, Fraction]] = {t: {} for t in switches}
    opening = sorted(steps)
    active: list[tuple[Fraction, Fraction, int, Fraction]] = []
    for t in switches:
        while opening and opening[0][0] <= t:
            active.append(opening.pop(0))
        active = [item for item in active if item[1] > t]
        firing[t] = {n: level for _, _, n, level in sorted(active, key=lambda item: item[2])}
    return [Segment(a, b, tuple(firing[a]), tuple(firing[a].values()))
            for a, b in zip(switches, switches[1:])]


def burn_of(table: Table) -> Burn | None:
    """The burn of a table [[thrusters]]; None where it has none, or a fault."""
    supplied = [key for key in BURN_KEYS if key in table]
    if not supplied:
        return None
    before = len(table.faults.problems)
    start = table.positive("start", zero=True)
    start = Fraction(0) if start is None else start
    stop = table.positive("stop", zero=True)
    if stop is not None and stop <= start:
        table.fault(f"the burn stops at {float(stop):.6g} s and starts at {float(start):.6g} s: give a stop "
                    f"after the start", "stop")
    period, on = _pulses(table)
    profile = _profile(table)
    flow, mass = table.positive("mass_flow"), table.positive("propellant")
    if "propellant" in table and "mass_flow" not in table:
        table.fault('propellant without a mass flow says nothing of when it is used up: add mass_flow, such '
                    'as "0.5 g/s"', "propellant")
    if "stuck" in table and table.data["stuck"] is True:
        table.fault("a stuck thruster fires for ever: take away stuck, or the schedule "
                    f"({', '.join(supplied)})", "stuck")
    if len(table.faults.problems) > before:
        return None
    burn = Burn(start, stop, period, on, mass, flow, profile)
    if burn.pulses() > PULSES:
        table.fault(f"{float(burn.pulses()):.6g} pulses are more than the {PULSES} that are followed one by "
                    f"one: give a longer period, or the mean force without pulses", "period")
    return burn


def _pulses(table: Table) -> tuple[Fraction | None, Fraction | None]:
    """(period, on), s; (None, None) of a burn without pulses."""
    key = table.one_of("duty", "on_time")
    period = table.positive("period")
    if key is None:
        if "period" in table and "duty" not in table:
            table.fault("a period without its share of firing: add duty (above 0, at most 1) or on_time",
                        "period")
        return None, None
    if "period" not in table:
        table.fault(f'{key} without a period: add period, such as "2 s"', key)
        return None, None
    value = table.number("duty") if key == "duty" else table.positive("on_time")
    if value is None or period is None:
        return None, None
    on = value * period if key == "duty" else value
    if not 0 < on <= period:
        table.fault(f"expected a share above 0 and at most 1, got {float(value):.6g}" if key == "duty" else
                    f"expected at most the period, {float(period):.6g} s, got {float(value):.6g} s", key)
        return None, None
    return (None, None) if on == period else (period, on)


def _profile(table: Table) -> tuple[tuple[Fraction, Fraction], ...]:
    """The levels of `profile`, each with the time from which it holds, s; () without one, and where it is at
    fault."""
    if "profile" not in table:
        return ()
    rows = table.data["profile"]
    if (not isinstance(rows, list) or not rows
            or not all(isinstance(row, list) and len(row) == 2 for row in rows)):
        table.fault("expected pairs of a time and the share of the force from then on, such as "
                    f'[["0 s", 1], ["2 s", 0.4], ["5 s", 0]], got {described(rows)}', "profile")
        return ()
    before = len(table.faults.problems)
    if len(rows) > PULSES:
        table.fault(f"{len(rows)} levels are more than the {PULSES} that are followed one by one", "profile")
    pulses = [key for key in ("period", "duty", "on_time") if key in table]
    if pulses:
        table.fault(f"a profile says when it fires by itself: take away {', '.join(pulses)}", "profile")
    times = [table.entry("profile", n, 0) for n in range(len(rows))]
    levels = [table.entry("profile", n, 1, share=True) for n in range(len(rows))]
    result: list[tuple[Fraction, Fraction]] = []
    for n, (time, level) in enumerate(zip(times, levels), 1):
        if time is None or level is None:
            continue
        if n == 1 and time:
            table.fault(f"row 1: times count from the opening: expected 0, got {float(time):.6g} s; give the "
                        "opening as start", "profile")
        if result and time <= result[-1][0]:
            table.fault(f"row {n}: expected a time after {float(result[-1][0]):.6g} s, got "
                        f"{float(time):.6g} s", "profile")
        if not 0 <= level <= 1:
            table.fault(f"row {n}: expected a share of the force from 0 to 1, got {float(level):.6g}; give "
                        "the largest force as force", "profile")
        if not result or result[-1][1] != level:
            result.append((time, level))
    if len(table.faults.problems) == before and not any(level for _, level in result):
        table.fault("every level is 0, so that it never fires: give one above, or take the thruster away",
                    "profile")
    return tuple(result)
