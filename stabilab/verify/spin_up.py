"""A spin-up off the axes, checked: the motion is enclosed by Taylor series in balls up to the state at which
the inequality is claimed, then the inequality is tried there.

x_i' = kappa_i x_j x_k + rho_i x_k + sigma_i x_j + m_i from an exact start. The set that holds the state is c
+ P E: c and the matrix P exact, E a box. A step takes c along by its Taylor polynomial, P by the derivative J
of the motion (entries as balls over the whole set; the mean value theorem), and adds what both err by to E,
through the inverse of P. P follows the stretching of the true motion alone, so its inverse needs no more bits
than that stretching takes.

The tail of a series. With alpha_n = |a_n| h^n, n <= N, P their sum and T the sum of all later ones, the
recursion (n + 1) a_(n+1) = ... summed from n = N on says

    T_i <= D_i + h/(N + 1) [|kappa| (P_j T_k + T_j P_k + T_j T_k) + |rho| T_k + |sigma| T_j],
    D_i  = h/(N + 1) [|kappa| sum over m + n >= N of alpha_j,m alpha_k,n + |rho| alpha_k,N + |sigma|
    alpha_j,N]

for each partial sum in terms of the one before. So any T with which the right side is at most T bounds the
tail, by induction. The series of J likewise, linear in its own tail.
"""
from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from operator import mul
from typing import Any

from flint import arb, arb_mat

from .inequality import MOST_ORDER, Inequality, MovingInequality, Unsuited
from .normal_form import equator, form_about, moving_form
from .numbers import (
    AHEAD,
    Malformed,
    Rates,
    above,
    ball,
    below,
    brackets,
    brief,
    entries,
    field,
    number,
    shown,
    whole,
    word,
    working,
)

STEP_RATIO = 20  # times the present step that later ones may be, in the mean
LINEAR_BITS, LINEAR_ORDER = 64, 9  # of J: what it errs by multiplies the width of the set alone


class Lost(Exception):
    """The motion could not be followed: why."""


class Way:
    """The set along the motion from three exact numbers, at the time t (exact). bits: of the centre; allowed:
    steps."""

    def __init__(self, rates: Rates, state: Sequence[Fraction], bits: int, allowed: int):
        self.allowed = allowed
        self.bits, self.order, self.t, self.steps = bits, bits // 5 + 12, Fraction(0), 0
        with working(bits):
            self.numbers = _in_balls(rates)
            start = [ball(v) for v in state]
            self.centre = [v.mid() for v in start]
            self.box = [v.rad() for v in start]
            self.P = arb_mat([[int(i == j) for j in range(3)] for i in range(3)])
        with working(LINEAR_BITS):
            self.coarse = _in_balls(rates)

    def to(self, t: Fraction):
        """The state at a later time, as three balls."""
        with working(self.bits):
            while self.t < t:
                if self.steps >= self.allowed:
                    raise Lost(f"not followed beyond {self.steps} steps, t = {brief(self.t)}")
                self._step(t)
            return [c + r for c, r in zip(self.centre, self._reach())]

    def _reach(self):
        """c + P E less c: balls about zero."""
        return (self.P * _column(map(_about_zero, self.box))).entries()

    def _step(self, t: Fraction):
        a = _series(self.numbers, self.centre, self.order)
        h = self._length(a)
        if t - self.t > STEP_RATIO * h * (self.allowed - self.steps):
            raise Lost(f"not followed beyond t = {brief(self.t)}: at this pace {self.allowed} steps do not "
                       f"reach {brief(t)}")
        around = [c + r for c, r in zip(self.centre, self._reach())]
        with working(LINEAR_BITS):
            wide = _series(self.coarse, around, LINEAR_ORDER)
            columns = [_linear(self.coarse, wide, j, LINEAR_ORDER) for j in range(3)]
        h = min(h, t - self.t)
        for _ in range(40):
            length = ball(h)
            tail = _tail(self.numbers, a, length)
            with working(LINEAR_BITS):
                wide_tail = _tail(self.coarse, wide, length)
                ends = (wide_tail
                        and [_linear_end(self.coarse, wide, wide_tail, column, length) for column in columns])
            if tail and ends and None not in ends:
                break
            h /= 2
        else:
            raise Lost(f"no step closes at t = {brief(self.t)}: the set is too wide")
        end = [_value(row, length) + _about_zero(bound) for row, bound in zip(a, tail[1])]
        self._carry(end, arb_mat(ends).transpose())
        self.t, self.steps = self.t + h, self.steps + 1

    def _carry(self, end: Sequence[arb], J: arb_mat):
        """The set at the end of a step: its centre a ball, J the derivative over the set."""
        product, E = J * self.P, _column(map(_about_zero, self.box))
        self.centre, self.P = [v.mid() for v in end], product.mid()
        left = _column(v - v.mid() for v in end) + (product - self.P) * E
        try:
            self.box = [v.abs_upper() for v in (E + self.P.inv() * left).entries()]
        except ZeroDivisionError:
            raise Lost("the set's directions have become parallel") from None
        if not all(v.is_finite() for v in (*self.box, *self.centre)):
            raise Lost(f"the set has no bounds any more at t = {brief(self.t)}")

    def _length(self, a: Sequence[list[arb]]) -> Fraction:
        """A step after which the last terms are some 2^-bits of the state: 24 binary digits of it."""
        size = max((abs(row[0]).abs_upper() for row in a), key=float)
        size = size if size > 0 else max((abs(row[1]).abs_upper() for row in a), key=float)
        lengths = []
        for n in (self.order - 1, self.order):
            top = max((abs(row[n]).abs_upper() for row in a), key=lambda v: v)
            if top > 0:
                lengths.append((size / top * ball(Fraction(1, 2**self.bits))).root(n))
        length = float(min(lengths)) if lengths else 1.0
        if not 1e-300 < length < 1e300:
            raise Lost(f"no step is found at t = {brief(self.t)}")
        exponent = 0
        while length < 2**23:
            length, exponent = length * 2, exponent + 1
        while length >= 2**24:
            length, exponent = length / 2, exponent - 1
        return Fraction(int(length)) / Fraction(2) ** exponent


