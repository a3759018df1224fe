"""Bodies with equal moments: what is exact, and the second fate, spin-up in the equatorial plane.

Axis 1 the axis of symmetry, D2 = D3 = D, d = D1 - D, no transverse wheel (l2 = l3 = 0): D1 omega1' = M1
exactly, and with X = omega1 + l1/d, xi = omega2 + i omega3, mu = (M2 + i M3)/D the other two are xi' = i
(d/D) X xi + mu.

* M1 != 0: every state spins up about the axis, in the sense of M1, with |xi(t)| <= |xi(0)| + 8 |mu|/sqrt(|d|
|M1|/(D D1)); nothing is integrated.
* M1 = 0: X is constant. X != 0: xi goes round a circle about i mu D/(d X): bounded. X = 0: xi = xi(0) + mu t,
it grows along the transverse
  torque (or stands still without one).

Sphere, D omega' = M - omega x l: without a wheel omega grows along M; with one spin-up along sgn(M.l) l,
bounded where M.l = 0.

A transverse wheel l_perp (and D2 = D3): besides axis 1 the motion may spin up in the equator, along e =
-sgn(D1 - D2) l_perp/|l_perp|, where (M_perp.l_perp)(D1 - D2) < 0. In the frame (e, a1 x e, a1) the form about
the moving centre has d2 = 0, q = |l_perp|, p = a3 x + |l_perp|, both positive for great x = omega.e exactly
with that sign of e, and M.e > 0. Its certificate is the theorem of `certificate`. Proofs:
docs/mathematics/spin-up.md.
"""
from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

from ...numbers.exact import sqrt_fraction
from ...numbers.vectors import dot
from ...orbit.result import Fate
from .centres import MovingCentre
from .result import WIDER, SpinUp, SteadyTrap


def axis_of_symmetry(D) -> int | None:
    """The index of the axis whose two others have equal moments; None for three different moments and for a
    sphere."""
    found = [i for i in range(3) if D[(i + 1) % 3] == D[(i + 2) % 3]]
    return found[0] if len(found) == 1 else None


@dataclass(frozen=True)
class Closed:
    """A closed solution, in exact numbers (roots to 240 bits). law: its name; direction: of the growth, any
    length, None where the motion is bounded; gain: the rate grows at least so fast along it; most: what is
    across it, or the whole rate of a bounded motion, is never larger; cause: words."""

    law: str
    direction: Sequence[Fraction] | None
    gain: Fraction | None
    most: Fraction
    cause: str

    @property
    def about(self) -> tuple[int, int]:
        """(axis 1, 2, 3, sense) of the growth; (0, 1) where it is along none, (0, 0) where bounded."""
        along = [n for n, v in enumerate(self.direction or ()) if v]
        if len(along) != 1:
            return 0, int(bool(along))
        return along[0] + 1, 1 if self.direction[along[0]] > 0 else -1


def closed(scene, state) -> Closed | None:
    """The closed solution from a state, three exact numbers; None where the scene has none."""
    if scene.variables == "scaled":
        return None
    D, l, M = scene.body.exact, scene.vector("gyrostat"), scene.vector("constant_torque")
    x = [Fraction(v) for v in state]
    if not any(M):
        return Closed("free", None, None, sqrt_fraction(dot(D, [v * v for v in x]) / min(D)),
                      "without a torque the energy is constant and the motion bounded")
    if D[0] == D[1] == D[2]:
        return _sphere(D[0], l, M, x)
    i = axis_of_symmetry(D)
    return None if i is None or l[(i + 1) % 3] or l[(i + 2) % 3] else _symmetric(i, D, l, M, x)


def _sphere(D, l, M, x):
    if not any(l):
        return Closed("sphere", M, _size(M) / D, _across(x, M),
                      "a sphere without a wheel: the rate grows along the torque")
    along, across = dot(l, M), _across(x, l) + 2 * _across(M, l) / _size(l)
    if not along:
        return Closed("sphere", None, None, across + abs(dot(x, l)) / _size(l),
                      "a sphere with a wheel across the torque: the rate goes round the wheel's momentum")
    return Closed("sphere", [v if along > 0 else -v for v in l], abs(along) / _size(l) / D, across,
                  "a sphere with a wheel: the rate grows along the wheel's momentum, by the torque's "
                  "component there")


