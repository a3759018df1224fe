"""Extremes and periods of bounded rows on circles and hyperbolas, one row at a time, as straight lines of
floats that numba compiles.

Equilibria along a row's orbit by Newton's method in twofold numbers, ends of the motion from the equilibrium
that is nearer in height, the period T = 2 int_0^pi dphi/sqrt(2 H) with theta = middle - half cos(phi), where
H = (E - V)/((theta - l)(r - theta)) is the second divided difference of V at (l, r, theta), formed by
products. What 32 digits do not settle is marked and left to balls. Every function is plain Python too.
"""
from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from math import factorial

import numpy as np

from ..numbers.error_free import add, exact_product, exact_sum, less, scaled, times, value

ULP = 2.220446049250313e-16
TURN, PI = 6.283185307179586, 3.141592653589793
INFINITY = float("inf")
BOX, PERIOD = 1, 2  # bits: wanted, and left open
TINY = 1e-300
ROUNDINGS = 64.0  # units of rounding allowed for beside a fold, as in `landscape`
# of Newton's method at an equilibrium; of a radian, a last step: the next would be its square
STEPS, SETTLED = 6, 1e-15
# of a radian: a last step that serves; farther from the first guess another equilibrium may have been found
ENOUGH, DRIFT = 1e-12, 1e-3
TWOFOLD, SURE = 2.0**-100, 1e-20  # of the terms: rounding of a twofold sum; a sum that is smaller may be zero
# units of rounding of a height, by the size of its terms; below it y - sinh y is a series
ROUNDED, LAG = 8.0, 0.3
CLEAR = 64.0  # times its error, so far a height is from the energy where the barrier's side is certain
DIGITS, PERIOD_DIGITS = 1e-12, 1e-11  # promised, relative: rounding that leaves less leaves a row open
# of the energy terms: nearer to a barrier an energy in doubles leaves the period no eleven digits
PERIOD_SHARE = 1e-4
ROOT = 1e-9  # relative, the last step to a turning point, which leaves its square
# relative, of sums over nodes: the last change, the error by estimate, a change that is nothing but rounding
ALIKE, CONVERGED, FLOOR = 1e-9, 1e-13, 1e-15
NARROW = 0.5  # half-widths below it take series where closed forms cancel
# of the terms of an energy in twofold numbers: a dozen sums and a series of twenty terms, with room to spare
FINE = 2.0**-92
# relative, of E - V at a stop and half-way between two; the period's promise is `PERIOD_DIGITS`
PIECE_DIGITS = 3e-12
STEP_CHANGE = 1e-6  # of the force at an end: what a step there may change it by, whose square is left
NEWTON = 3  # steps to an end in twofold numbers
HALVINGS, SERIES = 6, 12  # of a way, before its sine is summed; terms of the sum: 0.2^24/24! is 1e-41
# columns of a spot: its offset from the state, E - V there, whether it is a barrier, the place, dF/dtheta,
# modes (A, B) about it; what its force,
# its slope, the energy and the offset may be off by
OFFSET, OVER, BARRIER, AT_X, AT_Z, BEND, MODE_A, MODE_B, PULL, TILT, ERROR, ASTRAY = range(12)
# an end of a motion: offset, force there, error of the offset, error of the energy; E - V at the equilibrium
# that it is told from; dF/dtheta and modes there
END, FORCE, BLUR, HAZE, LEVEL, END_BEND, END_A, END_B = range(8)
# a stop of a motion, an end or an equilibrium that it passes: offset, E - V, force, dF/dtheta, modes
STOP, STOP_OVER, STOP_FORCE, STOP_BEND, STOP_A, STOP_B = range(6)


def _parts(values: Sequence[Fraction]):
    """The high and low parts of rationals."""
    highs = [float(value) for value in values]
    return np.array([(high, float(value - Fraction(high))) for high, value in zip(highs, values)])


OVER_FACTORIALS = _parts([Fraction(1, factorial(n)) for n in range(2 * SERIES + 1)])


def sine_and_lag(y: float):
    """(sin y, 1 - cos y) of a double, |y| <= 4 pi, as twofold numbers."""
    x = y / 2.0**HALVINGS
    t, s, lag = exact_product(x, x), (0.0 * y, 0.0 * y), (0.0 * y, 0.0 * y)
    t = -t[0], -t[1]
    for n in range(SERIES - 1, -1, -1):
        s = add(times(s, t), (OVER_FACTORIALS[2 * n + 1, 0], OVER_FACTORIALS[2 * n + 1, 1]))
        lag = add(times(lag, t), (OVER_FACTORIALS[2 * n + 2, 0], OVER_FACTORIALS[2 * n + 2, 1]))
    s, lag = scaled(s, x), times(lag, (-t[0], -t[1]))
    for _ in range(HALVINGS):
        twice = times(s, s)
        s, lag = add(s, s), less(s, times(s, lag))
        s, lag = add(lag, lag), add(twice, twice)
    return s, lag


def exponential(y: float):
    """exp y of a double as a twofold number."""
    halvings = max(0, int(np.ceil(np.log2(max(abs(y), 0.1) * 10))))
    x, total = y / 2.0**halvings, (0.0 * y, 0.0 * y)
    for n in range(2 * SERIES, -1, -1):
        total = add(scaled(total, x), (OVER_FACTORIALS[n, 0], OVER_FACTORIALS[n, 1]))
    for _ in range(halvings):
        total = times(total, total)
    return total


