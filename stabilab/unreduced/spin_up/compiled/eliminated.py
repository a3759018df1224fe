"""`elimination.corrected` by compiled loops: the tables of the moving centre cost a scene of a batch as much as thousands of steps."""
from __future__ import annotations

import numpy as np

from ..elimination import Algebra, Corrected, corrected
from ..terms import Terms, packed
from . import elimination_kernel as kernel

SPARE = 5  # degrees of zeta that occur beside those that the order counts: four, and degree 0; where q is constant, half as many again as the order


class Eliminated:
    """Stands for `corrected`, with the same arguments, about a moving centre; where its tables have no room, `corrected` itself answers. table: the
    kernel's functions by name."""

    def __init__(self, table: dict):
        self.table = table

    def __call__(self, algebra: Algebra, rate: Terms, order: int, added: Terms | None = None) -> Corrected:
        if len(algebra.rest.keys):
            return corrected(algebra, rate, order, added)
        sums = [] if added is None else [added]
        degrees = SPARE + order + (0 if algebra.weights[1] else (order + 1) // 2)
        cells = kernel.cell(degrees, 0)
        made = [np.zeros((kernel.ROWS, cells), kind) for _ in range(2) for kind in (complex, float)]
        place = np.full((kernel.SPAN, kernel.SPAN), -1, np.int16), np.zeros((3, kernel.ROWS), np.int64), np.zeros(1, np.int64)
        good = all(self.table["fill"](*to, *_columns(part.half()), *place) for part, to in [(s, made[2:]) for s in sums] + [(rate, made[:2])])
        numbers = complex(algebra.lift), *(np.array(v) for v in (algebra.turn, algebra.fall, algebra.weights)), degrees
        good = good and self.table["eliminate"](4 * order, *numbers, *_columns(algebra.x_rate), *_columns(algebra.carried), *made, *place,
                                                *_list(cells), *_list(cells))
        if not good:
            return corrected(algebra, rate, order, added)
        return Corrected(*(self._terms(*of, degrees, *place[1:]) for of in (made[2:], made[:2])))

    def _terms(self, c, m, degrees, pairs, count):
        n = 2 * np.count_nonzero(m[:count[0]])
        powers, values, sizes = np.zeros((4, n), np.int64), np.zeros(n, complex), np.zeros(n)
        n = self.table["whole"](c, m, degrees, pairs, int(count[0]), powers, values, sizes)
        return Terms(packed(*powers[:, :n]), values[:n], sizes[:n])


def _list(n):
    """Room for n terms: their j and k, coefficients, majorants."""
    return np.zeros((2, n), np.int64), np.zeros(n, complex), np.zeros(n)


def _columns(terms):
    return np.array(terms.powers, np.int64).reshape(4, -1), np.asarray(terms.c, complex), np.asarray(terms.m, float)
