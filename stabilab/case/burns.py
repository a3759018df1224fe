"""Burns: when a thruster of a case file fires, as `start`, `stop`, pulses (`period` with `duty` or `on_time`)
and `propellant` with its `mass_flow` say it; exact times."""
from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import NamedTuple

from .table import Table

KEYS = ("start", "stop", "period", "duty", "on_time", "propellant", "mass_flow")
MOST = 10_000  # pulses: each is a run of its own
ONLY = ("this thruster fires on a schedule, and this question takes a torque that never changes: ask "
        "`stabilab burn` (stabilab.burn), or take away its keys {} and write stuck = true for one that fires "
        "for ever")


@dataclass(frozen=True)
class Burn:
    """start, stop: s, from the time of the motion's start; stop None: none is given. period, on: s, of
    pulses, each `on` long; None: it fires without a pause. propellant: kg, None: without end; mass_flow:
    kg/s while it fires, or None."""

    start: Fraction
    stop: Fraction | None
    period: Fraction | None
    on: Fraction | None
    propellant: Fraction | None
    mass_flow: Fraction | None

    @property
    def endless(self) -> bool:
        """Whether nothing in the file ends it."""
        return self.stop is None and self.propellant is None

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
    """From `begin` to `end`, s, the thrusters of these indices fire and no other."""

    begin: Fraction
    end: Fraction
    firing: tuple[int, ...]


def segments(burns: Sequence[Burn | None], until: Fraction | None = None) -> list[Segment]:
    """From time 0 to the last closing: which of the thrusters fire, between exact switching times. A thruster
    without a burn is None."""
    windows = [(*window, n) for n, one in enumerate(burns) if one for window in one.windows(until)]
    switches = sorted({Fraction(0), *(t for opens, closes, _ in windows for t in (opens, closes))})
    firing: dict[Fraction, set[int]] = {t: set() for t in switches}
    opening = sorted(windows)
    active: list[tuple[Fraction, Fraction, int]] = []
    for t in switches:
        while opening and opening[0][0] <= t:
            active.append(opening.pop(0))
        active = [one for one in active if one[1] > t]
        firing[t] = {n for _, _, n in active}
    return [Segment(a, b, tuple(sorted(firing[a]))) for a, b in zip(switches, switches[1:])]


def burn_of(table: Table) -> Burn | None:
    """The burn of a table [[thrusters]]; None where it has none, or a fault."""
    given = [key for key in KEYS if key in table]
    if not given:
        return None
    before = len(table.faults.problems)
    start = table.positive("start", zero=True)
    start = Fraction(0) if start is None else start
    stop = table.positive("stop", zero=True)
    if stop is not None and stop <= start:
        table.fault(f"the burn stops at {float(stop):.6g} s and starts at {float(start):.6g} s: give a stop "
                    f"after the start", "stop")
    period, on = _pulses(table)
    flow, mass = table.positive("mass_flow"), table.positive("propellant")
    if "propellant" in table and "mass_flow" not in table:
        table.fault('propellant without a mass flow says nothing of when it is used up: add mass_flow, such '
                    'as "0.5 g/s"', "propellant")
    if "stuck" in table and table.data["stuck"] is True:
        table.fault("a stuck thruster fires for ever: take away stuck, or the schedule "
                    f"({', '.join(given)})", "stuck")
    if len(table.faults.problems) > before:
        return None
    burn = Burn(start, stop, period, on, mass, flow)
    if burn.pulses() > MOST:
        table.fault(f"{float(burn.pulses()):.6g} pulses are more than the {MOST} that are followed one by "
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
