"""Is the fate of the state what the certificate says, and do its brackets hold the extremes and the period?"""
from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import partial

from .closed import ClosedClaims, check_closed, closed_of
from .facts import Facts
from .numbers import Malformed, ball, bracket, exact_sign, field, numbers, shown, word
from .orbit import Orbit
from .period import period_of, round_once
from .precision import working
from .spin_up.claims import SpinUpClaims, check_spin_up, spin_up_of
from .zeros import Open, Spent, above, below

BITS, MOST_BITS = 192, 6144
CLOSER = 4  # times the bits that settled the fate: a bracket that these do not tell from the true value is left open
GOALS = (48, 96, 192)  # bits of the period, likewise
FATES = ("bounded", "spin-up", "separatrix", "equilibrium", "undecided")


@dataclass(frozen=True)
class Claims:
    """The certificate's part `motion`, read. None: nothing is claimed; within extremes: unbounded."""

    state: list[Fraction]
    fate: str
    axis: int | None
    sense: int | None
    extremes: list | None
    period: tuple[Fraction, Fraction] | None
    spin_up: SpinUpClaims | None
    closed: ClosedClaims | None = None

    @property
    def words(self) -> str:
        """Fate, axis and sense as claimed."""
        spin = [f"{name} {value}" for name, value in (("axis", self.axis), ("sense", self.sense)) if value]
        return ", ".join([f"fate: {self.fate}", *spin])


def motion_of(table) -> Claims:
    """The claims on a motion. Raises `Malformed` before anything is worked out."""
    extremes, period, spin_up, closed = (table.get(key) if isinstance(table, dict) else None for key in ("extremes", "period", "spin_up", "closed"))
    return Claims(numbers(field(table, "state", "motion"), "motion.state", 3), word(table, "fate", "motion", FATES),
                  _whole(table, "axis", range(4)), _whole(table, "sense", range(-1, 2)),
                  None if extremes is None else _pairs(extremes), None if period is None else bracket(period, "motion.period"),
                  None if spin_up is None else spin_up_of(spin_up), None if closed is None else closed_of(closed))


def _whole(table, key, known):
    """A whole number of a few, or None where it is not claimed; truth values are none."""
    value = table.get(key)
    if value is not None and (type(value) is not int or value not in known):
        raise Malformed(f"motion.{key}: expected {known[0]} to {known[-1]}, got {shown(value)}")
    return value


def _pairs(claimed):
    """Three pairs of brackets, None for what is unbounded."""
    if not (isinstance(claimed, list) and [len(pair) if isinstance(pair, list) else 0 for pair in claimed] == [2, 2, 2]):
        raise Malformed(f"motion.extremes: expected three pairs of brackets, got {shown(claimed)}")
    return [[None if ends is None else bracket(ends, f"motion.extremes[{i}][{k}]") for k, ends in enumerate(pair)] for i, pair in enumerate(claimed)]


def check_motion(rates, claims, note):
    """Findings on the certificate's part `motion`: every claim of it is among them, unless the fate is wrong."""
    if not any(rates.at(claims.state)):
        _check_rest(claims, note)
        return
    if claims.fate == "equilibrium":
        note(claims.words, "refuted", "the rates do not vanish exactly at the state")
        return
    if claims.closed:
        _check_closed(rates, claims, note)
        return
    if claims.spin_up:
        _check_trapped(rates, claims, note)
        return
    orbit = _orbit(rates, claims.state)
    proof = orbit and _Proof(orbit)
    found = proof and at_rising_precision(proof.facts)
    if found is None:
        _leave_open(claims, f"not decided with {MOST_BITS} bits" if orbit else "the scene has no reduction to one degree of freedom", note)
        return
    axis = orbit.axis + 1 if found.fate == "spin-up" else 0
    _check_words(claims, found.fate, axis, exact_sign(orbit.tilt) if axis else 0, found.reason, note)
    if claims.fate in (found.fate, "undecided"):
        _check_numbers(claims, proof, found, note)


def _check_rest(claims, note):
    """A state at which the rates vanish exactly: it is its own extremes, and nothing repeats."""
    _check_words(claims, "equilibrium", 0, 0, "the rates vanish exactly at the state", note)
    for claim, ends, x in _named(claims.extremes, [(x, x) for x in claims.state]):
        right = ends is not None and ends[0] <= x <= ends[1]
        note(claim, "proved" if right else "refuted", "the state does not change")
    if claims.period is not None:
        note("period", "refuted", "an equilibrium has no period")
    if claims.spin_up:
        note("spin-up", "refuted", "the state does not change")
    if claims.closed:
        note(f"law: {claims.closed.law}", "refuted", "the state does not change")