class Circle:
    """What rows on circles ask of their geometry; of `Hyperbola` the same names."""

    E = -1.0  # of the invariant Z^2 - E X^2
    ROUND = TURN  # after so much theta an orbit comes to the same place again
    WALLED = False  # whether all motions are bounded that are not on a plane

    @staticmethod
    def invariant(x: float, z: float):
        """Z^2 - E X^2."""
        return z * z + x * x

    @staticmethod
    def lost(x: float, z: float, xi: float, eta: float, wide: float, conic: Sequence[float]):
        """Whether a place may be one of those that are decided elsewhere."""
        return x * x + z * z <= TINY

    @staticmethod
    def onto(x: float, z: float, Q: float, xi: float, eta: float, radius: float):
        """(whether it stands on the orbit's own branch, X, Z) of a place brought onto an orbit."""
        scale = radius / np.sqrt(x * x + z * z)
        return True, x * scale, z * scale

    @staticmethod
    def way_between(u: tuple[float, float], v: tuple[float, float], X: tuple[float, float],
                    Z: tuple[float, float], Q: float):
        """theta from a state (X, Z) to a place (u, v) of its orbit, the short way round; all twofold, Q a
        double."""
        return np.arctan2(value(less(times(u, Z), times(v, X))) / Q, value(add(times(u, X), times(v, Z))) / Q)

    @staticmethod
    def whole_way(u: tuple[float, float], v: tuple[float, float], X: tuple[float, float],
                  Z: tuple[float, float], Q: float, way: float):
        """The same as a twofold number, given its double, be that some turns on."""
        s, lag = sine_and_lag(way)
        across, along = less(times(u, Z), times(v, X)), add(times(u, X), times(v, Z))
        return exact_sum(way, value(less(less(across, times(across, lag)), times(along, s))) / Q)

    @staticmethod
    def moved(X: tuple[float, float], Z: tuple[float, float], y: float):
        """The place a way y from (X, Z), twofold."""
        s, lag = sine_and_lag(y)
        return add(X, less(times(Z, s), times(X, lag))), less(Z, add(times(Z, lag), times(X, s)))

    @staticmethod
    def swing(y: float):
        """(sin y, sin(y/2), y less the first without cancellation)."""
        h, t = np.sin(0.5 * y), y * y
        s = 2 * h * np.cos(0.5 * y)
        return s, h, (y * t / 6 * (1 - t / 20 * (1 - t / 42 * (1 - t / 72 * (1 - t / 110 * (1 - t / 156)))))
                      if abs(y) < 0.7 else y - s)

    @staticmethod
    def bent(x: float, z: float):
        """Z^2 + E X^2."""
        return (z - x) * (z + x)

    @staticmethod
    def sizes_of_ways(x: float, z: float, u: float, v: float):
        """Sizes of what `way_between` is told from, at a state and at a place of its orbit."""
        return np.sqrt(x * x + z * z), np.sqrt(u * u + v * v)

    @staticmethod
    def repeated(spots: np.ndarray, count: int, mu: float):
        """The last of so many spots a turn earlier or later too, where the tilt has changed the potential by
        2 pi mu; how many there are then."""
        point, twin = spots[count - 1], spots[count]
        turn = TURN if point[OFFSET] <= 0 else -TURN
        twin[:] = point
        twin[OFFSET] += turn
        twin[OVER] += turn * mu
        twin[ERROR] += ROUNDED * ULP * TURN * mu
        return count + 1

    @staticmethod
    def change(x: float, z: float, xi: float, eta: float, y: float):
        """(what X and Z change by on the way y from a state, what rounding of that way's terms leaves of
        either)."""
        s, h = np.sin(y), np.sin(0.5 * y)
        down = 2 * h * h
        return z * s - x * down, -z * down - x * s, 4 * (abs(z * s)
                                                         + abs(x) * down), 4 * (abs(z) * down + abs(x * s))

    @staticmethod
    def stationary(row: int, x: float, z: float, xi: float, eta: float, left: float):
        """The first offset beyond the left end where X (row 0) or Z (1) is stationary; it is so again half a
        turn later."""
        first = np.arctan(z / x if row == 0 else -x / z)
        at = first + PI * np.ceil((left - first) / PI)
        return at if at > left else at + PI

    @staticmethod
    def size_of_terms(conic: Sequence[float], x: float, z: float, xi: float, eta: float):
        """Of the potential, but for its tilt."""
        q = x * x + z * z
        return abs(conic[2]) * q + (abs(conic[0]) + abs(conic[1])) * np.sqrt(q)

    @staticmethod
    def middle_modes(conic: Sequence[float], x: float, z: float, xi: float, eta: float, y: float,
                     data: np.ndarray):
        """Modes about a place y away from a state, then sizes of what these are sums of."""
        c, d, G = conic[0], conic[1], conic[2]
        dx, dz, _, _ = change(x, z, xi, eta, y)
        x, z = x + dx, z + dz
        data[0], data[1], data[2], data[3] = -c * x + d * z, -c * z - d * x, -0.25 * G * (x - z) * (
            x + z), -0.5 * G * x * z
        data[4], data[5] = abs(c * x) + abs(d * z), abs(c * z) + abs(d * x)
        data[6], data[7] = abs(data[2]), abs(data[3])

    @staticmethod
    def whole(rho: float):
        """What `modes_pair` needs of an interval whatever the node."""
        return np.sin(rho), np.cos(rho)

    @staticmethod
    def modes_pair(data: np.ndarray, rho: float, whole_s: float, whole_c: float, share: float):
        """(even, odd) of modes about the middle, as `pair`."""
        p1, q1, p2, q2 = data[0], data[1], data[2], data[3]
        u = rho * share
        v = rho - u
        fu, cu = sinc_cos(u)
        su = u * fu
        sv, cv = whole_s * cu - whole_c * su, whole_c * cu + whole_s * su
        fv = sv / v
        even = -0.5 * fu * fv * (p1 + 4 * p2 * cu * cv)
        if rho < NARROW:
            gu, gv, wu, wv = sinc_minus_cos(u
                                            * u), sinc_minus_cos(v * v), sinc_minus_cos(
                                                4 * u * u), sinc_minus_cos(4 * v * v)
            return even, (0.5 * q1 * (fu * gv - fv * gu) + q2 * (fu * cu * wv - fv * cv * wu)) / rho
        return even, (0.5 * q1 * (cu * fv - fu * cv)
                      + q2 * ((cu * cu - su * su) * fv * cv - fu * cu * (cv * cv - sv * sv))) / rho

    @staticmethod
    def modes_terms(data: np.ndarray, first: int, rho: float, whole_s: float, whole_c: float, left: float):
        """Size of what H is the sum of at a share of the interval, by the sizes that begin at `first`."""
        return abs(data[first]) + abs(data[first + 1]) + 4 * (abs(data[first + 2]) + abs(data[first + 3]))


