"""A certificate of spin-up: an inequality between numbers of one state that, once true, stays true for ever.

Theorem (proof: docs/mathematics/spin-up.md). Let x be the spin of a form, D1 x' = V(x) + what oscillates,
zeta its amplitude, Om(x) > 0 increasing (the rate of the phase up to a constant), V >= drive from z on, and
let, by elimination, for all x >= z and |zeta| <= A

    Y  = D1 int Om dx + (added),             Y' = Om V + (left),       |added| <= e,  |left|/Om <= k,
    B  = w(x) |zeta|^2 + (added),            |added| <= b,             int |B'| dx <= r,    w >= w_ > 0.

(e, k, b: sums of |c| A^(j+k) times the greatest value of the factor of x from z on; r the same with the
factor's integral.) If at one time

    x > z, |zeta| < A;    D1 int_z^x Om + added > e;    eta = drive - k > 0;    F = [B + b + r D1/eta]/w_ <
    A^2,

then at all later times |zeta| < A and x >= z + eta t/D1, x <= z+ + eta+ t/D1 with D1 int_x^(z+) Om = added +
e, eta+ = greatest V + k.

For the fixed centre Om = x, V = M1 + m*/x, and orders (0, 2) without the weight w = 1 + m*/(M1 x) are the
classical E + Im/X and B + R/(om X) + Psi/(D1 om^2 X^3), with k formed from the sums as they come out. Then
also D1 y' >= M1 + (m* - z k)/y and D1 y+' <= M1 + (m* + z k)/y+, for k x falls: the sharper clock (`clock`).
Since Om is concave, int_z^x Om >= (x - z)(Om(x) + Om(z))/2, which is what is tested (equal for the fixed
centre), and int_x^(z+) Om >= (z+ - x) Om(x) gives z+.

Rounding. The place of a state is known within its blur (rounding and, asked for, a ball of states about it):
x and |zeta| are taken at their worse ends and each term at the start within the change that the blur can make
of it. Coefficients hold their rounding (`elimination`), sums of positive numbers are off by less than 2^-40
of themselves, and every comparison leaves SLACK = 2^-30 of the sum of the sizes in it.

A and z are searched from the smallest that could do, by `fixed_kernel` and `moving_kernel`: compiled, or as
they are written.
"""
from __future__ import annotations

import math
from functools import cached_property, lru_cache
from types import ModuleType
from typing import NamedTuple

import numpy as np

from ...integrate.quadratic_series import in_unit
from . import fixed_kernel, moving_kernel
from .centres import FixedCentre, MovingCentre, Terms, moving_centre, sizes
from .compiled import functions
from .form import forms_of
from .symmetric import equatorial

# Orders of energy and amplitude. About the fixed centre: tested always (what (0, 2) decides they decide as
# well), and sparsely; the series is asymptotic, higher ones gain nothing. About the moving one: last, seldom.
ORDERS, HIGH_ORDERS, HIGHEST_ORDERS = (4, 6), (12, 14), (16, 18)
MOVING_ORDERS, LAST_ORDERS = (4, 6), (8, 10)
EQUATORIAL_ORDERS = ((2, 4), (4, 6))


class Certifier:
    """The inequality of the theorem in one field at one pair of orders, by the functions of a kernel over
    tables that are made once."""

    kernel: ModuleType
    numbers: tuple  # the arguments of the kernel's `decide` from the seventh on, but for arrays to work in

    def work(self) -> tuple:
        """Arrays to work in: new ones for each question, for threads may share a test."""
        raise NotImplementedError

    def decide(self, rows, states, reach, fired, number, found, fast: bool = False):
        """The test for those of rows that no test has fired for, balls of radius reach (n,) about states (n,
        3): fired (n,) becomes number, found (6, n) the constants A, z, eta, z_up, eta_up, k of the
        theorem."""
        with np.errstate(all="ignore"):  # what overflows is not finite, and certifies nothing
            decide = functions(self.kernel, fast)["decide"]
            decide(rows, states, reach, fired, number, found, *self.numbers, *self.work())

    def constants(self, state, near: float = 0.0, fast: bool = False) -> tuple[float, ...] | None:
        """The six constants for all states of the ball of radius `near` about one (3,); None where the
        inequality does not hold."""
        fired, found = np.full(1, -1), np.full((6, 1), np.nan)
        self.decide(np.arange(1), np.array([state], float), np.array([near], float), fired, 0, found, fast)
        return None if fired[0] else tuple(found[:, 0].tolist())


