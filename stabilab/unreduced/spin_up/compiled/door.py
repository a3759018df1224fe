"""The tests by compiled loops: the door of numba."""
from __future__ import annotations

from functools import lru_cache

import numpy as np

from ....numbers.numba_door import compiled
from ..certificate import Certifier, Found
from ..elimination import corrected
from ..fixed_centre import BLUR
from . import elimination_kernel, kernel, lanes, moving_kernel
from .eliminated import Eliminated

INLINED = {kernel: {"put", "columns", "total", "falling", "value_of", "blurred", "search"}, moving_kernel: {"greatest"},
           elimination_kernel: {"cell"}}


@lru_cache(maxsize=4)
def functions(module) -> dict:
    """A kernel's functions by name, compiled; kept on disk where there is a place for it."""
    return compiled(module, INLINED.get(module, ()), **{} if module in (moving_kernel, elimination_kernel) else lanes.vectors())


@lru_cache(maxsize=1)
def eliminated() -> Eliminated:
    """What takes away what oscillates about a moving centre, one for the process."""
    return Eliminated(functions(elimination_kernel))


def fast_certifier(field, orders: tuple[int, int]):
    """The test in a field by compiled loops."""
    return (FixedCertifier if field.sharp else MovingCertifier)(field, orders)


class Gathered:
    """Sums of sizes and of majorants of a quantity by degree (rows) and power, without the outer rows and columns of zeros, in rows of eight.

    first: index n of the first column; wide: how many times eight columns there are. Row d wide + c of a table holds the columns first + 8 c on of row d.
    """

    def __init__(self, sums, most):
        degrees, columns = np.flatnonzero(most.any(axis=1)), np.flatnonzero(most.any(axis=0))
        rows, self.first, self.end = (degrees[-1] + 1, columns[0], columns[-1] + 1) if columns.size else (1, 0, 1)
        self.wide = -(-(self.end - self.first) // lanes.WIDE)
        self.sums, self.most = self.in_rows(sums[:rows]), self.in_rows(most[:rows])

    def tails(self):
        """The sums for integrals of the factors over all greater x: X^(1 - n) gives z^(2 - n)/(n - 2), and infinity where it does not fall faster than 1/X."""
        fall = self.first + np.arange(lanes.WIDE * self.wide).reshape(self.wide, -1) - 2.0
        fall = np.tile(fall, (len(self.sums) // self.wide, 1))
        return np.where(fall > 0, self.sums / np.where(fall > 0, fall, 1.0), np.where(self.sums > 0, np.inf, 0.0))

    def in_rows(self, table):
        """The columns of a table as rows of eight."""
        filled = np.zeros((len(table), lanes.WIDE * self.wide))
        filled[:, :self.end - self.first] = table[:, self.first:self.end]
        return filled.reshape(-1, lanes.WIDE)


class FixedCertifier:
    """`certificate.Certifier` in a field about the fixed centre: the same test, its tables and its search by the kernel's functions."""

    def __init__(self, field, orders: tuple[int, int], table: dict | None = None):
        f, self.field, self.orders = field.form, field, orders
        self.kernel = functions(kernel) if table is None else table
        top, powers = max(orders) + 8, max(orders) + 5
        made = [np.zeros((top, top, powers), kind) for _ in range(4) for kind in (complex, float)]
        added_e, most_e, rate_e, rise_e, added_b, most_b, rate_b, rise_b = made
        self.kernel["tables"](np.array(orders), f.om, f.drag, np.array([f.D1, f.M1, f.gam, f.h]), np.array([f.mu, f.kap], complex), *made)
        e, b, r, k = (self._gathered(c, m) for c, m in ((added_e, most_e), (added_b, most_b), (rate_b, rise_b), (rate_e, rise_e)))
        self.tables = *self._parts(added_e, e), *self._parts(added_b, b), e.sums, e.most, b.sums, b.most, r.tails(), k.sums, np.array(
            [[q.first for q in (e, b, r, k)], [q.wide for q in (e, b, r, k)]])
        rows = max(q.wide for q in (e, b, r, k))
        self.work = np.zeros(top, complex), np.zeros((rows, lanes.WIDE)), np.zeros((rows, lanes.WIDE)), np.zeros(6)
        self.order, self.frame = np.array(f.order), np.array([*f.turn, f.shift, *f.centre, *f.scale], float)

    def _parts(self, c, gathered):
        """(powers of zeta and of its conjugate (2, m), real and imaginary parts) of a quantity's terms in the columns of its sums."""
        top, _, powers = c.shape
        m = top * (top + 1) // 2
        made = np.zeros((2, m), np.int64), np.zeros((m, powers)), np.zeros((m, powers))
        m = self.kernel["parts"](c, *made)
        return np.ascontiguousarray(made[0][:, :m]), gathered.in_rows(made[1][:m]), gathered.in_rows(made[2][:m])

    def _gathered(self, c, m):
        sums, most = np.zeros((2, 2 * c.shape[0], c.shape[2]))
        self.kernel["gather"](c, m, True, sums)
        self.kernel["gather"](c, m, False, most)
        return Gathered(sums, most)

    def __call__(self, states, near=0.0) -> Found:
        """See `certificate.Certifier`."""
        n, f = len(states), self.field.form
        good, out = np.zeros(n, bool), np.full((6, n), np.nan)
        with np.errstate(all="ignore"):
            x, zeta, dx, dz = self.field.place(np.asarray(states, float), near)
        self.kernel["search_all"](x, zeta, dx, dz, f.D1, f.M1, f.drag, *self.tables, *self.work, good, out)
        return Found(good, *out)

    def decide(self, rows, states, reach, fired, number, found):
        """The test for those of rows that no test has fired for, balls of radius reach (n,) about states (n, 3): see `kernel.decide`."""
        f = self.field.form
        self.kernel["decide"](rows, states, reach, fired, number, found, self.order, self.frame, f.D1, f.M1, f.drag, *self.tables, *self.work)


class MovingCertifier:
    """`certificate.Certifier` in a field about the moving centre: its tables, and the kernel's search."""

    def __init__(self, field, orders: tuple[int, int], table: dict | None = None):
        plain, self.field, self.orders = Certifier(field, orders, eliminated() if table is None else corrected), field, orders
        self.kernel = functions(moving_kernel) if table is None else table
        pairs = lambda sums: np.array([sums.a, sums.b]).astype(np.int64)
        e, b, r, k = plain.e, plain.b, plain.r, plain.k
        values = (part for v in (plain.energy_added, plain.amplitude_added) for part in (v.table, np.array([v.j, v.k])))
        reach = 1 + max(int(np.abs(s.a).max(initial=0) + np.abs(s.b).max(initial=0)) for s in (e, b, r, k)) + 4
        drive = np.array([(a, b, c) for (_, _, a, b), c in field.G0.items()], float).reshape(-1, 3).T
        degrees = 1 + max(int(v.j.max(initial=0)) for v in (plain.energy_added, plain.amplitude_added))
        self.serves = reach < moving_kernel.MIDDLE and all(part.size for part in (e.table, b.table, r.table, k.table))
        self.plain = plain
        self.numbers = (field.D1, field.M1, field.a2, field.a3, field.c, reach, np.ascontiguousarray(drive))
        self.tables = (*values, pairs(e), e.table, plain.energy_majorant.table, pairs(b), b.table, plain.amplitude_majorant.table,
                       pairs(r), r.table, pairs(k), k.table)
        self.work = np.zeros((4, 2 * moving_kernel.MIDDLE + 1)), np.zeros(degrees, complex), np.zeros(6)
        self.frame = np.array([field.s, *field.wheel, *field.torque, *field.roots, field.n2, field.n3, BLUR], float)

    def __call__(self, states, near=0.0) -> Found:
        """See `certificate.Certifier`."""
        if not self.serves:
            return self.plain(states, near)
        n = len(states)
        good, out = np.zeros(n, bool), np.full((6, n), np.nan)
        x, zeta, dx, dz = self.field.place(np.asarray(states, float), near)
        self.kernel["search_all"](x, zeta, dx, dz, *self.numbers, *self.tables, *self.work, good, out)
        return Found(good, *out)

    def decide(self, rows, states, reach, fired, number, found):
        """As of `FixedCertifier`."""
        if self.serves:
            self.kernel["decide"](rows, states, reach, fired, number, found, self.field.basis, self.frame, *self.numbers, *self.tables, *self.work)
            return
        rows = rows[fired[rows] < 0]
        got = self.plain(states[rows], reach[rows])
        fired[rows[got.good]] = number
        found[:, rows[got.good]] = np.array([got.A, got.z, got.eta, got.z_up, got.eta_up, got.k])[:, got.good]