class Hyperbola:
    """What rows on hyperbolas ask of their geometry."""

    E = 1.0
    ROUND = INFINITY
    WALLED = True

    @staticmethod
    def invariant(x: float, z: float):
        return (z - x) * (z + x)

    @staticmethod
    def lost(x: float, z: float, xi: float, eta: float, wide: float, conic: Sequence[float]):
        return min(abs(xi), abs(eta)) <= SURE * wide or np.sqrt(abs(xi)) * np.sqrt(abs(eta)) <= conic[6]

    @staticmethod
    def onto(x: float, z: float, Q: float, xi: float, eta: float, radius: float):
        first, second = x + z, x - z
        if abs(first) >= abs(second):
            second = -Q / first
        else:
            first = -Q / second
        there = (first > 0) == (xi > 0) and (second > 0) == (eta > 0)
        return there, 0.5 * (first + second), 0.5 * (first - second)

    @staticmethod
    def way_between(u: tuple[float, float], v: tuple[float, float], X: tuple[float, float],
                    Z: tuple[float, float], Q: float):
        # the larger of the growing and the decaying coordinate keeps its digits next to a plane too
        side = -1.0 if X[0] * Z[0] < 0 else 1.0
        start, end = add(X, scaled(Z, side)), add(u, scaled(v, side))
        grown = value(less(end, start)) / value(start)
        return side * (np.log1p(grown) if abs(grown) < 0.5 else np.log(value(end) / value(start)))

    @staticmethod
    def whole_way(u: tuple[float, float], v: tuple[float, float], X: tuple[float, float],
                  Z: tuple[float, float], Q: float, way: float):
        side = -1.0 if X[0] * Z[0] < 0 else 1.0
        start, end = add(X, scaled(Z, side)), add(u, scaled(v, side))
        off = value(less(times(end, exponential(-side * way)), start)) / value(start)
        return exact_sum(way, side * off * (1 - 0.5 * off))

    @staticmethod
    def moved(X: tuple[float, float], Z: tuple[float, float], y: float):
        grown, decayed = times(add(X, Z), exponential(y)), times(less(X, Z), exponential(-y))
        return scaled(add(grown, decayed), 0.5), scaled(less(grown, decayed), 0.5)

    @staticmethod
    def swing(y: float):
        h, t = np.sinh(0.5 * y), y * y
        s = 2 * h * np.sqrt(1 + h * h)
        return s, h, (-y * t / 6 * (1 + t / 20 * (1 + t / 42 * (1 + t / 72 * (1 + t / 110)))) if abs(y) < LAG
                      else y - s)

    @staticmethod
    def bent(x: float, z: float):
        return z * z + x * x

    @staticmethod
    def sizes_of_ways(x: float, z: float, u: float, v: float):
        side = -1.0 if x * z < 0 else 1.0
        return abs(x + side * z), abs(u + side * v)

    @staticmethod
    def repeated(spots: np.ndarray, count: int, mu: float):
        return count

    @staticmethod
    def change(x: float, z: float, xi: float, eta: float, y: float):
        grown, decayed = xi * np.expm1(y), eta * np.expm1(-y)
        off = 0.5 * (abs(grown) + abs(decayed)) * (4 + abs(y))
        return 0.5 * (grown + decayed), 0.5 * (grown - decayed), off, off

    @staticmethod
    def stationary(row: int, x: float, z: float, xi: float, eta: float, left: float):
        nearby, far = (-z / x, eta / xi) if row == 0 else (-x / z, -eta / xi)
        at = np.arctanh(nearby) if abs(nearby) < 0.5 else (0.5 * np.log(far) if far > 0 else INFINITY)
        return at if at > left else INFINITY

    @staticmethod
    def size_of_terms(conic: Sequence[float], x: float, z: float, xi: float, eta: float):
        q = xi * xi + eta * eta
        return abs(conic[2]) * q + 0.5 * (abs(conic[0] + conic[1]) + abs(conic[1] - conic[0])) * np.sqrt(q)

    @staticmethod
    def middle_modes(conic: Sequence[float], x: float, z: float, xi: float, eta: float, y: float,
                     data: np.ndarray):
        c, d, G = conic[0], conic[1], conic[2]
        xi, eta = xi * np.exp(y), eta * np.exp(-y)
        data[0], data[1] = -0.5 * (c + d) * xi, 0.5 * (d - c) * eta
        data[2], data[3] = -0.125 * G * xi * xi, -0.125 * G * eta * eta
        for k in range(4):
            data[4 + k] = abs(data[k])

    @staticmethod
    def whole(rho: float):
        return np.exp(rho), 0.0

    @staticmethod
    def modes_pair(data: np.ndarray, rho: float, whole_s: float, whole_c: float, share: float):
        return sides_of_exponentials(data[0], data[1], data[2], data[3], rho, whole_s, share)

    @staticmethod
    def modes_terms(data: np.ndarray, first: int, rho: float, whole_s: float, whole_c: float, left: float):
        even, odd = sides_of_exponentials(abs(data[first]), abs(data[first + 1]), abs(data[first + 2]),
                                          abs(data[first + 3]), rho, whole_s, min(left, 1 - left))
        return even + odd if left <= 0.5 else even - odd


def guessed(piece: np.ndarray, conic: Sequence[float], Q: float, xi: float, eta: float, radius: float):
    """(whether a piece of the conic meets the orbit, X, Z there by Newton's method in log|h|, held in a
    bracket)."""
    sign, inner, outer, rising, low, high = piece[0], piece[1], piece[2], piece[3] > 0, piece[5], piece[6]
    c, G, K, shift = conic[0], conic[2], conic[4], conic[5]
    if not (low < Q < high):
        return False, 0.0, 0.0
    root = np.sqrt(abs(Q))
    reach = root + abs(c / G) + abs(shift) + np.sqrt(abs(K / G)) + 1e-300
    far = min(outer, 4 * reach)
    nearby = max(inner, abs(K) / (4 * reach * abs(G)))
    low, high = min(nearby, far), max(nearby, far)
    if outer == INFINITY:
        h = min(max(root + abs(shift), low), high)
    elif inner == 0:
        h = min(max(abs(K) / (abs(G) * root + abs(c) + 1e-300), low), high)
    else:
        h = 0.5 * (low + high)
    x, z, before = 0.0, 0.0, INFINITY
    for _ in range(60):
        at = sign * h
        ratio = K / at
        x, z = (ratio - c) / G, at - shift
        off = invariant(x, z) - Q
        if (off > 0) == rising:
            high = h
        else:
            low = h
        step = off / (2 * (z * at + E * x * ratio / G))  # of log h
        new = h * (1 - step) if abs(step) < 0.1 else h * np.exp(-step)
        if not (low <= new <= high) or not abs(step) < before:
            new, step = np.sqrt(low) * np.sqrt(high), 2.0
        before = 0.7 * abs(step) if step < 1.0 else INFINITY
        h = new
        if abs(step) < 1e-7 or high - low <= 4 * ULP * high:
            break
    at = sign * h
    x, z = (K / at - c) / G, at - shift
    return onto(x, z, Q, xi, eta, radius)


def on_line(line: np.ndarray, Q: float, xi: float, eta: float, radius: float):
    """As `guessed`, of one of the two points (x0 + t dx, z0 + t dz) in which a line of equilibria meets the
    orbit."""
    x0, z0, dx, dz, side = line[0], line[1], line[2], line[3], line[4]
    a, b, rest = dz * dz - E * dx * dx, z0 * dz - E * x0 * dx, z0 * z0 - E * x0 * x0 - Q
    if a == 0:
        if b == 0 or side < 0:
            return False, 0.0, 0.0
        t = -0.5 * rest / b
    else:
        square = b * b - a * rest
        if not square > 0:
            return False, 0.0, 0.0
        root = side * np.sqrt(square)
        t = -rest / (b + root) if b * side > 0 else (root - b) / a
    return onto(x0 + t * dx, z0 + t * dz, Q, xi, eta, radius)


