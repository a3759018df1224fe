"""Margins of many states from barriers on orbits of any kind: every function takes numbers or arrays alike,
so that one text serves NumPy and, several rows at a time, a loop that numba compiles.

About a state, in theta = n alpha and x = tanh(theta/2) (tan on circles, theta/2 on parabolas, where n is 1),
the force times (1 - e x^2)^2, e = 1, -1 or 0, is the quartic (4) of `equilibria_kernel`: no centre of the
orbits takes part, which two nearly equal moments send far off. The sign of its discriminant says how many
equilibria there are (docs/mathematics/arcs.md). Wells and barriers take turns, so of four roots two are
barriers: on circles both, elsewhere the nearer one, if it stands on this branch of the orbit. Ferrari's
formula finds them, in a chart whose infinity is far from all roots, and Newton's method ends the search.
Sums, products, quotients and square roots are all that occurs: processors take several rows of them at once,
and NumPy's have the same digits. What rounding may change is marked as not clear, and so is what Newton's
method has not reached.
"""
from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ..numbers.double_double import TURN
from ..numbers.exact import sqrt_fraction
from ..numbers.numba_door import Kernel
from ..numbers.vectors import Number
from .arc_kernel import INFINITY, ROUNDINGS, ULP
from .equilibria_kernel import BESIDE_BARRIER, CLEAR, MARGIN_SHARE

if TYPE_CHECKING:
    from .reduction import Reduction

DOUBLE_ROOT = 2e-14  # of the sizes of coefficients: what it changes a discriminant by may be rounding
BESIDE_PLANE = 1e-9  # of its terms: so near is g to 2 c, its size on an invariant plane
BESIDE_END = 1e-5  # of a hyperbola, x = 1: nearer to it an equilibrium may be one of the other branch
TWICE = 1e-6  # in the chart: nearer to each other, two roots may be one
ROOT_HALF, TAN = 0.7071067811865476, 0.41421356237309503  # of pi/4 the sine, of pi/8
TINY = 1e-250  # in place of zero, so that a quotient is large
NEWTON_STEPS = 2  # from the closed form of a root
LAST_STEP = 1e-8  # in the chart: what is reached by one that is as short is a root
# twice the cosine of two thirds of an angle, of its cosine, to 4e-7
TWO_THIRDS = (1.0000003719387718, 1.1546638041490291, -0.2216109417953118, 0.10294952669106447,
              -0.05279949869562627, 0.021003507188871548, -0.004206982019890607)
MOST = 0.8  # of all rows: to pick so many takes longer than the others' numbers
HALVINGS = 5  # of an arc, whose theta is less than 13 on a hyperbola
SERIES = tuple((2 * n + 2) / (2 * n + 3) for n in range(10))  # of (S1 - y)/(2 e T^3) in e T^2


class Orbits(NamedTuple):
    """What the orbits of a scene have in common, in theta and in a unit of rate: the coefficients that
    `about` takes, the shift of the rate, e and what that makes them, 1/n, and what K changes by a radian."""

    form: tuple[float, ...]
    shift: float
    e: float
    circle: bool
    hyperbola: bool
    over: float
    drift: float


# --- Of arrays, and instead in compiled code
def where(condition: Number, one: Number, other: Number):
    """One or the other."""
    return np.where(condition, one, other)


def chosen(condition: bool, one: float, other: float):
    """`where` of single numbers."""
    return one if condition else other


def either(condition: np.ndarray, one: Callable[..., Any], other: Callable[..., Any], *args: Any):
    """What the one function or the other returns, which is not called where no row needs it."""
    if condition.all():
        return one(*args)
    return np.where(condition, one(*args), other(*args)) if condition.any() else other(*args)


def both(condition: bool, one: Callable[..., Any], other: Callable[..., Any], *args: Any):
    """`either` of single numbers, without a branch."""
    first, second = one(*args), other(*args)
    return first if condition else second


