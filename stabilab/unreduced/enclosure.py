"""A motion under a constant torque of any direction, enclosed step by step from an exact start, and a
spin-up proved along it.

Each step has a set at its time, and a band between it and the next.

The steps are those of `enclosure_kernel`, compiled where there is a compiler, with the same bits where there
is none. Scenes are taken at their exact numbers. Those of a frame of principal axes that is irrational have
an error of 2^-240 (`numbers.principal`): each step allows the coefficients FINE = 2^-92 of themselves.

A certified spin-up is proved: the motion from an exact start to the inequality is enclosed, and the
inequality holds for every state of the set there.

The theorem's inequality (`spin_up.certificate`) is tested for the ball that holds the enclosure at the time
when it fired. Its test is one in doubles, whose rounding is bounded beforehand: forms are exact before the
one root, each coefficient comes with a bound of its rounding (`spin_up.centres`), the place of the ball
is taken at its worse ends, and every comparison leaves room for the rest. So nothing in the answer rests on a
run that was not enclosed."""
from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import InputError
from ..integrate.crossing import Piece
from ..numbers.exact import exact_vector
from ..numbers.numba_door import Kernel, installed
from ..physics.coefficients import effective
from ..physics.own_unit import natural
from ..reasons import Quantity, Reasoned, Sentence
from ..validation import checked_scene
from . import enclosure_kernel
from .spin_up.certificate import tests_of
from .spin_up.result import SpinUp, Trap

if TYPE_CHECKING:
    from ..physics.scene import AnyScene, Scene

# --- The enclosed motion
# at most, unless others are asked for: compiled some three seconds, else some ten
STEPS, SLOW_STEPS = 200_000, 2_000
CHUNK = 512  # steps kept at a time between which the band is asked for
STEP_BITS = 112  # of a step in integers: far beyond its doubles
TOLERANCE = 2.0**-88  # of a step's tail, beside the state: as small as the rounding of its coefficients
WHY = {enclosure_kernel.DONE: Sentence("enclosure-done", "enclosed")(),
       enclosure_kernel.GOING: Sentence(
           "enclosure-steps-spent", "not finished: the steps allowed were used up")(),
       enclosure_kernel.LOST: Sentence(
           "enclosure-too-wide", "lost: the set has grown too wide to follow")(),
       enclosure_kernel.ENDLESS: Sentence(
           "enclosure-step-below-grain", "lost: a step would be below the grain of time")()}
STEP = 7.4e-3  # s of a processor: a step in plain Python
# a variant: sums of twofold numbers are compiled for it by itself, beside those of the orbits (`compiling`)
ADVANCE = Kernel(enclosure_kernel, "advance", 6.4, variant="enclosure_", options={"entries": {"advance"}})
TOO_LONG = Sentence("enclosure-too-long", "too long to enclose")()


