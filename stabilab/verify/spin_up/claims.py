"""What a certificate says of a spin-up, read and judged."""
from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from ..numbers import Malformed, ball, bracket, brief, entries, field, number, shown, word
from ..precision import working
from ..zeros import above, below
from .inequality import MOST_ORDER, Inequality, Unsuited
from .moving_form import equator, moving_form
from .moving_inequality import MovingInequality
from .normal_form import form_about
from .way import Lost, Way

BITS = (96, 192, 384)  # of the way: more where fewer leave something open
MOST_STEPS = 40_000  # of all ways together: some minute


@dataclass(frozen=True)
class SpinUpClaims:
    """about: the form, a key of `FORMS`; axis (1, 2, 3; 0 in the equator), sense; orders; t: when the inequality holds; cone, least, gain: its A and z and
    the rate at which the spin grows at least, in the units of the rates; way: [(time, three brackets)], times rising."""

    about: str
    axis: int
    sense: int
    orders: tuple[int, int]
    t: Fraction
    cone: Fraction
    least: Fraction
    gain: Fraction
    way: list


def spin_up_of(table) -> SpinUpClaims:
    """The claims on a spin-up. Raises `Malformed` before anything is worked out."""
    where = "motion.spin_up"
    if not isinstance(table, dict):
        raise Malformed(f"{where}: expected an object, got {shown(table)}")
    t, cone, least, gain = (number(field(table, key, where), f"{where}.{key}") for key in ("t", "cone", "least", "gain"))
    if t < 0:
        raise Malformed(f"{where}.t: expected a time that is not before the start, got {shown(table['t'])}")
    orders = field(table, "orders", where, list)
    if len(orders) != 2 or not all(type(n) is int and 0 <= n <= MOST_ORDER for n in orders):
        raise Malformed(f"{where}.orders: expected two whole numbers up to {MOST_ORDER}, got {shown(orders)}")
    way = [_point(entry, f"{where}.way[{i}]") for i, entry in enumerate(entries(table, "way", where))]
    if any(a >= b for (a, _), (b, _) in zip(way, way[1:])):
        raise Malformed(f"{where}.way: expected rising times")
    about = word(table, "about", where, tuple(FORMS)) if "about" in table else "fixed centre"
    axes, senses = ((0,), (1,)) if about == "equator" else ((1, 2, 3), (-1, 1))
    return SpinUpClaims(about, _one_of(table, "axis", axes), _one_of(table, "sense", senses), tuple(orders), t, cone, least, gain, way)


def _one_of(table, key, known):
    value = field(table, key, "motion.spin_up")
    if type(value) is not int or value not in known:
        raise Malformed(f"motion.spin_up.{key}: expected one of {', '.join(map(str, known))}, got {shown(value)}")
    return value


def _point(entry, where):
    t, box = number(field(entry, "t", where), f"{where}.t"), field(entry, "box", where, list)
    if t < 0:
        raise Malformed(f"{where}.t: expected a time that is not before the start, got {shown(entry['t'])}")
    if len(box) != 3:
        raise Malformed(f"{where}.box: expected three brackets, got {shown(box)}")
    return t, [bracket(ends, f"{where}.box[{i}]") for i, ends in enumerate(box)]


def check_spin_up(rates, state, claims: SpinUpClaims, note) -> tuple[str, str]:
    """Findings on the way and on the inequality; ("proved", "refuted" or "not checked", reason) of the spin-up itself."""
    findings, verdict, left = [], ("not checked", ""), MOST_STEPS
    for bits in BITS:
        way = Way(rates, state, bits, left)
        try:
            findings, verdict = _judged(rates, claims, way)
        except Unsuited as error:
            findings, verdict = [], ("not checked", str(error))
            break
        except Lost as error:
            if not findings:
                verdict = "not checked", str(error)
        left -= way.steps
        if left <= 0 or (findings and all(status != "not checked" for _, status, _ in findings)):
            break
    told = {claim for claim, _, _ in findings}
    for finding in findings:
        note(*finding)
    for claim in (*(_name(t) for t, _ in claims.way), _trap(claims)):
        if claim not in told:
            note(claim, "not checked", verdict[1])
    return verdict


def _name(t):
    return f"state at t = {brief(t)}"


def _trap(claims):
    return f"trap at t = {brief(claims.t)}"


# How the form about an axis (0, 1, 2) in a sense is made, and what is made of it.
FORMS = {"fixed centre": (form_about, Inequality), "moving centre": (moving_form, MovingInequality),
         "equator": (lambda rates, axis, sense: equator(rates), MovingInequality)}


def _judged(rates, claims, way):
    make, inequality_of = FORMS[claims.about]
    with working(max(way.bits, 128)):
        form = make(rates, claims.axis - 1, claims.sense)
        if form is None or not form.M > 0:
            why = "the spin there does not turn the other two" if form is None else "the torque's component does not have the sense of the spin"
            return [(_trap(claims), "refuted", why)], ("not checked", why)
        inequality = inequality_of(form, claims.orders)
    found, states = [], {}
    for t in sorted({claims.t, *(t for t, _ in claims.way)}):
        states[t] = way.to(t)
    with working(max(way.bits, 128)):
        for t, box in claims.way:
            found.append((_name(t), *_within(states[t], box, way.steps)))
        status, why = _trapped(inequality, states[claims.t], claims)
    found.append((_trap(claims), status, why))
    return found, (status if status == "proved" else "not checked", why)


def _within(state, box, steps):
    """(status, reason) of three brackets against three balls."""
    ends = [(below(v), above(v)) for v in state]
    if all(low <= a and b <= high for (a, b), (low, high) in zip(ends, box)):
        return "proved", f"the motion enclosed anew, in {steps} steps"
    if any(b < low or high < a for (a, b), (low, high) in zip(ends, box)):
        return "refuted", "the motion enclosed anew is elsewhere"
    return "not checked", "the brackets are narrower than what encloses the motion anew"


def _trapped(inequality, state, claims):
    if not (claims.cone > 0 and claims.least > 0 and claims.gain > 0):
        return "refuted", "cone, least and gain are not all positive"
    faults, gain = inequality.faults(state, claims.cone, claims.least)
    if not faults and not gain >= ball(claims.gain):
        faults = [("the spin grows as fast as claimed", bool(gain < ball(claims.gain)))]
    if not faults:
        return "proved", f"the inequality of orders {claims.orders[0]} and {claims.orders[1]}, worked out anew, holds: the spin grows for ever"
    words = f"the inequality fails: {', '.join(words for words, _ in faults)}"
    return ("refuted" if any(surely for _, surely in faults) else "not checked"), words
