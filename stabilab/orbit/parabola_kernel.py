"""Extremes and periods of many bounded orbits on parabolas (two equal moments), one row at a time, as
straight lines of floats that numba compiles.

Along a parabola the force is a cubic and E - V a quartic of the way y from the state, K(y) = w^2/2 + f0 y +
f1 y^2/2 + f2 y^3/6 + f3 y^4/24. Where f3 < 0 walls stand on both sides: the roots of the cubic are one well,
or two with a barrier between them, and K falls or rises between them throughout. Of a sphere the force is
linear, with one well. With K = (y - l)(r - y) H the period is sqrt(2) int dphi/sqrt(H) over half a circle, H
a quadratic, which tan(phi/2) makes an arithmetic-geometric mean. What doubles cannot settle is marked and
left to balls. Every function is plain Python too.
"""
from __future__ import annotations

from collections.abc import Sequence
from math import acos, acosh, asinh, cos, cosh, pi, sinh, sqrt
from typing import TYPE_CHECKING

from ..numbers.error_free import add, exact_sum, scaled, times

if TYPE_CHECKING:
    import numpy as np

ULP = 2.220446049250313e-16
INFINITY = float("inf")
BOX, PERIOD = 1, 2  # bits: wanted, and left open
DIGITS, PERIOD_DIGITS = 1e-12, 1e-11  # promised, relative
ROUNDED = 8.0  # roundings of a coefficient, by the size of its terms
TWOFOLD = 2.0**-96  # roundings of a sum of twofold numbers, by the size of its terms
# times its error: so far a height is from the energy, and a force from zero, where the side is certain
CLEAR = 64.0
# of the two terms of the discriminant: nearer to a fold balls say which equilibria there are
FOLD_WIDTH = 1e-8
SIXTH = 0.16666666666666666, 9.25185853854297e-18
POLISH, STEPS, DOUBLINGS = 3, 80, 1100
# steps of Newton's method at an equilibrium and in twofold numbers; at an end, most of them; doublings of a
# way towards a wall
MEANS = 8  # of the arithmetic-geometric mean, which doubles its digits with each


def speeds(u: float, v: float, fine: np.ndarray):
    """(a, b, p b, q a), twofold: at the way y the place is (u + a y + p b y^2/2, v + b y + q a y^2/2)."""
    p, p0, q, q0 = (fine[0, 0], fine[0, 1]), (fine[1, 0],
                                              fine[1, 1]), (fine[2, 0], fine[2, 1]), (fine[3, 0], fine[3, 1])
    a, b = add(scaled(p, v), p0), add(scaled(q, u), q0)
    return a, b, times(p, b), times(q, a)


def coefficients(u: float, v: float, w: tuple[float, float], a: tuple[float, float], b: tuple[float, float],
                 pb: tuple[float, float], qa: tuple[float, float], fine: np.ndarray):
    """Those of K, lowest power first, twofold; u, v: doubles of the place, w: the twofold rate, fine: as of
    `rows`."""
    kappa, rho, sigma, m = (fine[4, 0],
                            fine[4, 1]), (fine[5, 0],
                                          fine[5, 1]), (fine[6, 0], fine[6, 1]), (fine[7, 0], fine[7, 1])
    f0 = add(add(scaled(scaled(kappa, u), v), scaled(rho, v)), add(scaled(sigma, u), m))
    f1 = add(times(kappa, add(scaled(a, v), scaled(b, u))), add(times(rho, b), times(sigma, a)))
    bent = add(scaled(times(a, b), 2.0), add(scaled(pb, v), scaled(qa, u)))
    f2 = add(times(kappa, bent), add(times(rho, qa), times(sigma, pb)))
    f3 = scaled(times(kappa, add(times(qa, a), times(pb, b))), 3.0)
    sixth = (SIXTH[0], SIXTH[1])
    return scaled(times(w, w), 0.5), f0, scaled(f1, 0.5), times(f2, sixth), scaled(times(f3, sixth), 0.25)


def fine_quartic(y: float, c: Sequence[tuple[float, float]]):
    """K at the way y, rounded once."""
    total = add(scaled(add(scaled(c[4], y), c[3]), y), c[2])
    total = add(scaled(add(scaled(total, y), c[1]), y), c[0])
    return total[0] + total[1]


