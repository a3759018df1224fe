"""Many revolutions at once: powers of a map that is near the identity, by collocation in the number of revolutions.

A motion that goes round much faster than it drifts returns to a plane across it near to where it left: x(n + 1) = x(n) + d(x(n)), d small. As
long as no resonance is felt (what it would make falls faster than any power of d) x(n) lies on a smooth curve, and so does d along it. On a window
of N revolutions d is taken to be the polynomial in n/N through its values at the `NODES` + 1 Chebyshev points, and x(n) its sum, which the
formula of Euler and Maclaurin gives exactly for polynomials:

    x(n) = x(0) + sum_(i<n) d(i) = x(0) + int_0^n d - [d]/2 + [d']/12 - [d''']/720 + ...   ([f] = f(n) - f(0)),

so that x at the nodes is a matrix times d at the nodes. The two are solved for each other by turns, which contracts like the drift over the window
over the number of the turn. The time is summed with the place. What the polynomial leaves out of d is held below the rounding of one
revolution's steps: by its last coefficients, and by d itself at a place between two nodes.
"""
from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from math import factorial

import numpy as np

from .returns import Returns

NODES, TURNS = 16, 16
BERNOULLI = {2: 1 / 6, 4: -1 / 30, 6: 1 / 42, 8: -1 / 30}
BETWEEN = 0.37  # of the window: the place between nodes that is looked at
UNIT = 2.0**-52


@dataclass(frozen=True)
class Window:
    """states (m, 3), times (m,) passed, periods (m,) of the last return; good (m,); turns (m,) that it took."""

    states: np.ndarray
    times: np.ndarray
    periods: np.ndarray
    good: np.ndarray
    turns: np.ndarray


@lru_cache(maxsize=1)
def matrices():
    """(sums, powers, coefficients, between): x(n) - x(0) = sum_k N^powers[k] sums[k] @ d at the nodes; coefficients @ d those of Chebyshev's
    polynomials; between @ values at the nodes the value at BETWEEN."""
    from numpy.polynomial import chebyshev
    places = -np.cos(np.pi * np.arange(NODES + 1) / NODES)
    values, coefficients = chebyshev.chebvander(places, NODES), np.linalg.inv(chebyshev.chebvander(places, NODES))
    integral, slope = np.zeros((NODES + 2, NODES + 1)), np.zeros((NODES + 1, NODES + 1))
    for k, one in enumerate(np.eye(NODES + 1)):
        up, down = chebyshev.chebint(one, lbnd=-1) / 2, chebyshev.chebder(one) * 2
        integral[:up.size, k], slope[:down.size, k] = up, down
    sums = [chebyshev.chebvander(places, NODES + 1) @ integral @ coefficients, -0.5 * _from_start(np.eye(NODES + 1))]
    sums += [b / factorial(k) * _from_start(values @ np.linalg.matrix_power(slope, k - 1) @ coefficients) for k, b in BERNOULLI.items()]
    return np.array(sums), np.array([1, 0, *(1 - k for k in BERNOULLI)]), coefficients, chebyshev.chebvander(2 * BETWEEN - 1, NODES) @ coefficients


def _from_start(matrix):
    return matrix - matrix[0]


def window(returns: Returns, states, counts, periods, steps) -> Window:
    """The motions from states (m, 3) after so many revolutions: counts (m,), whole numbers from 16 on. periods (m,): of the first of them; steps
    (m,): how many a revolution takes. Each row is computed as if alone."""
    sums, powers, _, _ = matrices()
    m = len(states)
    normals, size = returns.normals(states), np.sqrt((states**2).sum(axis=1))
    matrix = (counts[:, None, None, None] ** powers[:, None, None].astype(float) * sums).sum(axis=1)
    x = np.zeros((m, NODES + 1, 4))
    x[:, :, :3] = states[:, None]
    d, guesses = np.zeros_like(x), np.repeat(periods[:, None], NODES + 1, axis=1)
    good, turns, open_ = np.zeros(m, bool), np.zeros(m, int), np.arange(m)
    before = np.full(m, np.inf)
    for turn in range(1, TURNS + 1):
        nodes = slice(turn > 1, None)  # the first node stays where it is
        if turn == 2:  # the faster, the sooner round: good enough to find the return by
            guesses *= size[:, None] / np.sqrt((x[:, :, :3]**2).sum(axis=2))
        d[open_, nodes], guesses[open_, nodes], fine = _drift(returns, x[open_, nodes, :3], normals[open_], guesses[open_, nodes])
        after = x[open_, :1] + matrix[open_] @ d[open_]
        after[:, 1:, :3] = _projected(returns, after[:, 1:, :3], normals[open_])
        change = np.abs(after - x[open_])[:, :, :3].max(axis=(1, 2)) / size[open_]
        x[open_], turns[open_] = after, turn
        settled = fine & (change <= UNIT * (8 + counts[open_]))
        good[open_[settled]] = True
        left = np.log(change / (UNIT * counts[open_])) / np.log(before[open_] / change)  # turns to come, at the pace of the last
        going = fine & ~settled & ((turn < 3) | (change < 0.5 * before[open_]) & (turn + left < TURNS))
        before[open_] = change
        open_ = open_[going]
        if not open_.size:
            break
    good &= _smooth(returns, x, d, normals, guesses, size * UNIT * steps, good)
    return Window(x[:, -1, :3], x[:, -1, 3], guesses[:, -1], good, turns)


def _drift(returns, x, normals, guesses):
    """(d (m, nodes, 4), times of return, rows where all is well)."""
    m, nodes = guesses.shape
    flat = x.reshape(-1, 3)
    back, times, fine = returns(flat, np.repeat(normals, nodes, axis=0), guesses.ravel())
    return np.concatenate([back - flat, times[:, None]], axis=1).reshape(m, nodes, 4), times.reshape(m, nodes), fine.reshape(m, nodes).all(axis=1)


def _projected(returns, x, normals):
    return returns.on_section(x.reshape(-1, 3), np.repeat(normals, x.shape[1], axis=0)).reshape(x.shape)


def _smooth(returns, x, d, normals, guesses, allowed, good):
    """Whether the polynomial follows the drift to within `allowed` (m,)."""
    _, _, coefficients, between = matrices()
    rows = np.flatnonzero(good)
    out = np.zeros(len(good), bool)
    if rows.size:
        tail = np.abs(coefficients[-3:] @ d[rows])[:, :, :3].max(axis=(1, 2))
        place, expected = _projected(returns, (between @ x[rows])[:, :, :3], normals[rows]), between @ d[rows]
        seen, _, fine = _drift(returns, place, normals[rows], guesses[rows, NODES // 2:NODES // 2 + 1])
        missed = np.abs(seen - expected)[:, 0, :3].max(axis=1)
        out[rows] = fine & (tail <= allowed[rows]) & (missed <= allowed[rows])
    return out
