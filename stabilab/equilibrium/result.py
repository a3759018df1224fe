"""Equilibria as data, and curves of them in exact form: rational in their parameter, cut where stability
changes."""
from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from itertools import pairwise
from typing import TYPE_CHECKING, Any, NamedTuple

from ..errors import InputError
from ..numbers.polynomial import Poly, rounded_ratios
from ..numbers.principal import PrincipalAxes
from ..numbers.vectors import Exact3, Float3
from ..reasons import Reason, Reasoned
from ..representation import Answer
from .description import PLANE, Description

if TYPE_CHECKING:
    from ..physics.law_limits import Validity


@dataclass(frozen=True)
class EquilibriumPoint(Reasoned):
    """One equilibrium with its verdicts.

    at: three components in the scene's variables. eigenvalues: of the Jacobian there (1/s, or 1/tau when
    scaled). linear: "stable" (centre), "unstable", "degenerate". verdict: "stable", "unstable", "undecided"
    (Lyapunov sense, for the full nonlinear motion), reason: its proof, because: the same in words.
    """

    at: Float3
    eigenvalues: tuple[complex, ...]
    linear: str
    verdict: str

    @property
    def characteristic(self) -> tuple[float, ...]:
        """Coefficients of the characteristic polynomial of the Jacobian, highest power first; of a gyrostat
        (1, 0, m, n), Amer et al. 2024, eq. (12)."""
        coefficients = [1 + 0j]
        for root in self.eigenvalues:
            coefficients = [a - root * b for a, b in zip([*coefficients, 0j], [0j, *coefficients])]
        return tuple(c.real + 0.0 for c in coefficients)


@dataclass(frozen=True)
class CurveSegment(Reasoned):
    """A piece of an equilibrium curve with one verdict; `t` is the open parameter interval (ends may be
    infinite)."""

    t: tuple[float, float]
    linear: str
    verdict: str

    @classmethod
    def like(cls, sample: EquilibriumPoint, t: tuple[float, float]) -> CurveSegment:
        """A piece all of whose points are judged as this one is."""
        return cls(t, sample.linear, sample.verdict, reason=sample.reason)


@dataclass(frozen=True)
class EquilibriumCurve:
    """A curve of equilibria: point(t) -> (x1, x2, x3) for t inside the segments' intervals.

    description: what it is called, its equation and its parametrisation, with their numbers; folds are the
    points between segments where the linear verdict is degenerate; samples are equilibria spread over every
    segment.
    """

    description: Description
    point: Callable[[float], Float3] = field(repr=False, compare=False)
    segments: tuple[CurveSegment, ...] = ()
    folds: tuple[Float3, ...] = ()
    samples: tuple[EquilibriumPoint, ...] = ()

    @property
    def plane(self) -> bool:
        """Whether it stands for a plane of equilibria, through whose centre it runs."""
        return self.description.name.says(PLANE)

    @property
    def name(self) -> str:
        """What it is called, in words and SI units."""
        return self.description.name.text()

    @property
    def equation(self) -> str:
        """Its equation in symbols, in SI units."""
        return self.description.equation.text()

    @property
    def parametrisation(self) -> str:
        """Its points over the parameter, in symbols and SI units."""
        return self.description.parametrisation.text()


@dataclass(frozen=True, repr=False)
class Equilibria(Answer, Reasoned):
    """All equilibria of a scene. kind: "none", "points", "curves" (curves, possibly with points) or "all"
    (every state is one); reason: why these and no others, because: the same in words. validity: of an
    approximate law (`stabilab.physics.law_limits`), at the points; None where all laws are exact. frame: the
    principal axes, along which states are, in the frame of the tensor that was given; None where the two are
    one."""

    kind: str
    points: tuple[EquilibriumPoint, ...] = ()
    curves: tuple[EquilibriumCurve, ...] = ()
    validity: Validity | None = None
    frame: PrincipalAxes | None = field(default=None, repr=False, compare=False)


T = Poly((0, 1))
ONE_POLY = Poly((1,))


class Verdict(NamedTuple):
    """On the stability of an equilibrium, and why."""

    word: str
    reason: Reason


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

    description: Description
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
            return rounded_ratios(self.numerators, self.denominator, Fraction(t))
        except (ZeroDivisionError, OverflowError, ValueError):
            raise InputError(
                f"t = {t!r} lies at an end of the curve ({self.description.name}): no equilibrium there"
            ) from None

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
        return EquilibriumCurve(self.description, self.rounded_point, tuple(s for s, _ in pieces),
                                tuple(point.at for point in folds), tuple(samples))

    def segment(self, lo: Fraction | None, hi: Fraction | None, judge: Callable[..., tuple[str, Verdict]],
                point: Callable[..., EquilibriumPoint]) -> tuple[CurveSegment, list[EquilibriumPoint]]:
        """The segment between two neighbouring cuts (None: infinite) and its samples. judge(t): the linear
        word and the verdict, asked in its middle; point(t, word, verdict): a sample."""
        middle = values_inside(lo, hi, self.scale)
        word, verdict = judge(middle)
        samples = [point(t, word, verdict) for t in sample_parameters(lo, hi, self.scale) or [middle]]
        return CurveSegment(float_ends(lo, hi), word, verdict.word, reason=verdict.reason), samples


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
