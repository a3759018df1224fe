"""An answer with the digits that its check showed, the errors that a check may find, and what formulas prove
of a motion in balls: all that needs no run."""
from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from ..errors import InputError, ToleranceNotMet
from ..numbers.balls import DOUBLE_BITS, Digits, working
from ..numbers.vectors import Exact3
from ..orbit.extremes import extreme_balls
from ..orbit.fate import free_margin, is_free, precise_margin
from ..orbit.one_orbit import Orbit
from ..orbit.period import period_ball
from ..orbit.reduction import reduce
from ..orbit.result import Fate, Motion, no_period
from ..physics.scene import AnyScene, aligned
from ..reasons import Quantity, Reason, Reasoned, Sentence, as_reason

DEFAULT = 10  # digits, where nothing else is asked for
# a digit by which an aim that nobody asked for may be missed, rather than pay for many digits
DIGITS_MISSED = 1.0
DOUBLE_DIGITS = 15  # decimal digits that every double holds
MOST_DECIMALS = 50  # digits of what is followed in time
MOST_DIGITS = 10_000  # digits of what a formula gives
FORMULA_DIGITS = 11  # the formulas hand over to balls where they hold less
CAUTION = 4  # differences between runs are samples of the error, not bounds: several times their size counts


NO_MARGIN = Sentence("no-margin-in-energy", "there is no margin in energy to be judged")()
BARRIER_BY_ALGEBRA = Sentence("barrier-by-algebra", "the energy equals the barrier's, by algebra")()
BESIDE_BALLS = Sentence("formulas-and-balls", "formulas in doubles, {error} from ball arithmetic")
BY_BALLS = Sentence("by-balls", "ball arithmetic: the number is within {width}")
BY_MANY_BALLS = Sentence("by-many-balls", "ball arithmetic: {digits} digits of the number are proved")
BY_OWN_BOUND = Sentence(
    "rounding-bounded", "formulas that bound their own rounding by {error}, balls beyond")
TOO_FEW = Sentence("too-few-digits", "{wanted} digits asked for, {reached} reached ({why})")
ASK_FOR_FEWER = Sentence("ask-for-fewer-digits", "ask for fewer")()


@dataclass(frozen=True)
class Told(Reasoned):
    """One answer. values: floats, as the question's own function gives them; decimals: the same, written out,
    where more digits were asked for than doubles hold; digits: what the check showed, None where there is no
    number to judge (no period, no barrier); reason: how they were checked, or why there are none."""

    question: str
    values: Any
    asked: int
    digits: float | None
    method: str
    decimals: Any = None

    @property
    def enough(self) -> bool:
        return self.digits is None or self.digits >= self.asked

    def required(self) -> Told:
        """Itself; raises ToleranceNotMet where the digits asked for were not reached."""
        if not self.enough:
            raise ToleranceNotMet(f"{self.question}: {short(self)}")
        return self


def short(printed: Told) -> str:
    """What is missing, in words."""
    return too_few(printed).then(ASK_FOR_FEWER).text()


def too_few(checked: Any) -> Reason:
    """Of an answer, or a run, with the digits that its check showed: how many are missing, and why."""
    return TOO_FEW(wanted=checked.asked, reached=Quantity(round(checked.digits, 1), digits=3),
                   why=checked.reason)


def checked_digits(digits: int, largest: int, why: str = "") -> int:
    """The number of digits, if it can be asked for. why: there are no more."""
    if not (isinstance(digits, int) and not isinstance(digits, bool) and 1 <= digits <= largest):
        raise InputError(f"digits: expected a whole number from 1 to {largest}, got {digits!r:.60}"
                         + (why and f" ({why})"))
    return digits


def followed_digits(digits: int, what: str) -> int:
    """The number of digits, if what is followed in time can have so many."""
    return checked_digits(digits, MOST_DECIMALS, f"{what} is followed in time; only formulas give more")


def digits_of(error: float, largest: float = DOUBLE_DIGITS + 0.95) -> float:
    """Correct digits of a relative error, at most what the numbers hold."""
    if not error > 0:
        return largest if error == 0 else 0.0
    return max(0.0, min(-math.log10(error), largest))


def number_of(question: str, motion: Motion) -> Any:
    """What a motion says to a question, None where it has no such number."""
    return {"extremes": motion.extremes, "period": motion.period, "fate": motion.margin_energy}[question]


def by_bound(question: str, motion: Motion) -> Told | None:
    """What the formulas of the reduced motion say of themselves: they bound their rounding as they go, and
    hand over to ball arithmetic where the bound is too large. None where no formula answered."""
    if motion.tolerance is None:
        return None
    values = number_of(question, motion)
    if question == "fate":
        return None if values is not None else nothing(question, DEFAULT, motion.reason)
    if values is None:
        return nothing(question, DEFAULT, no_period(motion.fate))
    tolerance = motion.tolerance * (10 if question == "period" else 1)
    return Told(question, values, DEFAULT, digits_of(tolerance), "formulas",
                reason=BY_OWN_BOUND(error=Quantity(tolerance, digits=1).upper))


def nothing(question: str, request: int, why: Reason | str) -> Told:
    """The answer that there is no such number."""
    return Told(question, None, request, None, "none", reason=as_reason(why))


# -- motions with a reduction


def tie(question: str, digits: int) -> Told:
    return Told(question, 0.0, digits, math.inf, "balls", reason=BARRIER_BY_ALGEBRA)


