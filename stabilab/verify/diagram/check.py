"""The claims of a diagram against what trace forms count: at every value where they degenerate, and once
between any two of these.
"""
from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from flint import fmpq_poly

from ..numbers import brief, exact_sign, q
from ..roots import TOO_LARGE, Root, TooLarge, Work, roots
from .claims import Claims, Event
from .equations import Count, Equations, System, count_at, critical, in_unknowns


@dataclass(frozen=True)
class Place:
    """root: of a critical polynomial, or None for all values between two of them; count: the zeros there."""

    root: Root | None
    count: Count


def check_diagram(claims: Claims, note: Callable[..., None], work: Work | None = None) -> None:
    """Findings on all claims. work: how much they may take (None: `work.MOST`)."""
    try:
        _check(claims, note, work or Work())
    except TooLarge:
        parts = f"{len(claims.pieces)} pieces and {len(claims.events)} events"
        note(parts, "not checked", TOO_LARGE)


def _check(claims: Claims, note: Callable[..., None], work: Work) -> None:
    equations = Equations.of(claims)
    if claims.variables == "physical":
        full = all(_positive(D, claims.low, claims.high, work) for D in claims.scene["inertia"])
        note("the moments of inertia are positive all over the range", "proved" if full else "refuted",
             "by Sturm's sequences")
        if not full:
            return
    system = _system(claims, equations, note)
    if system is None:
        return
    places = _places(system, claims.low, claims.high, work)
    changes = [n for n, location in enumerate(places) if location.root
               and any(side.count.real != location.count.real for side in _sides(places, n))]
    left = set(changes)
    for event in claims.events:
        _check_event(event, places, changes, left, note)
    _check_pieces(claims, places, changes, note)
    missed = sorted(_near(places[n].root) for n in left)
    between = (f"{sum(p.root is not None for p in places)} critical values, "
               f"{sum(p.root is None for p in places)} counts between them")
    printed = f"near {', '.join(missed)} the number changes too" if missed else f"trace forms: {between}"
    note("the events are complete", "refuted" if missed else "proved", printed)


def _positive(f: fmpq_poly, low: Fraction, high: Fraction, work: Work) -> bool:
    return f != 0 and exact_sign(f(q(low))) > 0 and not roots([f], low, high, work)


def _system(claims: Claims, equations: Equations, note: Callable[..., None]) -> System | None:
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
    item = equations.across(axis, equations.rates[axis])
    if claims.start is None:
        return System(2, [item, equations.across(axis, equations.m)], endless=equations.torque(axis))
    law = equations.kept(axis)
    if law is None:
        note("the curve that a motion stays on", "refuted", "no law of this form is constant")
        return None
    note("the curve that a motion stays on", "proved",
         "the rate of its law along every motion vanishes identically")
    law = equations.rise(law, claims.start)
    return System(2, [item, equations.across(axis, law)], [equations.across(axis, equations.m)])


def _places(system: System, low: Fraction, high: Fraction, work: Work) -> list[Place]:
    """Critical values and the intervals between them, rising."""
    result = roots(critical(system, work), low, high, work)
    out: list[Place] = []
    ends: list[Any] = [None, *result, None]
    for first, second in zip(ends, ends[1:]):
        a, b = first.high if first else low, second.low if second else high
        if a < b:  # at an end of the range there may be none
            between = (a + b) / 2
            at = Root(fmpq_poly([q(-between), 1]), between, between, work)
            out.append(Place(None, count_at(system, at, work)))
        if second:
            out.append(Place(second, count_at(system, second, work)))
    return out


def _sides(places: list[Place], n: int) -> list[Place]:
    return [places[k] for k in (n - 1, n + 1) if 0 <= k < len(places)]


def _check_event(event: Event, places: list[Place], changes: list[int], left: set[int],
                 note: Callable[..., None]) -> None:
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


def _check_pieces(claims: Claims, places: list[Place], changes: list[int], note: Callable[..., None]) -> None:
    """Findings on the pieces: those between the values at which the number changes."""
    runs: list[list[Place]] = [[]]
    for n, location in enumerate(places):
        if n in changes:
            runs.append([])
        else:
            runs[-1].append(location)
    runs = [run for run in runs if run]
    if len(runs) != len(claims.pieces):
        note(f"{len(claims.pieces)} pieces", "refuted", f"there are {len(runs)}")
        return
    for number, (piece, run) in enumerate(zip(claims.pieces, runs), 1):
        printed = ("endless equilibria" if piece.count is None
                else f"{piece.count} counted" + ("" if piece.stable is None else f", {piece.stable} stable"))
        right = all(index.count.real == piece.count for index in run)
        stable = {_stable(claims, index.count) for index in run if index.root is None}
        if right and piece.stable is not None and None in stable:
            note(f"piece {number}: {printed}", "not checked",
                 "at some value of it the sign that tells stability is open")
            continue
        right = right and (piece.stable is None or stable == {piece.stable})
        note(f"piece {number}: {printed}", "proved" if right else "refuted",
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
