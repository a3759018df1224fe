"""A motion about any location of its orbit, be that a circle, a hyperbola or a parabola, one at a time, as
straight lines of floats that numba compiles.

From a location (u, v) = (omega_j, omega_k) of the orbit, with y the arc of alpha from there, a = p v + p0,
b = q u + q0 and e = p q = n^2 (n real, imaginary or 0),

    u(y) = u + a S1 + p b S2,   v(y) = v + b S1 + q a S2,                                               (1)
    K(y) = k + f0 y + f1 S2 + F S3 + c S1 S2 + g S2^2/2,                                                (2)
    S1 = sinh(n y)/n,   S2 = (cosh(n y) - 1)/n^2,   S3 = (S1 - y)/n^2,

where K = (omega_i + s)^2/2 = E - V. All are entire in e: no centre, no radius, no root of p or q, so nothing
is lost where moments are nearly equal and the centre of the orbits stands far off. Proof:
docs/mathematics/arcs.md. Twofold numbers form the coefficients and move the base, the location that arcs
start from; doubles do the rest. Every function is plain Python too.
"""
from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from math import factorial

import numpy as np

from ..numbers.error_free import Pair, add, exact_product, exact_sum, less, scaled, times, value

# functions without which loops call instead of adding
INLINED = {"entire", "constant", "quartic", "converged", "component", "parts_of", "rounded"}
ENTRIES = {"entries": {"rows", "turns", "margins"}}  # what Python calls of all kernels with these functions
BASE = "base_of", 5.0  # a function here that all of these call, and s that compiling those here takes
ULP = 2.220446049250313e-16
INFINITY = float("inf")
TWOFOLD = 2.0**-94  # of its terms: rounding of a K in twofold numbers
ROUNDINGS = 8.0  # units of rounding of a sum, by the size of its terms
# rows of the twofold constants of a reduction: d omega_j/d alpha = p omega_k + p0, d omega_k/d alpha =
# q omega_j + q0, the rate of omega_i is kappa u v + rho v + sigma u + m, e = p q, s the shift of omega_i
P, P0, Q, Q0, KAPPA, RHO, SIGMA, M, E, SHIFT = range(10)
# of a base, all twofold: its location, K there, and the coefficients of (1) and (2)
U, V, OVER, ALONG_U, ALONG_V, BEND_U, BEND_V, F0, F1, F2, C, G, PULL_U, PULL_V = range(14)
LARGEST_SQUARE = 1e6  # of n y: beyond a thousand, hyperbolic functions leave the range of doubles
# relative, of sums over nodes: the last change, the error by estimate, a change that is nothing but rounding
ALIKE, CONVERGED, FLOOR = 1e-9, 1e-13, 1e-15
# a sum that eight nodes leave off by ten times that share is off by 1e-9 in 128: 1e-10^(8/128)
HOPEFUL = 0.23713737056616552
DIVISIONS = 16.0  # units of rounding of two divisions, by the size of all coefficients: 10 were seen
STEP_CHANGE = 0.1  # of the force at an end: what a step of Newton's method there may change it by
MAX_COEFFICIENTS = 64  # of Taylor's series about the middle; a full turn takes some forty
NEGLIGIBLE = 1e-18  # of the first coefficients: what is left out of that series
CUT_OFF = 4e-22  # of a piece: nearer to its ends stands no node of the double-exponential rule
PIECE_DIGITS = 3e-12  # relative, of K half-way between two stops, from the one and from the other
LONG = 1.0  # of e y^2: beyond, on hyperbolas, terms that grow are summed before they do
# columns of a stop, an end or an equilibrium that a motion passes: K, f0, f1, F, c, g, e; its arc, and what
# the double of it leaves; what grows like exp(n y) and exp(2 n y), in both directions
STOP_ARC, STOP_REST, GROWING, STOP_COLUMNS = 7, 8, 9, 13


def _inverse_factorials(first: int):
    """(13, 2) high and low parts of 1/first!, 1/(first + 2)!, ..."""
    exact = [Fraction(1, factorial(first + 2 * n)) for n in range(13)]
    return np.array([(float(term), float(term - Fraction(float(term)))) for term in exact])


TWO, THREE = _inverse_factorials(2), _inverse_factorials(3)


