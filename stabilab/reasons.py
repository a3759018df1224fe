"""Sentences that carry quantities: why something is known, and what limits an answer.

A `Sentence` stands beside the code that knows why, with a code and named holes; called with its quantities it
gives a `Reason`. Digits, units, names of axes and letters are put in when it is rendered: in SI and ASCII by
`str`, in the units of a case by `stabilab.show.units.Units.said`, as an object of JSON by `as_dict`."""
from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from decimal import ROUND_CEILING, ROUND_FLOOR, Context, Decimal
from enum import StrEnum
from functools import partial
from string import Formatter
from typing import Any, TypeAlias

DIGITS = 6  # of a number in a sentence in SI
BROAD = 0.1  # of the greater of two ends of a time
# What stands for the letters of a sentence where there are none: in JSON, CSV, Python, on a plain terminal
ASCII = {"ω": "omega", "λ": "lambda", "Λ": "Lambda", "μ": "mu", "γ": "gamma", "α": "alpha", "σ": "sigma",
         "ζ": "zeta", "τ": "tau", "β": "beta", "δ": "delta", "ε": "eps", "η": "eta", "θ": "theta", "κ":
         "kappa", "ν": "nu", "Π": "Pi", "π": "pi", "φ": "phi", "ψ": "psi", "ρ": "rho", "Γ": "Gamma", "Δ":
         "Delta", "Ω": "Omega", "ᵢ": "_i", "ⱼ": "_j", "ₖ": "_k", "∞": "inf", "²": "^2", "³": "^3", "⁴": "^4",
         "⁵": "^5", "⁶": "^6", "⁷": "^7", "⁸": "^8", "⁹": "^9", "±": "+-", "∓": "-+", "−": "-", "–": "-",
         "≤": "<=", "≥": ">=", "≠": "!=", "√": "sqrt", "×": "x", "·": ".", "µ": "u", "°": " deg", "…": "..."}
_PLAIN = str.maketrans(ASCII)


class Level(StrEnum):
    """How well an answer is known, the best first; docs/glossary.md has a line on each."""

    EXACT = "exact"
    PROVED = "proved"
    CERTIFIED = "certified"
    RUN = "run"
    SAMPLED = "sampled"
    LAW = "approximate law"
    UNDECIDED = "undecided"


@dataclass(frozen=True, slots=True)
class Quantity:
    """A number, or a vector, in SI. unit: its SI symbol, which is its dimension ("" of a number); digits:
    None where the view decides how many of an angle, a rate or a time it has room for. side: of a bound, +1
    (at most: never printed below itself) or -1 (at least: never printed above itself)."""

    value: Any
    unit: str = ""
    digits: int | None = None
    side: int = 0

    @property
    def upper(self) -> Quantity:
        """As an upper bound: rounded up where it is printed."""
        return replace(self, side=1)

    @property
    def lower(self) -> Quantity:
        """As a lower bound: rounded down where it is printed."""
        return replace(self, side=-1)


Rate = partial(Quantity, unit="rad/s")
Angle = partial(Quantity, unit="rad")
Time = partial(Quantity, unit="s")
Force = partial(Quantity, unit="N")
Torque = partial(Quantity, unit="N m")
Energy = partial(Quantity, unit="J")
Momentum = partial(Quantity, unit="N m s")
Mass = partial(Quantity, unit="kg")
Length = partial(Quantity, unit="m")
Inertia = partial(Quantity, unit="kg m^2")
PerSecond = partial(Quantity, unit="1/s")


def broad(low: float, high: float) -> bool:
    """Whether two ends are so far apart that a middle would say more than is known."""
    return high - low > BROAD * high


@dataclass(frozen=True, slots=True)
class Moment:
    """A point in time in the unit of its scene, with the name of the time: "t = 2.5 s", "tau = 2.5" of a
    scaled one. digits, side: as of `Quantity`."""

    value: float
    digits: int | None = None
    side: int = 0

    @property
    def lower(self) -> Moment:
        """As a lower bound: rounded down where it is printed."""
        return replace(self, side=-1)


@dataclass(frozen=True, slots=True)
class Span:
    """A time from one moment to another, in s, or in tau of a scaled scene."""

    start: float
    end: float
    unit: str = "s"


@dataclass(frozen=True, slots=True)
class Axis:
    """A principal axis by its number, 1 to 3; the reader's view names it."""

    number: int


Of: TypeAlias = Callable[[str], tuple[str, float]]  # an SI unit -> the unit shown, and how many make one


@dataclass(frozen=True, slots=True)
class Coefficient:
    """A number of a formula, whose unit stands beside the formula. unit: in SI; digits: in SI, None for all
    (the shortest decimal)."""

    value: Any
    unit: str = ""
    digits: int | None = None

    def text(self, of: Of | None, letters: bool) -> str:
        """Rounded to six digits but in SI."""
        item = 1.0 if of is None else of(self.unit)[1]
        result = decimal(self.value) if self.digits is None else number(self.value, self.digits)
        if item != 1.0 or of is not None and len(result) > DIGITS + 2:
            result = self._rounded(item)
        return result.replace("inf", "∞") if letters else result

    def _rounded(self, item: float) -> str:
        """To six digits in a unit of which so many make one in SI."""
        top, bottom = item.as_integer_ratio()
        value = self.value * top / bottom
        return number(float(value), DIGITS) if in_doubles(value) else decimal(value)


