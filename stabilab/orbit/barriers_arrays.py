"""Barriers of orbits that are parabolas or nearly so, of many states, NumPy.

About a state, in T = tanh(n y/2)/n, the force times (1 - e T^2)^2 is the quartic (4) of `equilibria_kernel`,
on a parabola a cubic: no centre of the orbits takes part, which two nearly equal moments send far off. Walls
stand on both sides, and wells are the outermost equilibria: an orbit has one of them, or three with a barrier
in the middle. Whether it may have one the quartic's discriminant says; then the middle root of the cubic is
near it, and Newton's method on the quartic finds it. K there is (2) of `arc_kernel`. Whatever rounding may
change is marked as doubtful.
"""
from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from .arc_kernel import ROUNDINGS, ULP
from .equilibria_kernel import CLEAR
from .margins_kernel import MARGIN_SHARE

if TYPE_CHECKING:
    from .reduction import Reduction

NEARLY = 1e-4  # of e: of hyperbolas with less, many are nearly parabolas as far as their barriers
DOUBLE_ROOT = 1e-13  # of its terms: a discriminant so small may be that of a double root, by rounding
STEPS = 3  # of Newton's method from the root of the cubic
CURVED = 0.05  # of e T^2: beyond, the series in it would be long, and the cubic tells little
SHORTEST = 1e-18  # of a series: what is left out


def middle_barriers(reduction: Reduction, states: np.ndarray):
    """(margins (n,) per unit of (omega_i + s)^2/2 below the barriers of the orbits of states (n, 3), inf where
    they have none; which are doubtful (n,))."""
    r, power = reduction, np.frexp(np.abs(states).max(initial=0.0))[1]
    unit = np.ldexp(1.0, -power)  # powers of rates remain doubles
    u, v, rate = (states[:, axis] * unit for axis in (r.j, r.k, r.axis))
    p, q, kappa, e = (float(number) for number in (r.p, r.q, r.kappa, r.p * r.q))
    p0, q0, rho, sigma, s = (float(number) * unit for number in (r.p0, r.q0, r.rho, r.sigma, r.s))
    scene = p, q, kappa, e, p0, q0, rho, sigma, float(r.m) * unit * unit
    margins, w = np.full(len(u), np.inf), rate + s
    with np.errstate(all="ignore"):
        series = about(scene, u, v)
        terms = about(tuple(map(abs, scene)), np.abs(u), np.abs(v), 1)
        quartic, sizes = force_quartic(series, e), force_quartic(terms, e, 1)
        if np.any(quartic[3]) or np.any(quartic[2]):
            apart, doubt = discriminant(quartic, e), DOUBLE_ROOT * discriminant(sizes, e, 1)
        else:  # a line, whose equilibrium is a well or a barrier
            apart, doubt = quartic[1], DOUBLE_ROOT * sizes[1]
        rows = np.nonzero(~(apart < -doubt))[0]
        doubtful = np.zeros(len(u), bool)
        if rows.size:
            some = [tuple(_at(part, rows) for part in numbers) for numbers in (series, terms, quartic)]
            T = middle_root(some[2])
            height, error, slope = barrier(*some, T, e, w[rows], np.abs(rate[rows]) + abs(s))
            energy = 0.5 * w[rows] * w[rows]
            enough = MARGIN_SHARE * (energy + np.abs(energy - height))
            sure = (slope > 0) & (error <= np.minimum(enough, np.abs(height) / CLEAR))
            margins[rows], doubtful[rows] = -height / unit / unit, ~(sure & (apart > doubt)[rows])
    return margins, doubtful


def _at(part: float | np.ndarray, rows: np.ndarray):
    return part[rows] if np.ndim(part) else part