def on_rows(needed: np.ndarray, function: Callable[..., Any], *args: Any):
    """The arrays that a function returns; where they are not needed anything, NaN or False."""
    rows = np.nonzero(needed)[0]
    if len(rows) > MOST * len(needed):
        return function(*args)
    out = []
    for part in function(*(_of_rows(rows, argument) for argument in args)):
        full = np.zeros(len(needed), part.dtype) if part.dtype == bool else np.full(len(needed), np.nan)
        full[rows] = part
        out.append(full)
    return out


def _of_rows(rows: np.ndarray, argument: Any):
    if type(argument) is tuple:  # `Orbits` is another
        return tuple(_of_rows(rows, part) for part in argument)
    return argument[rows] if isinstance(argument, np.ndarray) else argument


def on_all(needed: bool, function: Callable[..., Any], *args: Any):
    """`on_rows` of single numbers: several at a time, none is left out."""
    return function(*args)


# --- The force along an orbit
def product_size(x: Number, x_size: Number, y: Number, y_size: Number):
    """The size of a product, as its factors' roundings change it, given the sizes of these."""
    return 0.5 * (x_size * abs(y) + abs(x) * y_size)


def about(form: Sequence[float], u: Number, v: Number):
    """(f0, f1, F, c, g) of (2) at locations, and the sizes of their terms."""
    p, q, kappa, p0, q0, rho, sigma, m = form
    a, b, A, B = p * v + p0, q * u + q0, kappa * v + sigma, kappa * u + rho
    a_size, b_size = abs(p * v) + abs(p0), abs(q * u) + abs(q0)
    A_size, B_size = abs(kappa * v) + abs(sigma), abs(kappa * u) + abs(rho)
    c, c_size = kappa * (a * b), abs(kappa) * product_size(a, a_size, b, b_size)
    return ((A * u + rho * v + m, A * a + B * b, A * (p * b) + B * (q * a) - c, c,
             kappa * (q * (a * a) + p * (b * b))),
            (A_size * abs(u) + abs(rho * v) + abs(m),
             product_size(A, A_size, a, a_size) + product_size(B, B_size, b, b_size),
             (abs(p) * product_size(A, A_size, b, b_size) + abs(q) * product_size(B, B_size, a, a_size)
              + c_size), c_size,
             abs(kappa) * (abs(q) * (a_size * abs(a)) + abs(p) * (b_size * abs(b)))))


def force_quartic(series: Sequence[Number], e: float, sign: float):
    """The coefficients in x of the force times (1 - e x^2)^2, lowest first; sign -1, or 1 of sizes: that of
    their terms."""
    f0, f1, f2, c, g = series
    return (f0, 2 * f1, 2 * (f2 + 3 * c) + sign * (2 * e * f0), 4 * g + sign * (2 * e * f1),
            e * e * f0 + 2 * e * (sign * f2 + c))


def discriminant(quartic: Sequence[Number], sizes: Sequence[Number]):
    """(27 times that of quartics, negative where two roots are real; what a share `DOUBLE_ROOT` of their
    sizes changes it by)."""
    a, b, c, d, high = quartic
    bd, square = b * d, c * c
    first = 12 * (high * a) - 3 * bd + square
    second = c * (72 * (high * a) + 9 * bd - 2 * square) - 27 * (a * (d * d) + high * (b * b))
    apart = 4 * (first * first * first) - second * second
    a, b, c, d, high = abs(a), abs(b), abs(c), abs(d), abs(high)
    da, db, dc, dd, dh = sizes
    ends, sides = product_size(a, da, high, dh), product_size(b, db, d, dd)
    rest = (72 * (ends * c + a * high * dc) + 9 * (sides * c + b * d * dc) + 6 * (square * dc)
            + 27 * (d * (d * da + 2 * a * dd) + b * (b * dh + 2 * high * db)))
    return apart, DOUBLE_ROOT * (12 * (first * first) * (12 * ends + 3 * sides + 2 * c * dc)
                                 + 2 * abs(second) * rest)