@dataclass(frozen=True)
class Band:
    """Where the motion surely is during each of n steps.

    times: (n + 1,) ends, exact doubles; polynomials: (n, 3, N + 1) rates as polynomials in x = (t -
    times[i])/(times[i + 1] - times[i]), lowest first; radii: (n, 3): at every time of step i each rate is
    within radii[i] of its polynomial, however exactly that is evaluated. (n, 6, N + 1) and (n, 6) where a
    direction is followed, its components behind the rates.
    """

    times: np.ndarray
    polynomials: np.ndarray
    radii: np.ndarray

    def along(self, vector) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """((n, N + 1) polynomials, (n,) radii, (n,) sums of sizes) of a . y, y the components."""
        a = np.array([float(v) for v in vector])
        rows = self.polynomials[:, :len(a)]
        size = np.abs(rows).sum(axis=2) @ np.abs(a)
        radii = (self.radii[:, :len(a)] @ np.abs(a) + 2.0**-48 * size) * (1 + 2.0**-30)
        return np.tensordot(a, rows, (0, 1)), radii, size

    def form(self, terms) -> tuple[np.ndarray, np.ndarray]:
        """((n, 2 N + 1) polynomials, (n,) radii) of the sum of c (a . y)^2 during each step; terms: pairs of
        c, a positive number, and a."""
        n, _, m = self.polynomials.shape
        out, radius = np.zeros((n, 2 * m - 1)), np.zeros(n)
        for c, vector in terms:
            w, (row, r, size) = float(c), self.along(vector)
            for k in range(m):
                out[:, k:k + m] += w * row * row[:, k:k + 1]
            # N + 1 products and three sums to a coefficient, and the weight's rounding
            radius += w * (r * (2 * size + r) + 2.0**-44 * size**2)
        return out, radius * (1 + 2.0**-30)

    def piece(self, i: int, unit: Fraction) -> Piece:
        """Step i in integers of STEP_BITS bits, its rates over `unit`, a power of two, its time the
        scene's."""
        shift = STEP_BITS - (unit.numerator.bit_length() - unit.denominator.bit_length())
        places = [shift] * 3 + [STEP_BITS] * (self.polynomials.shape[1] - 3)
        rows = [[int(math.ldexp(v, n)) for v in row] for n, row in zip(places, self.polynomials[i].tolist())]
        # beside what is cut of each coefficient
        radii = [math.ceil(math.ldexp(r, n)) + len(rows[0]) for n, r in zip(places, self.radii[i].tolist())]
        begin, end = map(Fraction, self.times[i:i + 2].tolist())
        return Piece(begin, end - begin, STEP_BITS, rows, radii, [sum(map(abs, row)) for row in rows])