# --- The three entire functions
def entire(e: float, y: float):
    """(S1, S2, S3) of an arc; NaN where they may be no doubles.

    Series for an arc so short that |e y^2| <= 1, then S1(2 y) = 2 S1 (1 + e S2), S2(2 y) = 2 S1^2,
    S3(2 y) = 2 (S3 + S1 S2).
    """
    z, h = e * y * y, 1.0
    if not abs(z) < LARGEST_SQUARE:
        return np.nan, np.nan, np.nan
    while abs(z) > 1.0:
        z *= 0.25
        h *= 0.5
    x = y * h
    t = x * x
    s2 = t * (1 / 2 + z * (1 / 24 + z * (1 / 720 + z * (1 / 40320 + z * (1 / 3628800 + z * (
        1 / 479001600 + z * (1 / 87178291200 + z * (1 / 20922789888000 + z / 6402373705728000))))))))
    s3 = t * x * (1 / 6 + z * (1 / 120 + z * (1 / 5040 + z * (1 / 362880 + z * (1 / 39916800 + z * (
        1 / 6227020800 + z * (1 / 1307674368000 + z * (1 / 355687428096000 + z / 121645100408832000))))))))
    s1 = x + e * s3
    while h < 1.0:
        s3 = 2 * (s3 + s1 * s2)
        s1, s2 = 2 * s1 * (1 + e * s2), 2 * s1 * s1
        h *= 2
    return s1, s2, s3


def twofold_entire(e: Pair, y: float):
    """The same, twofold, of a twofold e and a double y."""
    h, square = 1.0, abs(e[0] * y * y)
    if not square < LARGEST_SQUARE:
        nothing = np.nan * y, np.nan * y
        return nothing, nothing, nothing
    while square * h * h > 0.25:
        h *= 0.5
    x = y * h
    t = exact_product(x, x)
    z = times(e, t)
    last = 7 if abs(z[0]) > 1e-3 else 4 if abs(z[0]) > 1e-9 else 2 if z[0] != 0 else 0
    two, three = 0.0 * y, 0.0 * y  # tails in doubles: z^7/16! is 3e-18
    for n in range(min(12, 2 * last), last, -1):
        two, three = two * z[0] + TWO[n, 0], three * z[0] + THREE[n, 0]
    s2 = exact_sum(TWO[last, 0], TWO[last, 1] + z[0] * two)
    s3 = exact_sum(THREE[last, 0], THREE[last, 1] + z[0] * three)
    for n in range(last - 1, -1, -1):
        s2 = add(times(s2, z), (TWO[n, 0], TWO[n, 1]))
        s3 = add(times(s3, z), (THREE[n, 0], THREE[n, 1]))
    s2, s3 = times(s2, t), scaled(times(s3, t), x)
    s1 = add((x, 0.0 * x), times(e, s3))
    while h < 1.0:
        s3 = scaled(add(s3, times(s1, s2)), 2.0)
        s2, s1 = scaled(times(s1, s1), 2.0), scaled(add(s1, times(s1, times(e, s2))), 2.0)
        h *= 2
    return s1, s2, s3


# --- The motion about a base
def constant(fine: np.ndarray, row: int):
    """A twofold constant of the reduction, by its row."""
    return fine[row, 0], fine[row, 1]


def base_at(u: Pair, v: Pair, k: Pair, a: Pair, b: Pair, A: Pair, B: Pair, f0: Pair, fine: np.ndarray):
    """The base at a location (u, v) with K = k there, given what moves along with it."""
    pb, qa = times(constant(fine, P), b), times(constant(fine, Q), a)
    kappa = constant(fine, KAPPA)
    c, g = times(kappa, times(a, b)), times(kappa, add(times(qa, a), times(pb, b)))
    f1, f2 = add(times(A, a), times(B, b)), less(add(times(A, pb), times(B, qa)), c)
    return u, v, k, a, b, pb, qa, f0, f1, f2, c, g, A, B


def base_of(state: np.ndarray, axes: Sequence[int], fine: np.ndarray):
    """The base at a state (3,), its components across the axis and about it in the order of axes."""
    j, k, i = axes
    turn, rest = exact_sum(state[i], fine[SHIFT, 0])
    w = exact_sum(turn, rest + fine[SHIFT, 1])
    u, v = (state[j], 0.0 * state[j]), (state[k], 0.0 * state[k])
    kappa, rho = constant(fine, KAPPA), constant(fine, RHO)
    a = add(times(constant(fine, P), v), constant(fine, P0))
    b = add(times(constant(fine, Q), u), constant(fine, Q0))
    A, B = add(times(kappa, v), constant(fine, SIGMA)), add(times(kappa, u), rho)
    f0 = add(add(times(A, u), times(rho, v)), constant(fine, M))
    return base_at(u, v, scaled(times(w, w), 0.5), a, b, A, B, f0, fine)