# --- Its roots
def larger(x: Number, y: Number):
    return where(x > y, x, y)


def root_of(x: Number):
    """The square root, 0 of less."""
    return np.sqrt(where(x > 0, x, 0.0))


def cube_root(x: Number):
    """That of x >= 0, to some digits."""
    root = np.sqrt(np.sqrt(x))
    fine = np.sqrt(np.sqrt(root))
    root = root * fine * np.sqrt(np.sqrt(fine))
    for _ in range(3):  # Halley's method
        cube = root * root * root
        root = root * (cube + 2 * x) / (2 * cube + x)
    return root


def scale_of(quartic: Sequence[Number]):
    """The size of most roots: there the terms of low order are as large as those of high order."""
    a, b, _, d, high = quartic
    mean = np.sqrt(np.sqrt(abs(a) / (abs(high) + TINY))) + TINY
    return np.sqrt((abs(b) + abs(a) / mean) / (abs(d) + abs(high) * mean))


def rotated(q: Sequence[Number]):
    """The coefficients of quartics in tan(phi - pi/8) in place of x = tan phi, lowest first: times cos(phi)^4
    they are 1/8 of M + P cos 2 phi + Q sin 2 phi + U cos 4 phi + V sin 4 phi."""
    a, b, c, d, high = q
    ends, P, Q = a + high, 2 * (a - high), b + d
    M, U, V = 3 * ends + c, ends - c, b - d
    ends, P, Q = 0.25 * (M + V), ROOT_HALF * (P + Q), ROOT_HALF * (Q - P)
    return 0.5 * ends + 0.25 * P, 0.5 * (Q - U), 0.25 * (M - 3 * V), 0.5 * (Q + U), 0.5 * ends - 0.25 * P


def barrier_roots(quartic: Sequence[Number]):
    """(X, Z of the first root where a quartic rises, of the second, whether the first is the surer one,
    whether four roots are real if two are not): a root is X/Z, or is none."""
    plain, ends = rotated(quartic), (quartic[0], quartic[4])
    turn = larger(abs(plain[0]), abs(plain[4])) > larger(abs(ends[0]), abs(ends[1]))
    a, b, c = where(turn, plain[0], ends[0]), where(turn, plain[1], quartic[1]), where(turn, plain[2],
                                                                                   quartic[2])
    d, high = where(turn, plain[3], quartic[3]), where(turn, plain[4], ends[1])
    inverse = abs(a) > abs(high)
    lead, over = where(inverse, a, high), 1 / where(inverse, a, high)
    s, B2, B1 = 0.25 * over * where(inverse, b, d), c * over, over * where(inverse, d, b)
    square = s * s
    # of the depressed quartic t^4 + p t^2 + q t + r, and its resolvent z^3 + 2 p z^2 + (p^2 - 4 r) z - q^2
    p, q = B2 - 6 * square, B1 - 2 * s * (B2 - 4 * square)
    r4 = 4 * (over * where(inverse, high, a) - s * (B1 - s * (B2 - 3 * square)))
    rest = p * p - r4
    z = largest_root(p, q, r4)
    half, split = 0.5 * np.sqrt(z), 2 * root_of((z + p) * (z + p) - r4)
    split = where(q > 0, split, -split)
    rises = where((lead > 0) == inverse, -0.5, 0.5)
    one, other = split - z - 2 * p, -split - z - 2 * p
    first = rises * root_of(one) - half - s
    second = rises * root_of(other) + half - s
    return (*back(first, inverse, turn), *back(second, inverse, turn), one > other, (p < 0) & (rest > 0))