def _in_balls(rates: Rates):
    return [[ball(v) for v in row] for row in (rates.kappa, rates.rho, rates.sigma, rates.m)]


def _nothing():
    return arb()


def _column(values):
    return arb_mat([[v] for v in values])


def _about_zero(reach: arb):
    """The ball of all numbers within `reach`."""
    return arb(0, reach.abs_upper())


def _series(numbers: Sequence[list[arb]], start: Sequence[arb], order: int):
    """Taylor coefficients of the three components, as balls."""
    kappa, rho, sigma, m = numbers
    rows = [[v] for v in start]
    for n in range(order):
        backward = [row[::-1] for row in rows]
        for i, (j, k) in enumerate(AHEAD):
            new = (kappa[i] * sum(map(mul, rows[j], backward[k])) + rho[i] * backward[k][0]
                   + sigma[i] * backward[j][0])
            rows[i].append((new if n else new + m[i]) / (n + 1))
    return rows


def _linear(numbers: Sequence[list[arb]], x: Sequence[list[arb]], column: int, order: int):
    """Taylor coefficients of one column of the derivative along the series x."""
    kappa, rho, sigma, _ = numbers
    V = [[ball(int(i == column))] for i in range(3)]
    for n in range(order):
        back = [row[n::-1] for row in x]
        new = [kappa[i] * (sum(map(mul, V[k], back[j])) + sum(map(mul, V[j], back[k]))) + rho[i] * V[k][n]
               + sigma[i] * V[j][n]
               for i, (j, k) in enumerate(AHEAD)]
        for i, row in enumerate(V):
            row.append(new[i] / (n + 1))
    return V


def _sizes(rows: Sequence[list[arb]], h: arb):
    """|c_n| h^n, upper bounds, and their sums."""
    powers = [ball(1)]
    for _ in rows[0][1:]:
        powers.append(powers[-1] * h)
    sizes = [[(c * p).abs_upper() for c, p in zip(row, powers)] for row in rows]
    return sizes, [sum(row).abs_upper() for row in sizes]


def _beyond(item: Sequence[arb], other: Sequence[arb]):
    """Sum of one_m other_n over m + n >= N, both up to N."""
    tails, total = [], _nothing()
    for value in reversed(other):
        total = total + value
        tails.append(total)  # tails[m]: the sum of other_n over n >= N - m
    return sum(map(mul, item, tails), _nothing())


