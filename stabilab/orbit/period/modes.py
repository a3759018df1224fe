"""Second divided differences of the potential, mode by mode, without cancellation."""
from __future__ import annotations

import numpy as np


class Modes:
    """V around the middle of an interval as a sum of modes, for exact second divided differences.

    Circle, hyperbola: V = -mu y + sum_k P_k C(k y) + Q_k S(k y) with (cos, sin) or (cosh, sinh), k = 1, 2.
    Parabola: V = sum_n v_n y^n, n = 2, 3, 4.
    """

    def __init__(self, land, middle):
        self.e = land.e
        pot = land.potential
        if land.e == 0:
            first, second, third = pot.derivatives(tuple(middle))
            self.data = np.array([-first / 2, -second / 6, -third / 24 * np.ones_like(first)])
        elif land.e < 0:
            x, z = middle
            self.data = np.array([-pot.c * x + pot.d * z, -pot.c * z - pot.d * x,
                                  -0.25 * pot.G * (x - z) * (x + z), -0.5 * pot.G * x * z])
        else:
            xi, eta = middle
            quarter = -0.125 * pot.G
            # coefficients of exp(y), exp(-y), exp(2y), exp(-2y)
            self.data = np.array([-pot.e1 * xi, pot.e2 * eta, quarter * xi * xi, quarter * eta * eta])

    def take(self, rows):
        """The modes of some of the states."""
        other = object.__new__(Modes)
        other.e, other.data = self.e, self.data[:, rows]
        return other

    def terms(self, rho, left, right):
        """Size of the terms of H."""
        if self.e < 0:
            return sum(weight * np.abs(row) for weight, row in zip((1, 1, 4, 4), self.data))
        if self.e == 0:
            return np.abs(self.data[0]) + np.abs(self.data[1]) * rho + np.abs(self.data[2]) * 2 * rho * rho
        sizes = object.__new__(Modes)
        sizes.e, sizes.data = self.e, np.abs(self.data)
        return sizes.second_difference(rho, left, right)

    def second_difference(self, rho, left, right):
        """V[l, r, theta] with theta - l = 2 rho left, r - theta = 2 rho right."""
        y = rho * (left - right)
        if self.e == 0:
            two, three, four = self.data
            return two + three * y + four * (y * y + rho * rho)
        if self.e < 0:
            p1, q1, p2, q2 = self.data
            return sum(p * _cos_difference(k, rho, left, right) + q * _sin_difference(k, rho, y, left, right)
                       for k, p, q in ((1, p1, q1), (2, p2, q2)))
        up1, down1, up2, down2 = self.data
        return (up1 * _exp_difference(rho, left, right) + down1 * _exp_difference(rho, right, left)
                + up2 * 4 * _exp_difference(2 * rho, left, right) + down2 * 4 * _exp_difference(2 * rho, right, left))


def _sinc(t):
    return np.sinc(t / np.pi)


def _cos_difference(k, rho, left, right):
    """(cos ky - cos k rho)/(y^2 - rho^2) = -(k^2/2) sinc(k rho left) sinc(k rho right)."""
    return -0.5 * k * k * _sinc(k * rho * left) * _sinc(k * rho * right)


def _sin_difference(k, rho, y, left, right):
    """(sin ky - (y/rho) sin k rho)/(y^2 - rho^2) = k^3 y (sinc a - sinc b)/(a^2 - b^2), a = ky, b = k rho."""
    a, b = k * y, k * rho
    m, e = k * rho * left, -k * rho * right  # (a + b)/2, (a - b)/2
    with np.errstate(all="ignore"):
        closed = (np.cos(m) * _sinc(e) - _sinc(m) * np.cos(e)) / (2 * a * b)
    a2, b2 = a * a, b * b
    series, power_sum, b_power, coefficient = 0.0, 1.0, 1.0, -1 / 6
    for n in range(1, 12):
        series = series + coefficient * power_sum
        b_power = b_power * b2
        power_sum = power_sum * a2 + b_power
        coefficient = -coefficient / ((2 * n + 2) * (2 * n + 3))
    return k**3 * y * np.where(np.abs(b) < 1.0, series, np.where(np.abs(a) < 1e-3, _even_limit(a2, b), closed))


def _even_limit(a2, b):
    """(sinc a - sinc b)/(a^2 - b^2) for small a and b >= 1: no cancellation to fear."""
    with np.errstate(all="ignore"):
        return (1 - a2 / 6 * (1 - a2 / 20) - np.sin(b) / b) / (a2 - b * b)


def _exp_difference(rho, left, right):
    """exp[-rho, rho, y]: second divided difference of exp, with y + rho = 2 rho left, rho - y = 2 rho right."""
    up, down = 2 * rho * right, 2 * rho * left  # distances from the right and the left end
    with np.errstate(all="ignore"):
        near_right = np.exp(rho) * np.where(up > 0, -np.expm1(-up) / np.where(up > 0, up, 1), 1.0)  # exp[y, rho]
        near_left = np.exp(-rho) * np.where(down > 0, np.expm1(down) / np.where(down > 0, down, 1), 1.0)  # exp[-rho, y]
        direct = (near_right - near_left) / (2 * rho)
    y = rho * (left - right)
    # series about the middle for short intervals: sum over complete homogeneous polynomials h_n(-rho, rho, y)/(n+2)!
    homogeneous, rho2, even, series, factor = np.ones_like(y), rho * rho, np.ones_like(y), 0.5 * np.ones_like(y), 0.5
    for n in range(1, 22):
        even = even * rho2 if n % 2 == 0 else even
        homogeneous = y * homogeneous + (even if n % 2 == 0 else 0.0)
        factor = factor / (n + 2)
        series = series + factor * homogeneous
    return np.where(rho < 1.0, series, direct)
