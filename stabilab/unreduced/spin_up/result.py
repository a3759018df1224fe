"""What is known of spin-up from one state, and what a certificate says of all later times: bounds of the
rates for ever, and when the spin reaches a limit, from both sides.
"""
from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from ...orbit.result import Fate
from ...reasons import Reasoned
from ...representation import Answer

WIDER = 1e-12  # relative widening of what is told: the rounding of these few lines


@dataclass(frozen=True)
class Trap:
    """The constants of the theorem (`certificate`) for one motion.

    field: the form, in the motion's own units; form: its name; orders: of energy and amplitude; A, z, eta,
    z_up, eta_up, k: of the theorem in these units; unit: one of them in rad/s (or scaled rates; exact, a
    power of two); t: time of the state that the inequality held for, off by `blur` at most (a certified
    motion may be that much early or late: the rounding of its run).
    """

    field: Any
    form: str
    orders: tuple[int, int]
    A: float
    z: float
    eta: float
    z_up: float
    eta_up: float
    k: float
    unit: float
    t: float
    blur: float = 0.0

    def bounds(self):
        """((low, high),) * 3 of the rates about the body's principal axes at all times from `t` on; the
        spin's far end is infinite.

        For spin-up in the equator, along no principal axis, only the rate about the axis of symmetry is
        bounded: the transverse rate in the equator may grow like the fourth root of the spin.
        """
        low, (second, third) = self.z - self._shift, self.field.transverse(self.A, self.z)
        out = [(-math.inf, math.inf)] * 3
        for row, (a, b) in zip(self.field.basis, ((low, math.inf), second, third)):
            entries = [n for n in range(3) if abs(row[n]) == 1]
            if entries:
                a, b = (a, b) if row[entries[0]] > 0 else (-b, -a)
                out[entries[0]] = (_down(a * self.unit), -_down(-b * self.unit))
        return tuple(out)

    def line(self, t: float) -> tuple[float, float]:
        """(least, greatest) spin about its axis, in its sense, at a time t >= self.t."""
        lower, upper = ((t - self.t + early) * self.unit / self.field.D1 for early in (-self.blur, self.blur))
        return (_down((self.z - self._shift + self.eta * max(0.0, lower)) * self.unit),
                -_down(-(self.z_up - self._shift + self.eta_up * upper) * self.unit))

    def clock(self, rate: float) -> tuple[float, float]:
        """(earliest, latest) time at which the spin about its axis, in its sense, first reaches `rate`; t
        counts from the start.

        A rate that the spin may have had before `t` gives (0, ...).
        """
        x = rate / self.unit + self._shift
        D1, (early, late) = self.field.D1, self._passing(x)
        early = max(0.0, self.t - self.blur + max(0.0, D1 * early) / self.unit) if x > self.z_up else 0.0
        late = self.t + self.blur + max(0.0, D1 * late) / self.unit
        return early * (1 - WIDER), late * (1 + WIDER)

    def _passing(self, x: float):
        """(earliest, latest) time to x over D1: D1 y' is within M1 + less/(y + S), M1 + more/(y + S), as what
        is beside M1 falls at least like 1/(y + S), S the field's `least_fall`."""
        M1, S, early, late = self.field.M1, self.field.least_fall, x - self.z_up, x - self.z
        if S is None:  # in the equator: the two lines
            return early / self.eta_up, late / self.eta
        if self.field.sharp:  # the drive's own m* counts on both sides, with its sign
            left = self.k * self.z * (1 + 1e-9)
            less, more = self.field.form.drag - left, self.field.form.drag + left
        else:
            less, more = ((1 + 1e-8) * c * (self.z + S) for c in (self.eta - M1, self.eta_up - M1))
        early -= _delay(more, M1, self.z_up + S, early) if early > 0 else 0.0
        late -= _delay(less, M1, self.z + S, late) if late > 0 else 0.0
        return early / M1, late / M1

    @property
    def _shift(self):
        return self.field.form.shift if self.field.sharp else 0.0


@dataclass(frozen=True)
class SteadyTrap:
    """The trap of a body of revolution without a transverse wheel: the spin about its axis is linear in time,
    exactly.

    start: the spin along `sense` at t = 0; gain: its rate; bounded: ((low, high),) * 3 for ever. unit as in
    `Trap`.
    """

    axis: int
    sense: int
    start: float
    gain: float
    bounded: tuple
    form: str = "axis of symmetry"
    t: float = 0.0

    def bounds(self):
        """((low, high),) * 3 of the rates at all times."""
        return self.bounded

    def line(self, t: float) -> tuple[float, float]:
        """(least, greatest) spin along its sense at time t: equal but for rounding."""
        value = self.start + self.gain * t
        blur = WIDER * (abs(self.start) + abs(self.gain * t))
        return value - blur, value + blur

    def clock(self, rate: float) -> tuple[float, float]:
        """(earliest, latest) time at which the spin reaches `rate`."""
        blur = WIDER * (abs(rate) + abs(self.start)) / self.gain
        t = (rate - self.start) / self.gain
        return max(0.0, t - blur), max(0.0, t + blur)


@dataclass(frozen=True, repr=False)
class SpinUp(Answer, Reasoned):
    """The fate of one motion as far as spin-up decides it.

    fate: SPIN_UP, BOUNDED (exact cases alone) or UNDECIDED. axis: 1, 2, 3 of the body, 0 where it is none;
    sense: +1 or -1 about it, 0 where undecided; direction: unit vector in principal axes along which the rate
    grows, None where undecided. level: "exact" (by a closed solution), "certified" (the theorem's inequality
    holds for the state at time t of a run in machine precision and for a ball about it that holds the run's
    rounding), "proved" (the way to the inequality is enclosed, `unreduced.enclosure`; t is exact, state the
    middle of what holds it) or "undecided". trap: bounds and clocks. t: when it fired, or how long the motion
    was followed; state there; steps. reason: what was seen, of
    which `cause` has the words in SI units. condition: growth of a small change of the start, across
    the motion, on the way to t. passed: steps that the way to t takes one by one; steps are those computed,
    fewer where a slow drift is run over many revolutions at once (`drift`).
    """

    fate: Fate
    axis: int
    sense: int
    direction: tuple | None
    level: str
    trap: Trap | SteadyTrap | None
    t: float
    state: tuple
    steps: int
    condition: float
    passed: float = 0.0

    @property
    def cause(self) -> str:
        """What was seen, in words and SI units."""
        return self.because


def _delay(c: float, M1: float, start: float, rise: float):
    """What c/y in D1 y' = M1 + c/y takes off the rise over M1/D1: (c/M1) ln of how M1 y + c grows. It is
    positive from the start on: eta of the theorem is."""
    return c / M1 * math.log1p(rise / (start + c / M1))


def _down(value: float) -> float:
    return value - WIDER * abs(value)