class Gathered(NamedTuple):
    """Sums of sizes and of majorants of a quantity by degree (rows) and power (columns from n = first on),
    without the outer rows and columns of zeros."""

    first: int
    sums: np.ndarray
    most: np.ndarray

    @classmethod
    def of(cls, c, m) -> Gathered:
        """Of coefficients c[j, k, n] and their majorants m."""
        degree = np.add.outer(*[np.arange(c.shape[0])] * 2)
        sums, most = np.zeros((2, 2 * c.shape[0], c.shape[2]))
        np.add.at(sums, degree, np.abs(c) + fixed_kernel.ROUNDING * m)
        np.add.at(most, degree, m)
        degrees, columns = np.flatnonzero(most.any(axis=1)), np.flatnonzero(most.any(axis=0))
        rows, first, end = (degrees[-1] + 1, columns[0], columns[-1] + 1) if columns.size else (1, 0, 1)
        return cls(first, *(np.ascontiguousarray(table[:rows, first:end]) for table in (sums, most)))

    def tails(self):
        """The sums for integrals of the factors over all greater x: X^(1 - n) gives z^(2 - n)/(n - 2), and
        infinity where it does not fall faster than 1/X."""
        fall = self.first + np.arange(self.sums.shape[1]) - 2.0
        return np.where(fall > 0, self.sums / np.where(fall > 0, fall, 1.0),
                        np.where(self.sums > 0, np.inf, 0.0))

    def terms(self, c):
        """(powers of zeta and of its conjugate (2, m), coefficients (m, columns)) of a quantity's terms with
        j >= k, doubled for their conjugates."""
        j, k = np.nonzero(np.tril((c != 0).any(axis=2)))
        columns = slice(self.first, self.first + self.sums.shape[1])
        return np.stack([j, k]), np.where(j == k, 1.0, 2.0)[:, None] * c[j, k, columns]


class FixedCertifier(Certifier):
    """The test about the fixed centre."""

    kernel = fixed_kernel

    def __init__(self, field: FixedCentre, orders: tuple[int, int], fast: bool = False):
        f = field.form
        top, powers = max(orders) + 8, max(orders) + 5
        made = [np.zeros((top, top, powers), kind) for _ in range(4) for kind in (complex, float)]
        added_e, most_e, rate_e, rise_e, added_b, most_b, rate_b, rise_b = made
        numbers, rest = np.array([f.D1, f.M1, f.gam, f.h]), np.array([f.mu, f.kap], complex)
        with np.errstate(all="ignore"):
            functions(fixed_kernel, fast)["tables"](np.array(orders), f.om, f.drag, numbers, rest, *made)
            e, b = Gathered.of(added_e, most_e), Gathered.of(added_b, most_b)
            r, k = Gathered.of(rate_b, rise_b), Gathered.of(rate_e, rise_e)
            tails, terms = r.tails(), (*e.terms(added_e), *b.terms(added_b))
        self.top, self.columns = top, max(q.sums.shape[1] for q in (e, b, r, k))
        frame = np.array([*f.turn, f.shift, *f.centre, *f.scale], float)
        self.numbers = (np.array(f.order), frame, f.D1, f.M1, f.drag, *terms, e.sums, e.most, b.sums, b.most,
                        tails, k.sums, np.array([q.first for q in (e, b, r, k)]))

    def work(self):
        return np.zeros(self.top, complex), *np.zeros((2, self.columns)), np.zeros(6)


class MovingCertifier(Certifier):
    """The test about a moving centre."""

    kernel = moving_kernel

    def __init__(self, field: MovingCentre, orders: tuple[int, int], fast: bool = False):
        with np.errstate(all="ignore"):
            energy, amplitude = field.energy(orders[0]), field.amplitude(orders[1])
        turn = field.algebra.turn
        e_pairs, e = _sums(energy.added, sizes(energy.added))
        b_pairs, b = _sums(amplitude.added, sizes(amplitude.added))
        r_pairs, r = _sums(amplitude.rate, sizes(amplitude.rate))
        k_pairs, k = _sums(energy.rate, sizes(energy.rate) / field.turn_size, (-turn[0], -turn[1]))
        (_, e_most), (_, b_most) = (_sums(part, part.m) for part in (energy.added, amplitude.added))
        values = *_values(energy.added), *_values(amplitude.added)
        all_pairs = np.concatenate([e_pairs, b_pairs, r_pairs, k_pairs], axis=1)
        reach = 5 + int(np.abs(all_pairs).sum(axis=0).max())
        drive = np.array([(a, b, c) for (_, _, a, b), c in field.G0.items()], float).reshape(-1, 3).T
        frame = np.array([field.s, *field.wheel, *field.torque, *field.roots, field.n2, field.n3], float)
        self.degrees = 1 + max(int(values[n].max()) for n in (1, 3))
        self.numbers = (field.basis, frame, field.D1, field.M1, field.a2, field.a3, field.c, reach,
                        np.ascontiguousarray(drive), *values, e_pairs, e, e_most, b_pairs, b, b_most,
                        r_pairs, r, k_pairs, k)

    def work(self):
        return np.zeros((4, 2 * moving_kernel.MIDDLE + 1)), np.zeros(self.degrees, complex), np.zeros(6)