def _symmetric(i, D, l, M, x):
    j, law, flat = (i + 1) % 3, "axis of symmetry", [v * (n != i) for n, v in enumerate(M)]
    push, cone = _size(flat) / D[j], _size([v * (n != i) for n, v in enumerate(x)])
    if M[i]:
        turning = abs(D[i] - D[j]) * abs(M[i]) / (D[i] * D[j])  # of the turn's own rate
        return Closed(law, [Fraction((n == i) * (1 if M[i] > 0 else -1)) for n in range(3)],
                      abs(M[i]) / D[i], cone + 8 * push / sqrt_fraction(turning),
                      "the axis of symmetry bears a torque and there is no transverse wheel: the spin about "
                      "it is linear in time")
    turn = ((D[i] - D[j]) * x[i] + l[i]) / D[j]
    if turn:
        return Closed(law, None, None, cone + 2 * push / abs(turn) + abs(x[i]),
                      "the spin about the axis of symmetry is constant and turns the transverse torque round")
    return Closed(law, flat, push, _across(x, flat),
                  "the spin about the axis of symmetry stays where the transverse rate stands still: it "
                  "grows along the transverse torque")


def _size(vector):
    return sqrt_fraction(Fraction(dot(vector, vector)))


def _across(vector, along):
    """The size of the part of a vector across another."""
    return sqrt_fraction(Fraction(dot(vector, vector))
                         - Fraction(dot(vector, along)) ** 2 / dot(along, along))


def exactly(scene, state) -> SpinUp | None:
    """The fate of a state where a closed solution tells it; None elsewhere. state: three floats, at their
    word."""
    found = closed(scene, state)
    if found is None:
        return None
    (axis, sense), direction, trap = found.about, None, None
    if found.direction:
        size = _size(found.direction)
        direction = tuple(float(v / size) for v in found.direction)
    if found.law == "axis of symmetry" and axis - 1 == axis_of_symmetry(scene.body.exact):
        most, start = float(found.most) * (1 + WIDER), float(sense * state[axis - 1])
        bounded = [(-most, most)] * 3
        bounded[axis - 1] = (start, math.inf) if sense > 0 else (-math.inf, -start)
        trap = SteadyTrap(axis, sense, start, float(found.gain), tuple(bounded))
    return SpinUp(Fate.SPIN_UP if direction else Fate.BOUNDED, axis, sense, direction, "exact", trap, 0.0,
                  tuple(map(float, state)), 0, found.cause, 1.0)


def equatorial(scene) -> MovingCentre | None:
    """The form for spin-up in the equator of a symmetric body; None where the scene has none."""
    if scene.variables == "scaled":
        return None
    D, l, M = scene.body.exact, scene.vector("gyrostat"), scene.vector("constant_torque")
    i = axis_of_symmetry(D)
    if i is None:
        return None
    j, k = (i + 1) % 3, (i + 2) % 3
    along, d = l[j] * M[j] + l[k] * M[k], D[i] - D[j]
    if not along * d < 0:
        return None
    s = 1 if d < 0 else -1
    L = sqrt_fraction(l[j] ** 2 + l[k] ** 2)
    e = (s * l[j] / L, s * l[k] / L)  # good to 240 bits: less than the rounding that the coefficients hold
    basis = [[0, 0, 0] for _ in range(3)]
    basis[0][j], basis[0][k], basis[1][j], basis[1][k], basis[2][i] = e[0], e[1], -e[1], e[0], 1
    torque = (abs(along) / L, e[0] * M[k] - e[1] * M[j], M[i])
    return MovingCentre((D[j], D[j], D[i]), (s * L, Fraction(0), l[i]), torque,
                        [[float(v) for v in row] for row in basis], s)