def largest_root(p: Number, q: Number, r4: Number):
    """That of the resolvent, which is not negative."""
    square, half = p * p, 0.5 * q * q
    P, Q = (square + 3 * r4) * (1 / 9), p * (square * (1 / 27) - r4 * (1 / 3)) + half
    z = either(P * P * P > Q * Q, largest_of_three, only_one, P, Q) - p * (2 / 3)
    rest = square - r4
    return larger(0.0, z - (z * (z * (z + 2 * p) + rest) - 2 * half) / (z * (3 * z + 4 * p) + rest))


def largest_of_three(P: Number, Q: Number):
    """That of w^3 - 3 P w = 2 Q, to six digits."""
    root = root_of(P)
    x = root_of(0.5 + 0.5 * Q / (P * root))
    c0, c1, c2, c3, c4, c5, c6 = TWO_THIRDS
    return root * (c0 + x * (c1 + x * (c2 + x * (c3 + x * (c4 + x * (c5 + x * c6))))))


def only_one(P: Number, Q: Number):
    """The same where one root is real."""
    root = cube_root(abs(Q) + root_of(Q * Q - P * P * P))
    return where(Q > 0, root + P / root, -root - P / root)


def back(t: Number, inverse: Number, turn: Number):
    """(X, Z) of roots in the charts that `barrier_roots` takes."""
    X, Z = where(inverse, 1.0, t), where(inverse, t, 1.0)
    return where(turn, X + TAN * Z, X), where(turn, Z - TAN * X, Z)


def polynomial(x: Number, quartic: Sequence[Number]):
    """(value, slope) of quartics, lowest coefficient first."""
    a, b, c, d, high = quartic
    return a + x * (b + x * (c + x * (d + x * high))), b + x * (2 * c + x * (3 * d + x * (4 * high)))


# --- K there
def third(X: Number, Z: Number, N: Number, e: float):
    """(y, S3) of the arc with x = X/Z, X and Z not negative, N = Z^2 - e X^2: S3(2 y) = 2 (S3 + S1 S2), from
    its series."""
    times, total, cube = 1.0, 0.0, 4 * (X * X * X)
    for _ in range(HALVINGS):
        root = np.sqrt(N)
        Z = Z + root
        N = 2 * root * Z
        over, times = 1 / N, 2 * times
        total = total + times * (cube * Z * (over * over))
    T = X / Z
    square = T * T
    z = e * square
    S3 = SERIES[9] + 0.0 * z
    for n in range(8, -1, -1):
        S3 = S3 * z + SERIES[n]
    S3 = 2 * T * square * S3
    return times * (2 * T / (1 - z) - e * S3), total + times * S3


def height(X: Number, Z: Number, R: Number, quartic: Sequence[Number], series: Sequence[Number],
           terms: Sequence[Number], energy: Number, size: Number, orbits: Orbits):
    """(K, whether that of a barrier is certain, X, Z, whether it stands on the other branch) of the
    equilibrium next to a root X/Z of a quartic in x/R; on a circle ahead, within one turn."""
    e, circle, hyperbola, over_n, drift = orbits[2:]
    far = abs(X) > abs(Z)
    a, b, c, d, high = quartic
    q = where(far, high, a), where(far, d, b), c, where(far, b, d), where(far, a, high)
    t = where(far, Z, X) / where(far, X, Z)
    for _ in range(NEWTON_STEPS):
        value, slope = polynomial(t, q)
        t = t - value / slope
    value, slope = polynomial(t, q)
    rises = abs(value) <= LAST_STEP * where(far, -slope, slope)
    chart_x, chart_z = where(far, 1.0, t), where(far, t, 1.0)
    X, Z = R * chart_x, chart_z
    total = Z * Z + e * e * (X * X)
    N = where(hyperbola, (Z - X) * (Z + X), total)
    over = 1 / N
    y, S3 = third(abs(X), abs(Z), N, e)
    side = where(t < 0, -1.0, 1.0)
    y, S1, S2, S3 = side * y, 2 * X * Z * over, 2 * X * X * over, side * S3
    jump = where(circle & (y * drift < 0), abs(drift) * TURN, 0.0)
    f0, f1, f2, f3, f4 = series
    S12, S22 = S1 * S2, 0.5 * S2 * S2
    K = energy + (f0 * y + f1 * S2 + f2 * S3 + f3 * S12 + f4 * S22) + jump
    f0, f1, f2, f3, f4 = terms
    bend = 0.5 * over * abs(slope) / R
    # besides, K at an equilibrium is off by half the square of a force that is left there over K''
    blur, left = ROUNDINGS * ULP * f0, value * (over * over)
    error = (ROUNDINGS * ULP * (size + f0 * abs(y) + f1 * S2 + f2 * abs(S3) + f3 * abs(S12) + f4 * S22 + jump)
             + (left * left + blur * blur) / bend)
    # rounding of the force must not tell whether a barrier stands ahead or a turn away
    ahead = (abs(y) * over_n > BESIDE_BARRIER) & (abs(y) * bend > CLEAR * blur)
    certain = ((error <= MARGIN_SHARE * (energy + abs(energy - K))) & (error <= abs(K) / CLEAR)
               & ((not circle) | ahead))
    return K, rises & certain & (N > BESIDE_END * total), chart_x, chart_z, rises & (N < -BESIDE_END * total)


