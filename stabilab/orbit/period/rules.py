"""The integral of dphi/sqrt(2 H) over half a libration, for many rows at once, each row as fine as it needs.

The trapezoidal rule in mirrored pairs of nodes serves nearly all rows: it converges geometrically. Where H is small beside its other values, next to a barrier
at an end or inside, the integrand has a peak; the double-exponential rule takes these rows, cut where H is least.
"""
from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from ...numbers.constants import TURN
from ..fine.rows_kernel import NARROW, converged
from .modes import Modes

PAIR_CHUNK = 2048  # a dozen arrays of so many doubles stay in the processor's second cache
BLOCK = 1 << 14  # elements of a block of nodes and rows, for the same reason
REACH = 3.45  # of t: beyond, the weights are 1e-20
FIRST_LEVEL, LAST_LEVEL = 0, 8  # steps of 2^-level
LOOKS = 64  # places among which the least H is sought
CLOSER = 4  # steps towards it, each to the bottom of a parabola through three places


def _rules(*halved):
    """sin(phi/2)^2 <= 1/2 at the trapezoidal nodes of 8 intervals, then at the midpoints of so many, each twice as many as before."""
    phi = [np.arange(5) * (np.pi / 8)] + [(np.arange(n // 2) + 0.5) * (np.pi / n) for n in halved]
    return np.sin(0.5 * np.concatenate(phi)) ** 2


NODES = _rules(8, 16, 32, 64)


def librations(modes: Modes, half):
    """(periods (n,), H (3, n) at the left end, in the middle and at the right end, `Peaks` of the rows where H is small beside that); NaN where no rule
    settles."""
    values, shape = trapezoidal(modes, half)
    rest = np.nonzero(np.isnan(values))[0]
    peaks = Peaks(rest, np.empty(0), np.empty(0))
    if rest.size:
        values[rest], cut, weight = double_exponential(modes.take(rest), half[rest])
        peaks = Peaks(rest, np.sin(0.5 * cut) ** 2, weight)
    return values, shape, peaks


class Peaks(NamedTuple):
    """Rows whose integrand has a peak; the share of the interval to the left of it; how much of the period, as a share, one unit of H takes away there
    and everywhere else: the mean of 1/(2 H) over the motion's time."""

    rows: np.ndarray
    share: np.ndarray
    weight: np.ndarray


def trapezoidal(modes: Modes, half):
    """As `librations`: sums over mirrored pairs of nodes, which nest, doubled until the change says that the next change would be rounding."""
    values, shape = np.empty(len(half)), np.empty((3, len(half)))
    for start in range(0, len(half), PAIR_CHUNK):
        part = np.arange(start, min(start + PAIR_CHUNK, len(half)))
        for narrow in (False, True):
            rows = part[(half[part] < NARROW) == narrow]
            if len(rows):
                values[rows], shape[:, rows] = _pair_sums(modes.take(rows), half[rows], narrow)
    return values, shape


def _pair_sums(modes, rho, narrow):
    values, live, shape = np.full(len(rho), np.nan), np.arange(len(rho)), np.empty((3, len(rho)))
    whole, total, sums = modes.whole(rho), np.zeros(len(rho)), []
    first, size = 0, 8
    while first < len(NODES):
        last = first + size // 2 if first else 5
        for node in range(first, last):
            even, odd = modes.pair(rho, whole, NODES[node], narrow)
            weight = 0.5 if node in (0, 4) else 1.0  # the ends of [0, pi], and its middle, which is its own mirror image
            with np.errstate(all="ignore"):
                term = weight * (1 / np.sqrt(2 * (even + odd)) + 1 / np.sqrt(2 * (even - odd)))
            total += term
            if not first:
                sums.append(term)
            if node == 0:
                shape[0], shape[2] = even + odd, even - odd
            elif node == 4:
                shape[1] = even
        size, first = size * 2 if first else size, last
        now = total * (TURN / size)
        if last == 5:  # of these nodes there are also the sums over two and four intervals
            sums = [(sums[0] + sums[4]) * (TURN / 2), (sums[0] + sums[2] + sums[4]) * (TURN / 4), now]
            continue
        with np.errstate(invalid="ignore"):  # infinite where rounding leaves no depth to the well: not settled here
            done = converged(now, *(np.abs(late - early) for late, early in zip((now, *sums[:0:-1]), sums[::-1])))
        values[live[done]] = now[done]
        if done.all():
            break
        rest = ~done
        live, rho, total, modes, whole = live[rest], rho[rest], total[rest], modes.take(rest), whole[:, rest]
        sums = [before[rest] for before in (*sums[1:], now)]
    return values, shape


def double_exponential(modes: Modes, rho):
    """By the tanh-sinh rule on both sides of the place where H is least: periods (n,), the step halved until a row's sums agree, NaN where they never do;
    the angles phi of that place; the means of 1/(2 H) over the motion's time."""
    cut, n = _least(modes, rho), len(rho)
    side = np.repeat([False, True], n)  # whether a piece begins at the right end
    length, both = np.concatenate([cut, np.pi - cut]), np.concatenate([np.arange(n)] * 2)
    total, values, (before, change, earlier) = np.zeros((2, 2 * n)), np.full(2 * n, np.nan), np.full((3, 2 * n), np.nan)
    live = np.arange(2 * n)
    for level in range(FIRST_LEVEL, LAST_LEVEL + 1):
        total[:, live] += _level_sums(modes, rho, both[live], length[live], side[live], level)
        now = length[live] * total[0, live] * 2.0**-level
        with np.errstate(invalid="ignore"):  # a sum that is no number never settles
            new = np.abs(now - before[live])
            done = converged(now, new, change[live], earlier[live])
        values[live[done]] = now[done]
        before[live], change[live], earlier[live] = now, new, change[live]
        live = live[~done]
        if not live.size:
            break
    with np.errstate(all="ignore"):
        weight = total[1] / total[0]  # a piece's; the sums of both come from as many nodes
        share = values[:n] / (values[:n] + values[n:])
        return 2 * (values[:n] + values[n:]), cut, weight[:n] * share + weight[n:] * (1 - share)


def _level_sums(modes, rho, rows, length, side, level):
    """(2, m) sums of 1/sqrt(2 H) and of its cube over the nodes that a level adds, of pieces of rows that begin at an end."""
    near, weight, inner = nodes_of(level)
    out = np.empty((2, len(rows)))
    wide = max(1, BLOCK // len(near))
    for start in range(0, len(rows), wide):
        part = slice(start, start + wide)
        some = modes.take(rows[part])
        way = length[part] * near[:, None]  # from the end where the piece begins, or on the inner side from the cut
        angle = np.where(inner[:, None], length[part] - way, way)
        small, large = np.sin(0.5 * angle) ** 2, np.cos(0.5 * angle) ** 2
        left, right = np.where(side[part], large, small), np.where(side[part], small, large)
        inverse = inverse_speed(some, rho[rows[part]], left, right)
        out[0, part] = weight @ inverse
        with np.errstate(all="ignore"):
            out[1, part] = weight @ (inverse * inverse * inverse)
    return out


@lru_cache(maxsize=16)
def nodes_of(level):
    """(distance from the nearer end over the length, weight, whether that end is the inner one) of the nodes that a level adds."""
    k = np.arange(-int(REACH * 2**level), int(REACH * 2**level) + 1)
    if level > FIRST_LEVEL:
        k = k[k % 2 != 0]
    t = k * 2.0**-level
    u = 0.5 * np.pi * np.sinh(t)
    # x = 1/(1 + exp(-2 u)), dx = pi/2 cosh t / (2 cosh(u)^2) dt
    return 1 / (1 + np.exp(2 * np.abs(u))), 0.25 * np.pi * np.cosh(t) / np.cosh(u) ** 2, t > 0


def _least(modes, rho):
    """(n,) angles phi where H is least inside (0, pi); pi/2 where it is least at an end."""
    phi, n = np.linspace(0, np.pi, LOOKS + 1)[:, None], len(rho)
    rows, wide = np.arange(n), max(1, BLOCK // (LOOKS + 1))
    seen = np.concatenate([_curvature(modes.take(rows[a:a + wide]), rho[a:a + wide], phi) for a in range(0, n, wide)], axis=1)
    at = np.argmin(np.where(np.isnan(seen), np.inf, seen), axis=0)
    inside = (at > 0) & (at < LOOKS)
    inner = np.clip(at, 1, LOOKS - 1)
    middle = phi[inner, 0]
    step = np.full(n, np.pi / LOOKS)
    one, two, three = (seen[inner + shift, rows] for shift in (-1, 0, 1))
    beside = np.array([-1.0, 0.0, 1.0])[:, None]
    for _ in range(CLOSER):
        with np.errstate(all="ignore"):
            move = 0.5 * step * (one - three) / (one - 2 * two + three)
        middle = middle + np.where(np.abs(move) <= step, move, 0.0)
        step = 0.1 * step
        one, two, three = _curvature(modes, rho, middle + beside * step)
    return np.where(inside & (middle > 0) & (middle < np.pi), middle, 0.5 * np.pi)


def _curvature(modes, rho, phi):
    """H (k, n) at angles (k, n), or (k, 1) for all rows."""
    left, right = (np.broadcast_to(share, np.broadcast_shapes(phi.shape, rho.shape)) for share in (np.sin(0.5 * phi) ** 2, np.cos(0.5 * phi) ** 2))
    with np.errstate(all="ignore"):
        return modes.second_difference(rho, left, right)


def inverse_speed(modes, rho, left, right):
    """1/sqrt(2 H) at theta = l + 2 rho left = r - 2 rho right (left + right = 1, each accurate near its end)."""
    with np.errstate(all="ignore"):
        return 1 / np.sqrt(2 * modes.second_difference(rho, left, right))
