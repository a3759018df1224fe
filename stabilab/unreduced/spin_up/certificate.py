"""A certificate of spin-up: an inequality between numbers of one state that, once true, stays true for ever.

Theorem (proof: docs/mathematics/spin-up.md). Let x be the spin of a form, D1 x' = V(x) + what oscillates, zeta its amplitude, Om(x) > 0
increasing (the rate of the phase up to a constant), V >= drive from z on, and let, by elimination, for all x >= z and |zeta| <= A

    Y  = D1 int Om dx + (added),             Y' = Om V + (left),       |added| <= e,  |left|/Om <= k,
    B  = w(x) |zeta|^2 + (added),            |added| <= b,             int |B'| dx <= r,    w >= w_ > 0.

(e, k, b: sums of |c| A^(j+k) times the greatest value of the factor of x from z on; r the same with the factor's integral.) If at one time

    x > z, |zeta| < A;    D1 int_z^x Om + added > e;    eta = drive - k > 0;    F = [B + b + r D1/eta]/w_ < A^2,

then at all later times |zeta| < A and x >= z + eta t/D1, x <= z+ + eta+ t/D1 with D1 int_x^(z+) Om = added + e, eta+ = greatest V + k.

For the fixed centre Om = x, V = M1 + m*/x, and orders (0, 2) without the weight w = 1 + m*/(M1 x) are the classical
E + Im/X and B + R/(om X) + Psi/(D1 om^2 X^3), with k formed from the sums as they come out. Then also D1 y' >= M1 + (m* - z k)/y and
D1 y+' <= M1 + (m* + z k)/y+, for k x falls: the sharper clock (`clock`). Since Om is concave, int_z^x Om >= (x - z)(Om(x) + Om(z))/2, which is what is
tested (equal for the fixed centre), and int_x^(z+) Om >= (z+ - x) Om(x) gives z+.

Rounding. The place of a state is known within its blur (rounding and, asked for, a ball of states about it): x and |zeta| are
taken at their worse ends and each term at the start within the change that the blur can make of it. Coefficients hold
their rounding (`elimination`), sums of positive numbers are off by less than 2^-40 of themselves, and every comparison leaves SLACK =
2^-30 of the sum of the sizes in it.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .elimination import corrected, sizes
from .terms import Terms

ORDERS = ((4, 6),)                  # of energy and amplitude: tested always; what (0, 2) decides it decides as well
HIGH_ORDERS, HIGHEST_ORDERS = ((12, 14),), ((16, 18),)  # sparsely; the series is asymptotic, higher ones gain nothing
PASSES = 25  # of the search for A and z: it is monotone and settles in ten or never
GROWTH = 1 + 1e-7  # of A between passes: strict inequalities need room
SLACK = 2.0**-30
COEFFICIENT = 2.0**-36  # rounding of the terms' values, of their majorant: four times that of the coefficients alone


class Sums:
    """Sums of |c| A^(j+k) f(z) over the terms of a quantity: coefficients gathered by degree and exponents, (degrees, pairs)."""

    def __init__(self, terms: Terms, coefficients, shift=(0, 0)):
        j, k, a, b = terms.powers
        pairs, column = _distinct(a + shift[0], b + shift[1])
        self.a, self.b = pairs.T.astype(float)
        self.table = np.zeros((1 + int((j + k).max(initial=0)), len(pairs)))
        np.add.at(self.table, ((j + k).astype(int), column.ravel()), coefficients)

    def __call__(self, A, factors):
        """A: (n,); factors: (n, pairs) -> (n,)."""
        return (np.vander(A, len(self.table), increasing=True) @ self.table * factors).sum(axis=1)


def _distinct(a, b):
    """The distinct pairs of whole numbers (m, 2), ordered, and which of them each pair is, (n,)."""
    keys, which = np.unique((a.astype(np.int64) << 20) + b, return_inverse=True)
    second = ((keys + (1 << 19)) & ((1 << 20) - 1)) - (1 << 19)
    return np.stack([(keys - second) >> 20, second], axis=1).reshape(-1, 2), which


class Values:
    """The value of a sum of terms at many places; pairs of exponents in the order of `Sums`."""

    def __init__(self, terms: Terms):
        j, k, a, b = terms.powers
        half = j >= k  # terms come with their conjugates
        pairs, column = _distinct(a, b)
        powers, row = _distinct(j[half], k[half])
        self.j, self.k = powers.T
        self.table = np.zeros((len(powers), len(pairs)), complex)
        np.add.at(self.table, (row.ravel(), column.ravel()[half]), np.where(j == k, 1, 2)[half] * terms.c[half])

    def __call__(self, zeta, factors):
        table = np.vander(zeta, 1 + int(self.j.max(initial=0)), increasing=True)
        return ((table[:, self.j] * table[:, self.k].conj()) @ self.table * factors).sum(axis=1).real


@dataclass(frozen=True)
class Found:
    """What the test finds of n states: good (n,), and where it is True the constants of the theorem, (n,) each."""

    good: np.ndarray
    A: np.ndarray
    z: np.ndarray
    eta: np.ndarray
    z_up: np.ndarray
    eta_up: np.ndarray
    k: np.ndarray


class Certifier:
    """The test in one field (`FixedCentre`, `MovingCentre`) at one pair of orders; by: what takes away what oscillates about a moving centre."""

    def __init__(self, field, orders: tuple[int, int], by=corrected):
        self.field, self.orders = field, orders
        energy, amplitude = field.energy(orders[0], by), field.amplitude(orders[1], by)
        turn = field.algebra.turn
        self.e, self.b, self.r = (Sums(terms, sizes(terms)) for terms in (energy.added, amplitude.added, amplitude.rate))
        self.k = Sums(energy.rate, sizes(energy.rate) / field.turn_size, (-turn[0], -turn[1]))
        self.energy_majorant, self.amplitude_majorant = (Sums(terms, terms.m) for terms in (energy.added, amplitude.added))
        self.energy_added, self.amplitude_added = Values(energy.added), Values(amplitude.added)

    def __call__(self, states, near=0.0) -> Found:
        """The theorem's inequality for states (n, 3), searched from the smallest A and z that could do; for all states of the
        balls of radius `near` (n,) about them."""
        n = len(states)
        out = np.full((6, n), np.nan)
        good = np.zeros(n, bool)
        with np.errstate(all="ignore"):
            x, zeta, dx, dz = self.field.place(np.asarray(states, float), near)
            rows = np.flatnonzero(self.field.valid(x - dx) & (dx < x / 8))
            if rows.size:
                start = _Start(self, x[rows], zeta[rows], dx[rows], dz[rows])
                self._search(start, rows, good, out)
        return Found(good, *out)

    def _search(self, start, rows, good, out):
        field = self.field
        A, z = start.size * GROWTH, start.x / GROWTH
        for number in range(PASSES):
            growth = min(1e-2, 1e-6 * 4.0**number)  # ever faster past a slow approach
            for _ in range(2):  # the equation for z is nearly linear
                e = self.e(A, field.greatest(self.e.a, self.e.b, z))
                need = np.maximum(e - start.energy, 0) * (GROWTH + growth) + 1e-7 * start.x * field.turning(start.x)
                z = start.x - 2 * need / (field.D1 * (field.turning(start.x) + field.turning(np.where(field.valid(z), z, start.x))))
                z = np.where(field.valid(z), z, start.x)
            here = z < start.x
            k = self.k(A, field.greatest(self.k.a, self.k.b, z))
            low, high = field.drive(z)
            eta, least = low - k - SLACK * (field.M1 + k), field.least_weight(z) - SLACK  # what is taken off M1 is below it
            alive = here & (eta > 0) & (least > 0)
            b, r = self.b(A, field.greatest(self.b.a, self.b.b, z)), self.r(A, field.tails(self.r.a, self.r.b, z))
            F = (start.amplitude + b + r * field.D1 / eta) / least
            alive &= F < 1e100
            e = self.e(A, field.greatest(self.e.a, self.e.b, z))
            gained = field.D1 * (start.x - z) * (field.turning(start.x) + field.turning(z)) / 2
            room = gained * (1 - SLACK) - SLACK * field.D1 * start.x * field.turning(start.x) * 2.0**-8 > e - start.energy
            done = alive & room & (F * (1 + SLACK) < A * A) & (start.size < A) & (z < start.x)
            if done.any():
                z_up = start.top + (e + start.energy_up) / (field.D1 * field.turning(start.x)) * (1 + SLACK) + SLACK * start.top
                values = np.array([A, z * (1 - SLACK), eta, z_up, (high + k) * (1 + SLACK), k])
                good[rows[done]], out[:, rows[done]] = True, values[:, done]
            keep = alive & ~done
            if not keep.any():
                return
            A = np.maximum(A, np.sqrt(np.maximum(F, 0.0))) * (1 + growth)
            A, z, rows, start = A[keep], z[keep], rows[keep], start.chosen(keep)


class _Start:
    """The numbers of the start that the search uses, at the worse end of their blur."""

    def __init__(self, test, x, zeta, dx, dz):
        field = test.field
        self.x, self.top, self.size = x - dx, x + dx, np.abs(zeta) * (1 + SLACK) + dz
        value, blur = self._value(test.energy_added, test.e, test.energy_majorant, field, x, zeta, dx)
        self.energy, self.energy_up = value - blur, value + blur
        value, blur = self._value(test.amplitude_added, test.b, test.amplitude_majorant, field, x, zeta, dx)
        self.amplitude = field.most_weight(x, dx) * self.size**2 * (1 + SLACK) + value + blur

    def _value(self, values, sums, majorant, field, x, zeta, dx):
        """(value, blur): |zeta1^j zeta1*^k - zeta^j zeta*^k| <= (|zeta| + d)^(j+k) - |zeta|^(j+k), and the factors move by their steepness."""
        a, b = sums.a, sums.b
        value = values(zeta, field.factors(a, b, x))
        greatest = field.greatest(a, b, self.x)
        wide, inner = sums(self.size, greatest), sums(np.abs(zeta), greatest)
        moved = sums(self.size, greatest * (field.steepness(a, b, self.x) * dx[:, None]))
        return value, (wide - inner) + moved * (1 + SLACK) + SLACK * wide + COEFFICIENT * majorant(self.size, greatest)

    def chosen(self, keep):
        """The rows that `keep` marks."""
        new = object.__new__(_Start)
        for name in ("x", "top", "size", "energy", "energy_up", "amplitude"):
            setattr(new, name, getattr(self, name)[keep])
        return new
