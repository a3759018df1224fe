"""Barriers of orbits that are parabolas or a pendulum's circles, or nearly so, of many states, NumPy.

About a state, in T = tanh(n y/2)/n, the force times (1 - e T^2)^2 is the quartic (4) of `equilibria_kernel`,
on a parabola a cubic: no centre of the orbits takes part, which two nearly equal moments send far off. The
sign of its discriminant says how many equilibria there are (docs/mathematics/arcs.md). Of these at most three
stand where the quartic is nearly a cubic, whose roots are closed; on a circle another one stands far off, and
1/T is its small root. Where the force along a circle is nearly one sine, the quartic is nearly a quadratic
times 1 - e T^2. Newton's method on the quartic ends the search, and K there is (2) of `arc_kernel`.
Whatever rounding may change is marked as doubtful, and so are places where the quartic is no such cubic.
"""
from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import partial
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

import numpy as np

from ..numbers.double_double import TURN
from .arc_kernel import ROUNDINGS, ULP
from .equilibria_kernel import BESIDE_BARRIER, CLEAR, MARGIN_SHARE

if TYPE_CHECKING:
    from .reduction import Reduction

# most orbits of a scene are nearly parabolas as far as their barriers where the lesser of p and q is at most
# so much of kappa, and the square of a rate that wheel and torque bring about of that of the centre's
# distance
NEARLY, FAR_CENTRE = 2e-3, 0.01
LITTLE = 3e-3  # of the wheel's share of the force, that of kappa on circles that are nearly a pendulum's
DOUBLE_ROOT = 1e-13  # of its terms: a discriminant so small may be that of a double root, by rounding
BESIDE_PLANE = 1e-9  # of its terms: so near is g to 2 n c, its size on an invariant plane
EXCESS = 1e-12  # of its terms: more than rounding of a force
STEPS = 3  # of Newton's method from the root of a cubic
CURVED = 0.05  # of |e T^2|: beyond, the series in it would be long, and the cubic tells little
SHORTEST = 1e-18  # of a series: what is left out


class Rows(NamedTuple):
    """States (n, 3) along their orbits: the coefficients of (2) and the sizes of their terms, the quartic,
    its discriminant and what rounding may change that by, omega_i + s and the size of its terms; all in a
    `unit` of rate; of the reduction e, and whether its orbits have a centre."""

    series: tuple[np.ndarray, ...]
    terms: tuple[np.ndarray, ...]
    quartic: tuple[np.ndarray, ...]
    apart: np.ndarray
    doubt: np.ndarray
    w: np.ndarray
    size: np.ndarray
    unit: float
    e: float
    centred: bool

    def some(self, rows: np.ndarray | slice) -> Rows:
        """These rows of them."""
        series, terms, quartic = (tuple(v[rows] if np.ndim(v) else v for v in part) for part in self[:3])
        apart, doubt, w, size = (part[rows] for part in self[3:7])
        return Rows(series, terms, quartic, apart, doubt, w, size, *self[7:])


MarginsByArcs: TypeAlias = Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]
Equilibria: TypeAlias = Callable[[Rows, np.ndarray, np.ndarray],
                                 Iterator[tuple[np.ndarray | slice, Sequence[np.ndarray]]]]


def rows_of(reduction: Reduction, states: np.ndarray) -> Rows:
    """Those of states (n, 3)."""
    r, power = reduction, np.frexp(np.abs(states).max(initial=0.0))[1]
    unit = float(np.ldexp(1.0, -power))  # powers of rates remain doubles
    u, v, rate = (states[:, axis] * unit for axis in (r.j, r.k, r.axis))
    p, q, kappa, e = (float(number) for number in (r.p, r.q, r.kappa, r.p * r.q))
    p0, q0, rho, sigma, s = (float(number) * unit for number in (r.p0, r.q0, r.rho, r.sigma, r.s))
    scene = p, q, kappa, p0, q0, rho, sigma, float(r.m) * unit * unit
    series = about(scene, u, v)
    terms = about(tuple(map(abs, scene)), np.abs(u), np.abs(v), 1)
    centred = r.geometry.centred
    quartic, sizes = force_quartic(series, e, centred), force_quartic(terms, abs(e), centred, 1)
    if np.any(quartic[3]) or np.any(quartic[2]):
        apart, doubt = discriminant(quartic), DOUBLE_ROOT * discriminant(sizes, 1)
    else:  # a line, whose equilibrium is a well or a barrier
        apart, doubt = quartic[1], DOUBLE_ROOT * sizes[1]
    return Rows(series, terms, quartic, apart, doubt, rate + s, np.abs(rate) + abs(s), unit, e, centred)


