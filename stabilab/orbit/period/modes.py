"""Second divided differences of the potential, mode by mode, without cancellation."""
from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ..fine.rows_kernel import sinc_minus_cos
from ..landscape import Landscape


class Modes:
    """V around the middle of an interval as a sum of modes, for exact second divided differences.

    data: (k, n) their coefficients; sizes: (k, n) those of the terms that these are the sums of."""

    about: Callable[..., Modes]  # of each geometry: the modes about the middles of intervals

    def __init__(self, data, sizes=None):
        self.data, self.sizes = data, np.abs(data) if sizes is None else sizes

    def take(self, rows) -> Modes:
        """The modes of some of the states."""
        return type(self)(self.data[:, rows], self.sizes[:, rows])

    def terms(self, rho, left, right):
        """Size of the terms of H."""
        return type(self)(np.abs(self.data)).second_difference(rho, left, right)

    def rounding(self, rho, left, right):
        """Size of what the terms of H are the sums of: times the unit of rounding, the error of H."""
        return type(self)(self.sizes).terms(rho, left, right)

    def second_difference(self, rho, left, right):
        """V[l, r, theta] with theta - l = 2 rho left, r - theta = 2 rho right; rho (n,), the shares (n,) or (nodes, n)."""
        raise NotImplementedError

    def whole(self, rho):
        """(k, n) what `pair` needs of the intervals whatever the node."""
        return np.empty((0, len(rho)))

    def pair(self, rho, whole, share, narrow):
        """(even, odd), (n,) each: V[l, r, theta] is their sum at theta - l = 2 rho share, and their difference at its mirror image.

        share: a number up to 1/2. narrow: whether the intervals are shorter than 2 `NARROW`, so that closed forms would cancel.
        """
        raise NotImplementedError


class CircleModes(Modes):
    """V = -mu y + sum_k P_k cos(k y) + Q_k sin(k y), k = 1, 2."""

    @classmethod
    def about(cls, pot, x, z) -> Modes:
        """Those about the place (X, Z)."""
        data = np.array([-pot.c * x + pot.d * z, -pot.c * z - pot.d * x, -0.25 * pot.G * (x - z) * (x + z), -0.5 * pot.G * x * z])
        c, d = np.abs([pot.c * x, pot.c * z]), np.abs([pot.d * z, pot.d * x])
        return cls(data, np.array([*(c + d), *np.abs(data[2:])]))

    def terms(self, rho, left, right):
        return sum(weight * np.abs(row) for weight, row in zip((1, 1, 4, 4), self.data))

    def second_difference(self, rho, left, right):
        y = rho * (left - right)
        p1, q1, p2, q2 = self.data
        return sum(p * _cos_difference(k, rho, left, right) + q * _sin_difference(k, rho, y, left, right)
                   for k, p, q in ((1, p1, q1), (2, p2, q2)))


    def whole(self, rho):
        return np.array([np.sin(rho), np.cos(rho)])

    def pair(self, rho, whole, share, narrow):
        u = rho * share
        sinc = np.sin(u) / u if share else np.ones_like(u)
        return divided_pair(u, sinc, np.cos(u), rho, *whole, *self.data, narrow)


class HyperbolaModes(Modes):
    """V = -mu y + a sum of exp(y), exp(-y), exp(2 y), exp(-2 y)."""

    @classmethod
    def about(cls, pot, xi, eta) -> Modes:
        """Those about the place (xi, eta)."""
        quarter = -0.125 * pot.G
        return cls(np.array([-pot.e1 * xi, pot.e2 * eta, quarter * xi * xi, quarter * eta * eta]))

    def second_difference(self, rho, left, right):
        up1, down1, up2, down2 = self.data
        with np.errstate(over="ignore", invalid="ignore"):  # of an interval some hundreds wide H is no number, and nothing vouches for it
            return (up1 * _exp_difference(rho, left, right) + down1 * _exp_difference(rho, right, left)
                    + up2 * 4 * _exp_difference(2 * rho, left, right) + down2 * 4 * _exp_difference(2 * rho, right, left))


    def whole(self, rho):
        with np.errstate(over="ignore"):
            return np.exp(rho)[None]

    def pair(self, rho, whole, share, narrow):
        """exp(+-y) has the divided differences A + B and A - B, A = sinhc u sinhc v/2, B = (cosh u sinhc v - sinhc u cosh v)/(2 rho), v = rho - u."""
        u = rho * share
        v = rho - u
        with np.errstate(all="ignore"):
            if narrow:
                (fu, gu), (fv, gv) = (_sinhc_and_rest(x * x) for x in (u, v))
                g2u, g2v = (_sinhc_and_rest(4 * x * x)[1] for x in (u, v))
                cu, cv = fu + gu, fv + gv
                odd1, odd2 = gu * fv - fu * gv, g2u * fv * cv - fu * cu * g2v
            else:
                less, grown = np.expm1(u), whole[0]
                eu = 1 + less
                cu, su = 0.5 * (eu + 1 / eu), 0.5 * (less + less / eu)
                cv, sv = 0.5 * (grown / eu + eu / grown), 0.5 * (grown / eu - eu / grown)
                fu, fv = su / u if share else np.ones_like(u), sv / v
                odd1, odd2 = cu * fv - fu * cv, (1 + 2 * su * su) * fv * cv - fu * cu * (1 + 2 * sv * sv)
            up1, down1, up2, down2 = self.data
            even = fu * fv * (0.5 * (up1 + down1) + 2 * (up2 + down2) * cu * cv)
            return even, (0.5 * (up1 - down1) * odd1 + (up2 - down2) * odd2) / rho