def fine_cubic(y: float, c: Sequence[tuple[float, float]]):
    """The force there."""
    total = add(scaled(add(scaled(c[4], 4 * y), scaled(c[3], 3.0)), y), scaled(c[2], 2.0))
    total = add(scaled(total, y), c[1])
    return total[0] + total[1]


def polished(y: float, c: Sequence[tuple[float, float]]):
    """(an end by Newton's method from its double, what it may be off by)."""
    step = 0.0 * y
    for _ in range(POLISH):
        step = fine_quartic(y, c) / fine_cubic(y, c)
        y -= step
    return y, abs(step) + ULP * abs(y)


def quartic(y: float, k0: float, f0: float, f1: float, f2: float, f3: float):
    """K at the way y."""
    return k0 + y * (f0 + y * (f1 / 2 + y * (f2 / 6 + y * f3 / 24)))


def cubic(y: float, f0: float, f1: float, f2: float, f3: float):
    """The force there, K's slope."""
    return f0 + y * (f1 + y * (f2 / 2 + y * f3 / 6))


def bend(y: float, f1: float, f2: float, f3: float):
    return f1 + y * (f2 + y * f3 / 2)


def equilibria(f0: float, f1: float, f2: float, f3: float, spots: np.ndarray):
    """(how many, whether that is certain); their ways in ascending order in `spots` (3,): a well, or a well,
    a barrier and a well."""
    if f3 == 0:
        spots[0] = -f0 / f1
        return 1, True
    middle = -f2 / f3
    d, rest = bend(middle, f1, f2, f3), cubic(middle, f0, f1, f2, f3)
    p, q = 6 * d / f3, 6 * rest / f3  # t^3 + p t + q = 0 about the middle
    cubed, square = 4 * p * p * p, 27 * q * q
    if p == 0 or not abs(cubed + square) > FOLD_WIDTH * (abs(cubed) + square):
        return 0, False
    size = 2 * sqrt(abs(p) / 3)
    fraction = 3 * abs(q) / (abs(p) * size)
    if p < 0 and fraction < 1:
        angle = acos(fraction if q < 0 else -fraction) / 3
        spots[0], spots[1], spots[2] = size * cos(angle + 2 * pi
                                                  / 3), size * cos(angle - 2 * pi / 3), size * cos(angle)
        count = 3
    else:
        t = size * (cosh(acosh(fraction) / 3) if p < 0 else sinh(asinh(fraction) / 3))
        spots[0] = -t if q > 0 else t
        count = 1
    for n in range(count):
        y = middle + spots[n]
        for _ in range(POLISH):
            y -= cubic(y, f0, f1, f2, f3) / bend(y, f1, f2, f3)
        spots[n] = y
        if not (bend(y, f1, f2, f3) > 0) == (n == 1):
            return 0, False
    return count, count == 1 or spots[0] < spots[1] < spots[2]


def crossing(inner: float, outer: float, k0: float, f0: float, f1: float, f2: float, f3: float):
    """The way between `inner`, where K is not negative, and `outer`, where it is, at which it vanishes; K
    falls from the one to the other."""
    slope, at = abs(bend(inner, f1, f2, f3)), quartic(inner, k0, f0, f1, f2, f3)
    guess = sqrt(2 * max(at, 0.0) / slope) if slope > 0 else INFINITY
    y = inner + (guess if outer > inner else -guess)
    if not (min(inner, outer) < y < max(inner, outer)):
        y = 0.5 * (inner + outer)
    for _ in range(STEPS):
        value = quartic(y, k0, f0, f1, f2, f3)
        if value < 0:
            outer = y
        else:
            inner = y
        new = y - value / cubic(y, f0, f1, f2, f3)
        if not (min(inner, outer) <= new <= max(inner, outer)):
            new = 0.5 * (inner + outer)
        step, y = abs(new - y), new
        if step <= 2 * ULP * abs(y) or value == 0:
            break
    return y


def end(side: float, k0: float, f0: float, f1: float, f2: float, f3: float, count: int, spots: np.ndarray,
        overs: np.ndarray, hazes: np.ndarray):
    """(turning point on a side, how certain: E - V over a barrier on the way against its error, the least of
    them)."""
    inner, smallest = 0.0, INFINITY
    for n in range(count):
        point = n if side > 0 else count - 1 - n
        y = spots[point]
        if y * side <= 0:
            continue
        smallest = min(smallest, abs(overs[point]) / hazes[point])
        if overs[point] < 0:
            return crossing(inner, y, k0, f0, f1, f2, f3), smallest
        inner = y
    route = 1.0 if inner == 0 else abs(inner)
    for _ in range(DOUBLINGS):
        if quartic(inner + side * route, k0, f0, f1, f2, f3) < 0:
            break
        route *= 2
    return crossing(inner, inner + side * route, k0, f0, f1, f2, f3), smallest


