"""The reduced motion of many bodies, or of many boxes of bodies, at once: height of the potential over the energy ahead.

Circles only (elliptic reduction). In the canonical variables of `reduction`, at the angle y ahead in the torque's direction,

    excess(y) = V(theta_0 + y) - E = -mu y - dX (G (X + dX/2) + c) + d dZ - W^2/2,

with dX, dZ what X, Z change by. A motion is bounded iff excess > 0 somewhere ahead, and surely spins up where excess < 0 all
over one turn ahead, as the next turn is lower by 2 pi mu. Formulas serve floats, arrays and `Affine` numbers.
"""
from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from ...numbers.affine import Affine, lifted, root, squared
from ...numbers.vectors import Number
from ...orbit.reduction import Reduction, reduction_about
from ...physics.quadratic import QuadraticForm

TURN = 2 * np.pi
GRID = 96  # angles a turn on which the highest place ahead is looked for: the potential has two maxima a turn at most
POLISH = 7  # Newton steps from there


class Orbit(NamedTuple):
    """X, Z, W at time 0 and the potential's coefficients, as in `reduction`."""

    x: Number
    z: Number
    w: Number
    G: Number
    c: Number
    d: Number
    mu: Number

    def turned(self, sense: int) -> Orbit:
        """Seen so that the torque of this sign points ahead (the reflection of theta)."""
        return self if sense > 0 else self._replace(x=-self.x, w=-self.w, c=-self.c, mu=-self.mu)

    def middle(self) -> Orbit:
        """The middle of every number, (n, 1)."""
        return Orbit(*(np.reshape(lifted(v).c, (-1, 1)) for v in self))


def reduction_over(form: QuadraticForm, axis: int) -> Reduction | None:
    """The reduction about an axis, in numbers of any kind (`reduction_about`); None where the scene has none."""
    return reduction_about(form, axis)


def orbit_of(r: Reduction, state: Sequence[Number], signs: Any) -> Orbit:
    """The orbit of a state (three numbers) of a reduction whose p, q have these signs all over the box."""
    sp, sq = signs
    ap, aq = sp * r.p, sq * r.q
    rp, rq = root(ap), root(aq)
    (sj, sk), (across_j, across_k) = r.centre, r.across
    # torque m: the three other terms of `Reduction.torque` cancel for a body and for the scaled system
    return Orbit(x=(state[r.j] + sj) / rp, z=(state[r.k] + sk) / (sp * rq), w=rp * rq * (state[r.axis] + r.s),
                 G=sp * r.kappa * ap * aq, c=sp * across_j * aq * rp, d=across_k * ap * rq,
                 mu=rp * rq * r.m)


def _sin_cos(y: Number) -> tuple[Number, Number]:
    return y.sin_cos() if isinstance(y, Affine) else (np.sin(y), np.cos(y))


def excess(o: Orbit, y: Number) -> Number:
    """Height of the potential at the angle y ahead over the energy."""
    s, _ = _sin_cos(y)
    half, _ = _sin_cos(y * 0.5)
    b = -2 * squared(half)
    dx, dz = o.z * s + o.x * b, o.z * b - o.x * s
    return o.d * dz - o.mu * y - dx * (o.G * (o.x + dx * 0.5) + o.c) - squared(o.w) * 0.5


def force(o: Orbit, y: Number) -> Number:
    """The force ahead at the angle y: minus the slope of the excess."""
    x, z = _place(o, y)
    return o.mu + o.G * (x * z) + o.c * z + o.d * x


def stiffness(o: Orbit, y: Number) -> Number:
    """The slope of the force: positive at the top of a barrier."""
    x, z = _place(o, y)
    return o.G * ((z - x) * (z + x)) - o.c * x + o.d * z


def _place(o: Orbit, y: Number) -> tuple[Number, Number]:
    s, c = _sin_cos(y)
    return o.x * c + o.z * s, o.z * c - o.x * s


def highest_ahead(o: Orbit) -> tuple[np.ndarray, np.ndarray]:
    """(angle, excess) of the highest place within one turn ahead, (n,) each, for an orbit of floats (n, 1)."""
    grid = np.arange(1, GRID + 1) * (TURN / GRID)
    heights = excess(o, grid[None])
    best = heights.argmax(1)[:, None]
    y, top = grid[best], np.take_along_axis(heights, best, 1)
    with np.errstate(all="ignore"):
        for _ in range(POLISH):
            step = -force(o, y) / stiffness(o, y)
            moved = np.clip(y + np.clip(step, -0.1, 0.1), TURN * 1e-12, TURN)
            higher = excess(o, moved)
            better = higher > top
            y, top = np.where(better, moved, y), np.where(better, higher, top)
    return y[:, 0], top[:, 0]