def settled(fine: np.ndarray, u0: float, v0: float, Q: tuple[float, float]):
    """(place u, v of the equilibrium next to a guess on the orbit Q, slope of the force there, last step, the
    way from the guess); u, v and Q twofold."""
    G, c, d, mu = (fine[0], fine[1]), (fine[2], fine[3]), (fine[4], fine[5]), (fine[6], fine[7])
    u, v, step, full = (u0, 0.0 * u0), (v0, 0.0 * v0), 1.0 + 0.0 * u0, 0.0 * u0
    for _ in range(STEPS):
        off = value(less(add(times(v, v), scaled(times(u, u), -E)), Q)) / (2 * (u[0] * u[0] + v[0] * v[0]))
        u, v = add(u, exact_product(E * off, u[0])), add(v, exact_product(-off, v[0]))
        across = add(times(G, u), c)
        force = add(add(times(v, across), mu), times(d, u))
        step = -value(force) / slope_of(G, d, u, v, across)
        if not abs(step) < 0.1:
            return u, v, 0.0 * u0, np.nan * u0, full
        full += step
        half = 0.5 * E * step * step
        u, v = add(add(u, scaled(v, step)),
                   scaled(u, half)), add(add(v, scaled(u, E * step)), scaled(v, half))
        if abs(step) <= SETTLED:
            break
    return u, v, slope_of(G, d, u, v, add(times(G, u), c)), step, full


def slope_of(G: tuple[float, float], d: tuple[float, float], u: tuple[float, float], v: tuple[float, float],
             across: tuple[float, float]):
    """dF/dtheta at (u, v), across: G u + c."""
    return value(add(times(v, add(times(G, v), d)), scaled(times(u, across), E)))


def rise_and_force(mu: float, y: float, slope: float, a: float, b: float):
    """(V(y) - V(0), F, size of the terms of the first, sin y, sin(y/2)) y away from an equilibrium with this
    slope and modes a, b."""
    s, h, behind = swing(y)
    h2 = h * h
    item, two, three, four = -2 * slope * h2, -mu * behind, -E * 2 * a * s * h2, -E * 4 * b * h2 * h2
    force = slope * s + E * h2 * (6 * a - 2 * mu + 4 * b * s) + 8 * a * h2 * h2
    return item + two + three + four, force, abs(item) + abs(two) + abs(three) + abs(four), s, h


def end_of_modes(mu: float, slope: float, a: float, b: float, s: float, h: float, end: np.ndarray):
    """dF/dtheta and modes where sin y and sin(y/2) from an equilibrium are s and h: derivatives of what
    `rise_and_force` says."""
    h2 = h * h
    q = 1 + 2 * E * h2
    end[END_BEND] = slope * q + E * (0.5 * s * (6 * a - 2 * mu + 4 * b * s) + 4 * b * h2 * q) + 8 * a * h2 * s
    end[END_A], end[END_B] = a * (q * q
                                  + E * s * s) + 2 * b * s * q, b * (q * q + E * s * s) + 2 * E * a * s * q


def rounding_of(y: float, terms: float, s: float, h: float, pull: float, tilt: float):
    """Size of the error of a rise: of its terms, which grow like an exponential of y, and of what the
    equilibrium's force and slope are off by."""
    return (ROUNDED + 2 * abs(y)) * ULP * terms + pull * abs(s) + 2 * tilt * h * h


def placed(u: tuple[float, float], v: tuple[float, float], X: tuple[float, float], Z: tuple[float, float],
           wide: float, last: float, conic: Sequence[float], route: float, slope: float, point: np.ndarray):
    """Fill a spot's place, slope, modes and what 32 digits leave open of it."""
    c, d, G, mu = conic[0], conic[1], conic[2], conic[3]
    uh, vh = value(u), value(v)
    far = abs(uh) + abs(vh)
    off = TWOFOLD * (far + wide * wide / far)
    steep = abs(G) * far + abs(c) + abs(d)
    start, end = sizes_of_ways(X[0], Z[0], uh, vh)
    point[OFFSET], point[AT_X], point[AT_Z], point[BEND] = route, uh, vh, slope
    point[MODE_A], point[MODE_B] = G * uh * vh, 0.5 * G * bent(uh, vh)
    point[PULL] = steep * off + TWOFOLD * mu + (2 * abs(G) * far + steep) * far * last * last
    point[TILT], point[ASTRAY] = (abs(G) * far + steep) * off, TWOFOLD * wide / start + off / end


def spots_of_row(fine: np.ndarray, conic: Sequence[float], pieces: np.ndarray, lines: np.ndarray,
                 straight: float, folds: np.ndarray, X: tuple[float, float], Z: tuple[float, float], w: float,
                 wide: float, spots: np.ndarray):
    """(how many equilibria stand along the orbit of a row, in ascending order in `spots`; whether all were
    placed).

    straight: the invariant up to which lines say where they are about, and no pieces of the conic."""
    Q = add(times(Z, Z), scaled(times(X, X), -E))
    xi, eta, q = value(add(X, Z)), value(less(X, Z)), value(Q)
    mu, count = conic[3], 0
    for fold in folds:
        if not abs(q - fold) > ROUNDINGS * ULP * (wide * wide + abs(fold)):
            return 0, False
    radius = np.sqrt(abs(q))
    kinetic, x, z = 0.5 * w * w, value(X), value(Z)
    force = conic[3] + conic[2] * x * z + conic[0] * z + conic[1] * x
    by_lines = q <= straight
    for p in range(len(lines) if by_lines else len(pieces)):
        there, u0, v0 = (on_line(lines[p], q, xi, eta, radius) if by_lines
                         else guessed(pieces[p], conic, q, xi, eta, radius))
        if not there:
            continue
        u, v, slope, last, drift = settled(fine, u0, v0, Q)
        as_expected = by_lines or (slope > 0) == (pieces[p, 4] > 0)
        if not (abs(last) <= ENOUGH and abs(drift) <= DRIFT and as_expected):
            return 0, False
        point = spots[count]
        route = way_between(u, v, X, Z, q)
        placed(u, v, X, Z, wide, last, conic, route, slope, point)
        rise, _, terms, s, h = rise_and_force(mu, -route, slope, point[MODE_A], point[MODE_B])
        point[OVER], point[BARRIER] = kinetic + rise, 1.0 if slope > 0 else 0.0
        point[ERROR] = (rounding_of(route, terms, s, h, point[PULL], point[TILT]) + ROUNDED * ULP * kinetic
                       + abs(force) * point[ASTRAY])
        count = repeated(spots, count + 1, mu)
    for i in range(1, count):
        for k in range(i, 0, -1):
            if spots[k - 1, OFFSET] <= spots[k, OFFSET]:
                break
            for column in range(ASTRAY + 1):
                spots[k - 1, column], spots[k, column] = spots[k, column], spots[k - 1, column]
    sure = True
    for i in range(count):
        sure = (sure and abs(spots[i, OVER]) < INFINITY and spots[i, ERROR] < INFINITY
                and spots[i, ASTRAY] < INFINITY)
        if i:  # wells and barriers take turns
            sure = (sure and spots[i, OFFSET] > spots[i - 1, OFFSET]
                    and spots[i, BARRIER] != spots[i - 1, BARRIER])
    return count, sure


