"""Corrected energies and amplitudes: their rates are what is said, and their rounding is covered."""
import random

import mpmath
import numpy as np
import pytest

from stabilab.unreduced.spin_up import fixed_kernel, moving_kernel
from stabilab.unreduced.spin_up.centres import moving_centre
from stabilab.unreduced.spin_up.form import forms_of, normal_form

from .scenes import EXAMPLE, random_scene


class Digits:
    """A kind of number with 40 digits."""

    real, root, pair = staticmethod(lambda v: mpmath.mpf(v.numerator)
                                    / v.denominator), mpmath.sqrt, mpmath.mpc
    i = mpmath.mpc(0, 1)


def corrected(form, orders, drag=None, kind=complex):
    """((added, majorants), (rate, majorants)) of the energy and of the amplitude about the fixed centre:
    tables of zeta^j zeta*^k X^(1 - n)."""
    top, powers = max(orders) + 8, max(orders) + 5
    kinds = (complex, float) if kind is complex else (kind, kind)
    made = [np.zeros((top, top, powers), k) for _ in range(4) for k in kinds]
    numbers, rest = np.array([form.D1, form.M1, form.gam, form.h]), np.array([form.mu, form.kap])
    fixed_kernel.tables(orders, form.om, form.drag if drag is None else drag, numbers, rest, *made)
    return [[(made[n], made[n + 1]), (made[n + 2], made[n + 3])] for n in (0, 4)]


def terms(table):
    """(j, k, n, c) of a table."""
    return [(*at, table[at]) for at in zip(*(v.tolist() for v in np.nonzero(table)))]


def value(table, X, z):
    return sum(c * z**j * z.conjugate()**k * X**(1 - n) for j, k, n, c in terms(table))


def derivative(table, X, z, dX, dz):
    """Along the motion, by the chain rule term by term."""
    slope = lambda j, k, n: j * dz / z + k * (dz / z).conjugate() + (1 - n) * dX / X
    return sum(c * z**j * z.conjugate()**k * X**(1 - n) * slope(j, k, n) for j, k, n, c in terms(table))


@pytest.mark.parametrize("orders", [(0, 2), (4, 6)])
def test_rates_of_corrected_quantities_are_what_is_left(orders):
    rng = random.Random(5)
    for _ in range(10):
        for f in forms_of(random_scene(rng)):
            X, z = rng.uniform(3, 9), complex(rng.gauss(0, 1), rng.gauss(0, 1))
            dX = (f.M1 + f.gam * (z * z).imag + (f.kap.conjugate() * z).real) / f.D1
            dz = 1j * f.om * X * z + 1j * f.h * z.conjugate() + f.mu
            for weight in (f.drag / f.M1, 0.0):
                ((energy, _), (left, _)), ((amplitude, _), (rate, _)) = corrected(f, orders, weight * f.M1)
                true = 2 * (dz * z.conjugate()).real * (1 + weight / X) - weight * abs(z)**2 / X**2 * dX
                true += derivative(amplitude, X, z, dX, dz)
                size = sum(abs(c) * abs(z)**(j + k) * X**(1 - n) for j, k, n, c in terms(rate))
                assert abs(true - value(rate, X, z)) < 1e-9 * (1 + size + abs(dz))  # chain rule on the form
            true = f.D1 * X * dX + derivative(energy, X, z, dX, dz)
            assert abs(true - f.M1 * X - f.drag - value(left, X, z)) < 1e-8 * (1 + abs(X * dX) + abs(dz))


@pytest.mark.parametrize("order", [2, 6, 14])
def test_everything_left_of_the_amplitude_falls_like_1_over_x_squared(order):
    for f in forms_of(EXAMPLE):
        _, (_, (rate, _)) = corrected(f, (0, order))
        assert min(n for *_, n, _ in terms(rate)) >= 3
        assert min(n for j, k, n, _ in terms(rate) if j != k) > order + 1  # what oscillates was taken out
        field = moving_centre(f, EXAMPLE)
        assert field.algebra.levels(field.amplitude(min(order, 4)).rate).min() > 4


@pytest.mark.parametrize("orders", [(4, 6), (12, 14)])
def test_majorants_cover_the_rounding_of_coefficients(orders):
    scene = random_scene(random.Random(6), 1)
    args = [tuple(map(float, v)) for v in (scene.body.exact, scene.vector("gyrostat"),
                                           scene.vector("constant_torque"))]
    with mpmath.workdps(40):
        for axis in range(3):
            rough, fine = normal_form(*args, axis), normal_form(*args, axis, Digits)
            if rough is None:
                continue
            for of, true in zip(corrected(rough, orders), corrected(fine, orders, kind=object)):
                for (c, m), (exact, _) in zip(of, true):
                    for at in zip(*np.nonzero(m)):
                        error = abs(exact[at] - c[at])  # against 40 digits
                        assert error <= 2.0**-38 * m[at]
                        assert abs(exact[at]) <= abs(c[at]) + fixed_kernel.ROUNDING * m[at]


def test_factors_fall_and_their_tails_are_their_integrals():
    from scipy.integrate import quad
    for field in (moving_centre(f, EXAMPLE) for f in forms_of(EXAMPLE)):
        a2, a3, rows = field.a2, field.a3, np.zeros((4, 2 * moving_kernel.MIDDLE + 1))
        pq = lambda x, field=field: (field.a3 * x + field.c, field.a2 * x + field.c)
        moving_kernel.prepare(rows, *pq(7.0), a2, a3, 30)
        for a, b in ((8, 0), (12, 8), (3, 9), (11, -2)):
            curve = lambda x: (lambda p, q: p ** (-a / 4) * q ** (-b / 4))(*pq(x))
            greatest, tail = moving_kernel.greatest(a, b, rows, a2), moving_kernel.tail(a, b, rows, a2, a3)
            assert max(curve(x) for x in np.linspace(7, 60, 200)) <= greatest * (1 + 1e-12)
            assert quad(curve, 7, 4000, limit=400)[0] <= tail * (1 + 1e-6)  # quadrature by SciPy
