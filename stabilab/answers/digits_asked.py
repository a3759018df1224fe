"""An answer with the digits that its check showed, and the errors that a check may find."""
from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from ..errors import InputError, ToleranceNotMet
from ..orbit.result import Motion, no_period
from ..reasons import Quantity, Reason, Reasoned, Sentence, as_reason

DEFAULT = 10  # digits, where nothing else is asked for
# a digit by which an aim that nobody asked for may be missed, rather than pay for many digits
DIGITS_MISSED = 1.0
DOUBLE_DIGITS = 15  # decimal digits that every double holds
MOST_DECIMALS = 50  # digits of what is followed in time
MOST_DIGITS = 10_000  # digits of what a formula gives
CAUTION = 4  # differences between runs are samples of the error, not bounds: several times their size counts


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