def about(scene: Sequence[float], u: np.ndarray, v: np.ndarray, sign: int = -1):
    """(f0, f1, F, c, g) of (2) at locations; sign 1: of sizes, that of their terms."""
    p, q, kappa, p0, q0, rho, sigma, m = scene
    a, b, A, B = p * v + p0, q * u + q0, kappa * v + sigma, kappa * u + rho
    pb, qa, c = p * b, q * a, kappa * a * b
    return A * u + rho * v + m, A * a + B * b, A * pb + B * qa + sign * c, c, kappa * (qa * a + pb * b)


def force_quartic(series: Sequence[np.ndarray], e: float, centred: bool, sign: int = -1):
    """The coefficients in T of the force times (1 - e T^2)^2, lowest first; sign as of `about`."""
    f0, f1, f2, c, g = series
    if not centred:
        return f0, 2 * f1, 2 * f2 + 6 * c, 4 * g, 0.0
    return (f0, 2 * f1, 2 * (f2 + 3 * c) + sign * (2 * e * f0), 4 * g + sign * (2 * e * f1),
            e * (e * f0 + 2 * (sign * f2 + c)))


def discriminant(quartic: Sequence[np.ndarray], sign: int = -1):
    """27 times that of quartics: negative where two roots are real; sign as of `about`."""
    a, b, c, d, high = quartic
    first, second = sign * 3 * b * d + c * c, c * (9 * b * d + sign * 2 * c * c) + sign * 27 * a * d * d
    if np.ndim(high):
        first, second = first + 12 * high * a, second + high * (72 * a * c + sign * 27 * b * b)
    return 4 * first * first * first + sign * second * second


# --- Roots, the way to them, and K there
def near_roots(quartic: Sequence[np.ndarray], which: Sequence[int]):
    """Of the three roots of the cubics that quartics nearly are, the first (-1), the middle one (0), the last
    (1) in T or -T; NaN where one alone is real."""
    a, b, c, d, _ = quartic
    if not np.any(d):
        return [-a / b]  # a line's
    centre = -c / (3 * d)
    slope, value = b + c * centre, a + centre * (b + 2 * c * centre / 3)
    reach = np.sqrt(-slope / (3 * d))
    third = np.arcsin(value / (2 * d * reach * reach * reach)) / 3
    return [centre + 2 * reach * (np.sin(third + side * (TURN / 3)) if side else sine(third))
            for side in which]


def sine(t: np.ndarray):
    """sin t for |t| <= pi/6 to 1e-10, for Newton's method to begin with: in a tenth of the time."""
    t2 = t * t
    return t * (1 - t2 / 6 * (1 - t2 / 20 * (1 - t2 / 42 * (1 - t2 / 72))))


def only_root(quartic: Sequence[np.ndarray]):
    """The one real root of these cubics."""
    a, b, c, d, _ = quartic
    centre = -c / (3 * d)
    p, q = (b + c * centre) / (3 * d), 0.5 * (a + centre * (b + 2 * c * centre / 3)) / d
    root = -np.copysign(np.cbrt(np.abs(q) + np.sqrt(np.maximum(q * q + p * p * p, 0))), q)
    other = np.where(root == 0, 0.0, -p / root)
    # where p > 0 the sum would cancel
    return centre + np.where(p > 0, -2 * q / (root * root + p + other * other), root + other)


def polynomial(x: np.ndarray, quartic: Sequence[np.ndarray]):
    """(value, slope) of quartics, lowest coefficient first."""
    a, b, c, d, high = quartic
    return a + x * (b + x * (c + x * (d + x * high))), b + x * (2 * c + x * (3 * d + x * 4 * high))


def near_arc(rows: Rows, T: np.ndarray):
    """(y, S1, S2, S3, K'' there, by how much K may be off because the force does not vanish) of the
    equilibria near T."""
    e = rows.e
    for _ in range(STEPS if rows.centred else 1):
        value, slope = polynomial(T, rows.quartic)
        T = T - value / slope
    force, slope = polynomial(T, rows.quartic)
    x = e * T * T
    x = np.where(np.abs(x) <= CURVED, x, np.nan)
    S1 = 2 * T / (1 - x)
    S3 = 2 * T * T * T * odd_series(x)
    return S1 - e * S3, S1, T * S1, S3, 0.5 * slope, 2 * force * force / np.abs(slope)


