"""Corrected energies and amplitudes: their rates are what is said, and their rounding is covered."""
import random
from dataclasses import replace

import mpmath
import numpy as np
import pytest

from stabilab.unreduced.spin_up import moving_kernel
from stabilab.unreduced.spin_up.centres import ROUNDING, FixedCentre, moving_centre
from stabilab.unreduced.spin_up.certificate import Certifier
from stabilab.unreduced.spin_up.form import forms_of
from tests.verify import inequality_in_digits

from .scenes import EXAMPLE, random_scene


def corrected(form, orders):
    """(added, rate) of the energy and of the amplitude about the fixed centre."""
    field = FixedCentre(form)
    return [(one.added, one.rate) for one in (field.energy(orders[0]), field.amplitude(orders[1]))]


def terms(quantity):
    """(j, k, n, c) of c zeta^j zeta*^k X^-n."""
    j, k, a, _ = quantity.powers
    return [*zip(j.tolist(), k.tolist(), (a / 4).tolist(), quantity.c.tolist())]


def in_digits(form, scene, orders):
    """The same as tables {(j, k, n): c}, and (X, zeta) of a state, in 60 digits by a code that shares nothing
    with this one: its zeta is ours over a number, its energy ours over D1."""
    claims = {"variables": "physical", "inertia": scene.body.exact, "momentum": scene.vector("gyrostat"),
              "torque": scene.vector("constant_torque")}
    fine = inequality_in_digits.Form(claims, form.axis + 1, form.sense)
    D = [inequality_in_digits.number(scene.body.exact[n]) for n in form.order]
    size = mpmath.sqrt(D[1] * abs(D[0] - D[1]))
    scaled = lambda table, factor: {key: factor * c / size ** (key[0] + key[1]) for key, c in table.items()}
    high, rest, _, wide, left = inequality_in_digits.corrections(fine, orders)

    def place(state):
        X, z = fine.place([mpmath.mpf(v) for v in state])
        return X, size * z
    return (scaled(high, D[0]), scaled(rest, D[0])), (scaled(wide, size**2), scaled(left, size**2)), place


def value(table, X, z):
    return sum(c * z**j * z.conjugate()**k * X**-n for j, k, n, c in table)


def derivative(table, X, z, dX, dz):
    """Along the motion, by the chain rule term by term."""
    slope = lambda j, k, n: j * dz / z + k * (dz / z).conjugate() - n * dX / X
    return sum(c * z**j * z.conjugate()**k * X**-n * slope(j, k, n) for j, k, n, c in table)


@pytest.mark.parametrize("orders", [(0, 2), (4, 6)])
def test_rates_of_corrected_quantities_are_what_is_left(orders):
    rng = random.Random(5)
    for _ in range(10):
        for f in forms_of(random_scene(rng)):
            X, z = rng.uniform(3, 9), complex(rng.gauss(0, 1), rng.gauss(0, 1))
            dX = (f.M1 + f.gam * (z * z).imag + (f.kap.conjugate() * z).real) / f.D1
            dz = 1j * f.om * X * z + 1j * f.h * z.conjugate() + f.mu
            for weight in (f.drag / f.M1, 0.0):
                changed = replace(f, drag=weight * f.M1)
                (energy, left), (amplitude, rate) = [map(terms, one) for one in corrected(changed, orders)]
                true = 2 * (dz * z.conjugate()).real * (1 + weight / X) - weight * abs(z)**2 / X**2 * dX
                true += derivative(amplitude, X, z, dX, dz)
                size = sum(abs(c) * abs(z)**(j + k) * X**-n for j, k, n, c in rate)
                assert abs(true - value(rate, X, z)) < 1e-9 * (1 + size + abs(dz))  # chain rule on the form
            true = f.D1 * X * dX + derivative(energy, X, z, dX, dz)
            assert abs(true - f.M1 * X - f.drag - value(left, X, z)) < 1e-8 * (1 + abs(X * dX) + abs(dz))


@pytest.mark.parametrize("order", [2, 6, 14])
def test_everything_left_of_the_amplitude_falls_like_1_over_x_squared(order):
    for f in forms_of(EXAMPLE):
        left = terms(FixedCentre(f).amplitude(order).rate)
        assert min(n for *_, n, _ in left) >= 2
        assert min(n for j, k, n, _ in left if j != k) > order  # what oscillates was taken out
        field = moving_centre(f, EXAMPLE)
        assert field.algebra.levels(field.amplitude(min(order, 4)).rate).min() > 4


@pytest.mark.parametrize("orders", [(4, 6), (12, 14)])
def test_majorants_cover_the_rounding_of_coefficients(orders):
    scene = random_scene(random.Random(6), 1)
    for form in forms_of(scene):
        with mpmath.workdps(inequality_in_digits.DIGITS):
            *true, _ = in_digits(form, scene, orders)
            for of, fine in zip(corrected(form, orders), true):
                for rough, exact in zip(of, fine):
                    j, k, a, _ = (v.tolist() for v in rough.powers)
                    found = dict(zip(zip(j, k, [n // 4 for n in a]), zip(rough.c.tolist(), rough.m.tolist())))
                    for key in found.keys() | exact.keys():
                        c, m = found.get(key, (0, 0))
                        error = abs(exact.get(key, 0) - c)
                        assert error <= 2.0**-38 * m
                        assert abs(exact.get(key, 0)) <= abs(c) + ROUNDING * m


def test_factors_fall_and_their_tails_are_their_integrals():
    from scipy.integrate import quad
    for field in (moving_centre(f, EXAMPLE) for f in forms_of(EXAMPLE)):
        a2, a3, form = field.a2, field.a3, Certifier(field, (2, 4)).numbers[0]
        pq = lambda x, field=field: (field.a3 * x + field.c, field.a2 * x + field.c)
        rows = np.ones((4, 2 * moving_kernel.MIDDLE + 1))
        moving_kernel.prepare(rows, 7.0, form)
        for a, b in ((8, 0), (12, 8), (3, 9), (11, -2)):
            curve = lambda x: (lambda p, q: p ** (-a / 4) * q ** (-b / 4))(*pq(x))
            greatest = moving_kernel.greatest(a, b, rows, a2)
            tail = moving_kernel.tail(a, b, rows, a2, a3, form.parts)
            assert max(curve(x) for x in np.linspace(7, 60, 200)) <= greatest * (1 + 1e-12)
            assert quad(curve, 7, 4000, limit=400)[0] <= tail * (1 + 1e-6)  # quadrature by SciPy