def terms_of(y: float, k0: float, t0: float, t1: float, t2: float, t3: float):
    """Size of the terms of K at the way y, given those of its coefficients' terms."""
    y = abs(y)
    return k0 + y * (t0 + y * (t1 / 2 + y * (t2 / 6 + y * t3 / 24)))


def blur_of_force(y: float, t0: float, t1: float, t2: float, t3: float):
    y = abs(y)
    return ROUNDED * ULP * (t0 + y * (t1 + y * (t2 / 2 + y * t3 / 6)))


def place_at(at: float, speed: tuple[float, float], curve: tuple[float, float], y: float):
    """at + y (speed + curve y/2), rounded once; speed and curve twofold."""
    result = add(scaled(add(scaled(curve, 0.5 * y), speed), y), (at, 0.0 * at))
    return result[0] + result[1]


def swept(at: float, speed: tuple[float, float], curve: tuple[float, float], left: float, right: float):
    """(least, most) of `place_at` between two ways."""
    item, other = place_at(at, speed, curve, left), place_at(at, speed, curve, right)
    low, high = min(at, min(item, other)), max(at, max(item, other))
    if curve[0] != 0:
        y = -speed[0] / curve[0]
        if left < y < right:
            vertex = place_at(at, speed, curve, y)
            low, high = min(low, vertex), max(high, vertex)
    return low, high


def mean(x: float, y: float):
    """The arithmetic-geometric mean of positive numbers."""
    for _ in range(MEANS):
        x, y = 0.5 * (x + y), sqrt(x * y)
    return 0.5 * (x + y)


def period_of(left: float, right: float, f3: float, blurs: tuple[float, float], pulls: tuple[float, float],
              forces: tuple[float, float]):
    """(period, what it is off by, relative), given the errors of both ends, the forces inwards there and
    their errors."""
    rho = 0.5 * (right - left)
    at_left, at_right = pulls
    if not (at_left > 0 and at_right > 0 and rho > 0):
        return 0.0, INFINITY
    p, s, c = at_left / (2 * rho), at_right / (2 * rho), -f3 / 24 * rho * rho
    root = sqrt(p * s)
    second = 0.5 * (root + 0.5 * (p + s) - 2 * c)
    if not second > 0:
        return 0.0, INFINITY
    wide = (blurs[0] + blurs[1]) / rho + 2 * ULP * max(abs(left), abs(right)) / rho
    off_p, off_s = p * (forces[0] / at_left + wide + 4 * ULP), s * (forces[1] / at_right + wide + 4 * ULP)
    first = 0.25 * (off_p / p + off_s / s)
    off = 0.5 * root * (off_p / p + off_s / s) + 0.5 * (off_p + off_s) + 2 * c * (2 * wide + 8 * ULP)
    return sqrt(2.0) * pi / mean(sqrt(root), sqrt(second)), max(first, 0.25 * off / second) + 8 * ULP