# --- Margins
def margin(u: Number, v: Number, rate: Number, orbits: Orbits):
    """(Margin of states below the barrier that bounds their motion, whether it is clear), per unit of
    (omega_i + s)^2/2: on circles of the highest one within one turn ahead, -inf without one, else of the one
    between walls, inf without one."""
    form, shift, e, circle, hyperbola, _, _ = orbits
    w = rate + shift
    energy = 0.5 * w * w
    series, terms = about(form, u, v)
    quartic = force_quartic(series, e, -1.0)
    apart, doubt = discriminant(quartic, force_quartic(terms, abs(e), 1.0))
    # on a circle S1 is no more than 1, S2 than 2: too much of a force to vanish
    strong = circle & (abs(series[0]) > CLEAR * ULP * terms[0] + terms[1] + 2 * terms[2] + 14 * terms[3]
                       + 2 * terms[4])
    clear = (abs(apart) > doubt) & (
        (not hyperbola) | (abs(abs(series[4]) - 2 * abs(series[3])) > BESIDE_PLANE * terms[4]))
    R = scale_of(quartic)
    R2 = R * R
    quartic = quartic[0], quartic[1] * R, quartic[2] * R2, quartic[3] * R2 * R, quartic[4] * R2 * R2
    X1, Z1, X2, Z2, surer, four = barrier_roots(quartic)
    two, four = (apart < 0 if circle else apart > 0), four & (apart > 0) & circle
    order = where(circle, surer, abs(X1 * Z2) < abs(X2 * Z1))
    shared = R, quartic, series, terms, energy, energy + abs(w) * (abs(rate) + abs(shift)), orbits
    K, sure, x1, z1, outside = on_rows(clear & (two | four), height, where(order, X1, X2),
                                       where(order, Z1, Z2), *shared)
    other, sure2, x2, z2, outside2 = on_rows(clear & (four | outside), height, where(order, X2, X1),
                                             where(order, Z2, Z1), *shared)
    distinct = abs(x1 * z2 - x2 * z1) > TWICE
    none = strong | ((two | four) == False) | (outside & outside2 & distinct)  # noqa: E712  # of arrays too
    return (where(none, -INFINITY if circle else INFINITY, -where(four & (other < K), other, K)),
            strong | (clear & (none | (sure & (two | (sure2 & distinct))))))


def margins(u: np.ndarray, v: np.ndarray, rate: np.ndarray, orbits: Orbits, out: np.ndarray,
            clear: np.ndarray):
    """Fill out (n,) and clear (n,), bytes, with what `margin` gives of states."""
    for n in range(len(u)):
        out[n], sure = margin(u[n], v[n], rate[n], orbits)
        clear[n] = 1 if sure else 0