@dataclass(frozen=True, slots=True)
class Unit:
    """The name of a unit, by its SI symbol."""

    name: str

    def text(self, of: Of | None, letters: bool) -> str:
        """Its name for the reader."""
        return self.name if of is None else of(self.name)[0]


@dataclass(frozen=True, slots=True)
class Power:
    """An exponent from 2 to 9."""

    exponent: int

    def text(self, of: Of | None, letters: bool) -> str:
        """Raised where there are letters."""
        return "⁰¹²³⁴⁵⁶⁷⁸⁹"[self.exponent] if letters else f"^{self.exponent}"


@dataclass(frozen=True, slots=True)
class Formula:
    """Symbols and signs with numbers between them, such as "ω1 - 0.4"; in JSON a list of both."""

    parts: tuple[str | Coefficient | Unit, ...]

    def text(self, of: Of | None, letters: bool) -> str:
        """Its parts in a row."""
        plain_of = (lambda part: part) if letters else (lambda part: part.translate(_PLAIN))
        return "".join(plain_of(part) if isinstance(part, str) else part.text(of, letters)
                       for part in self.parts)


Symbolic = (Coefficient, Unit, Power, Formula)
# str: a user's name, or a word without a number
Filling: TypeAlias = ("Quantity | Moment | Span | Axis | Level | int | str | Reason | Coefficient | Unit "
                      "| Power | Formula | tuple[Filling, ...]")


@dataclass(frozen=True)
class Sentence:
    """code: unique, for scripts; template: words with holes in braces, letters as people write them."""

    code: str
    template: str

    def __call__(self, **quantities: Filling) -> Reason:
        return Reason(self, tuple(quantities.items()))

    @property
    def holes(self) -> tuple[str, ...]:
        """The names of its holes, each once."""
        return tuple(dict.fromkeys(name for _, name, *_ in Formatter().parse(self.template) if name))


@dataclass(frozen=True, repr=False)
class Reason:
    """A sentence with its quantities, and the clauses that follow it, each behind its joint."""

    sentence: Sentence
    filled: tuple[tuple[str, Any], ...] = ()
    rest: tuple[tuple[str, Reason], ...] = ()

    @property
    def code(self) -> str:
        """Which sentence it is; empty of words that carry no quantities yet."""
        return self.sentence.code

    @property
    def quantities(self) -> dict[str, Any]:
        """What fills the holes, by name."""
        return dict(self.filled)

    @property
    def alone(self) -> Reason:
        """Without the clauses that follow."""
        return replace(self, rest=())

    def then(self, other: Reason | None, joint: str = "; ") -> Reason:
        """With another clause behind it; as it is where there is none, or it says nothing."""
        return replace(self, rest=(*self.rest, (joint, other))) if other else self

    def clauses(self) -> Iterator[tuple[str, Reason]]:
        """(joint, clause) of all of it, the first behind no joint."""
        yield "", self.alone
        for joint, item in self.rest:
            for inner, clause in item.clauses():
                yield inner or joint, clause

    def says(self, *sentences: Sentence) -> bool:
        """Whether one of its clauses is one of these sentences."""
        return any(item.sentence in sentences for _, item in self.clauses())

    def without(self, sentence: Sentence) -> Reason:
        """Without the clauses that are this sentence, as far as others are left."""
        rest = tuple((joint, item) for joint, item in self.rest if item.sentence != sentence)
        if self.sentence != sentence or not rest:
            return replace(self, rest=rest)
        (_, first), *others = rest
        return replace(first, rest=(*first.rest, *others))

    def text(self, fill: Callable[[Any], str] | None = None, letters: bool = False) -> str:
        """The words. fill: a filling as text, in SI without it; letters: whether it is printed with letters
        such as ω, in ASCII otherwise."""
        template = self.sentence.template if letters else self.sentence.template.translate(_PLAIN)
        filled = in_si if fill is None else fill
        own = (template.format_map({name: filled(value) for name, value in self.filled}) if self.code
               else template)
        return own + "".join(joint + item.text(fill, letters) for joint, item in self.rest)

    def __str__(self) -> str:
        return self.text()

    def __bool__(self) -> bool:
        return bool(self.sentence.template)

    def __repr__(self) -> str:
        return f"Reason({self.code!r}, {self.text()!r})"

    def as_dict(self, fill: Callable[[Any], str] | None = None) -> dict[str, Any]:
        """An object of JSON: "code", "text" and each quantity by its name in SI; "then": the clauses that
        follow."""
        result = {"code": self.code, "text": self.alone.text(fill)} | quantities_of(self)
        return result | ({"then": [item.as_dict(fill) for _, item in self.rest]} if self.rest else {})


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Reasoned:
    """What every result brings that says why it is known. reason: with its quantities, false where there is
    nothing to say; words without any, and None, are taken as they are. because: the same in words, in SI."""

    reason: Reason

    def __post_init__(self) -> None:
        object.__setattr__(self, "reason", as_reason(self.reason))

    @property
    def because(self) -> str:
        """The reason in words and SI units."""
        return self.reason.text()