def _tail(numbers: Sequence[list[arb]], rows: Sequence[list[arb]], h: arb):
    """(sums, tails) of a series at h; None where no tail is found."""
    sizes, sums = _sizes(rows, h)
    kappa, rho, sigma, _ = [[abs(v) for v in row] for row in numbers]
    fraction = h / len(rows[0])
    resolved = [fraction * (kappa[i] * _beyond(sizes[j], sizes[k]) + rho[i] * sizes[k][-1]
                      + sigma[i] * sizes[j][-1]) for i, (j, k) in enumerate(AHEAD)]
    return _closed(resolved,
                   lambda T: [fraction * (kappa[i] * (sums[j] * T[k] + T[j] * sums[k] + T[j] * T[k])
                                       + rho[i] * T[k] + sigma[i] * T[j])
                                     for i, (j, k) in enumerate(AHEAD)], sums)


def _closed(resolved: Sequence[arb], more: Callable[[list[arb]], list[arb]], sums: Sequence[arb]):
    """(sums, T) with known + more(T) <= T, tried at twice what goes in; None where that does not close."""
    floor = max((v.abs_upper() for v in resolved), key=float)
    T = [2 * (v.abs_upper() + floor) for v in resolved]
    for _ in range(3):
        right = [(a + b).abs_upper() for a, b in zip(resolved, more(T))]
        if all(a <= b for a, b in zip(right, T)):
            return sums, T
        T = [2 * max(a, b) for a, b in zip(right, T)]
    return None


def _linear_end(numbers: Sequence[list[arb]], x: Sequence[list[arb]], known_tail: Sequence[list[arb]],
                V: Sequence[list[arb]], h: arb):
    """The values at h of a column of the derivative, as balls; None where no tail is found."""
    (sizes, _), (v, vsum) = _sizes(x, h), _sizes(V, h)
    sums, T = known_tail
    kappa, rho, sigma, _ = [[abs(c) for c in row] for row in numbers]
    fraction = h / len(V[0])
    resolved = [fraction * (kappa[i] * (_beyond(sizes[j], v[k]) + _beyond(sizes[k], v[j]) + T[j] * vsum[k]
                                  + T[k] * vsum[j])
                      + rho[i] * v[k][-1] + sigma[i] * v[j][-1]) for i, (j, k) in enumerate(AHEAD)]
    full = [a + b for a, b in zip(sums, T)]
    closed = _closed(resolved,
                     lambda U: [fraction * (kappa[i] * (full[j] * U[k] + full[k] * U[j]) + rho[i] * U[k]
                                         + sigma[i] * U[j])
                                       for i, (j, k) in enumerate(AHEAD)], vsum)
    return closed and [_value(row, h) + _about_zero(u) for row, u in zip(V, closed[1])]


def _value(row: Sequence[arb], h: arb):
    """The polynomial at h, by Horner's rule."""
    total = row[-1]
    for c in row[-2::-1]:
        total = total * h + c
    return total


# --- What a certificate says of a spin-up, read and judged
TRIED_BITS = (96, 192, 384)  # of the way: more where fewer leave something open
MOST_STEPS = 40_000  # of all ways together: some minute


@dataclass(frozen=True)
class SpinUpClaims:
    """about: the form, a key of `FORMS`; axis (1, 2, 3; 0 in the equator), sense; orders; t: when the
    inequality holds; cone, least, gain: its A and z and the rate at which the spin grows at least, in the
    units of the rates; way: [(time, three brackets)], times rising."""

    about: str
    axis: int
    sense: int
    orders: tuple[int, int]
    t: Fraction
    cone: Fraction
    least: Fraction
    gain: Fraction
    way: list


def spin_up_of(table: Mapping[str, Any]) -> SpinUpClaims:
    """The claims on a spin-up. Raises `Malformed` before anything is worked out."""
    where = "motion.spin_up"
    if not isinstance(table, dict):
        raise Malformed(f"{where}: expected an object, got {shown(table)}")
    t = _time(table, where)
    cone, smallest, gain = (number(field(table, key, where), f"{where}.{key}")
                         for key in ("cone", "least", "gain"))
    orders = field(table, "orders", where, list)
    if len(orders) != 2 or not all(type(n) is int and 0 <= n <= MOST_ORDER for n in orders):
        raise Malformed(f"{where}.orders: expected two whole numbers up to {MOST_ORDER}, got {shown(orders)}")
    route = [_point(entry, f"{where}.way[{i}]") for i, entry in enumerate(entries(table, "way", where))]
    if any(a >= b for (a, _), (b, _) in zip(route, route[1:])):
        raise Malformed(f"{where}.way: expected rising times")
    about = word(table, "about", where, tuple(FORMS)) if "about" in table else "fixed centre"
    resolved = {"axis": (0,), "sense": (1,)} if about == "equator" else {"axis": (1, 2, 3), "sense": (-1, 1)}
    axis, sense = (whole(field(table, key, where), f"{where}.{key}", of) for key, of in resolved.items())
    return SpinUpClaims(about, axis, sense, tuple(orders), t, cone, smallest, gain,
                        route)