def judged(question: str, values: Any, balls: Any, digits: int) -> Told:
    """The formulas' values where the balls (to max(digits, MOST) + 1 digits) confirm so many digits, else the
    balls'."""
    with working(DOUBLE_BITS):
        error = gap_of(values, balls)
    if digits <= FORMULA_DIGITS and error <= 10.0**-digits:
        return Told(question, values, digits, digits_of(error), "formulas",
                    reason=BESIDE_BALLS(error=Quantity(error, digits=2)))
    return proved(question, balls, digits)


def proved(question: str, balls: Any, digits: int) -> Told:
    """What balls (to max(digits, DOUBLE_DIGITS) + 1 digits) prove."""
    wanted = max(digits, DOUBLE_DIGITS) + 1
    held = digits_held(balls, wanted)
    return of_balls(question, balls, digits, held, "balls", BY_BALLS(width=Quantity(
        10.0**-held, digits=1).upper) if digits <= MOST_DECIMALS else BY_MANY_BALLS(digits=int(held)))


def of_balls(question: str, balls: Any, digits: int, held: float, method: str, reason: Reason) -> Told:
    """The balls as floats, and written out where more digits are asked for than these have. held: digits."""
    more = digits > DOUBLE_DIGITS
    return Told(question, floats_of(balls), digits, held if more else min(held, DOUBLE_DIGITS + 0.95), method,
                decimals_of(balls, digits) if more else None, reason=reason)


def _balls(question: str, orbit: Orbit, label: Fate, digits: int,
           tell: Callable[[float], None] | None) -> Any:
    """The answer in balls, nested as its floats are."""
    if question == "extremes":
        return extreme_balls(orbit, int(label), math.ceil(digits * math.log2(10)))
    if question == "period":
        return period_ball(orbit, digits, tell) if label == Fate.BOUNDED else Digits(DOUBLE_BITS).ball(0)
    return precise_margin(orbit, digits)


def each_of(values: Any) -> list[tuple[Any, Any]]:
    """(value, size of its component) of a number or of pairs."""
    if not isinstance(values, (list, tuple)) and not getattr(values, "ndim", 0):  # an array has it
        return [(values, values)]
    return [(v, max((u for u in pair if math.isfinite(float(u))), key=lambda u: abs(float(u)), default=1))
            for pair in values for v in pair]


def gap_of(values: Any, balls: Any) -> float:
    """Largest distance of floats from balls, relative to the component's size."""
    from flint import arb
    worst = 0.0
    for (value, _), (exact, size) in zip(each_of(values), each_of(balls)):
        if math.isinf(float(value)) or math.isinf(float(exact)):
            worst = worst if float(value) == float(exact) else math.inf
        elif (far := float(abs(arb(float(value)) - exact).mid())) > 0:
            worst = max(worst, far / abs(float(size)) if float(size) else math.inf)
    return worst


def digits_held(balls: Any, largest: float) -> float:
    """Digits that the radii of balls leave, relative to their component's size, at most `largest`."""
    from flint import arb
    result = largest
    with working(DOUBLE_BITS):
        for value, size in each_of(balls):
            width = arb(value).rad() / (abs(arb(size).mid()) or 1)
            if width.is_finite() and width > 0:
                result = min(result, float(-width.log() / arb(10).log()))
    return max(0.0, result)


def floats_of(balls: Any) -> Any:
    if isinstance(balls, list):
        return tuple(tuple(map(floats_of, pair)) for pair in balls)
    return float(balls) if isinstance(balls, float) or 0 not in balls else 0.0


def decimals_of(balls: Any, digits: int) -> Any:
    """Written out with one digit more, so that writing costs none of them."""
    if isinstance(balls, list):
        return [[decimals_of(v, digits) for v in pair] for pair in balls]
    from flint import arb
    if isinstance(balls, float):
        return str(balls)
    return "0" if 0 in arb(balls) else arb(balls).mid().str(digits + 1, radius=False)


# -- motions without a reduction


def by_formula(question: str, scene: AnyScene, resolved: Motion, digits: int, exact: Exact3 | None = None,
               tell: Callable[[float], None] | None = None) -> Told | None:
    """What formulas say in balls of a motion, by a reduction or of a body without a torque; None where there
    is none. scene: with nothing but a wheel and a torque, if `plain` (`coefficients.effective`)."""
    if question != "extremes" and number_of(question, resolved) is None:
        return nothing(question, digits, no_period(resolved.fate) if question == "period" else NO_MARGIN)
    start = exact or resolved.at[:3]
    if question == "fate" and is_free(scene):
        return _margin_without_reduction(scene, resolved, digits, start)
    if scene.plain and (reduction := reduce(scene)) is not None:
        balls = _balls(question, Orbit(reduction, start), resolved.fate, max(digits, DOUBLE_DIGITS) + 1, tell)
        return (tie(question, digits) if balls is None  # on the separatrix
                else judged(question, number_of(question, resolved), balls, digits))
    if question == "fate" and resolved.fate != Fate.EQUILIBRIUM:
        return _margin_without_reduction(scene, resolved, digits, start)
    return None


def _margin_without_reduction(scene: AnyScene, resolved: Motion, digits: int, state: Any) -> Told:
    wanted = max(digits, DOUBLE_DIGITS) + 1
    if is_free(scene):
        margin = free_margin(scene, state, wanted)
        balls = None if margin.tie else margin.ball
    else:
        turn: Any = aligned(scene)  # between two equal moments, or there were no margin
        twin: Any = reduce(turn.twin)
        balls = precise_margin(Orbit(twin, turn(state)), wanted)
    return tie("fate", digits) if balls is None else judged("fate", resolved.margin_energy, balls, digits)
