"""A motion enclosed step by step, and a spin-up proved along it.

One motion under a constant torque of any direction, enclosed from an exact start: a set at each time, a
band between them.

The steps are those of `kernel` (compiled) or of `digits` (python-flint, as many bits as are asked for, no
compiler). Scenes are taken at their exact numbers. Those of a frame of principal axes that is irrational have
an error of 2^-240 (`numbers.principal`): each step allows the coefficients FINE = 2^-92 of themselves.

A certified spin-up proved: the way from an exact start to the inequality enclosed, and the inequality for
every state of the set there.

The theorem's inequality (`spin_up.certificate`) is tested for the ball that holds the enclosure at the time
when it fired. Its test is one in doubles, whose rounding is bounded beforehand: forms are exact before the
one root, each coefficient comes with a bound of its rounding (`spin_up.centres`), the place of the ball
is taken at its worse ends, and every comparison leaves room for the rest. So nothing in the answer rests on a
run that was not enclosed.
"""
from __future__ import annotations

import math
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any

import numpy as np

from ...errors import InputError
from ...numbers.exact import exact_vector
from ...numbers.numba_door import installed
from ...physics.coefficients import effective
from ...validation import checked_scene
from ..spin_up.certificate import natural, tests_of
from ..spin_up.result import SpinUp, Trap
from . import kernel
from .digits import DigitSteps, advance, energy_of, loaded, rows_of, twofold

# at most, unless others are asked for: compiled some three seconds, else some ten
STEPS, SLOW_STEPS = 200_000, 2_000
CHUNK = 512  # steps kept at a time between which the band is asked for
TOLERANCE = 2.0**-88  # of a step's tail, beside the state: as small as the rounding of its coefficients
BITS = 104  # of the compiled steps
WHY = {kernel.DONE: "enclosed", kernel.GOING: "not finished: the steps allowed were used up",
       kernel.LOST: "lost: the set has grown too wide to follow",
       kernel.ENDLESS: "lost: a step would be below the grain of time"}


@dataclass(frozen=True)
class Band:
    """Where the motion surely is during each of n steps.

    times: (n + 1,) ends, exact doubles; polynomials: (n, 3, N + 1) rates as polynomials in x = (t -
    times[i])/(times[i + 1] - times[i]), lowest first; radii: (n, 3): at every time of step i each rate is
    within radii[i] of its polynomial, however exactly that is evaluated.
    """

    times: np.ndarray
    polynomials: np.ndarray
    radii: np.ndarray

    def form(self, weights) -> tuple[np.ndarray, np.ndarray]:
        """((n, 2 N + 1) polynomials, (n,) radii) of the sum of weights_i omega_i^2 (three numbers, not
        negative) during each step: ones for |omega|^2, halves of the moments for the energy."""
        weights = [float(w) for w in weights]
        n, _, m = self.polynomials.shape
        out, radius, size = np.zeros((n, 2 * m - 1)), np.zeros(n), np.abs(self.polynomials).sum(axis=2)
        for i, w in enumerate(weights):
            row = self.polynomials[:, i]
            for k in range(m):
                out[:, k:k + m] += w * row * row[:, k:k + 1]
            r = self.radii[:, i]
            # N + 1 products and three sums to a coefficient, and the weight's rounding
            radius += w * (r * (2 * size[:, i] + r) + 2.0**-44 * size[:, i] ** 2)
        return out, radius * (1 + 2.0**-30)

    def at(self, t: float) -> tuple[np.ndarray, np.ndarray]:
        """((3,) middle, (3,) radius) of the rates at a time in the band."""
        i = min(max(int(np.searchsorted(self.times, t, "right")) - 1, 0), len(self.radii) - 1)
        if not self.times[0] <= t <= self.times[-1]:
            raise InputError(f"t: expected a time from {self.times[0]!r} to {self.times[-1]!r}, got {t!r}")
        begin, end = self.times[i], self.times[i + 1]
        x = (t - begin) / (end - begin)
        rows = self.polynomials[i]
        value = np.zeros(3)
        for column in rows.T[::-1]:
            value = value * x + column
        # x is off by less than four roundings, of t - begin (t is any double) and of the quotient
        size = np.abs(rows) @ np.arange(1, rows.shape[1] + 1)
        return value, (self.radii[i] + 2.0**-46 * size) * (1 + 2.0**-30)