def odd_series(x: np.ndarray):
    """2/3 + 4 x/5 + 6 x^2/7 + ..., that is (S1 - y)/(2 e T^3) of x = e T^2."""
    largest, last = float(np.nanmax(np.abs(x), initial=0.0)), 0
    while largest ** (last + 1) > SHORTEST:
        last += 1
    total = (2 * last + 2) / (2 * last + 3) + 0.0 * x
    for n in range(last - 1, -1, -1):
        total = total * x + (2 * n + 2) / (2 * n + 3)
    return total


def circle_arc(rows: Rows, turned: bool | np.ndarray, x: np.ndarray):
    """As `near_arc`, of the equilibria of circles, anywhere: near x = n T or, where it is turned, near its
    inverse; within half a turn on either side."""
    n = np.sqrt(-rows.e)
    quartic = [part * (1 / n) ** k for k, part in enumerate(rows.quartic)]
    if turned is True:
        quartic.reverse()
    elif turned is not False:
        a, b, c, d, high = quartic
        quartic = [np.where(turned, high, a), np.where(turned, d, b), c, np.where(turned, b, d),
                   np.where(turned, a, high)]
    for _ in range(STEPS - 1):
        value, slope = polynomial(x, quartic)
        x = x - value / slope
    force, slope = polynomial(x, quartic)
    square = x * x
    share = 1 / (1 + square)
    S1, half = (2 / n) * (x * share), np.arctan(x)
    y = (2 / n) * np.where(turned, np.copysign(0.5 * np.pi, x) - half, half)
    return (y, S1, (2 / n / n) * (share if turned is True else share * np.where(turned, 1.0, square)),
            (S1 - y) * (1 / rows.e), (0.5 * n) * share * np.where(turned, -slope, slope),
            (2 / n) * (force * force) * (share * share * share) / np.abs(slope))


def height(rows: Rows, arc: Sequence[np.ndarray]):
    """(K, which have their digits) after arcs."""
    y, S1, S2, S3, _, off = arc
    f0, f1, f2, c, g = rows.series
    half, energy = 0.5 * S2 * S2, 0.5 * rows.w * rows.w
    K = energy + (f0 * y + f1 * S2 + f2 * S3 + c * (S1 * S2) + g * half)
    f0, f1, f2, c, g = rows.terms
    size = energy + np.abs(rows.w) * rows.size + (
        f0 * np.abs(y) + f1 * S2 + f2 * np.abs(S3) + c * np.abs(S1 * S2) + g * half)
    error = ROUNDINGS * ULP * size + off
    return K, error <= np.minimum(MARGIN_SHARE * (energy + np.abs(energy - K)), np.abs(K) / CLEAR)


# --- Margins
def margins_by_arcs(reduction: Reduction) -> MarginsByArcs | None:
    """What gives the margins of states (n, 3), as `middle_barriers` does, of a scene with orbits that are
    parabolas, or nearly so, or nearly a pendulum's; None of others."""
    r = reduction
    (small, off), (large, away) = sorted(((r.p, r.p0), (r.q, r.q0)), key=lambda pair: abs(pair[0]))
    parabolic = not small or (
        abs(small) < NEARLY * abs(r.kappa)
        and abs(small) * (away * away + abs(r.m * large * large)) < FAR_CENTRE * abs(large) * off * off)
    if r.geometry.walled:
        return partial(middle_barriers, r) if parabolic else None
    if parabolic:
        return partial(highest_barriers, r, nearby_and_far)
    wheel, centre = abs(r.rho) + abs(r.sigma), sum(map(abs, r.centre))
    rates = wheel * wheel + centre * centre + abs(r.m)
    swings = r.kappa * r.kappa * rates < LITTLE * LITTLE * wheel * wheel
    return partial(highest_barriers, r, swinging) if swings else None


