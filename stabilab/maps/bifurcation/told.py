"""Where equilibria form curves for every value of the range: which curves, and the values at which these become others, in words.

Without a torque they are lines along principal axes that carry no wheel, planes of equal moments, and the curve on which momentum is along the rotation.
Under a torque along equal moments of inertia they are a conic in the plane across it. Which of these there are hangs on differences of moments, on parts of
wheel and torque that vanish, on lambda . M, and on the determinant of the conic alone: polynomials in what varies.
"""
from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from typing import TYPE_CHECKING, NamedTuple

from ...equilibrium.gyrostat import gyrostat_equilibria
from ...numbers.vectors import dot
from ...physics.coefficients import effective
from .critical import Cut, between, cuts
from .eliminated import univariate
from .family import Family
from .result import CURVES, ENDLESS, Diagram, Event, Piece

if TYPE_CHECKING:
    from flint import fmpq_mpoly


class Told(NamedTuple):
    """What there is at one value: how many equilibria, and in words."""

    number: int
    words: str


def told(family: Family, what: str) -> Diagram:
    """The diagram in words over one number."""
    span, named = family.spans[0], list(_named(family))
    parts = [factor for f, _ in named if not f.is_constant() for factor, _ in f.factor()[1]]
    found = cuts((univariate(f, 2) for f in parts), span.low, span.high)
    ends = [(span.low, span.low), *((cut.low, cut.high) for cut in found), (span.high, span.high)]
    values = [float(span.low), *(float(cut.number) for cut in found), float(span.high)]
    pieces: list[Piece] = []
    events: list[Event] = []
    for n, ((_, low), (high, _)) in enumerate(zip(ends, ends[1:])):
        event = _event(family, found[n - 1], named) if n else None
        if low < high:
            sample = between(low, high)
            there = _at(family, sample)
            same = pieces and there == (pieces[-1].count, pieces[-1].words) and (event is None or (event.count, event.words) == there)
            if same:
                pieces[-1] = Piece(pieces[-1].low, values[n + 1], there.number, pieces[-1].sample, (), words=there.words)
                continue
            pieces.append(Piece(values[n], values[n + 1], there.number, sample, (), words=there.words))
        if event is not None:
            events.append(event)
    return Diagram(family, CURVES, what, tuple(pieces), tuple(events))


def _at(family: Family, value: Fraction) -> Told:
    found = gyrostat_equilibria(effective(family.at((value,)).scene))
    if found.kind == "all":
        return Told(ENDLESS, "every state is an equilibrium")
    if found.kind == "none":
        return Told(0, "")
    return Told(ENDLESS if found.curves else len(found.points), ", ".join(curve.name for curve in found.curves))


def _event(family: Family, cut: Cut, named: list[tuple[fmpq_mpoly, str]]) -> Event:
    number, exact = cut.number, cut.number.rational
    here = _at(family, exact) if exact is not None else Told(ENDLESS, "")
    why = [words for f, words in named if number.reduced(univariate(f, 2)) == 0]
    return Event(float(number), exact, tuple(int(c) for c in number.polynomial.numer().coeffs()), number.index, ("curve",), here.number, (),
                 here.words or "; ".join(dict.fromkeys(why)))


def _named(family: Family) -> Iterator[tuple[fmpq_mpoly, str]]:
    """(polynomial, what is so where it vanishes) of all that may change the curves; those that vanish all over the range are left out."""
    n = family.numbers
    D, lam, M = n["D"], n["lam"], n["M"]
    load = dot(lam, M)
    rows = [(D[i] - D[j], f"moments of inertia {i + 1} and {j + 1} are equal") for i in range(3) for j in range(i)]
    rows += [(lam[i], f"the wheel's part along axis {i + 1} vanishes") for i in range(3)]
    rows += [(M[i], f"the torque's part along axis {i + 1} vanishes") for i in range(3)]
    rows += [(load, "the wheel is across the torque")]
    for c in range(3):
        i, j = (c + 1) % 3, (c + 2) % 3
        rows.append(((D[i] - D[c]) * dot(M, M) + lam[c] * (lam[j] * M[i] - lam[i] * M[j]), "the conic falls apart into lines"))
    return ((f, words) for f, words in rows if not f.is_zero())
