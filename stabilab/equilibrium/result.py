"""Equilibria as data, and curves of them in exact form: rational in their parameter, cut where stability
changes."""
from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from itertools import pairwise
from typing import TYPE_CHECKING, Any, NamedTuple

from ..errors import InputError
from ..numbers.polynomial import Poly
from ..numbers.principal import PrincipalAxes
from ..numbers.vectors import Exact3, Float3, Number
from ..representation import Answer

if TYPE_CHECKING:
    from ..physics.law_limits import Validity

@dataclass(frozen=True)
class EquilibriumPoint:
    """One equilibrium with its verdicts.

    at: three components in the scene's variables. eigenvalues: of the Jacobian there (1/s, or 1/tau when
    scaled). linear: "stable" (centre), "unstable", "degenerate". verdict: "stable", "unstable", "undecided"
    (Lyapunov sense, for the full nonlinear motion), because: its proof in words.
    """

    at: Float3
    eigenvalues: tuple[complex, ...]
    linear: str
    verdict: str
    because: str

    @property
    def characteristic(self) -> tuple[float, ...]:
        """Coefficients of the characteristic polynomial of the Jacobian, highest power first; of a gyrostat
        (1, 0, m, n), Amer et al. 2024, eq. (12)."""
        coefficients = [1 + 0j]
        for root in self.eigenvalues:
            coefficients = [a - root * b for a, b in zip([*coefficients, 0j], [0j, *coefficients])]
        return tuple(c.real + 0.0 for c in coefficients)


@dataclass(frozen=True)
class CurveSegment:
    """A piece of an equilibrium curve with one verdict; `t` is the open parameter interval (ends may be
    infinite)."""

    t: tuple[float, float]
    linear: str
    verdict: str
    because: str


@dataclass(frozen=True)
class EquilibriumCurve:
    """A curve of equilibria: point(t) -> (x1, x2, x3) for t inside the segments' intervals.

    equation and parametrisation in symbols; folds are the points between segments where the linear verdict is
    degenerate; samples are equilibria spread over every segment.
    """

    name: str
    equation: str
    parametrisation: str
    point: Callable[[float], Float3] = field(repr=False, compare=False)
    segments: tuple[CurveSegment, ...] = ()
    folds: tuple[Float3, ...] = ()
    samples: tuple[EquilibriumPoint, ...] = ()


@dataclass(frozen=True, repr=False)
class Equilibria(Answer):
    """All equilibria of a scene. kind: "none", "points", "curves" (curves, possibly with points) or "all"
    (every state is one); reason: why these and no others. validity: of an approximate law
    (`stabilab.physics.law_limits`), at the points; None where all laws are exact. frame: the principal axes,
    along which states are, in the frame of the tensor that was given; None where the two are one."""

    kind: str
    reason: str
    points: tuple[EquilibriumPoint, ...] = ()
    curves: tuple[EquilibriumCurve, ...] = ()
    validity: Validity | None = None
    frame: PrincipalAxes | None = field(default=None, repr=False, compare=False)


T = Poly((0, 1))
ONE_POLY = Poly((1,))
Verdict = tuple[str, str]  # (word, because)


class Grounds(NamedTuple):
    """Why a curve's points are what they are: verdicts for m > 0 and for a zero of m by the signs of m beside
    it."""

    positive: Verdict
    odd: Verdict        # m changes sign
    minimum: Verdict    # m > 0 on both sides
    maximum: Verdict    # m < 0 on both sides


@dataclass(frozen=True)
class RationalCurve:
    """x_i(t) = numerators[i](t)/denominator(t). crossings: parameter where another curve meets this one ->
    verdict. poles: zeros of the denominator, rising, all rational. scale: a parameter size at which something
    happens."""

    name: str
    equation: str
    parametrisation: str
    numerators: tuple[Poly, ...]
    grounds: Grounds
    denominator: Poly = ONE_POLY
    poles: tuple[Fraction, ...] = ()
    crossings: dict[Fraction, Verdict] = field(default_factory=dict)
    scale: Fraction = Fraction(1)

    def exact_point(self, t: Fraction) -> Exact3:
        """The equilibrium at a rational t that is not a pole."""
        bottom = self.denominator(t)
        return tuple(n(t) / bottom for n in self.numerators)

    def rounded_point(self, t: float) -> Float3:
        """The equilibrium at a float t, each coordinate rounded once; InputError at a pole or a t that is not
        finite."""
        try:
            return tuple(float(v) for v in self.exact_point(Fraction(t)))
        except (ZeroDivisionError, OverflowError, ValueError):
            raise InputError(
                f"t = {t!r} lies at an end of the curve ({self.name}): no equilibrium there") from None

    def cut(self, cuts: Sequence[Fraction], segment: Callable[..., Any],
            fold: Callable[..., EquilibriumPoint]) -> EquilibriumCurve:
        """It with verdicts. cuts: parameters, rising; segment(lo, hi): one between two of them (None:
        infinite) and its samples; fold(t, before, after): the equilibrium between two segments, asked where t
        is no pole."""
        pieces = [segment(lo, hi) for lo, hi in pairwise([None, *cuts, None])]
        samples, folds = list(pieces[0][1]), []
        for t, (before, _), (after, points) in zip(cuts, pieces, pieces[1:]):
            if t not in self.poles:
                folds.append(fold(t, before, after))
                samples.append(folds[-1])
            samples += points
        return EquilibriumCurve(self.name, self.equation, self.parametrisation, self.rounded_point,
                                tuple(s for s, _ in pieces), tuple(point.at for point in folds),
                                tuple(samples))


