"""Extremes and periods of many bounded orbits on parabolas (two equal moments), one row at a time, as straight lines of floats that numba compiles.

Along a parabola the force is a cubic and E - V a quartic of the way y from the state, K(y) = w^2/2 + f0 y + f1 y^2/2 + f2 y^3/6 + f3 y^4/24. Where f3 < 0
walls stand on both sides: the roots of the cubic are one well, or two with a barrier between them, and K falls or rises between them throughout. With
K = (y - l)(r - y) H the period is sqrt(2) int dphi/sqrt(H) over half a circle, H a quadratic, which tan(phi/2) makes an arithmetic-geometric mean.
What doubles cannot settle is marked and left to the arrays. Every function is plain Python too. All in one file: numba's cache on disk watches no other.
"""
from __future__ import annotations

from math import acos, acosh, asinh, cos, cosh, pi, sinh, sqrt

EPS = 2.220446049250313e-16
INFINITY = float("inf")
BOX, PERIOD = 1, 2  # bits: wanted, and left open
DIGITS, PERIOD_DIGITS = 1e-12, 1e-11  # as in `guards` and `period.arrays`
ROUNDED = 8.0  # roundings of a coefficient, by the size of its terms
CLEAR = 64.0  # times its error: so far a height is from the energy, and a force from zero, where the side is certain
BESIDE = 1e-8  # of the two terms of the discriminant: nearer to a fold the arrays say which equilibria there are
POLISH, STEPS, DOUBLINGS = 3, 80, 1100  # steps of Newton's method at an equilibrium; at an end, most of them; doublings of a way towards a wall
MEANS = 8  # of the arithmetic-geometric mean, which doubles its digits with each


def exact_sum(x, y):
    s = x + y
    back = s - x
    return s, (x - (s - back)) + (y - back)


def quartic(y, k0, f0, f1, f2, f3):
    """K at the way y."""
    return k0 + y * (f0 + y * (f1 / 2 + y * (f2 / 6 + y * f3 / 24)))


def cubic(y, f0, f1, f2, f3):
    """The force there, K's slope."""
    return f0 + y * (f1 + y * (f2 / 2 + y * f3 / 6))


def bend(y, f1, f2, f3):
    return f1 + y * (f2 + y * f3 / 2)


def equilibria(f0, f1, f2, f3, spots):
    """(how many, whether that is certain); their ways in ascending order in `spots` (3,): a well, or a well, a barrier and a well."""
    middle = -f2 / f3
    d, rest = bend(middle, f1, f2, f3), cubic(middle, f0, f1, f2, f3)
    p, q = 6 * d / f3, 6 * rest / f3  # t^3 + p t + q = 0 about the middle
    cubed, square = 4 * p * p * p, 27 * q * q
    if p == 0 or not abs(cubed + square) > BESIDE * (abs(cubed) + square):
        return 0, False
    size = 2 * sqrt(abs(p) / 3)
    share = 3 * abs(q) / (abs(p) * size)
    if p < 0 and share < 1:
        angle = acos(share if q < 0 else -share) / 3
        spots[0], spots[1], spots[2] = size * cos(angle + 2 * pi / 3), size * cos(angle - 2 * pi / 3), size * cos(angle)
        count = 3
    else:
        t = size * (cosh(acosh(share) / 3) if p < 0 else sinh(asinh(share) / 3))
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


def crossing(inner, outer, k0, f0, f1, f2, f3):
    """The way between `inner`, where K is not negative, and `outer`, where it is, at which it vanishes; K falls from the one to the other."""
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
        if step <= 2 * EPS * abs(y) or value == 0:
            break
    return y


def end(side, k0, f0, f1, f2, f3, count, spots, hazes):
    """(turning point on a side, how certain: E - V over a barrier on the way against its error, the least of them)."""
    inner, least = 0.0, INFINITY
    for n in range(count):
        spot = n if side > 0 else count - 1 - n
        y = spots[spot]
        if y * side <= 0:
            continue
        over = quartic(y, k0, f0, f1, f2, f3)
        least = min(least, abs(over) / hazes[spot])
        if over < 0:
            return crossing(inner, y, k0, f0, f1, f2, f3), least
        inner = y
    way = 1.0 if inner == 0 else abs(inner)
    for _ in range(DOUBLINGS):
        if quartic(inner + side * way, k0, f0, f1, f2, f3) < 0:
            break
        way *= 2
    return crossing(inner, inner + side * way, k0, f0, f1, f2, f3), least