def moved(base: Sequence[Pair], y: float, fine: np.ndarray):
    """The base an arc y further on, by (1), (2) and (3); the speeds a and b move as well, because formed anew
    they would be small differences of large terms."""
    e, kappa = constant(fine, E), constant(fine, KAPPA)
    s1, s2, s3 = twofold_entire(e, y)
    es2, a, b, c, g = times(e, s2), base[ALONG_U], base[ALONG_V], base[C], base[G]
    du = add(times(a, s1), times(base[BEND_U], s2))
    dv = add(times(b, s1), times(base[BEND_V], s2))
    a = add(a, add(times(a, es2), times(base[BEND_U], s1)))
    b = add(b, add(times(b, es2), times(base[BEND_V], s1)))
    k = add(add(base[OVER], scaled(base[F0], y)), add(times(base[F1], s2), times(base[F2], s3)))
    k = add(k, times(s2, add(times(c, s1), scaled(times(g, s2), 0.5))))
    inner = add(add(base[F2], scaled(c, 3.0)), add(times(g, s1), scaled(times(c, es2), 2.0)))
    f0 = add(base[F0], add(times(base[F1], s1), times(s2, inner)))
    return base_at(add(base[U], du), add(base[V], dv), k, a, b, add(base[PULL_U], times(kappa, dv)),
                   add(base[PULL_V], times(kappa, du)), f0, fine)


def rounded(base: Sequence[Pair], e: float):
    """(k, f0, f1, F, c, g, e) in doubles: the coefficients that `kinetic` takes."""
    return (value(base[OVER]), value(base[F0]), value(base[F1]), value(base[F2]), value(base[C]),
            value(base[G]), e)


def kinetic(y: float, series: Sequence[float]):
    """(K, K', K'', size of the terms of K) an arc y from a base."""
    k, f0, f1, f2, c, g, e = series
    s1, s2, s3 = entire(e, y)
    first, second, third, fourth, fifth = f0 * y, f1 * s2, f2 * s3, c * s1 * s2, 0.5 * g * s2 * s2
    force = f0 + f1 * s1 + s2 * (f2 + 3 * c + g * s1 + 2 * e * c * s2)
    slope = f1 * (1 + e * s2) + s1 * (f2 + 3 * c + 4 * e * c * s2) + g * s2 * (3 + 2 * e * s2)
    return (k + (first + second + third + fourth + fifth), force, slope,
            abs(k) + abs(first) + abs(second) + abs(third) + abs(fourth) + abs(fifth))


def stationary(speed: float, bend: float, n: float, e: float, left: float):
    """(the first arc beyond left where speed (1 + e S2) + bend S1 vanishes; how far the next is from there);
    inf where there is none."""
    if e < 0:
        first, half = -np.arctan(n * speed / bend) / n if bend != 0 else 0.5 * np.pi / n, np.pi / n
        return first + half * np.ceil((left - first) / half), half
    if e > 0:
        return -np.arctanh(n * speed / bend) / n if abs(n * speed) < abs(bend) else INFINITY, INFINITY
    return -speed / bend if bend != 0 else INFINITY, INFINITY


def component(at: float, speed: float, bend: float, e: float, y: float):
    """(value, size of its terms, slope) of at + speed S1 + bend S2 at an arc."""
    s1, s2, _ = entire(e, y)
    first, second = speed * s1, bend * s2
    return at + (first + second), abs(at) + abs(first) + abs(second), speed * (1 + e * s2) + bend * s1


def twofold_error(y: float, base: Sequence[Pair], fine: np.ndarray):
    """Of a K an arc y from a base in twofold numbers: after a full turn terms are small again, and their
    rounding is that of half a turn."""
    series = rounded(base, fine[E, 0])
    return TWOFOLD * max(kinetic(y, series)[3], kinetic(0.5 * y, series)[3])