def rows(states: np.ndarray, open_rows: np.ndarray, axes: Sequence[int], fine: np.ndarray, spots: np.ndarray,
         overs: np.ndarray, hazes: np.ndarray, boxes: np.ndarray, periods: np.ndarray, left_open: np.ndarray):
    """Fill boxes (n, 3, 2) and periods (n,) of the open rows of states (n, 3), as far as their bits in
    left_open (n,) ask; the bits of what is settled go.

    fine: high and low parts of p, p0, q, q0, kappa, rho, sigma, m of the reduction and of its shift s of the
    third component; spots, overs, hazes: room for three.
    """
    j, k, i = axes
    p, p0, q, q0, kappa, rho, sigma, m, shift = fine[:, 0]
    for row in open_rows:
        request = int(left_open[row])
        u, v = states[row, j], states[row, k]
        turn, low = exact_sum(states[row, i], shift)
        turn, low = exact_sum(turn, low + fine[8, 1])
        a, b, pb, qa = speeds(u, v, fine)
        c = coefficients(u, v, (turn, low), a, b, pb, qa, fine)
        k0, f0, f1, f2, f3 = c[0][0], c[1][0], 2 * c[2][0], 6 * c[3][0], 24 * c[4][0]
        a_size, b_size = abs(p * v) + abs(p0), abs(q * u) + abs(q0)
        t0 = abs(kappa * u * v) + abs(rho * v) + abs(sigma * u) + abs(m)
        t1 = abs(kappa) * (a_size * abs(v) + abs(u) * b_size) + abs(rho) * b_size + abs(sigma) * a_size
        t2 = (abs(kappa) * (2 * a_size * b_size + abs(p * v) * b_size + abs(u * q) * a_size)
              + abs(rho * q) * a_size + abs(sigma * p) * b_size)
        t3 = 3 * abs(kappa) * (abs(q) * a_size * a_size + abs(p) * b_size * b_size)
        # at the place of an equilibrium to rounding doubles do not tell on which side of it a state is, nor
        # whether it is at rest
        walled = f1 < -CLEAR * ROUNDED * ULP * t1 if t2 == 0 and t3 == 0 else f3 < -CLEAR * ROUNDED * ULP * t3
        if abs(f0) <= CLEAR * ROUNDED * ULP * t0 or not (walled and t3 < INFINITY and k0 < INFINITY):
            continue
        count, sure = equilibria(f0, f1, f2, f3, spots)
        if not sure:
            continue
        fastest, fog = k0, ULP * k0
        for n in range(count):
            blurred = blur_of_force(spots[n], t0, t1, t2, t3)
            overs[n] = fine_quartic(spots[n], c)
            hazes[n] = TWOFOLD * terms_of(spots[n], k0, t0, t1, t2, t3) + ULP * abs(overs[n])
            hazes[n] += blurred * blurred / abs(bend(spots[n], f1, f2, f3))
        if count == 3 and not abs(overs[1]) > CLEAR * hazes[1]:
            continue
        left, clear = end(-1.0, k0, f0, f1, f2, f3, count, spots, overs, hazes)
        right, other = end(1.0, k0, f0, f1, f2, f3, count, spots, overs, hazes)
        left, blur_left = polished(left, c)
        right, blur_right = polished(right, c)
        left, right = min(left, 0.0), max(right, 0.0)
        if not (min(clear, other) > CLEAR and right - left < INFINITY):
            continue
        for n in range(count):
            if left < spots[n] < right and overs[n] > fastest:
                fastest, fog = overs[n], hazes[n]
        pulls = fine_cubic(left, c), -fine_cubic(right, c)
        if not (pulls[0] > 0 and pulls[1] > 0):
            continue
        blurs = (TWOFOLD * terms_of(left, k0, t0, t1, t2, t3) / pulls[0] + blur_left,
                 TWOFOLD * terms_of(right, k0, t0, t1, t2, t3) / pulls[1] + blur_right)
        if request & BOX:
            top = sqrt(2 * fastest)
            low_u, high_u = swept(u, a, pb, left, right)
            low_v, high_v = swept(v, b, qa, left, right)
            low_w, high_w = min(states[row, i], -top - shift), max(states[row, i], top - shift)
            good = (0.5 * fog / fastest
                    + ULP) * top + ULP * abs(shift) <= DIGITS * max(abs(low_w), abs(high_w))
            for side in range(2):
                y, blur = (right, blurs[1]) if side else (left, blurs[0])
                fast_u, fast_v = abs(a[0] + pb[0] * y), abs(b[0] + qa[0] * y)
                good = good and fast_u * blur <= DIGITS * max(abs(low_u), abs(high_u))
                good = good and fast_v * blur <= DIGITS * max(abs(low_v), abs(high_v))
            if good:
                boxes[row, j, 0], boxes[row, j, 1] = low_u, high_u
                boxes[row, k, 0], boxes[row, k, 1] = low_v, high_v
                boxes[row, i, 0], boxes[row, i, 1] = low_w, high_w
                request -= BOX
        if request & PERIOD:
            forces = (2 * ULP * pulls[0] + abs(bend(left, f1, f2, f3)) * blurs[0],
                      2 * ULP * pulls[1] + abs(bend(right, f1, f2, f3)) * blurs[1])
            period, off = period_of(left, right, f3, blurs, pulls, forces)
            if off <= PERIOD_DIGITS:
                periods[row] = period
                request -= PERIOD
        left_open[row] = request