def haze_of(y, k0, t0, t1, t2, t3):
    """What K may be off by at the way y, given the sizes of its coefficients' terms."""
    y = abs(y)
    return ROUNDED * EPS * (k0 + y * (t0 + y * (t1 / 2 + y * (t2 / 6 + y * t3 / 24))))


def blur_of_force(y, t0, t1, t2, t3):
    y = abs(y)
    return ROUNDED * EPS * (t0 + y * (t1 + y * (t2 / 2 + y * t3 / 6)))


def swept(at, speed, curve, left, right):
    """(least, most) of at + y (speed + curve y/2) between two ways."""
    one, other = at + left * (speed + 0.5 * curve * left), at + right * (speed + 0.5 * curve * right)
    low, high = min(at, min(one, other)), max(at, max(one, other))
    if curve != 0:
        y = -speed / curve
        if left < y < right:
            vertex = at + 0.5 * speed * y
            low, high = min(low, vertex), max(high, vertex)
    return low, high


def mean(x, y):
    """The arithmetic-geometric mean of positive numbers."""
    for _ in range(MEANS):
        x, y = 0.5 * (x + y), sqrt(x * y)
    return 0.5 * (x + y)


def period_of(left, right, f0, f1, f2, f3, blurs, forces):
    """(period, what it is off by, relative), given the errors of both ends and of the force there."""
    rho = 0.5 * (right - left)
    at_left, at_right = cubic(left, f0, f1, f2, f3), -cubic(right, f0, f1, f2, f3)
    if not (at_left > 0 and at_right > 0 and rho > 0):
        return 0.0, INFINITY
    p, s, c = at_left / (2 * rho), at_right / (2 * rho), -f3 / 24 * rho * rho
    root = sqrt(p * s)
    second = 0.5 * (root + 0.5 * (p + s) - 2 * c)
    if not second > 0:
        return 0.0, INFINITY
    wide = (blurs[0] + blurs[1]) / rho + 2 * EPS * max(abs(left), abs(right)) / rho
    off_p, off_s = p * (forces[0] / at_left + wide + 4 * EPS), s * (forces[1] / at_right + wide + 4 * EPS)
    first = 0.25 * (off_p / p + off_s / s)
    off = 0.5 * root * (off_p / p + off_s / s) + 0.5 * (off_p + off_s) + 2 * c * (2 * wide + 8 * EPS)
    return sqrt(2.0) * pi / mean(sqrt(root), sqrt(second)), max(first, 0.25 * off / second) + 8 * EPS


