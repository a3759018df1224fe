"""Homoclinic loops on hyperbolas, as straight lines of floats: what `circle_kernel` has of circles, under the same names, for numba to compile.

A place is (xi, eta) = (X + Z, X - Z), g the numbers (G, e1, e2, mu) of `potential.Hyperbola`.
"""
from __future__ import annotations

from math import exp, log

from ..circle_kernel import ENDS, NONE, OWN, crossing, real_cubic

FAR = 700.0        # beside an open plane there is no wall as near as this
SERIES = 0.7       # below, exp(t) - 1 - t is its series


def place_of(x, z):
    return x + z, x - z


def xz(xi, eta):
    return 0.5 * (xi + eta), 0.5 * (xi - eta)


def invariant(xi, eta):
    return -xi * eta


def force(g, xi, eta):
    return g[3] + 0.25 * g[0] * (xi - eta) * (xi + eta) + g[1] * xi + g[2] * eta


def slope(g, xi, eta):
    return 0.5 * g[0] * (xi * xi + eta * eta) + g[1] * xi - g[2] * eta


def moved(xi, eta, y):
    return xi * exp(y), eta * exp(-y)


def rise(g, xi, eta, y):
    return risen(g, xi, eta, y)[0]


def risen(g, xi, eta, y):
    """(V at the offset y over V at an equilibrium, the place there).

    With e = exp(y) and T = e - 1 - y, without cancellation: exp(2 y) - 1 - 2 y = 2 T + (e - 1)^2 and exp(-y) - 1 + y = (y (e - 1) - T)/e.
    """
    if abs(y) < SERIES:
        T = 0.0
        for n in range(17, 2, -1):
            T = (1 + T) * y / n
        T = 0.5 * y * y * (1 + T)
        less = y + T
        e = 1 + less
    else:
        e = exp(y)
        less = e - 1
        T = less - y
    back = (y * less - T) / e
    fall = less / e  # 1 - exp(-y)
    height = -0.125 * g[0] * (xi * xi * (2 * T + less * less) + eta * eta * (2 * back + fall * fall)) - g[1] * xi * T + g[2] * eta * back
    return height, xi * e, eta / e


def risen_row(g, xi, eta, y, height, there_xi, there_eta):
    """`risen` of offsets y (m,)."""
    for a in range(len(y)):
        height[a], there_xi[a], there_eta[a] = risen(g, xi, eta, y[a])


def departure_row(g, xi, eta, y, there_xi, there_eta, here_xi, here_eta, w, size_x, size_z, out):
    """As `circle_kernel.departure_row`: the larger of xi, eta tells the place, and how far the other lies from the saddle's hyperbola is the residual where
    that is more."""
    eighth, slopes, mu = 0.125 * g[0], abs(g[1]) + abs(g[2]), g[3]
    for a in range(len(y)):
        p, q = here_xi[a], here_eta[a]
        ahead_ = abs(p) >= abs(q)
        e = p / xi if ahead_ else eta / q
        seen = y[a] + ((p - there_xi[a]) / there_xi[a] if ahead_ else -(q - there_eta[a]) / there_eta[a])
        u, v = xi * e, eta / e
        kinetic = 0.5 * w[a] * w[a]
        height = (-eighth * (u * u - xi * xi * (1 + 2 * seen) + v * v - eta * eta * (1 - 2 * seen)) - g[1] * (u - xi * (1 + seen))
                  + g[2] * (v - eta * (1 - seen)))
        wide, high, largest = abs(0.5 * (p + q)) + size_x, abs(0.5 * (p - q)) + size_z, max(abs(p), abs(q))
        scale = kinetic + 8 * abs(eighth) * (wide * wide + high * high) + slopes * (wide + high) + mu + mu * (wide + high) / largest
        off, beside = abs(kinetic + height) / scale, abs(p * q - xi * eta) / ((abs(p) + abs(q)) * (wide + high))
        out[a] = max(off if off > 0 else 0.0, beside if beside > 0 else 0.0)


def others(g, xi, eta, side):
    """Distances to the other equilibria on one side, ascending, inf where there is none."""
    b3, b0 = 0.25 * g[0] * xi * xi, 0.25 * g[0] * eta * eta
    first, second, third = real_cubic(b3, b3 + g[1] * xi, b0 - g[2] * eta, b0)
    first, second, third = ahead(side, first), ahead(side, second), ahead(side, third)
    low, high = min(first, second), max(first, second)
    return min(low, third), max(low, min(high, third)), max(high, third)


def ahead(side, t):
    """The distance at which exp(theta) has grown to t; inf for the saddle itself, for what lies behind it and for nan."""
    y = side * log(t) if t > 0 else 0.0
    return y if y > OWN else float("inf")


def loop_end(g, sense, xi, eta, side):
    """As `circle_kernel.loop_end`; beyond the last well a wall stands on all hyperbolas but next to an open plane."""
    low, high, deep, centre = 0.0, float("inf"), float("inf"), 0.0
    for t in others(g, xi, eta, side):
        if t == float("inf"):
            continue
        over, there_xi, there_eta = risen(g, xi, eta, side * t)
        if slope(g, there_xi, there_eta) > 0:
            if over >= 0:
                high = t
                break
        else:
            low = t
            if over < deep:
                deep, centre = over, t
    if low == 0:
        return 0.0, 0.0, NONE
    step = 1.0
    while high == float("inf") and step < FAR:
        if rise(g, xi, eta, side * (low + step)) > 0:
            high = low + step
        step *= 2
    if high == float("inf"):
        return 0.0, 0.0, NONE
    return crossing(g, xi, eta, side, low, high), centre, ENDS