def about(scene: Sequence[float], u: np.ndarray, v: np.ndarray, sign: int = -1):
    """(f0, f1, F, c, g) of (2) at locations; sign 1: of sizes, that of their terms."""
    p, q, kappa, e, p0, q0, rho, sigma, m = scene
    a, b, A, B = p * v + p0, q * u + q0, kappa * v + sigma, kappa * u + rho
    pb, qa, c = p * b, q * a, kappa * a * b
    return A * u + rho * v + m, A * a + B * b, A * pb + B * qa + sign * c, c, kappa * (qa * a + pb * b)


def force_quartic(series: Sequence[np.ndarray], e: float, sign: int = -1):
    """The coefficients in T of the force times (1 - e T^2)^2, lowest first; sign as of `about`."""
    f0, f1, f2, c, g = series
    if not e:
        return f0, 2 * f1, 2 * f2 + 6 * c, 4 * g, 0.0
    return (f0, 2 * f1, 2 * (f2 + 3 * c) + sign * (2 * e * f0), 4 * g + sign * (2 * e * f1),
            e * (e * f0 + 2 * (sign * f2 + c)))


def discriminant(quartic: Sequence[np.ndarray], e: float, sign: int = -1):
    """27 times that of quartics: negative where two roots are real; sign as of `about`."""
    a, b, c, d, high = quartic
    first, second = sign * 3 * b * d + c * c, c * (9 * b * d + sign * 2 * c * c) + sign * 27 * a * d * d
    if e:
        first, second = first + 12 * high * a, second + high * (72 * a * c + sign * 27 * b * b)
    return 4 * first * first * first + sign * second * second


def middle_root(quartic: Sequence[np.ndarray]):
    """The middle root of the cubic that a quartic nearly is; NaN where it has one alone. A line's root."""
    a, b, c, d, _ = quartic
    if not np.any(d):
        return -a / b
    centre = -c / (3 * d)
    slope, value = b + c * centre, a + centre * (b + 2 * c * centre / 3)
    reach = np.sqrt(-slope / (3 * d))
    return centre + 2 * reach * np.sin(np.arcsin(value / (2 * d * reach * reach * reach)) / 3)


def barrier(series: Sequence[np.ndarray], terms: Sequence[np.ndarray], quartic: Sequence[np.ndarray],
            T: np.ndarray, e: float, w: np.ndarray, size: np.ndarray):
    """(K, its error, K'') at the equilibrium near T; size: of the terms of w."""
    a, b, c, d, high = quartic
    for _ in range(STEPS if e else 1):
        T = T - (a + T * (b + T * (c + T * (d + T * high)))) / (b + T * (2 * c + T * (3 * d + T * 4 * high)))
    force = a + T * (b + T * (c + T * (d + T * high)))
    slope = 0.5 * (b + T * (2 * c + T * (3 * d + T * 4 * high)))
    x = e * T * T
    near = np.where(x <= CURVED, x, np.nan) if e else x
    S1 = 2 * T / (1 - near)
    S2 = T * S1
    S3 = 2 * T * T * T * odd_series(near)
    y = S1 - e * S3
    f0, f1, f2, c, g = series
    half = 0.5 * S2 * S2
    K = 0.5 * w * w + (f0 * y + f1 * S2 + f2 * S3 + c * (S1 * S2) + g * half)
    f0, f1, f2, c, g = terms
    size = w * w + np.abs(w) * size + (f0 * np.abs(y) + f1 * S2 + f2 * np.abs(S3)
                                       + c * np.abs(S1 * S2) + g * half)
    return K, ROUNDINGS * ULP * size + force * force / np.abs(slope), slope


def odd_series(x: np.ndarray):
    """2/3 + 4 x/5 + 6 x^2/7 + ..., that is (S1 - y)/(2 e T^3) of x = e T^2."""
    largest, last = np.nanmax(x, initial=0.0), 0
    while largest ** (last + 1) > SHORTEST:
        last += 1
    total = (2 * last + 2) / (2 * last + 3) + 0.0 * x
    for n in range(last - 1, -1, -1):
        total = total * x + (2 * n + 2) / (2 * n + 3)
    return total