def _sums(terms: Terms, coefficients, shift=(0, 0)):
    """(exponents a, b (2, pairs), table (degrees, pairs)) of a sum of coefficients by degree and exponents;
    of no terms one that is 0."""
    j, k, a, b = terms.powers
    pairs, column = _distinct(a + shift[0], b + shift[1])
    table = np.zeros((1 + int((j + k).max(initial=0)), pairs.shape[1]))
    np.add.at(table, (j + k, column), coefficients)
    return pairs, table


def _values(terms: Terms):
    """(table (powers, pairs), j and k (2, powers)) of a sum's value, j >= k, for terms come with their
    conjugates; pairs in the order of `_sums`."""
    j, k, a, b = terms.powers
    half = j >= k
    pairs, column = _distinct(a, b)
    powers, row = _distinct(j[half], k[half])
    table = np.zeros((powers.shape[1], pairs.shape[1]), complex)
    np.add.at(table, (row, column[half]), np.where(j == k, 1, 2)[half] * terms.c[half])
    return table, powers


def _distinct(a, b):
    """The distinct pairs of whole numbers (2, m), ordered, and which of them each pair is, (n,); (0, 0) where
    there are none."""
    if not a.size:
        return np.zeros((2, 1), np.int64), np.zeros(0, np.int64)
    pairs, which = np.unique(np.stack([a, b]), axis=1, return_inverse=True)
    return np.ascontiguousarray(pairs), which.ravel()


@lru_cache(maxsize=32)
def natural(scene):
    """(scene in natural units, unit of rates): powers of two near the mean moment and near the root of torque
    over moment. Kept, for a certificate and its proof ask for it in turn."""
    if scene.variables == "scaled":
        torque, mass = max(map(abs, scene.exact_mu)), 1
    else:
        torque, mass = max(map(abs, scene.vector("constant_torque"))), sum(scene.body.exact) / 3
    if not torque:
        return scene, 1.0
    weight = 2.0 ** round(_log2(mass))
    unit = 2.0 ** round((_log2(torque) - _log2(mass)) / 2)
    return scene if unit == weight == 1 else in_unit(scene, unit, weight), unit


def _log2(value):
    return (math.log2(value.numerator) - math.log2(value.denominator) if hasattr(value, "numerator")
            else math.log2(value))


class Tests:
    """The certificates of a scene (in natural units), each made when it is first asked for.

    often: those of low order; high: with high orders about the fixed centre; all: with the highest, and the
    moving centre where a wheel takes it elsewhere; last: with those that take long to make. Each is a prefix
    of the next. asked: those that were.
    """

    def __init__(self, scene):
        self.scene, self.forms, round_ = scene, forms_of(scene), equatorial(scene)
        self.fixed = [FixedCentre(form) for form in self.forms]
        self.equatorial = [round_] if round_ else []
        self.made: dict[tuple, Certifier] = {}
        self.asked: list[tuple] = []
        low = [(field, ORDERS) for field in self.fixed]
        self.often = low + [(field, EQUATORIAL_ORDERS[0]) for field in self.equatorial]
        self.high = self.often + [(field, HIGH_ORDERS) for field in self.fixed]

    @cached_property
    def moving(self):
        found = (moving_centre(form, self.scene) for form in self.forms)
        return [moving for moving in found if moving]

    @cached_property
    def all(self):
        # the centre moves far where there is a wheel
        wheeled = [field for field in self.moving if field.wheeled]
        return (self.high + [(field, HIGHEST_ORDERS) for field in self.fixed] +
                [(field, MOVING_ORDERS) for field in wheeled] +
                [(field, EQUATORIAL_ORDERS[1]) for field in self.equatorial])

    @cached_property
    def last(self):
        still = [(field, MOVING_ORDERS) for field in self.moving if not field.wheeled]
        return self.all + still + [(field, LAST_ORDERS) for field in self.moving]

    def __bool__(self):
        return bool(self.often)

    def certifier(self, field, orders: tuple[int, int], fast: bool = False) -> Certifier:
        """The test itself; fast: its tables made by compiled functions. What others made does not alter an
        answer."""
        key = id(field), orders, fast and field.sharp
        if key not in self.made:
            # before it is made: another thread that finds it made looks for its number
            if (field, orders) not in self.asked:
                self.asked.append((field, orders))
            self.made[key] = (FixedCertifier if field.sharp else MovingCertifier)(field, orders, fast)
        return self.made[key]


@lru_cache(maxsize=32)
def tests_of(scene) -> Tests:
    """The tests of a scene, kept for the next state of the same one."""
    return Tests(scene)