def middle_barriers(reduction: Reduction, states: np.ndarray):
    """(margins (n,) per unit of (omega_i + s)^2/2 below the barriers between walls of the orbits of states
    (n, 3), inf where they have none; which are doubtful (n,), those beside an invariant plane too).

    Wells are the outermost equilibria: an orbit has one, or three with its only barrier in the middle."""
    margins, doubtful = np.full(len(states), np.inf), np.zeros(len(states), bool)
    with np.errstate(all="ignore"):
        all_rows = rows_of(reduction, states)
        barred = np.nonzero(~(all_rows.apart < -all_rows.doubt))[0]
        if barred.size:
            rows = all_rows.some(barred)
            arc = near_arc(rows, near_roots(rows.quartic, (0,))[0])
            K, clear = height(rows, arc)
            margins[barred] = -K / rows.unit / rows.unit
            doubtful[barred] = ~(clear & (arc[4] > 0) & (rows.apart > rows.doubt))
        if all_rows.centred:
            *_, c, g = all_rows.series
            off = np.abs(np.abs(g) - 2 * np.sqrt(all_rows.e) * np.abs(c))
            doubtful |= ~(off > BESIDE_PLANE * all_rows.terms[4])
    return margins, doubtful


def highest_barriers(reduction: Reduction, equilibria: Equilibria, states: np.ndarray):
    """As `middle_barriers`, below the highest barrier within one turn ahead, on circles, -inf where there is
    none. equilibria: `nearby_and_far` or `swinging`."""
    drift, turn = float(reduction.torque), TURN / np.sqrt(-float(reduction.p * reduction.q))
    with np.errstate(all="ignore"):
        rows = rows_of(reduction, states)
        lowest, missing = np.full(len(states), np.inf), np.zeros(len(states), int)
        clear = np.abs(rows.apart) > rows.doubt
        for index, arc in equilibria(rows, missing, clear):
            some = rows.some(index)
            K, sure = height(some, arc)
            barrier = arc[4] > 0
            K += np.where(arc[0] * drift < 0, abs(drift) * rows.unit * rows.unit * turn, 0.0)
            lowest[index] = np.minimum(lowest[index], np.where(barrier, K, np.inf))
            missing[index] -= barrier
            # rounding of the force must not tell whether a barrier stands ahead or a turn away
            clear[index] &= ~barrier | (sure & (np.abs(arc[0]) > BESIDE_BARRIER)
                                        & (np.abs(arc[0] * arc[4]) > CLEAR * ULP * some.terms[0]))
    return -lowest / rows.unit / rows.unit, ~(clear & (missing == 0))


def nearby_and_far(rows: Rows, missing: np.ndarray, clear: np.ndarray):
    """(rows, arcs to equilibria of them) of nearly parabolic circles, one about half a turn off and the
    others near; missing: set to the number of barriers.

    Wells and barriers take turns: there is one barrier where two roots are real, there are two where four
    are."""
    n = np.sqrt(-rows.e)
    arc = circle_arc(rows, True, -rows.quartic[4] / (n * rows.quartic[3]))
    far, four = arc[4] > 0, rows.apart > 0
    missing[:] = np.where(four, 2, 1)
    clear &= np.abs(arc[1]) <= 1 / n  # far it is, and there
    yield slice(None), arc
    for members, which in ((far & four, (0,)), (~far & four, (-1, 1)), (~far & ~four, ())):
        index = np.nonzero(members & clear)[0]
        if index.size:
            some = rows.some(index)
            for T in near_roots(some.quartic, which) if which else [only_root(some.quartic)]:
                yield index, near_arc(some, T)


def swinging(rows: Rows, missing: np.ndarray, clear: np.ndarray):
    """The same of circles along which the force is nearly a constant and one sine, as of a pendulum: the
    quartic in x = n T nearly 1 + x^2 times a quadratic."""
    n = np.sqrt(-rows.e)
    a, b, c, d, high = (part / n**k for k, part in enumerate(rows.quartic))
    b, rest = 0.5 * (b + d), 0.5 * np.abs(b - d) + 0.5 * np.abs(c - a - high)
    under, four = b * b - 4 * a * high, rows.apart > 0
    # without a root the constant exceeds the sine by more than the rest, which is no more than half of itself
    clear &= ~four | (np.abs(a + high) - np.hypot(a - high, b) > rest + EXCESS * (np.abs(a) + np.abs(high)))
    missing[:] = np.where(four, 0, 1)
    index = np.nonzero(~four & clear)[0] if four.any() else slice(None)
    if len(rows.w[index]):
        a, b, high, root = a[index], b[index], high[index], np.sqrt(under[index])
        top, bottom = np.where(b > 0, -2 * a, root - b), np.where(b > 0, root + b, 2 * high)
        turned = np.abs(top) > np.abs(bottom)
        yield index, circle_arc(rows.some(index), turned, np.where(turned, bottom / top, top / bottom))