def sharpened(fine: np.ndarray, conic: Sequence[float], X: tuple[float, float], Z: tuple[float, float],
              turn: tuple[float, float], wide: float, count: int, spots: np.ndarray):
    """E - V at the equilibria along a row's orbit anew, as sums of twofold numbers: next to a separatrix
    doubles leave little of it.

    turn: the rate about the axis, less its shift, twofold."""
    G, c, d, mu = (fine[0], fine[1]), (fine[2], fine[3]), (fine[4], fine[5]), (fine[6], fine[7])
    kinetic = times((fine[16], fine[17]), times(turn, turn))
    Q = add(times(Z, Z), scaled(times(X, X), -E))
    for i in range(count):
        point = spots[i]
        u, v, slope, last, _ = settled(fine, point[AT_X], point[AT_Z], Q)
        route = whole_way(u, v, X, Z, value(Q), point[OFFSET])
        half = times(G, scaled(add(u, X), 0.5))
        over = add(add(kinetic, times(mu, route)),
                   add(times(less(u, X), add(half, c)), scaled(times(d, less(v, Z)), E)))
        far = abs(u[0]) + abs(v[0]) + wide
        terms = kinetic[0] + mu[0] * (1 + abs(route[0])) + (abs(G[0]) * far + abs(c[0]) + abs(d[0])) * far
        if abs(last) <= ENOUGH:
            point[OVER], point[ERROR] = value(over), FINE * terms + point[PULL] * point[PULL] / abs(slope)


def sharpened_ends(fine: np.ndarray, X: tuple[float, float], Z: tuple[float, float],
                   turn: tuple[float, float], wide: float, ends: np.ndarray, turns: np.ndarray):
    """Fill turns with the ends after steps of Newton's method, E - V there a sum of twofold numbers and the
    force that of the place: where the force is small or the equilibrium far, doubles leave few digits.

    They are told from the state. Next to a barrier the period needs the ends that are told from it."""
    G, c, d, mu = (fine[0], fine[1]), (fine[2], fine[3]), (fine[4], fine[5]), (fine[6], fine[7])
    kinetic = times((fine[16], fine[17]), times(turn, turn))
    for k in range(2):
        turns[k] = ends[k]
        end = turns[k]
        for _ in range(NEWTON):
            u, v = moved(X, Z, end[END])
            half = times(G, scaled(add(u, X), 0.5))
            rise = add(times(less(u, X), add(half, c)), scaled(times(d, less(v, Z)), E))
            over = value(add(add(kinetic, scaled(mu, end[END])), rise))
            across = add(times(G, u), c)
            end[FORCE] = value(add(add(times(v, across), mu), times(d, u)))
            end[END_BEND] = slope_of(G, d, u, v, across)
            step, steep = -over / end[FORCE], abs(end[END_BEND] / end[FORCE])
            if not abs(step) * steep <= STEP_CHANGE:
                turns[k] = ends[k]
                break
            end[END] += step
            far = abs(u[0]) + abs(v[0]) + wide
            terms = kinetic[0] + mu[0] * (1 + abs(end[END])) + (abs(G[0]) * far + abs(c[0]) + abs(d[0])) * far
            end[HAZE] = FINE * terms
            end[BLUR] = end[HAZE] / abs(end[FORCE]) + step * step * steep + ULP * abs(end[END])
            if abs(step) <= ULP * abs(end[END]):
                break


def way_of_cosine(psi: float, nearby: float, far: float):
    """First guess of a turning point between a barrier and a well, as a share of the way: there V is nearly a
    cosine, and in its angle psi (0 to 1) the way is a cubic with the slopes near, far that the curvatures at
    both ends give."""
    return psi * (nearby * (1 - psi) * (1 - psi) + psi * (3 - 2 * psi) - far * psi * (1 - psi))


def turned(mu: float, count: int, spots: np.ndarray, side: int, end: np.ndarray):
    """Where a motion turns on one side: fills an end; whether it was found."""
    b = -1
    for i in range(count):
        i = i if side > 0 else count - 1 - i
        if spots[i, BARRIER] > 0 and spots[i, OVER] <= 0 and spots[i, OFFSET] * side > 0:
            b = i
            break
    well = b - side if b >= 0 else (count - 1 if side > 0 else 0)
    has_well = 0 <= well < count and not spots[well, BARRIER] > 0
    if b < 0 and not has_well:
        return False
    at_barrier = b >= 0 and (not has_well or -spots[b, OVER] < max(spots[well, OVER], 0.0))
    point = spots[b] if at_barrier else spots[well]
    level, slope = (min(point[OVER], 0.0) if at_barrier else max(point[OVER], 0.0)), point[BEND]
    towards = -side if at_barrier else side
    mode_a, mode_b = point[MODE_A], point[MODE_B]
    gap = abs(spots[b, OFFSET] - spots[well, OFFSET]) if b >= 0 and has_well else INFINITY
    reach = min(gap, ROUND) if min(gap, ROUND) < INFINITY else 1.0
    for _ in range(64 if reach == 1.0 and gap == ROUND else 0):
        up = rise_and_force(mu, towards * reach, slope, mode_a, mode_b)[0]
        if not (up > level if level < 0 else up < level):
            break
        reach = min(2 * reach, reach + 64)
    t = min(np.sqrt(2 * abs(level) / max(abs(slope), 1e-300)), 0.5 * reach)
    if b >= 0 and has_well:
        other = spots[well] if at_barrier else spots[b]
        full = spots[well, OVER] - spots[b, OVER]
        psi = 2 / PI * np.arcsin(np.sqrt(min(abs(level) / full, 1.0)))
        guess = (reach * way_of_cosine(psi, PI * np.sqrt(0.5 * full / abs(slope)) / reach,
                                       PI * np.sqrt(0.5 * full / abs(other[BEND])) / reach))
        t = guess if 0 < guess < reach else 0.5 * reach
    low, high, result, before = 0.0, reach, level == 0, INFINITY
    if result:
        t = 0.0 * t
    for _ in range(100):
        if result:
            break
        rise, force, _, _, _ = rise_and_force(mu, towards * t, slope, mode_a, mode_b)
        if (rise - level > 0) != at_barrier:
            high = t
        else:
            low = t
        step = (rise - level) / (-towards * force)
        small = abs(step) <= ROOT * t
        if small or (low <= t - step <= high and abs(step) < 0.5 * before):
            before, t, result = abs(step), t - step, small or rise == level
        else:
            before, t = high - low, 0.5 * (low + high)
            result = high - low <= 2 * ULP * high
    y = t * towards
    _, force, terms, s, h = rise_and_force(mu, y, slope, mode_a, mode_b)
    blur = rounding_of(y, terms, s, h, point[PULL], point[TILT])
    end[END], end[FORCE], end[HAZE] = point[OFFSET] + y, force, blur
    end[BLUR] = blur / abs(force) + ULP * abs(point[OFFSET])
    end[LEVEL] = point[OVER]
    end_of_modes(mu, slope, mode_a, mode_b, s, h, end)
    return result and abs(end[END]) < INFINITY