def chained(*reasons: Reason | None, joint: str = "; ") -> Reason | None:
    """Those that there are as one, each a clause behind the one before; None where there is none."""
    first, *rest = [*filter(None, reasons), None]
    for item in rest:
        first = first and first.then(item, joint)
    return first


def quantities_of(reason: Reason) -> dict[str, Any]:
    """The quantities of a reason by their names as JSON holds them."""
    return {name: plain(value) for name, value in reason.filled}


def plain(value: Any) -> Any:
    """A filling as JSON holds it."""
    if isinstance(value, Quantity):
        if isinstance(value.value, tuple):
            return [*map(float, value.value)]
        return value.value if type(value.value) is int and not value.unit else float(value.value)
    if isinstance(value, Moment):
        return float(value.value)
    if isinstance(value, Span):
        return [float(value.start), float(value.end)]
    if isinstance(value, Axis):
        return value.number
    if isinstance(value, Coefficient):
        return float(value.value) if in_doubles(value.value) else decimal(value.value)
    if isinstance(value, Power):
        return value.exponent
    if isinstance(value, Formula) and not all(isinstance(part, str) for part in value.parts):
        return [part.translate(_PLAIN) if isinstance(part, str) else plain(part) for part in value.parts]
    if isinstance(value, Symbolic):
        return value.text(None, False)
    if isinstance(value, Reason):
        return value.as_dict() if value.code else value.text()
    return [*map(plain, value)] if isinstance(value, tuple) else value


def as_reason(supplied: Reason | str | None) -> Reason:
    """A reason as it is, words as one, None as one that says nothing."""
    return supplied if isinstance(supplied, Reason) else old(supplied or "")


def old(text: str) -> Reason:
    """Words that still hold digits, units and axes: they are read again where they are printed."""
    return Reason(Sentence("", text))


def number(value: float, digits: int = DIGITS, side: int = 0) -> str:
    """So many significant digits at most, rounded to nearest, up (side +1) or down (-1)."""
    return f"{outward(float(value), digits, side) + 0.0:.{digits}g}"


def decimal(value: Any) -> str:
    """An exact number or a double: the shortest decimal that reads back as the same double; six digits beyond
    the doubles."""
    if not in_doubles(value):
        digits = Context(prec=6, Emin=-10**6, Emax=10**6)
        ratio = digits.divide(*map(digits.create_decimal, (value.numerator, value.denominator)))
        return f"{ratio:e}"
    return repr(float(value) + 0.0).removesuffix(".0")


def in_doubles(value: Any) -> bool:
    """Whether a number is zero or has a double near it that is not."""
    try:
        return bool(float(value)) or not value
    except OverflowError:
        return False


def outward(value: float, digits: int, side: int) -> float:
    """The value rounded to so many significant digits, up (side +1) or down (-1); itself for side 0."""
    if not side or value - value != 0 or float(f"{value:.{digits}g}") == value:  # which is read back as it is
        return value
    context = Context(prec=digits, rounding=ROUND_CEILING if side > 0 else ROUND_FLOOR)
    return float(context.create_decimal(Decimal(value)))


def in_si(value: Any, axis: Callable[[int], str] = "axis {}".format) -> str:
    """A filling as text, in SI units. axis: the name of an axis by its number."""
    if isinstance(value, Quantity):
        many = value.value if isinstance(value.value, tuple) else (value.value,)
        numbers = ", ".join(number(item, value.digits or DIGITS, value.side) for item in many)
        return f"({numbers}) {value.unit}".rstrip() if isinstance(value.value, tuple) else (
            f"{numbers} {value.unit}".rstrip())
    if isinstance(value, Moment):
        return f"t = {number(value.value, value.digits or DIGITS, value.side)}"
    if isinstance(value, Span):
        return f"{value.unit} in [{value.start:g}, {value.end:g}]"
    if isinstance(value, Axis):
        return axis(value.number)
    if isinstance(value, Symbolic):
        return value.text(None, False)
    if isinstance(value, Reason):
        return value.text(partial(in_si, axis=axis))
    if isinstance(value, tuple):
        return listed(tuple(in_si(item, axis) for item in value))
    return f"{value:,}" if type(value) is int else str(value)


def listed(text: tuple[str, ...]) -> str:
    """Words one after the other: "a", "a and b", "a, b and c"."""
    return " and ".join(filter(None, (", ".join(text[:-1]), text[-1]))) if text else ""