@dataclass(frozen=True)
class Enclosed(Reasoned):
    """The set that surely holds the state at one time.

    t: exact, the scene's unit of time; middle: (3,) rates (rad/s, or x when scaled); rest: (3,), to be added
    to them: the centre is a sum of two doubles; radius: (3,) each true rate is within it of the centre.
    steps: so many; status: "enclosed" where t is the time asked for, else "stopped", and reason says why.
    """

    t: float
    middle: np.ndarray
    rest: np.ndarray
    radius: np.ndarray
    steps: int
    status: str

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
    exact. direction: a vector of length 1 at rest in space, as it is in the body at t = 0, which is followed,
    too. The interpreter takes the first steps of a process, to the same bits, until compiled code pays
    (`Kernel`): a motion may be at its end before.
    """

    def __init__(self, scene, state, t_end: float, direction=None):
        scene = effective(checked_scene(scene))
        scene.quadratic()  # says which effect of the scene is not covered
        start = exact_vector(state, "state")
        if not (math.isfinite(t_end) and t_end > 0):
            raise InputError(f"t: expected a time above 0, got {t_end!r}")
        own, self.unit = natural(scene)
        self.t, self.steps, self.status = 0.0, 0, enclosure_kernel.GOING
        self._end = t_end * self.unit
        self._grain = math.ulp(self._end)
        form = own.quadratic()
        self._numbers = *twofold([form.kappa, form.rho, form.sigma, form.m]), energy_of(own), TOLERANCE
        centre, low = twofold([v / Fraction(self.unit) for v in start])
        self._set = [centre, low, np.eye(3), np.abs(centre) * 2.0**-104 + enclosure_kernel.TINY,
                     *twofold(direction or ()), np.array([2.0**-100])]

    def advance(self, t: float, steps: int | None = None, band: bool = False) -> Band | None:
        """Carry the motion on to the time t (taken down to the grain of time), by at most so many steps, at
        most CHUNK where the band is asked for.

        steps: None for as many as take some seconds, those made already counted. Returns the band where it is
        asked for and a step was made."""
        t = min(t * self.unit, self._end)
        t = float(int(t / self._grain)) * self._grain
        steps = max(0, allowed() - self.steps) if steps is None else steps
        size = min(steps, CHUNK) if band else 0
        followed = 3 + len(self._set[4])
        retained = [np.empty(size), np.empty((size, followed, enclosure_kernel.ORDER + 1)),
                np.empty((size, followed))]
        begun = self.t * self.unit
        now, built = self._carried(begun, t, size or steps, retained)
        self.t, self.steps = now / self.unit, self.steps + built
        if not (band and built):
            return None
        times, polynomials, radii = (rows[:built] for rows in retained)
        for rows in (polynomials, radii):
            rows[:, :3] *= self.unit
        return Band(np.append(begun, times) / self.unit, polynomials, radii)

    def _carried(self, t: float, t_end: float, steps: int, retained: Sequence[np.ndarray]):
        """(time, steps made) of the set carried on; what is told of each step goes to arrays `retained`."""
        built, fast = 0, ADVANCE.pays(0.0)
        while True:
            rest, before = [rows[built:] for rows in retained], [v.copy() for v in self._set]
            size = steps - built if fast else int(min(steps - built, 1 + ADVANCE.left() / STEP))
            try:
                t, more = self._run(fast, t, t_end, size, rest)
            except (ArithmeticError, ValueError):  # what is no number has no integer part for the interpreter
                self._set, fast = before, installed()
                if fast:
                    continue
                self.status = enclosure_kernel.LOST
                return t, built
            built += more
            fast = ADVANCE.pays(STEP * more) or fast
            if built >= steps or self.status != enclosure_kernel.GOING:
                return t, built

    def _run(self, fast, t, t_end, steps, retained):
        with np.errstate(all="ignore"):  # as compiled code
            self.status, t, built = ADVANCE.functions(fast)["advance"](
                *self._numbers, t, t_end, self._grain, steps, *self._set, *retained)
        return t, built

    @property
    def now(self) -> Enclosed:
        """Where the motion is."""
        centre, low, B, rad = self._set[:4]
        status = "enclosed" if self.status == enclosure_kernel.DONE else "stopped"
        return Enclosed(self.t, centre * self.unit, low * self.unit,
                        np.abs(B) @ rad * enclosure_kernel.WIDER * self.unit,
                        self.steps, status, reason=WHY[self.status])


def allowed() -> int:
    """How many steps take some seconds."""
    return STEPS if installed() else SLOW_STEPS


def twofold(values):
    """Exact numbers, nested lists of them, as two arrays of doubles whose sum they are to 105 bits."""
    values = np.array(values, dtype=object)
    high = np.array([float(v) for v in values.ravel()])
    low = np.array([float(v - Fraction(h)) for v, h in zip(values.ravel(), high.tolist())])
    return high.reshape(values.shape), low.reshape(values.shape)


def energy_of(own: AnyScene):
    """(4,) roots of the moments, and the greatest rate at which the root of the sum of D omega^2 grows; zeros
    for scaled variables."""
    if own.variables == "scaled":
        return np.zeros(4)
    D, M = (np.array([float(v) for v in vector])
            for vector in (own.body.exact, own.vector("constant_torque")))
    return np.append(np.sqrt(D), math.sqrt(float((M * M / D).sum())))


# --- A spin-up proved along it
TRIED, HOPELESS = 512, 16  # steps after which a way that would take so many times what is allowed is given up
SETTLED = 8192  # steps from whose lengths it is judged how many more there are
# times, over that of the certified run, at which the inequality is asked again
LATER = (1.0, 1.0625, 1.25, 1.5, 2.0)
WIDENED = 1 + 2.0**-40


NOT_ENCLOSED = Sentence(
    "not-enclosed", "not proved: after {steps} validated steps, which reach {time}, the motion is {why}")
ENCLOSED = Sentence("enclosed", "the motion up to there is enclosed, within {size} after {time}")
NOT_FOR_ALL = Sentence(
    "not-for-all", "not proved: the inequality does not hold for the whole set that is known to hold the "
    "state")()
# code of what is certified: the same where it is proved
AS_PROVED = {
    "spin-up-certified": Sentence(
        "spin-up-proved", "spin-up about {axis} is proved: an inequality that the motion meets holds for "
        "ever"),
    "spin-up-in-equator-certified": Sentence(
        "spin-up-in-equator-proved", "spin-up in the equator, across the axis of symmetry, is proved: an "
        "inequality that the motion meets holds for ever")}


def proved(scene, state, result: SpinUp, steps: int | None = None, fast: bool = False) -> SpinUp:
    """The answer of `spin_up` for the motion from a state (three exact numbers: floats at their word,
    Fractions, decimals in strings), with level "proved" where its way can be enclosed in so many validated
    steps and the inequality holds for the whole set there; else as it was found, its cause told what
    hindered. fast: the inequality is evaluated by compiled loops, where those that certified it are."""
    if result.level != "certified":
        return result
    before: Any = result.trap  # of a motion off the axes of symmetry
    scene = effective(checked_scene(scene))
    own, unit = natural(scene)
    rates = "" if scene.variables == "scaled" else "rad/s"
    test = tests_of(own).certifier(before.field, before.orders)
    arc = _Way(scene, state, result.t * LATER[-1])
    for later in LATER:
        reached = arc.to(result.t * later, steps)
        if reached is None:
            return replace(result,
                           reason=result.reason.then(NOT_ENCLOSED(
                               steps=arc.steps, time=Quantity(arc.t, scene.time_unit).lower, why=arc.why)))
        middle, nearby = reached
        constants = test.constants(middle / unit, nearby / unit * WIDENED, fast)
        if constants:
            # six constants
            trap = Trap(before.field, before.form, before.orders,  # type: ignore[call-arg]
                        *constants, unit, arc.t)
            reason = replace(result.reason, sentence=AS_PROVED[result.reason.code]).then(ENCLOSED(
                size=Quantity(nearby, rates, 2).upper, time=Quantity(arc.t, scene.time_unit)))
            return replace(result, level="proved", trap=trap, t=arc.t, state=tuple(middle.tolist()),
                           reason=reason)
        if not result.t:
            break
    return replace(result, reason=result.reason.then(NOT_FOR_ALL))


class _Way:
    """The motion at rising times, as the centre and radius of a ball."""

    def __init__(self, scene: Scene, state: Sequence[float | Fraction], t_end: float):
        self.start = exact_vector(state, "state")
        self.course = Course(scene, state, t_end) if t_end else None
        self.t, self.steps, self.why = 0.0, 0, WHY[enclosure_kernel.GOING]

    def to(self, t, steps):
        """(middle (3,), radius of a ball about it); None where the steps do not reach."""
        if self.course is None:
            middle = np.array([float(v) for v in self.start])
            return middle, _up([abs(v - Fraction(m)) for v, m in zip(self.start, middle.tolist())])
        steps = allowed() if steps is None else steps
        if not self.course.steps:
            self.course.advance(t, min(steps, TRIED))
            slow = self.course.t * steps < t * self.course.steps / HOPELESS
            if self.course.status == enclosure_kernel.GOING and slow:
                self.t, self.steps, self.why = self.course.t, self.course.steps, TOO_LONG
                return None
            if self._slows_down(t, steps):
                self.t, self.steps, self.why = self.course.t, self.course.steps, TOO_LONG
                return None
        self.course.advance(t, steps - self.course.steps)
        now = self.course.now
        self.t, self.steps, self.why = now.t, now.steps, now.reason
        return (now.middle, _up(now.radius + np.abs(now.rest))) if now.status == "enclosed" else None

    def _slows_down(self, t: float, steps: int) -> bool:
        """Whether steps grow shorter, as in a spin-up they go on to do, and those left do not come to t even
        at the length that they have: looked at whenever their number has doubled."""
        course, until = self.course, SETTLED
        while course.status == enclosure_kernel.GOING and 2 * until < steps:
            before, taken = course.t, course.steps
            course.advance(t, until - taken)
            pace = (course.t - before) / max(course.steps - taken, 1)
            if (taken >= SETTLED and pace * taken < before
                    and course.status == enclosure_kernel.GOING and t - course.t > pace * (steps - until)):
                return True
            until *= 2
        return False


def _up(reach: np.ndarray) -> float:
    """A bound of the length of a vector with components of at most these sizes."""
    return math.hypot(*map(float, reach)) * WIDENED  # squares of small reaches would vanish