def _check_trapped(rates, claims, note):
    """A motion that an inequality traps in spin-up."""
    status, reason = check_spin_up(rates, claims.state, claims.spin_up, note)
    if status == "proved":
        _check_words(claims, "spin-up", claims.spin_up.axis, claims.spin_up.sense, reason, note)
    else:
        note(claims.words, "not checked", reason)
    for claim, *_ in _named(claims.extremes, [(None, None)] * 3):
        note(claim, "not checked", "the inequality says nothing of the time before")
    if claims.period is not None:
        note("period", "refuted" if status == "proved" else "not checked", "a motion that spins up does not repeat")


def _check_closed(rates, claims, note):
    """A motion that a closed solution tells."""
    fate, axis, sense, reason = check_closed(rates, claims.state, claims.closed, note)
    if fate:
        _check_words(claims, fate, axis, sense, reason, note)
    else:
        note(claims.words, "not checked", reason)
    for claim, *_ in _named(claims.extremes, [(None, None)] * 3):
        note(claim, "not checked", "the closed solution bounds sizes alone")
    if claims.period is not None:
        note("period", "refuted" if fate == "spin-up" else "not checked", "the closed solution is not asked for a period")
    if claims.spin_up:
        check_spin_up(rates, claims.state, claims.spin_up, note)


def _check_words(claims, fate, axis, sense, reason, note):
    """Fate, axis and sense against what is found; what is not claimed is not compared."""
    said = [(claims.axis, axis), (claims.sense, sense)]
    if claims.fate != "undecided":
        said.append((claims.fate, fate))
    if any(claimed not in (None, true) for claimed, true in said):
        note(claims.words, "refuted", reason)
    elif claims.fate == "undecided":
        note(claims.words, "not checked", f"the certificate leaves open what is proved: {fate}: {reason}")
    else:
        note(claims.words, "proved", reason)


def _leave_open(claims, why, note):
    """Every claim of the motion is not checked, for one reason."""
    note(claims.words, "not checked", why)
    for claim, *_ in _named(claims.extremes, [(None, None)] * 3):
        note(claim, "not checked", why)
    if claims.period is not None:
        note("period", "not checked", why)


def _named(claimed, found):
    """(claim, claimed, found) of the six extremes."""
    for i, pair in enumerate(claimed or ()):
        for word_, said, true in zip(("least", "greatest"), pair, found[i]):
            yield f"{word_} x{i + 1}", said, true


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


def at_rising_precision(question, least=None, most=None):
    """question() at more and more bits while it raises Open; None when the most are not enough, or the work is too much."""
    bits = least or BITS
    while bits <= (most or MOST_BITS):
        with working(bits):
            try:
                return question()
            except Spent:
                return None
            except Open:
                bits *= 2
    return None


def _check_numbers(claims, proof, found, note):
    """The brackets of extremes and period."""
    for claim, said, true in _named(claims.extremes, [[(i, k) for k in (0, 1)] for i in range(3)]):
        i, k = true
        if said is None or found.extremes[i][k] is None:
            unbounded = found.extremes[i][k] is None
            note(claim, "proved" if unbounded and said is None else "refuted", "unbounded" if unbounded else "bounded")
        else:
            status = at_rising_precision(lambda i=i, k=k, said=said: _within(proof.facts().extremes[i][k], *said), found.bits, CLOSER * found.bits)
            note(claim, status or "not checked", "roots on the potential" if status else "the bracket ends too close to the true value")
    if claims.period is not None and found.fate != "bounded":
        note("period", "refuted", "a motion that spins up does not repeat")
    elif claims.period is not None:
        status = _period_status(proof, claims.period, found.bits)
        note("period", status or "not checked", "verified quadrature between the turning points, or round the circle" if status
             else "the verified quadrature did not close, or not on one side of the bracket's ends")


def _period_status(proof, said, bits):
    """Whether the bracket holds the period, by quadratures to more and more digits; None where they leave it open."""
    for goal in GOALS:
        true = at_rising_precision(partial(proof.period, goal), max(bits, 4 * goal))
        try:
            return true and _within(true, *said)
        except Open:
            pass
    return None


class _Proof:
    """What is proved of one orbit, kept by the number of bits it was worked out with."""

    def __init__(self, orbit):
        self.orbit, self._known = orbit, {}

    def facts(self) -> Facts:
        """At the working precision. Raises Open where it does not do."""
        from flint import ctx
        if ctx.prec not in self._known:
            self._known[ctx.prec] = Facts(self.orbit)
        return self._known[ctx.prec]

    def period(self, goal):
        """The period to about so many bits, as a ball."""
        facts = self.facts()
        if self.orbit.forceless():
            return self.orbit.turn / abs(ball(self.orbit.y0))
        return round_once(self.orbit, goal) if facts.round else period_of(self.orbit, facts.ends, goal)


def _within(true, low, high) -> str:
    """"proved" or "refuted": that the ball lies in the bracket. Raises Open where it is neither inside nor outside."""
    least, most = below(true), above(true)
    if low <= least and most <= high:
        return "proved"
    if least <= high and low <= most:
        raise Open
    return "refuted"