@dataclass(frozen=True)
class Enclosed:
    """The set that surely holds the state at one time.

    t: exact, the scene's unit of time; middle: (3,) rates (rad/s, or x when scaled); rest: (3,), to be added
    to them: the centre is a sum of two doubles; radius: (3,) each true rate is within it of the centre.
    steps: so many; status: "enclosed" where t is the time asked for, else "stopped", and reason says why;
    bits: of the centre.
    """

    t: float
    middle: np.ndarray
    rest: np.ndarray
    radius: np.ndarray
    steps: int
    status: str
    reason: str
    bits: int

    @property
    def box(self):
        """((low, high),) * 3 in exact fractions."""
        ends = []
        for m, r, e in zip(self.middle.tolist(), self.rest.tolist(), self.radius.tolist()):
            ends.append((Fraction(m) + Fraction(r) - Fraction(e), Fraction(m) + Fraction(r) + Fraction(e)))
        return tuple(ends)


class Course:
    """A motion followed by validated steps: `advance` carries it on, `now` tells where it is.

    scene: gyrostat and constant torque, physical or scaled; state: three rates at t = 0, each an exact number
    (a double at its word, a Fraction, a decimal in a string). t_end: the end of what will be asked for; its
    last binary digit is the grain of time, and every step ends at a whole number of grains, so that times are
    exact. bits: None for the compiled steps (104 bits, `digits` where numba is not installed), else of
    python-flint's. plain: so many first ones of the compiled steps are taken by the interpreter unless the
    compiled code is loaded, to the same bits (powers are those of one library): a motion may be at its end
    before that is.
    """

    def __init__(self, scene, state, t_end: float, bits: int | None = None, plain: int = 0):
        scene = effective(checked_scene(scene))
        scene.quadratic()  # says which effect of the scene is not covered
        start = exact_vector(state, "state")
        if not (math.isfinite(t_end) and t_end > 0):
            raise InputError(f"t: expected a time above 0, got {t_end!r}")
        own, self.unit = natural(scene)
        self.t, self.steps, self.status = 0.0, 0, kernel.GOING
        self._end = t_end * self.unit
        self._grain = math.ulp(self._end)
        self._work = (Doubles(own, start, self.unit, plain) if bits is None and installed()
                      else DigitSteps(own, start, self.unit, bits or 128))

    def advance(self, t: float, steps: int | None = None, band: bool = False) -> Band | None:
        """Carry the motion on to the time t (taken down to the grain of time), by at most so many steps, at
        most CHUNK where the band is asked for.

        steps: None for as many as take some seconds, those made already counted. Returns the band where it is
        asked for and a step was made."""
        t = min(t * self.unit, self._end)
        t = float(int(t / self._grain)) * self._grain
        steps = max(0, allowed(self.bits) - self.steps) if steps is None else steps
        size = min(steps, CHUNK) if band else 0
        times, polynomials, radii = np.empty(size), np.empty((size, 3, kernel.ORDER + 1)), np.empty((size, 3))
        begun = self.t * self.unit
        self.status, now, made = self._work.advance(begun, t, self._grain, size or steps, times, polynomials,
                                                    radii)
        self.t, self.steps = now / self.unit, self.steps + made
        if not (band and made):
            return None
        return Band(np.append(begun, times[:made]) / self.unit, polynomials[:made] * self.unit,
                    radii[:made] * self.unit)

    @property
    def now(self) -> Enclosed:
        """Where the motion is."""
        middle, rest, radius = self._work.box()
        status = "enclosed" if self.status == kernel.DONE else "stopped"
        return Enclosed(self.t, middle * self.unit, rest * self.unit, radius * self.unit, self.steps, status,
                        WHY[self.status], self.bits)

    @property
    def bits(self) -> int:
        """Of the centre."""
        return self._work.bits


def allowed(bits: int) -> int:
    """How many steps take some seconds, with a centre of so many bits."""
    return STEPS if bits == BITS else SLOW_STEPS


class Doubles:
    """The set of the compiled steps, in a scene's natural unit."""

    bits = BITS

    def __init__(self, own, start, unit, plain: int = 0):
        self.numbers, self.low = twofold(rows_of(own))
        self.centre, self.low_centre = twofold([v / Fraction(unit) for v in start])
        self.energy = energy_of(own)
        self.B, self.rad, self.plain = np.eye(3), np.abs(self.centre) * 2.0**-104 + kernel.TINY, plain

    def advance(self, t, t_end, grain, steps, times, polynomials, radii):
        made = 0
        if self.plain and not loaded():
            first = min(steps, self.plain)
            kept = [v.copy() for v in (self.centre, self.low_centre, self.B, self.rad)]
            try:
                status, t, made = self._advance(_plainly, t, t_end, grain, first, times[:first],
                                                polynomials[:first], radii[:first])
            except (ArithmeticError,
                    ValueError):  # what is no number has no whole part here; compiled code goes on
                self.centre, self.low_centre, self.B, self.rad = kept
                self.plain = 0
            else:
                self.plain -= made
                if status != kernel.GOING or made == steps:
                    return status, t, made
        status, t, more = self._advance(advance(), t, t_end, grain, steps - made, times[made:],
                                        polynomials[made:], radii[made:])
        return status, t, made + more

    def _advance(self, by, t, t_end, grain, steps, times, polynomials, radii):
        return by(self.numbers, self.low, self.energy, TOLERANCE, t, t_end, grain, steps, self.centre,
                  self.low_centre, self.B, self.rad,
                  times, polynomials, radii)

    def box(self):
        return self.centre.copy(), self.low_centre.copy(), np.abs(self.B) @ self.rad * kernel.WIDER


