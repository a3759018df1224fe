"""Is the fate of the state what the certificate says, and do its brackets hold the extremes and the period?"""
from __future__ import annotations

from .facts import Facts
from .numbers import Malformed, ball, bracket, exact_sign, field, numbers
from .orbit import Orbit
from .period import period_of, round_once
from .zeros import Open, above, below

BITS, MOST_BITS = 192, 6144


def check_motion(rates, claims, note):
    """Findings on the certificate's part `motion`."""
    state = numbers(field(claims, "state", "motion"), "motion.state", 3)
    fate = field(claims, "fate", "motion", str)
    claim = f"fate: {fate}"
    if not any(rates.at(state)):
        note(claim, "proved" if fate == "equilibrium" else "refuted", "the rates vanish exactly at the state")
        return
    if fate in ("equilibrium", "undecided"):
        note(claim, "refuted" if fate == "equilibrium" else "not checked", "the rates do not vanish exactly at the state")
        return
    orbit = _orbit(rates, state)
    if orbit is None:
        note(claim, "not checked", "the scene has no reduction to one degree of freedom")
        return
    found = _at_rising_precision(lambda: Facts(orbit))
    if found is None:
        note(claim, "not checked", f"not decided with {MOST_BITS} bits")
        return
    axis = orbit.axis + 1 if found.fate == "spin-up" else 0
    sense = exact_sign(orbit.tilt) if axis else 0
    said = fate, claims.get("axis", axis), claims.get("sense", sense)
    note(claim, "proved" if said == (found.fate, axis, sense) else "refuted", found.reason)
    if said[0] == found.fate:
        _check_numbers(claims, orbit, found, note)


def _orbit(rates, state):
    """The orbit about the torque's axis, or, without one, about the first axis that allows it, circles first."""
    acting = [i for i in range(3) if rates.m[i]]
    if len(acting) > 1:
        return None
    made = []
    for axis in acting or range(3):
        try:
            made.append(Orbit(rates, axis, state))
        except ValueError:
            pass
    return min(made, key=lambda o: (-1, 1, 0).index(o.kind), default=None)


def _at_rising_precision(question):
    """question() at more and more bits while it raises Open; None when the most are not enough."""
    from flint import ctx
    bits = BITS
    while bits <= MOST_BITS:
        with ctx.workprec(bits):
            try:
                return question()
            except Open:
                bits *= 2
    return None


def _check_numbers(claims, orbit, found, note):
    """The brackets of extremes and period."""
    if claims.get("extremes") is not None:
        _check_extremes(claims["extremes"], found.extremes, note)
    if claims.get("period") is not None:
        low, high = bracket(claims["period"], "motion.period")
        if found.fate != "bounded":
            note("period", "refuted", "a motion that spins up does not repeat")
            return
        true = _at_rising_precision(lambda: _period(orbit, Facts(orbit)))
        if true is None:
            note("period", "not checked", "the verified quadrature did not close")
        else:
            note("period", _within(true, low, high), "verified quadrature between the turning points, or round the circle")


def _period(orbit, facts):
    if orbit.forceless():
        return orbit.turn / abs(ball(orbit.y0))
    return round_once(orbit) if facts.round else period_of(orbit, facts.ends)


def _check_extremes(claimed, found, note):
    if not (isinstance(claimed, list) and [len(pair) if isinstance(pair, list) else 0 for pair in claimed] == [2, 2, 2]):
        raise Malformed(f"motion.extremes: expected three pairs of brackets, got {claimed!r:.80}")
    for i, pair in enumerate(claimed):
        for word, said, true in zip(("least", "greatest"), pair, found[i]):
            claim = f"{word} x{i + 1}"
            if said is None or true is None:
                note(claim, "proved" if said is None and true is None else "refuted", "unbounded" if true is None else "bounded")
            else:
                note(claim, _within(true, *bracket(said, f"motion.extremes[{i}]")), "roots on the potential")


def _within(true, low, high) -> str:
    least, most = below(true), above(true)
    if low <= least and most <= high:
        return "proved"
    return "not checked" if least <= high and low <= most else "refuted"