def spanned(mu: float, w: float, count: int, spots: np.ndarray, ends: np.ndarray):
    """(whether the motion's two ends are known, fastest W^2/2, its error, nearest barrier's distance in
    energy)."""
    if count == 0 or not (turned(mu, count, spots, -1, ends[0]) and turned(mu, count, spots, 1, ends[1])):
        return False, 0.0, 0.0, 0.0
    ends[0, END], ends[1, END] = min(ends[0, END], 0.0), max(ends[1, END], 0.0)
    left, right = ends[0, END], ends[1, END]
    fastest, closest, clear, barred = 0.5 * w * w, INFINITY, True, False
    for i in range(count):
        point = spots[i]
        if point[BARRIER] > 0:
            closest = min(closest, abs(point[OVER]))
            clear = clear and abs(point[OVER]) > CLEAR * point[ERROR]
            barred = barred or (point[OVER] <= 0 and point[OFFSET] > 0)
        elif left <= point[OFFSET] <= right:
            fastest = max(fastest, point[OVER])
    off, astray = 0.0, 0.0
    for i in range(count):
        nearby = False
        for k in range(max(i - 1, 0), min(i + 2, count)):
            nearby = nearby or left <= spots[k, OFFSET] <= right
        if nearby and abs(spots[i, OVER]) <= fastest:
            off, astray = max(off, spots[i, ERROR]), max(astray, spots[i, ASTRAY])
    for k in range(2):
        ends[k, BLUR] += off / abs(ends[k, FORCE]) + astray
        # no number is not: the largest of some would pass over it
        clear = clear and ends[k, BLUR] < INFINITY and ends[k, HAZE] < INFINITY
    return clear and (barred or WALLED), fastest, off + ULP * fastest, closest


def boxed(form: Sequence[float], axes: Sequence[int], state: np.ndarray, x: float, z: float, xi: float,
          eta: float, ends: np.ndarray, fastest: float, margin: float, box: np.ndarray):
    """Fill the box (3, 2) of a row; whether it has its digits. form: factors of X and Z, flip/n and the shift
    of the third."""
    j, k, i = axes
    low_x, high_x, low_z, high_z, off_x, off_z = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    left, right = ends[0, END], ends[1, END]
    for at in range(2):
        y, blur = ends[at, END], ends[at, BLUR]
        dx, dz, rx, rz = change(x, z, xi, eta, y)
        low_x, high_x, low_z, high_z = min(low_x, dx), max(high_x, dx), min(low_z, dz), max(high_z, dz)
        off_x, off_z = max(off_x, abs(z + dz) * blur + ULP * rx), max(off_z, abs(x + dx) * blur + ULP * rz)
        if not abs(dx) + abs(dz) + rx + rz < INFINITY:
            return False
    for row in range(2):
        at = stationary(row, x, z, xi, eta, left)
        while at < right:
            dx, dz, rx, rz = change(x, z, xi, eta, at)
            low_x, high_x, low_z, high_z = min(low_x, dx), max(high_x, dx), min(low_z, dz), max(high_z, dz)
            off_x, off_z = max(off_x, ULP * rx), max(off_z, ULP * rz)
            at += 0.5 * ROUND
    a, b = form[0] * low_x, form[0] * high_x
    box[j, 0], box[j, 1] = state[j] + min(a, b), state[j] + max(a, b)
    good = (abs(form[0]) * off_x + 4 * ULP * (abs(state[j]) + max(abs(a), abs(b))) <= DIGITS
            * max(abs(box[j, 0]), abs(box[j, 1])))
    a, b = form[1] * low_z, form[1] * high_z
    box[k, 0], box[k, 1] = state[k] + min(a, b), state[k] + max(a, b)
    good = (good and abs(form[1]) * off_z
            + 4 * ULP * (abs(state[k]) + max(abs(a), abs(b))) <= DIGITS * max(abs(box[k, 0]), abs(box[k, 1])))
    top = np.sqrt(2 * fastest)
    a, b = form[2] * top - form[3], -form[2] * top - form[3]
    box[i, 0], box[i, 1] = min(a, b, state[i]), max(a, b, state[i])
    full = 0.0
    for axis in range(3):
        full += abs(box[axis, 0]) + abs(box[axis, 1])
    return good and margin <= DIGITS * 2 * fastest and full < INFINITY


def sinc_cos(u: float):
    """sin(u)/u and cos u for 0 <= u <= pi/2."""
    t = u * u
    s = 1 - t * (1 / 6) * (1 - t * (1 / 20) * (1 - t * (1 / 42) * (1 - t * (1 / 72) * (1 - t * (1 / 110) * (
        1 - t * (1 / 156)
        * (1 - t * (1 / 210) * (1 - t * (1 / 272) * (1 - t * (1 / 342) * (1 - t * (1 / 420))))))))))
    k = 1 - t * 0.5 * (1 - t * (1 / 12) * (1 - t * (1 / 30) * (1 - t * (1 / 56) * (1 - t * (1 / 90) * (
        1 - t * (1 / 132)
        * (1 - t * (1 / 182) * (1 - t * (1 / 240) * (1 - t * (1 / 306) * (1 - t * (1 / 380) * (
            1 - t * (1 / 462)))))))))))
    return s, k


def sinc_minus_cos(t: float):
    """sin(u)/u - cos u of t = u^2 <= 1, without cancellation."""
    return t * (1 / 3) * (1 - t * (1 / 10) * (1 - t * (1 / 28) * (1 - t * (1 / 54) * (1 - t * (1 / 88) * (
        1 - t * (1 / 130) * (1 - t * (1 / 180) * (1 - t * (1 / 238) * (1 - t * (1 / 304)))))))))


def sinhc_and_rest(t: float):
    """sinh(u)/u and cosh u less it, of t = u^2 <= 1."""
    f = 1 + t * (1 / 6) * (1
                           + t * (1 / 20) * (1 + t * (1 / 42)
                                             * (1 + t * (1 / 72) * (1 + t * (1 / 110) * (1 + t * (1 / 156) * (
        1 + t * (1 / 210) * (1 + t * (1 / 272))))))))
    g = 1 + t * (1 / 10) * (1
                            + t * (1 / 28)
                            * (1 + t * (1 / 54)
                               * (1 + t * (1 / 88) * (1 + t * (1 / 130) * (1 + t * (1 / 180) * (
        1 + t * (1 / 238) * (1 + t * (1 / 304))))))))
    return f, t * (1 / 3) * g