class ParabolaModes(Modes):
    """V = sum_n v_n y^n, n = 2, 3, 4, besides its slope."""

    @classmethod
    def about(cls, pot, u, v) -> Modes:
        """Those about the place (omega_j, omega_k)."""
        first, second, third = pot.derivatives((u, v))
        sizes = zip(pot.derivative_terms((u, v)), (2, 6, 24))
        return cls(np.array([-first / 2, -second / 6, -third / 24 * np.ones_like(first)]), np.array([size / n * np.ones_like(first) for size, n in sizes]))

    def terms(self, rho, left, right):
        return np.abs(self.data[0]) + np.abs(self.data[1]) * rho + np.abs(self.data[2]) * 2 * rho * rho

    def second_difference(self, rho, left, right):
        y = rho * (left - right)
        two, three, four = self.data
        return two + three * y + four * (y * y + rho * rho)

    def pair(self, rho, whole, share, narrow):
        two, three, four = self.data
        y = rho * (2 * share - 1)
        return two + four * (y * y + rho * rho), three * y


GEOMETRIES = {-1: CircleModes, 1: HyperbolaModes, 0: ParabolaModes}


def modes_of(land: Landscape, middle) -> Modes:
    """The modes of the potential about places, the middles of intervals."""
    return GEOMETRIES[land.e].about(land.potential, *middle)


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


def _sinhc_and_rest(t):
    """sinh(u)/u and cosh u less it, of t = u^2 <= 1."""
    f, g = 1.0, 1.0
    for n in range(11, 0, -1):
        f = 1 + t * f * (1 / (2 * n * (2 * n + 1)))
        g = 1 + t * g * (1 / (2 * n * (2 * n + 3)))
    return f, t * (1 / 3) * g


def _even_limit(a2, b):
    """(sinc a - sinc b)/(a^2 - b^2) for small a and b >= 1: no cancellation to fear."""
    with np.errstate(all="ignore"):
        return (1 - a2 / 6 * (1 - a2 / 20) - np.sin(b) / b) / (a2 - b * b)


def _exp_difference(rho, left, right):
    """exp[-rho, rho, y]: second divided difference of exp, with y + rho = 2 rho left, rho - y = 2 rho right."""
    short = rho < 1.0
    series = _exp_series(rho, left, right) if np.any(short) else np.nan
    return np.where(short, series, np.nan if np.all(short) else _exp_directly(rho, left, right))


def _exp_directly(rho, left, right):
    up, down = 2 * rho * right, 2 * rho * left  # distances from the right and the left end
    with np.errstate(all="ignore"):
        near_right = np.exp(rho) * np.where(up > 0, -np.expm1(-up) / np.where(up > 0, up, 1), 1.0)  # exp[y, rho]
        near_left = np.exp(-rho) * np.where(down > 0, np.expm1(down) / np.where(down > 0, down, 1), 1.0)  # exp[-rho, y]
        return (near_right - near_left) / (2 * rho)


def _exp_series(rho, left, right):
    """About the middle, for short intervals: a sum over complete homogeneous polynomials h_n(-rho, rho, y)/(n+2)!."""
    y = rho * (left - right)
    homogeneous, rho2, even, series, factor = np.ones_like(y), rho * rho, np.ones_like(y), 0.5 * np.ones_like(y), 0.5
    for n in range(1, 22):
        even = even * rho2 if n % 2 == 0 else even
        homogeneous = y * homogeneous + (even if n % 2 == 0 else 0.0)
        factor = factor / (n + 2)
        series = series + factor * homogeneous
    return series


def divided_pair(u, fu, cu, rho, whole_s, whole_c, p1, q1, p2, q2, narrow):
    """(even, odd): V[l, r, theta] is their sum at the node whose distance from l is 2u, and their difference at its
    mirror image. With v = rho - u the modes cos, sin have the divided differences -sinc u sinc v/2 and
    (cos u sinc v - sinc u cos v)/(2 rho). fu, cu = sinc u, cos u; narrow: rho < NARROW."""
    v = rho - u
    su = u * fu
    sv, cv = whole_s * cu - whole_c * su, whole_c * cu + whole_s * su
    fv = sv / v
    even = -0.5 * fu * fv * (p1 + 4 * p2 * cu * cv)
    if narrow:
        gu, gv = sinc_minus_cos(u * u), sinc_minus_cos(v * v)
        g2u, g2v = sinc_minus_cos(4 * u * u), sinc_minus_cos(4 * v * v)
        odd = (0.5 * q1 * (fu * gv - fv * gu) + q2 * (fu * cu * g2v - fv * cv * g2u)) / rho
    else:
        odd = (0.5 * q1 * (cu * fv - fu * cv) + q2 * ((cu * cu - su * su) * fv * cv - fu * cu * (cv * cv - sv * sv))) / rho
    return even, odd
