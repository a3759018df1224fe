"""Arbitrary-precision Taylor integration of quadratic rates (mpmath): slow, and as exact as one asks.

Taylor coefficients follow from (n+1) x_i[n+1] = kappa_i sum_l x_j[l] x_k[n-l] + rho_i x_k[n] + sigma_i x_j[n]
+ m_i [n=0].
"""
from __future__ import annotations

from fractions import Fraction

import mpmath as mp

from tests.oracles.model import CYCLE, Model


def coefficients(table, x, order):
    kappa, rho, sigma, m = table
    series = [[v] for v in x]
    for n in range(order):
        new = []
        for i, (j, k) in enumerate(CYCLE):
            product = mp.fdot(series[j], series[k][::-1]) if kappa[i] else mp.mpf(0)
            value = (kappa[i] * product + rho[i] * series[k][n] + sigma[i] * series[j][n]
                     + (m[i] if n == 0 else 0))
            new.append(value / (n + 1))
        for row, value in zip(series, new):
            row.append(value)
    return series


def step_length(series, order, digits):
    """The last two coefficients bound the tail: step so that it is 10^-digits of the state's size, and a
    fifth less for the tail's other terms."""
    size = max(1e-300 + abs(row[0]) for row in series)
    lengths = []
    for n in (order - 1, order):
        top = max(abs(row[n]) for row in series)
        if top:
            lengths.append((size * mp.mpf(10) ** (-digits) / top) ** (mp.mpf(1) / n))
    return min(lengths) * mp.mpf("0.8") if lengths else mp.inf


def integrate(model: Model, state, times, digits: int = 40, order: int | None = None):
    """States (list of lists of mpf) at the given times, in order and of one sign, from `state` at time 0;
    numbers of any kind, or exact in strings; local error 10^-digits."""
    order = order or int(1.2 * digits) + 4
    with mp.workdps(digits + 10):
        def number(v):
            return v if isinstance(v, mp.mpf) else mp.mpf(Fraction(v).numerator) / Fraction(v).denominator

        table = [[number(v) for v in row] for row in (model.kappa, model.rho, model.sigma, model.m)]
        x, now, found = [number(v) for v in state], mp.mpf(0), []
        for target in times:
            target = number(target)
            while now != target:
                series = coefficients(table, x, order)
                step = min(step_length(series, order, digits), abs(target - now))
                step = step if target > now else -step
                x = [mp.polyval(row[::-1], step) for row in series]
                now = target if abs(target - now) <= abs(step) else now + step
            found.append(list(x))
        return found


def integrate_checked(model: Model, state, times, digits: int = 30):
    """(states at times, largest difference from a run with 12 digits more): the difference bounds the error.
    """
    low, high = integrate(model, state, times, digits), integrate(model, state, times, digits + 12)
    gap = max(abs(p - q) for xs, ys in zip(low, high) for p, q in zip(xs, ys))
    return high, gap