def sides_of_exponentials(p1: float, q1: float, p2: float, q2: float, rho: float, grown: float, part: float):
    """(even, odd) of a sum of exp(y), exp(-y), exp(2 y), exp(-2 y) about the middle, grown: exp(rho)."""
    u = rho * part
    v = rho - u
    if rho < NARROW:
        fu, gu = sinhc_and_rest(u * u)
        fv, gv = sinhc_and_rest(v * v)
        wu, wv = sinhc_and_rest(4 * u * u)[1], sinhc_and_rest(4 * v * v)[1]
        cu, cv = fu + gu, fv + gv
        odd1, odd2 = gu * fv - fu * gv, wu * fv * cv - fu * cu * wv
    else:
        down = np.expm1(u)
        eu = 1 + down
        cu, su = 0.5 * (eu + 1 / eu), 0.5 * (down + down / eu)
        cv, sv = 0.5 * (grown / eu + eu / grown), 0.5 * (grown / eu - eu / grown)
        fu, fv = su / u if part > 0 else 1.0, sv / v
        odd1, odd2 = cu * fv - fu * cv, (1 + 2 * su * su) * fv * cv - fu * cu * (1 + 2 * sv * sv)
    return fu * fv * (0.5 * (p1 + q1)
                      + 2 * (p2 + q2) * cu * cv), (0.5 * (p1 - q1) * odd1 + (p2 - q2) * odd2) / rho


def converged(now: float, last: float, middle: float, first: float):
    """Whether a sum over nodes is its integral, given what it changed by as its nodes were doubled: the last,
    the middle and the first of three such changes; any numbers.

    Doubling squares the error of the trapezoidal rule, C r^n for n nodes, and of the double-exponential one,
    so a last change of `ALIKE` leaves nothing. But the sign of an error goes round, and it may be next to
    nothing by chance. So the rate r^n is told by either ratio of changes too, and a size by its own change or
    by the one before; the larger counts each time, and what these leave must be `CONVERGED`: four products,
    asked without a division.
    """
    c, b, a = last / now, middle / now + FLOOR, first / now + FLOOR
    a2, b2 = a * a, b * b
    return (c <= ALIKE) & (c * c * c <= CONVERGED
                           * b2) & (c * b2 * b2 <= CONVERGED * a2 * a2) & (b * c * c <= CONVERGED * a2) & (
        b2 * b2 * b2 * b <= CONVERGED * a2 * a2 * a2)


def summed(data: np.ndarray, rho: float, whole_s: float, whole_c: float, nodes: np.ndarray):
    """The period by the trapezoidal rule over mirrored pairs of nodes; NaN where that does not settle."""
    total, coarse, half, before, change, earlier, size, first = 0.0, 0.0, 0.0, np.nan, np.nan, np.nan, 8, 0
    while first < len(nodes):
        last = first + size // 2 if first else 5
        for n in range(first, last):
            even, odd = modes_pair(data, rho, whole_s, whole_c, nodes[n])
            weight = 0.5 if n == 0 or n == 4 else 1.0
            term = weight * (1 / np.sqrt(2 * (even + odd)) + 1 / np.sqrt(2 * (even - odd)))
            total += term
            if n == 0 or n == 4:
                half += term
            elif n == 2:
                coarse = term
        if not first:
            before = (coarse + half) * (TURN / 4)
            change = abs(before - half * (TURN / 2))
        size, first = size * 2 if first else size, last
        now = total * (TURN / size)
        new = abs(now - before)
        if converged(now, new, change, earlier):
            return now
        before, change, earlier = now, new, change
    return np.nan


def timed(conic: Sequence[float], x: float, z: float, xi: float, eta: float, w: float, count: int,
          spots: np.ndarray, ends: np.ndarray, closest: float, nodes: np.ndarray, data: np.ndarray):
    """(period, whether it has its digits) of a motion between two ends, by modes about the middle; not where
    these cancel."""
    mu, left, right = conic[3], ends[0, END], ends[1, END]
    rho = 0.5 * (right - left)
    if not (0 < rho < 0.5 * ROUND
            and closest > PERIOD_SHARE * (0.5 * w * w + mu + size_of_terms(conic, x, z, xi, eta))):
        return np.nan, False
    whole_s, whole_c = whole(rho)
    middle_modes(conic, x, z, xi, eta, 0.5 * (left + right), data)
    blur = ends[0, BLUR] + ends[1, BLUR]
    fraction, dip, lowest = 0.5, INFINITY, INFINITY
    for i in range(count):
        if spots[i, BARRIER] > 0 and left < spots[i, OFFSET] < right and spots[i, OVER] < lowest:
            lowest = spots[i, OVER]
            fraction = (spots[i, OFFSET] - left) / (2 * rho)
            dip = lowest / (4 * rho * rho * fraction * (1 - fraction))
    even, odd = modes_pair(data, rho, whole_s, whole_c, 0.0)
    first, last, inner = even + odd, even - odd, modes_pair(data, rho, whole_s, whole_c, 0.5)[0]
    # on a long hyperbola H over a barrier may be far less than at both ends and in the middle
    sharp = ULP * modes_terms(data, 4, rho, whole_s, whole_c, fraction) <= PERIOD_DIGITS * dip
    for sizes in range(0, 8, 4):
        sharp = (sharp and ULP * modes_terms(data, sizes, rho, whole_s, whole_c, 0.0) <= PERIOD_DIGITS * first
                 and ULP * modes_terms(data, sizes, rho, whole_s, whole_c, 0.5) <= PERIOD_DIGITS * inner
                 and ULP * modes_terms(data, sizes, rho, whole_s, whole_c, 1.0) <= PERIOD_DIGITS * last)
    largest, lowest = max(first, inner, last), min(first, inner, last)
    if not (sharp and blur * (largest - lowest) <= PERIOD_DIGITS * rho * lowest):
        return np.nan, False
    period = summed(data, rho, whole_s, whole_c, nodes)
    return period, period < INFINITY


def kinetic_near(mu: float, stop: np.ndarray, y: float):
    """W^2/2 = E - V at the way y from a stop."""
    s, h, behind = swing(y)
    h2 = h * h
    return (stop[STOP_OVER] + stop[STOP_FORCE] * s + 2 * stop[STOP_BEND] * h2 + mu * behind
            + 2 * E * h2 * (stop[STOP_A] * s + 2 * stop[STOP_B] * h2))


def stops_of(count: int, spots: np.ndarray, ends: np.ndarray, stops: np.ndarray):
    """Fill the stops of a motion in their order; how many there are, 0 where E - V is not known well at one
    of them."""
    many, sure = 1, True
    for i in range(count):
        point = spots[i]
        if ends[0, END] < point[OFFSET] < ends[1, END]:
            stop = stops[many]
            stop[STOP], stop[STOP_OVER], stop[STOP_FORCE] = point[OFFSET], point[OVER], 0.0
            stop[STOP_BEND], stop[STOP_A], stop[STOP_B] = point[BEND], point[MODE_A], point[MODE_B]
            sure = (sure and point[ERROR] <= PIECE_DIGITS * point[OVER]
                    and point[TILT] <= PIECE_DIGITS * abs(point[BEND]))
            many += 1
    for k in range(2):
        stop, end = stops[k * many], ends[k]
        stop[STOP], stop[STOP_OVER], stop[STOP_FORCE] = end[END], 0.0, end[FORCE]
        stop[STOP_BEND], stop[STOP_A], stop[STOP_B] = end[END_BEND], end[END_A], end[END_B]
        sure = sure and end[HAZE] <= PIECE_DIGITS * abs(end[LEVEL])
    return many + 1 if sure else 0


