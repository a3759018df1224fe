"""The claims of a diagram against what trace forms count: at every value where they degenerate, and once
between any two of these.

Real zeros of polynomials in t are isolated by Sturm's sequences.
"""
from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from flint import fmpq_poly

from ..numbers import Malformed, brief, exact_sign, fraction, q
from .algebra import MOST, TooLarge, Work
from .claims import Claims, Event
from .equations import Count, Equations, System, count_at, critical, in_unknowns

HALVINGS = 20_000  # of one bracket; two zeros of polynomials of a certificate are farther apart


def sequence(f, work: Work) -> list:
    """Sturm's sequence of a polynomial without double zeros."""
    out = [f, f.derivative()]
    while out[-1].degree() > 0:
        work.division(out[-2], out[-1])
        rest = -(out[-2] % out[-1])
        if rest == 0:
            break
        out.append(rest / abs(rest.leading_coefficient()))
    return out


def sign_at(f, at: Fraction, work: Work) -> int:
    """The sign of a polynomial at a rational number."""
    work.value(f, at)
    return exact_sign(f(q(at)))


def changes(chain: Sequence, at: Fraction, work: Work) -> int:
    """Changes of sign of a sequence at a place."""
    signs = [s for f in chain if (s := sign_at(f, at, work))]
    return sum(a != b for a, b in zip(signs, signs[1:]))


class Root:
    """A real zero of an irreducible polynomial: the only one in (low, high), or the rational number low =
    high itself."""

    def __init__(self, polynomial, low: Fraction, high: Fraction, work: Work):
        self.polynomial, self.low, self.high, self.work = polynomial, low, high, work
        self.rising = 0 if low == high else sign_at(polynomial, high, work)

    @property
    def rational(self) -> bool:
        return self.low == self.high

    def halve(self) -> None:
        """Half the bracket; a zero that is rational has none."""
        if not self.rational:
            middle = (self.low + self.high) / 2
            if sign_at(self.polynomial, middle, self.work) == self.rising:
                self.high = middle
            else:
                self.low = middle

    def sign(self, f) -> int:
        """The sign of a polynomial at the zero."""
        if self.rational:
            return sign_at(f, self.low, self.work)
        self.work.division(f, self.polynomial)
        f = f % self.polynomial
        if f == 0:
            return 0
        self.work.common(f, f)
        chain = sequence(f / f.gcd(f.derivative()), self.work) if f.degree() > 0 else []
        for _ in range(HALVINGS):
            if not chain or (sign_at(chain[0], self.low, self.work)
                             and changes(chain, self.low, self.work) == changes(chain, self.high, self.work)):
                return sign_at(f, self.high, self.work)
            self.halve()
        raise Malformed(f"a sign that {HALVINGS} halvings do not tell")

    def within(self, low: Fraction, high: Fraction) -> bool:
        """Whether the zero lies in [low, high]."""
        for _ in range(HALVINGS):
            if low <= self.low and self.high <= high:
                return True
            if self.high < low or high < self.low or (not self.rational
                                                      and (self.high == low or high == self.low)):
                return False
            self.halve()
        raise Malformed(f"a bracket whose end {HALVINGS} halvings do not tell from a zero")


def roots(polynomials: Iterable, low: Fraction, high: Fraction, work: Work) -> list[Root]:
    """The different real zeros in [low, high] of polynomials that are not zero, rising, their brackets apart
    from one another and from the ends."""
    factors = {}
    for p in polynomials:
        if p.degree() > 0:
            work.factors(p)
            factors |= {str(f / f.leading_coefficient()): f / f.leading_coefficient() for f,
                        _ in p.factor()[1]}
    found = [root for f in factors.values() for root in _of(f, low, high, work)]
    for _ in range(HALVINGS):
        found.sort(key=lambda root: (root.low, root.high))
        near = {n for n, (a, b) in enumerate(zip(found, found[1:])) if a.high >= b.low}
        near |= ({n + 1 for n in near} | {n for n, root in enumerate(found) if not root.rational
                                          and (root.low == low or root.high == high)})
        if not near:
            return found
        for n in near:
            found[n].halve()
    raise Malformed(f"two values that {HALVINGS} halvings do not tell apart")


def _of(f, low: Fraction, high: Fraction, work: Work) -> list[Root]:
    if f.degree() == 1:
        exact = -fraction(f[0] / f[1])
        return [Root(f, exact, exact, work)] if low <= exact <= high else []
    chain, out = sequence(f, work), []
    todo = [(low, high, changes(chain, low, work), changes(chain, high, work))]
    while todo:
        a, b, first, last = todo.pop()
        if first - last == 1:
            out.append(Root(f, a, b, work))
        elif first - last > 1:
            c = (a + b) / 2
            middle = changes(chain, c, work)
            todo += [(a, c, first, middle), (c, b, middle, last)]
    return out


class Between:
    """A place between two zeros, or at an end of the range: a rational number."""

    def __init__(self, at: Fraction, work: Work):
        self.at, self.work = at, work

    @property
    def polynomial(self):
        """t less this number."""
        return fmpq_poly([q(-self.at), 1])

    def sign(self, f) -> int:
        """The sign of a polynomial there."""
        return sign_at(f, self.at, self.work)


@dataclass(frozen=True)
class Place:
    """root: of a critical polynomial, or None for all values between two of them; count: the zeros there."""

    root: Root | None
    count: Count