def straight_line(start: Sequence[Fraction], direction: Sequence[Fraction]) -> tuple[Poly, ...]:
    """start + t direction as polynomials."""
    return tuple(Poly((s, d)) for s, d in zip(start, direction))


def size_of(*vectors: Sequence[Fraction]) -> Fraction:
    """The largest entry in size, 1 where all vanish: a scale for the parameter of a line."""
    return max((abs(v) for vector in vectors for v in vector), default=Fraction(0)) or Fraction(1)


def float_ends(lo: Fraction | None, hi: Fraction | None) -> tuple[float, float]:
    """An open interval whose ends may be infinite (None)."""
    return float("-inf") if lo is None else float(lo), float("inf") if hi is None else float(hi)


def values_inside(lo: Fraction | None, hi: Fraction | None, scale: Fraction) -> Fraction:
    if lo is None:
        return Fraction(0) if hi is None else hi - (abs(hi) or scale)
    return lo + (abs(lo) or scale) if hi is None else (lo + hi) / 2


def sample_parameters(lo: Fraction | None, hi: Fraction | None, scale: Fraction) -> list[Fraction]:
    """Doubles (as fractions) inside the open interval, spread over it and log-spaced towards its infinite
    ends."""
    if lo is None:
        if hi is not None:
            return [-t for t in reversed(sample_parameters(-hi, None, scale))]
        raw = [f * scale for f in (-100, -1, 0, 1, 100)]
    elif hi is None:
        raw = [lo + (abs(lo) or scale) * f for f in (Fraction(1, 100), 1, 100, 10000)]
    elif lo == 0 or 0 < lo and hi > 100 * lo:
        ratio = float(hi / lo) if lo else 1e4
        raw = [hi / Fraction(ratio ** f) for f in (0.95, 0.7, 0.4, 0.1, 0.01)]
    elif hi == 0 or hi < 0 and lo < 100 * hi:
        return [-t for t in reversed(sample_parameters(-hi, -lo, scale))]
    else:
        raw = [lo + (hi - lo) * f for f in (Fraction(1, 1000), Fraction(1, 10), Fraction(1, 2),
                                            Fraction(9, 10), Fraction(999, 1000))]
    rounded = []
    for t in raw:
        try:
            rounded.append(Fraction(float(t)))
        except OverflowError:
            continue
    return [t for t in dict.fromkeys(rounded) if (lo is None or t > lo) and (hi is None or t < hi)]


def decimal(value: Number) -> str:
    """A number for the user's eye: the shortest decimal that reads back as the same double; six digits beyond
    the doubles."""
    try:
        number = float(value)
    except OverflowError:
        number = 0.0
    if value and not number:
        from decimal import Context
        digits, value = Context(prec=6, Emin=-10**6, Emax=10**6), Fraction(value)
        ratio = digits.divide(*map(digits.create_decimal, (value.numerator, value.denominator)))
        return f"{ratio:e}"
    return repr(number + 0.0).removesuffix(".0")


def shifted(name: str, centre: Fraction) -> str:
    """"x1", "(x1 + 0.4)" or "(x1 - 0.4)" for the distance of a component from its centre."""
    return name if not centre else f"({name} {'-' if centre > 0 else '+'} {decimal(abs(centre))})"


def sum_of(*terms: Number | str) -> str:
    """A readable sum of numbers and strings such as "2 + t", without zero terms."""
    out = ""
    for term in terms:
        text = term if isinstance(term, str) else decimal(term) if term else ""
        if text:
            out += text if not out else f" - {text[1:]}" if text.startswith("-") else f" + {text}"
    return out or "0"


def line_text(names: Sequence[str], start: Sequence[Fraction],
              direction: Sequence[Fraction]) -> tuple[str, str]:
    """(equation, parametrisation) of start + t direction."""
    fixed = [f"{n} = {decimal(s)}" for n, s, d in zip(names, start, direction) if not d]
    free = [n for n, d in zip(names, direction) if d]
    moving = []
    for s, d in zip(start, direction):
        term = "t" if d == 1 else "-t" if d == -1 else f"{decimal(d)} t" if d else ""
        moving.append(sum_of(s, term))
    along = f"{free[0]} arbitrary" if len(free) == 1 else f"({', '.join(free)}) on a straight line"
    return ", ".join(fixed + [along]), ", ".join(f"{n} = {v}" for n, v in zip(names, moving))