def orbits(states, axes, form, wanted, spots, hazes, boxes, periods, left_open):
    """Fill boxes (n, 3, 2) and periods (n,) as far as wanted; left_open (n,): the bits that stay open.

    form: p, p0, q, q0, kappa, rho, sigma, m of the reduction, its shift s of the third component and what its double leaves; spots, hazes: room for three.
    """
    j, k, i = axes
    p, p0, q, q0, kappa, rho, sigma, m, shift, rest = form
    for row in range(len(states)):
        left_open[row], asked = wanted, wanted
        u, v = states[row, j], states[row, k]
        turn, low = exact_sum(states[row, i], shift)
        w = turn + (low + rest)
        k0 = 0.5 * w * w
        a, b, a_size, b_size = p * v + p0, q * u + q0, abs(p * v) + abs(p0), abs(q * u) + abs(q0)
        f0 = kappa * u * v + rho * v + sigma * u + m
        f1 = kappa * (a * v + u * b) + rho * b + sigma * a
        f2 = kappa * (2 * a * b + p * b * v + u * q * a) + rho * q * a + sigma * p * b
        f3 = 3 * kappa * (q * a * a + p * b * b)
        t0 = abs(kappa * u * v) + abs(rho * v) + abs(sigma * u) + abs(m)
        t1 = abs(kappa) * (a_size * abs(v) + abs(u) * b_size) + abs(rho) * b_size + abs(sigma) * a_size
        t2 = abs(kappa) * (2 * a_size * b_size + abs(p * v) * b_size + abs(u * q) * a_size) + abs(rho * q) * a_size + abs(sigma * p) * b_size
        t3 = 3 * abs(kappa) * (abs(q) * a_size * a_size + abs(p) * b_size * b_size)
        # at the place of an equilibrium to rounding doubles do not tell on which side of it a state is, nor whether it is at rest
        if abs(f0) <= CLEAR * ROUNDED * EPS * t0 or not (f3 < -CLEAR * ROUNDED * EPS * t3 and t3 < INFINITY and k0 < INFINITY):
            continue
        count, sure = equilibria(f0, f1, f2, f3, spots)
        if not sure:
            continue
        fastest, fog = k0, EPS * k0
        for n in range(count):
            blurred = blur_of_force(spots[n], t0, t1, t2, t3)
            hazes[n] = haze_of(spots[n], k0, t0, t1, t2, t3) + blurred * blurred / abs(bend(spots[n], f1, f2, f3))
        if count == 3 and not abs(quartic(spots[1], k0, f0, f1, f2, f3)) > CLEAR * hazes[1]:
            continue
        left, clear = end(-1.0, k0, f0, f1, f2, f3, count, spots, hazes)
        right, other = end(1.0, k0, f0, f1, f2, f3, count, spots, hazes)
        if not (min(clear, other) > CLEAR and left <= 0 <= right and right - left < INFINITY):
            continue
        for n in range(count):
            if left < spots[n] < right:
                over = quartic(spots[n], k0, f0, f1, f2, f3)
                if over > fastest:
                    fastest, fog = over, hazes[n]
        pulls = abs(cubic(left, f0, f1, f2, f3)), abs(cubic(right, f0, f1, f2, f3))
        blurs = (haze_of(left, k0, t0, t1, t2, t3) / pulls[0] + 2 * EPS * abs(left) if pulls[0] > 0 else INFINITY,
                 haze_of(right, k0, t0, t1, t2, t3) / pulls[1] + 2 * EPS * abs(right) if pulls[1] > 0 else INFINITY)
        if wanted & BOX:
            top = sqrt(2 * fastest)
            low_u, high_u = swept(u, a, p * b, left, right)
            low_v, high_v = swept(v, b, q * a, left, right)
            low_w, high_w = min(states[row, i], -top - shift), max(states[row, i], top - shift)
            good = (0.5 * fog / fastest + EPS) * top + EPS * abs(shift) <= DIGITS * max(abs(low_w), abs(high_w))
            for side in range(2):
                y, blur = (right, blurs[1]) if side else (left, blurs[0])
                fast_u, fast_v = abs(a + p * b * y), abs(b + q * a * y)
                way_u = abs(u) + abs(y) * (a_size + 0.5 * abs(p) * b_size * abs(y))
                way_v = abs(v) + abs(y) * (b_size + 0.5 * abs(q) * a_size * abs(y))
                good = good and fast_u * blur + 4 * EPS * way_u <= DIGITS * max(abs(low_u), abs(high_u))
                good = good and fast_v * blur + 4 * EPS * way_v <= DIGITS * max(abs(low_v), abs(high_v))
            if good:
                boxes[row, j, 0], boxes[row, j, 1] = low_u, high_u
                boxes[row, k, 0], boxes[row, k, 1] = low_v, high_v
                boxes[row, i, 0], boxes[row, i, 1] = low_w, high_w
                asked -= BOX
        if wanted & PERIOD:
            forces = (blur_of_force(left, t0, t1, t2, t3) + abs(bend(left, f1, f2, f3)) * blurs[0],
                      blur_of_force(right, t0, t1, t2, t3) + abs(bend(right, f1, f2, f3)) * blurs[1])
            period, off = period_of(left, right, f0, f1, f2, f3, blurs, forces)
            if off <= PERIOD_DIGITS:
                periods[row] = period
                asked -= PERIOD
        left_open[row] = asked