# all but `margins` are one loop without a call, as it takes to have several rows at a time
INLINED = {"chosen", "where", "on_all", "on_rows", "product_size", "about", "force_quartic", "discriminant",
           "larger", "root_of", "cube_root", "scale_of", "rotated", "barrier_roots", "largest_root", "either",
           "both", "largest_of_three", "only_one", "back", "polynomial", "third", "height", "margin"}
BARRIERS = Kernel(sys.modules[__name__], "margins", 2.0, INLINED,
                  instead={"where": chosen, "either": both, "on_rows": on_all},
                  options={"allocating": False, "entries": {"margins"}})
# s of a processor: the margin of a row in plain Python, which serves a FEW; a call of arrays beyond the
# compiled loop, which takes as long for each row
IN_PLAIN, FEW, CALL = 5.8e-5, 8, 4.7e-4


def orbits_of(reduction: Reduction) -> Orbits:
    """Those of a reduction, in the unit of its rates."""
    r, n = reduction, sqrt_fraction(abs(reduction.p * reduction.q)) or Fraction(1)
    form = tuple(float(number / n) for number in (r.p, r.q, r.kappa, r.p0, r.q0, r.rho, r.sigma, r.m))
    walled, centred = r.geometry.walled, r.geometry.centred
    return Orbits(form, float(r.s), float(r.e), not walled, walled and centred, float(1 / n),
                  float(r.torque / n))


def in_unit(orbits: Orbits, unit: float) -> Orbits:
    """The same with all rates times a power of two, which they remain doubles by."""
    p, q, kappa, *linear, m = orbits.form
    return orbits._replace(form=(p, q, kappa, *(number * unit for number in linear), m * unit * unit),
                           shift=orbits.shift * unit, drift=orbits.drift * unit * unit)


def margins_of(reduction: Reduction, orbits: Orbits, states: np.ndarray):
    """(Margins (n,) of states (n, 3) as `margin` has them, in the unit of their rates; which are doubtful
    (n,), those beside an invariant plane too)."""
    unit = float(np.ldexp(1.0, -np.frexp(np.abs(states).max(initial=0.0))[1]))
    u, v, rate = (states[:, axis] * unit for axis in (reduction.j, reduction.k, reduction.axis))
    scaled = in_unit(orbits, unit)
    with np.errstate(all="ignore"):
        if on_lines(orbits):
            below, clear = margin_on_line(u, v, rate, scaled)
        elif (fast := BARRIERS.pays(min(IN_PLAIN * len(states), CALL))) or len(states) < FEW:
            below, clear = np.empty(len(states)), np.empty(len(states), np.int8)
            BARRIERS.functions(fast)["margins"](u, v, rate, scaled, below, clear)
        else:
            below, clear = margin(u, v, rate, scaled)
        return below / unit / unit, clear == 0


def on_lines(orbits: Orbits) -> bool:
    """Whether the force changes evenly along all orbits, as it does of spheres."""
    p, q, kappa, p0, q0, *_ = orbits.form
    return not (orbits.circle or orbits.hyperbola) and not ((p or p0) and (q or q0) and (p or q or kappa))


def margin_on_line(u: np.ndarray, v: np.ndarray, rate: np.ndarray, orbits: Orbits):
    """`margin` where the force is f0 + f1 y."""
    w = rate + orbits.shift
    (f0, f1, *_), (size0, size1, *_) = about(orbits.form, u, v)
    energy, y = 0.5 * w * w, f0 / f1
    K = energy - 0.5 * f0 * y
    error = ROUNDINGS * ULP * (energy + abs(w) * (abs(rate) + abs(orbits.shift)) + size0 * abs(y)
                               + size1 * y * y)
    sure = (error <= MARGIN_SHARE * (energy + abs(energy - K))) & (error <= abs(K) / CLEAR)
    return where(f1 > 0, -K, INFINITY), (abs(f1) > DOUBLE_ROOT * size1) & (sure | (f1 < 0))