def _plainly(*arguments):
    """`kernel.advance` as it is written."""
    with np.errstate(all="ignore"):  # as compiled code
        return kernel.advance(*arguments)


TRIED, HOPELESS = 512, 16  # steps after which a way that would take so many times what is allowed is given up
# times, over that of the certified run, at which the inequality is asked again
LATER = (1.0, 1.0625, 1.25, 1.5, 2.0)
WIDER = 1 + 2.0**-40


def proved(scene, state, found: SpinUp, steps: int | None = None, bits: int | None = None, fast: bool = False,
           plain: int = 0) -> SpinUp:
    """The answer of `spin_up` for the motion from a state (three exact numbers: floats at their word,
    Fractions, decimals in strings), with level "proved" where its way can be enclosed in so many validated
    steps and the inequality holds for the whole set there; else as it was found, its cause told what
    hindered. bits, plain: as of `Course`. fast: ask the inequality by compiled loops, for which
    the first of an installation waits some seconds: where those that found it have loaded them."""
    if found.level != "certified":
        return found
    before: Any = found.trap  # of a motion off the axes of symmetry
    scene = effective(checked_scene(scene))
    own, unit = natural(scene)
    rates = "" if scene.variables == "scaled" else " rad/s"
    test = tests_of(own).certifier(before.field, before.orders)
    way = _Way(scene, state, found.t * LATER[-1], bits, plain)
    for later in LATER:
        reached = way.to(found.t * later, steps)
        if reached is None:
            return replace(found,
                           cause=f"{found.cause}; not proved: after {way.steps} validated steps, at t = "
                                 f"{way.t:.6g}, the motion is {way.why}")
        middle, near = reached
        constants = test.constants(middle / unit, near / unit * WIDER, fast)
        if constants:
            # six constants
            trap = Trap(before.field, before.form, before.orders, *constants, unit, way.t)  # type: ignore[call-arg]
            words = (found.cause.replace("is certified", "is proved")
                     + f"; the motion up to there is enclosed, within {near:.2g}{rates} at t = {way.t:.6g}")
            return replace(found, level="proved", trap=trap, t=way.t, state=tuple(middle.tolist()),
                           cause=words)
        if not found.t:
            break
    return replace(found,
                   cause=f"{found.cause}; not proved: the inequality does not hold for the whole set that is "
                         f"known to hold the state")


class _Way:
    """The motion at rising times, as the centre and radius of a ball."""

    def __init__(self, scene, state, t_end, bits, plain):
        self.start = exact_vector(state, "state")
        self.course = Course(scene, state, t_end, bits, plain) if t_end else None
        self.t, self.steps, self.why = 0.0, 0, ""

    def to(self, t, steps):
        """(middle (3,), radius of a ball about it); None where the steps do not reach."""
        if self.course is None:
            middle = np.array([float(v) for v in self.start])
            return middle, _up([abs(v - Fraction(m)) for v, m in zip(self.start, middle.tolist())])
        steps = allowed(self.course.bits) if steps is None else steps
        if not self.course.steps:
            self.course.advance(t, min(steps, TRIED))
            slow = self.course.t * steps < t * self.course.steps / HOPELESS
            if self.course.status == kernel.GOING and slow:
                self.t, self.steps, self.why = self.course.t, self.course.steps, "too long to enclose"
                return None
        self.course.advance(t, steps - self.course.steps)
        now = self.course.now
        self.t, self.steps, self.why = now.t, now.steps, now.reason
        return (now.middle, _up(now.radius + np.abs(now.rest))) if now.status == "enclosed" else None


def _up(reach) -> float:
    """A bound of the length of a vector with components of at most these sizes."""
    return math.hypot(*map(float, reach)) * WIDER  # squares of small reaches would vanish