def _time(table: Mapping[str, Any], where: str):
    t = number(field(table, "t", where), f"{where}.t")
    if t < 0:
        raise Malformed(f"{where}.t: expected a time that is not before the start, got {shown(table['t'])}")
    return t


def _point(entry: Mapping[str, Any], where: str):
    return _time(entry, where), brackets(field(entry, "box", where), f"{where}.box")


def check_spin_up(rates: Rates, state: Sequence[Fraction], claims: SpinUpClaims,
                  note: Callable[[str, str], None]) -> tuple[str, str]:
    """Findings on the way and on the inequality; ("proved", "refuted" or "not checked", reason) of the
    spin-up itself."""
    findings, verdict, left = [], ("not checked", ""), MOST_STEPS
    for bits in TRIED_BITS:
        route = Way(rates, state, bits, left)
        try:
            findings, verdict = _judged(rates, claims, route)
        except Unsuited as error:
            findings, verdict = [], ("not checked", str(error))
            break
        except Lost as error:
            if not findings:
                verdict = "not checked", str(error)
        left -= route.steps
        if left <= 0 or (findings and all(status != "not checked" for _, status, _ in findings)):
            break
    printed = {claim for claim, _, _ in findings}
    for finding in findings:
        note(*finding)
    for claim in (*(_name(t) for t, _ in claims.way), _trap(claims)):
        if claim not in printed:
            note(claim, "not checked", verdict[1])
    return verdict


def _name(t: Fraction):
    return f"state at t = {brief(t)}"


def _trap(claims: SpinUpClaims):
    return f"trap at t = {brief(claims.t)}"


# How the form about an axis (0, 1, 2) in a sense is made, and what is made of it.
FORMS = {"fixed centre": (form_about, Inequality), "moving centre": (moving_form, MovingInequality),
         "equator": (lambda rates, axis, sense: equator(rates), MovingInequality)}


def _judged(rates, claims, route):
    make, inequality_of = FORMS[claims.about]
    with working(max(route.bits, 128)):
        form = make(rates, claims.axis - 1, claims.sense)
        if form is None or not form.M > 0:
            why = ("the spin there does not turn the other two" if form is None
                   else "the torque's component does not have the direction of the spin")
            return [(_trap(claims), "refuted", why)], ("not checked", why)
        inequality = inequality_of(form, claims.orders)
    result, states = [], {}
    for t in sorted({claims.t, *(t for t, _ in claims.way)}):
        states[t] = route.to(t)
    with working(max(route.bits, 128)):
        for t, box in claims.way:
            result.append((_name(t), *_within(states[t], box, route.steps)))
        status, why = _trapped(inequality, states[claims.t], claims)
    result.append((_trap(claims), status, why))
    return result, (status if status == "proved" else "not checked", why)


def _within(state: Sequence[arb], box: Sequence[tuple[Fraction, Fraction]], steps: int):
    """(status, reason) of three brackets against three balls."""
    ends = [(below(v), above(v)) for v in state]
    if all(low <= a and b <= high for (a, b), (low, high) in zip(ends, box)):
        return "proved", f"the motion enclosed anew, in {steps} steps"
    if any(b < low or high < a for (a, b), (low, high) in zip(ends, box)):
        return "refuted", "the motion enclosed anew is elsewhere"
    return "not checked", "the brackets are narrower than what encloses the motion anew"


def _trapped(inequality: MovingInequality, state: Sequence[arb], claims: SpinUpClaims):
    if not (claims.cone > 0 and claims.least > 0 and claims.gain > 0):
        return "refuted", "cone, least and gain are not all positive"
    faults, gain = inequality.faults(state, claims.cone, claims.least)
    if not faults and not gain >= ball(claims.gain):
        faults = [("the spin grows as fast as claimed", bool(gain < ball(claims.gain)))]
    if not faults:
        return ("proved",
                f"the inequality of orders {claims.orders[0]} and {claims.orders[1]}, worked out anew, "
                f"holds: the spin grows for ever")
    text = f"the inequality fails: {', '.join(phrase for phrase, _ in faults)}"
    return ("refuted" if any(surely for _, surely in faults) else "not checked"), text