def in_pieces(mu: float, count: int, spots: np.ndarray, ends: np.ndarray, nearby: np.ndarray,
              weights: np.ndarray, levels: np.ndarray, stops: np.ndarray):
    """(period, whether it has its digits): dtheta/W by the double-exponential rule from stop to stop, E - V
    told from the nearer one."""
    many, period = stops_of(count, spots, ends, stops), 0.0
    if many < 3:
        return np.nan, False
    for i in range(many - 1):
        length = stops[i + 1, STOP] - stops[i, STOP]
        here, there = kinetic_near(mu, stops[i], 0.5 * length), kinetic_near(mu, stops[i + 1], -0.5 * length)
        if not (length > 0 and abs(here - there) <= PIECE_DIGITS * here):
            return np.nan, False
        total, before, change, earlier, result = 0.0, np.nan, np.nan, np.nan, False
        for level in range(len(levels) - 1):
            for n in range(levels[level], levels[level + 1]):
                part, far = abs(nearby[n]), nearby[n] < 0  # from the stop at the far end
                scale = 1.0
                # the way from a turning point is L u^2, which takes its root away
                if i == 0 or i == many - 2:
                    at_turn = far == (i > 0)
                    part, scale = (part * part,
                                    2 * part) if at_turn else (part * (2 - part), 2 * (1 - part))
                y = length * part
                total += (weights[n] * scale
                          / np.sqrt(2 * (kinetic_near(mu, stops[i + 1], -y) if far
                                         else kinetic_near(mu, stops[i], y))))
            now = length * total * 2.0**-level
            new = abs(now - before)
            if converged(now, new, change, earlier):
                period, result = period + 2 * now, True
                break
            before, change, earlier = now, new, change
        if not result:
            return np.nan, False
    return period, period < INFINITY


def rows(states: np.ndarray, open_rows: np.ndarray, fine: np.ndarray, form: Sequence[float],
         axes: Sequence[int], conic: Sequence[float], pieces: np.ndarray, lines: np.ndarray,
         folds: np.ndarray, rules: Sequence[np.ndarray], boxes: np.ndarray, periods: np.ndarray,
         left_open: np.ndarray):
    """Fill boxes (n, 3, 2) and periods (n,) of the open rows of states (n, 3), as far as their bits in
    left_open (n,) ask; the bits of what is settled go.

    fine: high and low parts of G, c, d, mu, sj, sk, flip/rx, 1/rz, (flip n)^2/2; form: factors of X and Z,
    flip/n, shift s of the third component and what its double leaves, the invariant up to which the lines
    serve; conic: c, d, G, mu, K, shift, and how near a hyperbola's centre no row is settled.
    """
    nodes, nearby, weights, levels = rules
    j, k, i = axes
    largest = max(len(pieces), len(lines))
    spots, box = np.empty((2 * largest + 1, ASTRAY + 1)), np.empty((3, 2))
    ends, turns = np.empty((2, END_B + 1)), np.empty((2, END_B + 1))
    stops = np.empty((2 * largest + 3, STOP_B + 1))
    data = np.empty(8)
    extra = abs(fine[8] * fine[12]) + abs(fine[10] * fine[14])
    for row in open_rows:
        request, state = int(left_open[row]), states[row]
        X = times(add((fine[8], fine[9]), (state[j], 0.0 * state[j])), (fine[12], fine[13]))
        Z = times(add((fine[10], fine[11]), (state[k], 0.0 * state[k])), (fine[14], fine[15]))
        turn, rest = exact_sum(state[i], form[3])
        w = (turn + (rest + form[4])) / form[2]
        x, z, xi, eta = value(X), value(Z), value(add(X, Z)), value(less(X, Z))
        wide = abs(x) + abs(z) + extra
        if lost(x, z, xi, eta, wide, conic):
            continue
        # whether a state is at rest is decided exactly, elsewhere
        terms = conic[3] + abs(conic[2] * x * z) + abs(conic[0] * z) + abs(conic[1] * x)
        still = abs(turn) <= ROUNDINGS * ULP * (abs(state[i]) + abs(form[3]))
        if still and abs(conic[3] + conic[2] * x * z + conic[0] * z
                         + conic[1] * x) <= ROUNDINGS * ULP * terms * (1 + wide / (abs(x) + abs(z))):
            continue
        count, sure = spots_of_row(fine, conic, pieces, lines, form[5], folds, X, Z, w, wide, spots)
        if not sure:
            continue
        for sharp in range(2):
            if sharp:
                sharpened(fine, conic, X, Z, exact_sum(turn, rest + form[4]), wide, count, spots)
            resolved, fastest, blur, closest = spanned(conic[3], w, count, spots, ends)
            if not resolved:
                continue
            if sharp:
                sharpened_ends(fine, X, Z, exact_sum(turn, rest + form[4]), wide, ends, turns)
            if request & BOX and boxed(form, axes, state, x, z, xi, eta, turns if sharp else ends, fastest,
                                     blur, box):
                boxes[row] = box
                request -= BOX
            if request & PERIOD:
                period, good = timed(conic, x, z, xi, eta, w, count, spots, turns if sharp else ends, closest,
                                     nodes, data)
                if sharp and not good:
                    period, good = in_pieces(conic[3], count, spots, ends, nearby, weights, levels, stops)
                if good:
                    periods[row] = period
                    request -= PERIOD
            if not request:
                break
        left_open[row] = request


def functions_of(geometry: type):
    """{name: function or number} of a geometry, which stand for the names of this module that follow."""
    return {name: getattr(geometry, name) for name in vars(Circle) if not name.startswith("_")}


GEOMETRIES = {"circle": Circle, "hyperbola": Hyperbola}
E, ROUND, WALLED = Circle.E, Circle.ROUND, Circle.WALLED
invariant, lost, onto, way_between, whole_way, moved, swing, bent, sizes_of_ways = (
    Circle.invariant, Circle.lost, Circle.onto, Circle.way_between, Circle.whole_way, Circle.moved,
    Circle.swing, Circle.bent, Circle.sizes_of_ways)
repeated, change, stationary, size_of_terms, middle_modes, whole, modes_pair, modes_terms = (
    Circle.repeated, Circle.change, Circle.stationary, Circle.size_of_terms, Circle.middle_modes,
    Circle.whole, Circle.modes_pair, Circle.modes_terms)