def check_diagram(claims: Claims, note, work: Work | None = None) -> None:
    """Findings on all claims. work: how much they may take (None: `work.MOST`)."""
    try:
        _check(claims, note, work or Work())
    except TooLarge:
        parts = f"{len(claims.pieces)} pieces and {len(claims.events)} events"
        note(parts, "not checked",
             f"too large: degrees and digits ask for more than {MOST:,} operations on bits, and a file from "
             f"a stranger is given no more")


def _check(claims: Claims, note, work: Work) -> None:
    equations = Equations.of(claims)
    if claims.variables == "physical":
        whole = all(_positive(D, claims.low, claims.high, work) for D in claims.scene["inertia"])
        note("the moments of inertia are positive all over the range", "proved" if whole else "refuted",
             "by Sturm's sequences")
        if not whole:
            return
    system = _system(claims, equations, note)
    if system is None:
        return
    places = _places(system, claims.low, claims.high, work)
    changes = [n for n, place in enumerate(places) if place.root
               and any(side.count.real != place.count.real for side in _sides(places, n))]
    left = set(changes)
    for event in claims.events:
        _check_event(event, places, changes, left, note)
    _check_pieces(claims, places, changes, note)
    missed = sorted(_near(places[n].root) for n in left)
    between = (
        f"{sum(p.root is not None for p in places)} critical values, {sum(p.root is None for p in places)} "
        f"counts between them")
    told = f"near {', '.join(missed)} the number changes too" if missed else f"trace forms: {between}"
    note("the events are complete", "refuted" if missed else "proved", told)


def _positive(f, low: Fraction, high: Fraction, work: Work) -> bool:
    return f != 0 and exact_sign(f(q(low))) > 0 and not roots([f], low, high, work)


def _system(claims: Claims, equations: Equations, note) -> System | None:
    """What is counted; None where the claims fit no such count."""
    if claims.counted == "isolated":
        zero_together = [in_unknowns(f) for f in (*equations.conditions, *equations.rates)]
        return System(3, zero_together, [in_unknowns(equations.n)])
    axis = claims.axis - 1
    claim = f"the torque lies on principal axis {claims.axis}, and no wheel along it"
    if not equations.along(axis):
        note(claim, "refuted", "a rate across it does not vanish there")
        return None
    note(claim, "proved", "in the plane across it one condition is left")
    one = equations.across(axis, equations.rates[axis])
    if claims.start is None:
        return System(2, [one, equations.across(axis, equations.m)], endless=equations.torque(axis))
    law = equations.kept(axis)
    if law is None:
        note("the curve that a motion keeps to", "refuted", "no law of this form is constant")
        return None
    note("the curve that a motion keeps to", "proved",
         "the rate of its law along every motion vanishes identically")
    law = equations.rise(law, claims.start)
    return System(2, [one, equations.across(axis, law)], [equations.across(axis, equations.m)])


def _places(system: System, low: Fraction, high: Fraction, work: Work) -> list[Place]:
    """Critical values and the intervals between them, rising."""
    found = roots(critical(system, work), low, high, work)
    out: list[Place] = []
    ends: list[Any] = [None, *found, None]
    for first, second in zip(ends, ends[1:]):
        a, b = first.high if first else low, second.low if second else high
        if a < b:  # at an end of the range there may be none
            out.append(Place(None, count_at(system, Between((a + b) / 2, work), work)))
        if second:
            out.append(Place(second, count_at(system, second, work)))
    return out


def _sides(places: list[Place], n: int) -> list[Place]:
    return [places[k] for k in (n - 1, n + 1) if 0 <= k < len(places)]


def _check_event(event: Event, places: list[Place], changes: list[int], left: set[int], note) -> None:
    held = [n for n in changes if (root := places[n].root) and root.within(event.low, event.high)]
    if len(held) != 1:
        note(event.claim, "refuted",
             f"between these bounds there are {len(held)} values at which the number changes, not one")
        return
    left.discard(held[0])
    real = places[held[0]].count.real
    note(event.claim, "proved" if real == event.count else "refuted",
         "the signature of the trace form at this value, exactly" if real is not None else
         "the equations leave endless zeros there")


def _check_pieces(claims: Claims, places: list[Place], changes: list[int], note) -> None:
    """Findings on the pieces: those between the values at which the number changes."""
    runs: list[list[Place]] = [[]]
    for n, place in enumerate(places):
        if n in changes:
            runs.append([])
        else:
            runs[-1].append(place)
    runs = [run for run in runs if run]
    if len(runs) != len(claims.pieces):
        note(f"{len(claims.pieces)} pieces", "refuted", f"there are {len(runs)}")
        return
    for number, (piece, run) in enumerate(zip(claims.pieces, runs), 1):
        told = ("endless equilibria" if piece.count is None
                else f"{piece.count} counted" + ("" if piece.stable is None else f", {piece.stable} stable"))
        right = all(place.count.real == piece.count for place in run)
        stable = {_stable(claims, place.count) for place in run if place.root is None}
        if right and piece.stable is not None and None in stable:
            note(f"piece {number}: {told}", "not checked",
                 "at some value of it the sign that tells stability is open")
            continue
        right = right and (piece.stable is None or stable == {piece.stable})
        note(f"piece {number}: {told}", "proved" if right else "refuted",
             "signatures of trace forms, at one value of each interval between critical values")


def _stable(claims: Claims, count: Count) -> int | None:
    """How many are stable; None where a sign is open. On a motion's curve those with m > 0; of isolated ones
    none, where n is not zero."""
    if count.real is None or not count.tests:
        return 0
    (signature, nowhere_zero), = count.tests
    if not nowhere_zero:
        return None
    return (count.real + signature) // 2 if claims.counted == "motion" else 0


def _near(root: Root | None) -> str:
    return brief((root.low + root.high) / 2) if root else ""
