"""Corrected energies and amplitudes: their rates are what is said, and their rounding is covered."""
import random

import mpmath
import numpy as np
import pytest
import sympy as sp

from stabilab.unreduced.spin_up.elimination import corrected_amplitude, corrected_energy, sizes
from stabilab.unreduced.spin_up.fixed_centre import FixedCentre
from stabilab.unreduced.spin_up.form import forms_of, normal_form
from stabilab.unreduced.spin_up.moving_centre import moving_centre

from .scenes import EXAMPLE, random_scene


class Digits:
    """A kind of number with 40 digits."""

    real, root, pair = staticmethod(lambda v: mpmath.mpf(v.numerator) / v.denominator), mpmath.sqrt, mpmath.mpc
    i = mpmath.mpc(0, 1)


def value(terms, p, q, z):
    return sum(c * z**j * z.conjugate()**k * p**(-a / 4) * q**(-b / 4) for (j, k, a, b), c in terms.as_dict().items())


def derivative(terms, p, q, z, dp, dq, dz):
    """Along the motion, by the chain rule term by term."""
    return sum(c * z**j * z.conjugate()**k * p**(-a / 4) * q**(-b / 4) * (j * dz / z + k * (dz / z).conjugate() - a / 4 * dp / p - b / 4 * dq / q)
               for (j, k, a, b), c in terms.as_dict().items())


@pytest.mark.parametrize("order", [(0, 2), (4, 6)])
def test_rates_of_corrected_quantities_are_what_is_left(order):
    rng = random.Random(5)
    for _ in range(20):
        for f in forms_of(random_scene(rng)):
            X, z = rng.uniform(3, 9), complex(rng.gauss(0, 1), rng.gauss(0, 1))
            dX = (f.M1 + f.gam * (z * z).imag + (f.kap.conjugate() * z).real) / f.D1
            dz = 1j * f.om * X * z + 1j * f.h * z.conjugate() + f.mu
            for weighted in (True, False):
                found, w = corrected_amplitude(f, order[1], weighted), f.drag / f.M1 * weighted
                true = 2 * (dz * z.conjugate()).real * (1 + w / X) - w * abs(z)**2 / X**2 * dX + derivative(found.added, X, 1, z, dX, 0, dz)
                size = np.abs(found.rate.c) @ (abs(z)**(found.rate.powers[0] + found.rate.powers[1]) * X**(-found.rate.powers[2] / 4))
                assert abs(true - value(found.rate, X, 1, z)) < 1e-9 * (1 + size + abs(dz))  # chain rule on the form
            found = corrected_energy(f, order[0])
            true = f.D1 * X * dX + derivative(found.added, X, 1, z, dX, 0, dz)
            assert abs(true - f.M1 * X - f.drag - value(found.rate, X, 1, z)) < 1e-9 * (1 + abs(X * dX) + abs(dz)) * 10


def test_first_order_is_the_classical_energy_and_amplitude():
    f = normal_form((1.4, 1, .6), (.2, .1, -.3), (.5, .6, .62), 0)
    X, z = 6.375, .5 - .4j
    energy = f.gam / 2 / f.om * (z * z).real - (f.kap.conjugate() * z).imag / f.om - (f.nu * z).imag / f.om**2 / X
    assert value(corrected_energy(f, 0).added, X, 1, z).real == pytest.approx(energy, rel=1e-13)  # E2 of the paper's section 1
    m, k, g, h, M1 = f.mu, f.kap.conjugate(), f.gam, f.h, f.M1
    psi = (M1 * h / 2 * (z**2).imag + 2 * M1 * (m.conjugate() * z).real - g * h / 8 * (z**4).real - g * abs(z)**2 * (m * z).imag
           + g / 3 * (m.conjugate() * z**3).imag + h / 6 * (k * z**3).imag + h / 2 * abs(z)**2 * (f.kap * z).imag + (k * m.conjugate() * z**2).real / 2)
    R = h * (z * z).real - 2 * (m.conjugate() * z).imag
    amplitude = R / f.om / X + psi / f.D1 / f.om**2 / X**3
    assert value(corrected_amplitude(f, 2, weighted=False).added, X, 1, z).real == pytest.approx(amplitude, rel=1e-12)  # B of section 1


def test_the_term_of_the_amplitude_that_falls_like_1_over_x_vanishes_identically():
    z, zc, mu, muc, h = sp.symbols("z zc mu muc h")
    rest, restc = sp.I * h * zc + mu, -sp.I * h * z + muc
    R = h * (z**2 + zc**2) / 2 - (muc * z - mu * zc) / sp.I
    assert sp.expand(sp.diff(R, z) * rest + sp.diff(R, zc) * restc) == 0  # in symbols; so no tolerance decides it


@pytest.mark.parametrize("order", [2, 6, 14])
def test_everything_left_of_the_amplitude_falls_like_1_over_x_squared(order):
    for f in forms_of(EXAMPLE):
        rate = corrected_amplitude(f, order).rate
        assert rate.powers[2].min() >= 8
        osc = rate.powers[0] != rate.powers[1]
        assert rate.powers[2][osc].min() > 4 * order  # what oscillates was taken out
        field = moving_centre(f, EXAMPLE)
        assert field.algebra.levels(field.amplitude(min(order, 4)).rate).min() > 4


@pytest.mark.parametrize("orders", [(4, 6), (12, 14)])
def test_majorants_cover_the_rounding_of_coefficients(orders):
    scene = random_scene(random.Random(6), 1)
    args = [tuple(map(float, v)) for v in (scene.body.exact, scene.vector("gyrostat"), scene.vector("constant_torque"))]
    with mpmath.workdps(40):
        for axis in range(3):
            rough, fine = normal_form(*args, axis), normal_form(*args, axis, Digits)
            if rough is None:
                continue
            for of, order in ((corrected_energy, orders[0]), (corrected_amplitude, orders[1])):
                for name in ("added", "rate"):
                    a, b = getattr(of(rough, order), name), getattr(of(fine, order), name)
                    true = {key: c for key, c in b.as_dict().items()}
                    for key, c, m, size in zip(zip(*(v.tolist() for v in a.powers)), a.c.tolist(), a.m.tolist(), sizes(a).tolist()):
                        assert abs(true[key] - c) <= 2.0**-38 * m and abs(true[key]) <= size  # against 40 digits


def test_factors_fall_and_their_tails_are_their_integrals():
    from scipy.integrate import quad
    for f in forms_of(EXAMPLE):
        for field in (FixedCentre(f), moving_centre(f, EXAMPLE)):
            a, b = np.array([8.0, 12.0, 3.0, 11.0]), np.array([0.0, 8.0, 9.0, -2.0])
            if isinstance(field, FixedCentre):
                a, b = a[:2], 0 * b[:2]
            z = np.array([7.0])
            most, tails = field.greatest(a, b, z)[0], field.tails(a, b, z)[0]
            for n in range(len(a)):
                curve = lambda x: field.factors(a, b, np.array([x]))[0, n]
                assert max(curve(x) for x in np.linspace(7, 60, 200)) <= most[n] * (1 + 1e-12)
                assert quad(curve, 7, 4000, limit=400)[0] <= tails[n] * (1 + 1e-6)  # quadrature by SciPy
