"""Extremes and periods of librations, one row at a time: the door of numba. What the kernels leave open is
left to balls."""
from __future__ import annotations

from fractions import Fraction
from functools import lru_cache, partial

import numpy as np

from ...numbers.numba_door import compiled, installed, twins
from ..extremes import parabola_kernel
from ..landscape import CENTRE, Landscape
from . import rows_kernel
from .places import twofold_constant

# Functions without which loops call instead of adding
INLINED = {"swing", "kinetic", "converged", "rounding_of"}
INLINED_ON_PARABOLAS = {"quartic", "cubic", "bend", "terms_of", "blur_of_force", "place_at"}
# Loading the code from disk costs some 0.3 s of a processor, compiling it once per machine some ten for each
# geometry;
# a row of plain Python costs two milliseconds.
COLD, WARM = 1000, 20
STRAIGHT = 1e-6  # of the slopes, as in `conic`: a circle so small hardly sees the bend of its equilibria
PARABOLA = "p", "p0", "q", "q0", "kappa", "rho", "sigma", "m", "s"
REACH = 3.45  # of t: beyond, the weights of double-exponential nodes are 1e-20
LAST_LEVEL = 8  # of these nodes, whose steps are 2^-level
HALVED = 8, 16, 32, 64  # intervals whose midpoints are added to the trapezoidal nodes of eight


def settle_rows(land: Landscape, states, boxes, periods, left_open, by_numba: bool | None = None):
    """Fill boxes (n, 3, 2) and periods (n,), each unless it is empty, of the librations of states (n, 3) that
    are open.

    left_open: (n,) bits, `BOX` and `PERIOD`, of which those that are settled are cleared. by_numba: whether
    compiled code serves, where numba is installed; None: where so many rows repay loading it.
    """
    rows = np.nonzero(left_open)[0]
    if not rows.size:
        return
    if by_numba is None:
        by_numba = rows.size >= (WARM if COMPILED[land.base].cache_info().currsize else COLD)
    kernel = COMPILED[land.base]() if by_numba and installed() else plain(land.base)
    with np.errstate(all="ignore"):
        kernel(states, rows, *kernel_input(land), boxes, periods, left_open)


@lru_cache(maxsize=3)
def plain(base: str):
    """`rows` on a geometry, named as landscapes name it, in plain Python."""
    module, _, names = _module(base)
    return twins(module, lambda name, twin: twin, **names)["rows"]


def _module(base: str):
    """(module with the kernel of a geometry, its functions to inline, the names that are the geometry's own).
    """
    if base == "parabola":
        return parabola_kernel, INLINED_ON_PARABOLAS, {}
    return rows_kernel, INLINED, rows_kernel.functions_of(rows_kernel.GEOMETRIES[base])


def _compiled(base: str):
    module, inlined, names = _module(base)
    return compiled(module, inlined, base, **names)["rows"]


COMPILED = {base: lru_cache(maxsize=1)(partial(_compiled, base))
            for base in ("circle", "hyperbola", "parabola")}


@lru_cache(maxsize=64)
def kernel_input(land: Landscape):
    """The numbers of a landscape as its kernel takes them, between the rows and what these fill."""
    r = land.reduction
    shift = float(r.s)
    rest = float(r.s - Fraction(shift))
    axes = r.j, r.k, r.axis
    if land.conic is None:
        return axes, _parts([twofold_constant(getattr(r, name)) for name in PARABOLA]), *np.empty((3, 3))
    conic, g = land.conic, r.constants
    # of conics
    fine = *land.twofold, twofold_constant(r.exact_constants["n"] ** 2 / 2)  # type: ignore[attr-defined]
    lines, straight, beside = conic.lines, np.inf, 0.0
    if conic.pieces:
        centre = CENTRE * (abs(conic.c) + abs(conic.d)) / abs(conic.G)
        beside = centre if conic.mu <= (abs(conic.c) + abs(conic.d)) * centre else 0.0
        lines, straight = (), -np.inf
        if land.e < 0 and conic.limit is not None:
            lines, straight = (conic.limit,), float(STRAIGHT * np.hypot(conic.c, conic.d) / conic.G) ** 2
    form = g["flip"] * g["rx"], g["rz"], g["flip"] / g["n"], shift, rest, straight
    numbers = tuple(map(float, (conic.c, conic.d, conic.G, conic.mu, conic.K, conic.shift, beside)))
    pieces = np.array([(p.sign, p.inner, p.outer, p.rising, p.barrier, *conic.reach(p))
                       for p in conic.pieces], float)
    points = np.array([(*line, side) for line in lines for side in (-1, 1)], float)
    folds = np.array(conic.fold_invariants + conic.tangents, float)
    return (_parts(fine).ravel(), form, axes, numbers, pieces.reshape(-1, 7), points.reshape(-1, 5), folds,
            rules())


def _parts(numbers):
    """(n, 2) high and low parts of twofold numbers."""
    return np.array([(float(number.high), float(number.low)) for number in numbers])


@lru_cache(maxsize=1)
def rules():
    """(shares sin(phi/2)^2 <= 1/2 of the trapezoidal nodes of eight intervals, then of the midpoints of these
    and of twice as many; distances of the double-exponential nodes from the nearer end, negative where that
    is the inner one, their weights, and where levels begin)."""
    phi = np.concatenate([np.arange(5) * (np.pi / 8)]
                         + [(np.arange(n // 2) + 0.5) * (np.pi / n) for n in HALVED])
    levels = [double_exponential_nodes(level) for level in range(LAST_LEVEL + 1)]
    near, weights = (np.concatenate(parts) for parts in zip(*levels))
    return np.sin(0.5 * phi) ** 2, near, weights, np.cumsum([0] + [len(way) for way, _ in levels])


def double_exponential_nodes(level):
    """(signed distances over the length, weights) of the nodes that a level adds."""
    k = np.arange(-int(REACH * 2**level), int(REACH * 2**level) + 1)
    if level:
        k = k[k % 2 != 0]
    t = k * 2.0**-level
    u = 0.5 * np.pi * np.sinh(t)
    # x = 1/(1 + exp(-2 u)), dx = pi/2 cosh t / (2 cosh(u)^2) dt
    near = 1 / (1 + np.exp(2 * np.abs(u)))
    return np.where(t > 0, -near, near), 0.25 * np.pi * np.cosh(t) / np.cosh(u) ** 2