# --- The period
def converged(now: float, last: float, middle: float, first: float):
    """Whether a sum over nodes is its integral, given what it changed by as its nodes were doubled: the last,
    the middle and the first of three such changes; any numbers.

    Doubling squares the error of the trapezoidal rule, C r^n for n nodes, and of the double-exponential one,
    so a last change of `ALIKE` leaves nothing. But the sign of an error goes round, and it may be next to
    nothing by chance. So the rate r^n follows from either ratio of changes too, and a size from its own
    change or from the one before; the larger counts each time, and what these leave must be `CONVERGED`:
    four products, without a division.
    """
    c, b, a = last / now, middle / now + FLOOR, first / now + FLOOR
    a2, b2 = a * a, b * b
    return (c <= ALIKE) & (c * c * c <= CONVERGED
                           * b2) & (c * b2 * b2 <= CONVERGED * a2 * a2) & (b * c * c <= CONVERGED * a2) & (
        b2 * b2 * b2 * b <= CONVERGED * a2 * a2 * a2)


def taylor(series: Sequence[float], rho: float, t: np.ndarray):
    """Fill t with the coefficients of K in x = y/rho, lowest first; the index of the last one, 0 where these
    are too many.

    Those of y^(2 n + 2) and y^(2 n + 3) are, entire in e as all else,

        (e^n f1 + g e^(n-1) (4^(n+1)/4 - 1))/(2 n + 2)!,   e^n (F + c (4^(n+1) - 1))/(2 n + 3)!.
    """
    k, f0, f1, f2, c, g, e = series
    t[0], t[1] = k, f0 * rho
    even, bent, four, n = 0.5 * rho * rho, 0.0 * rho, 4.0, 0  # e^n rho^(2 n + 2)/(2 n + 2)!, and that over e
    while True:
        t[2 * n + 2] = f1 * even + (0.25 * four - 1.0) * g * bent
        t[2 * n + 3] = (f2 + c * (four - 1)) * even * rho / (2 * n + 3)
        n += 1
        if four * abs(even) < NEGLIGIBLE * rho * rho:
            return 2 * n + 1
        if 2 * n + 3 >= MAX_COEFFICIENTS:
            return 0
        scale = rho * rho / ((2 * n + 1) * (2 * n + 2))
        bent, even, four = even * scale, even * scale * e, 4 * four


def divided(t: np.ndarray, last: int, root: float):
    """Divide a polynomial by x - root, the rest left out; the index of its last coefficient."""
    carry = t[last]
    for n in range(last, 0, -1):
        t[n - 1], carry = carry, t[n - 1] + root * carry
    return last - 1


