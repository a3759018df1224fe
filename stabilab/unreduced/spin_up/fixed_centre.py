"""The normal form about its fixed centre as the certificate wants it: where states lie, how terms are bounded from a spin on."""
from __future__ import annotations

import numpy as np

from .elimination import corrected_amplitude, corrected_energy, fixed_algebra
from .form import NormalForm

BLUR = 2.0**-50  # relative rounding in the place of a state: a dozen operations, each within half of 2^-52


class FixedCentre:
    """A normal form with p = X. Arrays: (n,) or (n, m) for m pairs of exponents.

    In every such field x is the spin that grows, D1 x' = drive + what oscillates, `turning(x)` the rate of the phase up to a
    constant, increasing and concave: turn_size times a monomial.
    """

    name, sharp, turn_size = "fixed centre", True, 1.0

    def __init__(self, form: NormalForm):
        self.form, self.algebra = form, fixed_algebra(form)
        self.D1, self.M1, self.axis, self.sense = form.D1, form.M1, form.axis, form.sense

    def place(self, states, near=0.0):
        """(x, zeta, blur of x, blur of zeta) of states (n, 3): the true place of each state within `near` (n,) of them."""
        f = self.form
        w = states[:, list(f.order)] * np.array(f.turn, float)
        U, V = w[:, 1] - f.centre[0], w[:, 2] - f.centre[1]
        most = max(map(abs, f.scale))
        size = np.abs(w).sum(axis=1) + abs(f.centre[0]) + abs(f.centre[1])
        return (w[:, 0] + f.shift, f.scale[0] * U + 1j * f.scale[1] * V, BLUR * (np.abs(w[:, 0]) + abs(f.shift)) + near,
                most * (BLUR * size + near))

    def turning(self, x):
        """X itself: om X is the rate of the phase."""
        return x

    def drive(self, z):
        """(least, greatest) of M1 + m*/x over x >= z."""
        f = self.form
        return f.M1 + min(0.0, f.drag) / z, f.M1 + max(0.0, f.drag) / z

    def most_weight(self, x, dx):
        """A bound of the factor of |zeta|^2 in the amplitude within dx of x, rounding included."""
        mean = self.form.drag / self.form.M1
        return 1 + mean / x + abs(mean) * (dx / (x - dx) ** 2 + BLUR / x) + BLUR

    def least_weight(self, z):
        """Its least value over x >= z."""
        return 1 + min(0.0, self.form.drag) / (self.form.M1 * z)

    def factors(self, a, b, x):
        """p^(-a/4) q^(-b/4), (n, m): each decreases, so it is its own greatest value over all greater x."""
        return x[:, None] ** (-a / 4.0)

    greatest = factors

    def steepness(self, a, b, x):
        """|d log factor/dx| at most, over x and beyond."""
        return np.abs(a) / (4.0 * x[:, None])

    def tails(self, a, b, z):
        """The integral of the factors over x from z on."""
        n = a / 4.0
        return z[:, None] ** (1 - n) / (n - 1)

    def valid(self, x):
        """Where the form applies."""
        return x > 0

    def energy(self, order, by=None):  # the loops about the fixed centre make their own tables
        return corrected_energy(self.form, order)

    def amplitude(self, order, by=None):
        return corrected_amplitude(self.form, order)

    def transverse(self, A, z):
        """((low, high), (low, high)) of omega2 and omega3 of the form while |zeta| <= A."""
        return tuple((c - A / abs(scale), c + A / abs(scale)) for c, scale in zip(self.form.centre, self.form.scale))

    @property
    def basis(self):
        """The form's three axes in principal axes of the body, rows."""
        basis = np.zeros((3, 3))
        for row, (t, n) in enumerate(zip(self.form.turn, self.form.order)):
            basis[row, n] = t
        return basis