def parts_of(t: np.ndarray, last: int, x: float):
    """(even, odd) part of a polynomial at x."""
    z, even, odd = x * x, 0.0 * x, 0.0 * x
    for n in range(last // 2, -1, -1):
        even, odd = even * z + t[2 * n], odd * z + (t[2 * n + 1] if 2 * n + 1 <= last else 0.0)
    return even, odd * x


def period_about(series: Sequence[float], rho: float, left: float, right: float, t: np.ndarray,
                 nodes: np.ndarray):
    """(period, its relative error) by series about the middle, from which the ends are at left and right, rho
    half of their distance; NaN or any number, inf where the sum does not settle.

    T = 2 rho int_0^pi dphi/sqrt(2 H), where K = (x - l)(r - x) H in x = y/rho = -cos phi: two divisions of
    Taylor's polynomial, the trapezoidal rule over mirrored pairs of nodes.
    """
    last = taylor(series, rho, t)
    if not last:
        return np.nan, INFINITY
    size = 0.0  # rounding of the divisions goes by the coefficients before them
    for n in range(last + 1):
        size += abs(t[n])
    last = divided(t, divided(t, last, left / rho), right / rho)
    total, coarse, half, before, change, earlier = 0.0, 0.0, 0.0, np.nan, np.nan, np.nan
    count, first, smallest, now, settled, hopeful = 8, 0, INFINITY, np.nan, False, HOPEFUL
    while first < len(nodes) and not settled:
        stop = first + count // 2 if first else 5
        for n in range(first, stop):
            even, odd = parts_of(t, last, 1 - 2 * nodes[n])
            low = -even - abs(odd)
            smallest = min(smallest, low)
            weight = 0.5 if n == 0 or n == 4 else 1.0
            term = np.nan
            if low > 0:
                term = weight * (1 / np.sqrt(2 * (-even - odd)) + 1 / np.sqrt(2 * (odd - even)))
            total += term
            if n == 0 or n == 4:
                half += term
            elif n == 2:
                coarse = term
        if not first:
            before = (coarse + half) * (np.pi / 4)
            change = abs(before - half * (np.pi / 2))
        count, first = count * 2 if first else count, stop
        now = total * (np.pi / count)
        new = abs(now - before)
        settled = converged(now, new, change, earlier)
        if not settled and new > 10 * hopeful * now:
            break  # twice the nodes square what is left, and that many times there are not
        before, change, earlier, hopeful = now, new, change, hopeful * hopeful
    return 2 * rho * now, DIVISIONS * ULP * size / smallest if settled else INFINITY


def fill_stop(stop: np.ndarray, base: Sequence[Pair], y: float, rest: float, fine: np.ndarray):
    """The columns of a stop at a base, an arc y and its rest from where arcs begin."""
    series = rounded(base, fine[E, 0])
    for column in range(STOP_ARC):
        stop[column] = series[column]
    stop[STOP_ARC], stop[STOP_REST] = y, rest
    stop[GROWING:] = 0.0
    if series[6] > 0:
        growing(stop, base, fine)


def growing(stop: np.ndarray, base: Sequence[Pair], fine: np.ndarray):
    """Fill what grows along a hyperbola, in either direction: the coefficients L of S2 and N of S2^2 in
    `kinetic_from`, formed in twofold numbers because they nearly vanish where a motion comes from afar."""
    e, kappa, q = constant(fine, E), constant(fine, KAPPA), constant(fine, Q)
    n = np.sqrt(e[0])
    square = exact_product(n, n)
    root = exact_sum(n, (((e[0] - square[0]) - square[1]) + e[1]) / (2 * n))
    for column in range(2):
        side = 1.0 - 2 * column
        speed = value(add(times(root, base[ALONG_U]), scaled(base[BEND_U], side))) / n
        force = value(add(times(root, base[PULL_U]), scaled(times(q, base[PULL_V]), side))) / n
        stop[GROWING + 2 * column] = speed * force
        stop[GROWING + 2 * column + 1] = 0.5 * kappa[0] * q[0] * speed * speed


def stop_at(stop: np.ndarray, base: Sequence[Pair], y: float, end: bool, fine: np.ndarray):
    """Fill a stop next to an arc y from a base: there by Newton's method in twofold numbers, where K vanishes
    (an end) or its slope does. What a period may be off by it, relative.

    A double leaves a rest of the arc. Of an equilibrium it costs K nothing; at an end it leaves a force,
    which next to a barrier is much of the small one there. What rounding moves an end by counts against the
    arc along which K is linear.
    """
    there, rest, error = base, 0.0 * y, 0.0 * y
    for _ in range(3):
        there = moved(base, y, fine)
        rest = (-value(there[OVER]) / value(there[F0]) if end
                else -value(there[F0]) / value(there[F1]))
        if abs(rest) <= 1e-9 * ULP * abs(y):
            break
        if end and not abs(rest * value(there[F1])) < STEP_CHANGE * abs(value(there[F0])):
            error = INFINITY  # it may be one beyond a barrier
        y += rest
    fill_stop(stop, there, y, rest, fine)
    if end:
        error += force_error(there, fine)
        error += twofold_error(y, base, fine) / abs(stop[1]) * linear(stop)
        stop[0], stop[1] = 0.0, stop[1] + stop[2] * rest
    else:
        stop[0], stop[1] = stop[0] + 0.5 * stop[1] * rest, 0.0
    return error


def force_error(base: Sequence[Pair], fine: np.ndarray):
    """Relative error of the force at a base: next to a barrier its terms cancel."""
    u, v = base[U][0], base[V][0]
    size = (abs(fine[KAPPA, 0] * u * v) + abs(fine[RHO, 0] * v) + abs(fine[SIGMA, 0] * u) + abs(fine[M, 0]))
    return TWOFOLD * size / abs(value(base[F0]))


def linear(stop: np.ndarray):
    """One over the arc from an end along which the force hardly changes."""
    _, f0, f1, f2, c, g, e = series_of(stop)
    f0 = abs(f0)
    return (abs(f1) / f0 + np.sqrt((abs(f2) + 3 * abs(c) + abs(e) * f0) / f0)
            + np.cbrt((3 * abs(g) + abs(e * f1)) / f0))


def series_of(stop: np.ndarray):
    """What `kinetic` takes, of a stop."""
    return stop[0], stop[1], stop[2], stop[3], stop[4], stop[5], stop[6]


def kinetic_from(y: float, stop: np.ndarray):
    """(K, size of its terms) an arc y from a stop.

    On a hyperbola, with m = |y|, D = (1 - exp(-n m))/n and S1 = +-(D + n S2), the sign that of y, (2) is

        k + f0 y + L S2 + F (+-D - y)/e -+ c D^2/(2 n) + N S2^2,   S2 = exp(n m) D^2/2,
        L = P (A +- q B/n),   N = kappa q P^2/2,   P = a +- p b/n,

    where nothing grows but S2.
    """
    k, f0, f1, f2, c, g, e = series_of(stop)
    if not e * y * y > LONG:
        over, _, _, terms = kinetic(y, (k, f0, f1, f2, c, g, e))
        return over, terms
    n, side, column = np.sqrt(e), (1.0 if y > 0 else -1.0), (GROWING if y > 0 else GROWING + 2)
    d = -np.expm1(-n * abs(y)) / n
    s2 = 0.5 * d * d * np.exp(n * abs(y))
    first, second, third = f0 * y, stop[column] * s2, f2 * (side * d - y) / e
    fourth, fifth = -0.5 * side * c * d * d / n, stop[column + 1] * s2 * s2
    terms = abs(k) + abs(first) + abs(second) + abs(third) + abs(fourth) + abs(fifth)
    # a rounding of n y is one of so many in the exponential
    return k + (first + second + third + fourth + fifth), terms * (1 + n * abs(y) / ROUNDINGS)


def period_in_pieces(stops: np.ndarray, count: int, nearby: np.ndarray, weights: np.ndarray,
                     levels: np.ndarray, turning: bool):
    """(time from the first stop to the last and back, its relative error) by the double-exponential rule from
    stop to stop, K from the nearer one; NaN, inf where a sum does not settle. turning: whether the motion
    turns at the first and at the last."""
    period, worst, cut, slow = 0.0, 1.0, 0.0, 0.0
    if turning and count > 1:  # what the nodes leave out of the arcs at both ends along which K is linear
        length = stops[count - 1, STOP_ARC] - stops[0, STOP_ARC]
        cut = CUT_OFF * (np.sqrt(length * linear(stops[0])) + np.sqrt(length * linear(stops[count - 1])))
    for n in range(count - 1):
        here, there = stops[n], stops[n + 1]
        length = (there[STOP_ARC] - here[STOP_ARC]) + (there[STOP_REST] - here[STOP_REST])
        one, other = kinetic_from(0.5 * length, here)[0], kinetic_from(-0.5 * length, there)[0]
        if not (length > 0 and abs(one - other) <= PIECE_DIGITS * one):
            return np.nan, INFINITY
        for k in (here[0], there[0]):
            if k > 0:  # the same at a barrier, which a motion that hardly passes it passes slowly
                slow += 2 * CUT_OFF * length / np.sqrt(2 * k)
        total, before, change, earlier, settled = 0.0, np.nan, np.nan, np.nan, False
        for level in range(len(levels) - 1):
            for node in range(levels[level], levels[level + 1]):
                part, far, scale = abs(nearby[node]), nearby[node] < 0, 1.0
                # the arc from a turning point is L x^2, which takes its root away; not so between two of them
                if turning and count > 2 and (n == 0 or n == count - 2):
                    at_turn = far == (n > 0)
                    part, scale = ((part * part, 2 * part) if at_turn
                                   else (part * (2 - part), 2 * (1 - part)))
                over, terms = (kinetic_from(-length * part, there) if far
                               else kinetic_from(length * part, here))
                worst = max(worst, terms / over)
                total += weights[node] * scale / np.sqrt(2 * over)
            now = length * total * 2.0**-level
            new = abs(now - before)
            if converged(now, new, change, earlier):
                period, settled = period + 2 * now, True
                break
            before, change, earlier = now, new, change
        if not settled:
            return np.nan, INFINITY
    return period, ROUNDINGS * ULP * worst + cut + slow / period
