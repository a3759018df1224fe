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
from fractions import Fraction

from ...numbers.exact import sqrt_fraction
from ...orbit.result import Fate
from .centres import MovingCentre
from .result import WIDER, SpinUp, SteadyTrap


def axis_of_symmetry(D) -> int | None:
    """The index of the axis whose two others have equal moments; None for three different moments and for a
    sphere."""
    found = [i for i in range(3) if D[(i + 1) % 3] == D[(i + 2) % 3]]
    return found[0] if len(found) == 1 else None


def exactly(scene, state) -> SpinUp | None:
    """The fate of a state where a closed solution tells it; None elsewhere. state: three floats, at their
    word."""
    if scene.variables == "scaled":
        return None
    D, l, M = scene.body.exact, scene.vector("gyrostat"), scene.vector("constant_torque")
    if not any(M):
        return _answer(Fate.BOUNDED, state, "without a torque the energy is constant and the motion bounded")
    if D[0] == D[1] == D[2]:
        return _sphere(D[0], l, M, state)
    i = axis_of_symmetry(D)
    if i is None or l[(i + 1) % 3] or l[(i + 2) % 3]:
        return None
    return _about_the_axis(i, D, l, M, state) if M[i] else _across_the_axis(i, D, l, M, state)


def _answer(fate, state, cause, direction=None, axis=0, sense=0, trap=None):
    return SpinUp(fate, axis, sense, direction, "exact", trap, 0.0, tuple(map(float, state)), 0, cause, 1.0)


def _sphere(D, l, M, state):
    if not any(l):
        return _grows(M, state, "a sphere without a wheel: the rate grows along the torque")
    along = sum(a * b for a, b in zip(l, M))
    if not along:
        return _answer(Fate.BOUNDED, state,
                       "a sphere with a wheel across the torque: the rate goes round the wheel's momentum")
    return _grows([along * v for v in l], state,
                  "a sphere with a wheel: the rate grows along the wheel's momentum, by the torque's "
                  "component there")


def _grows(vector, state, cause):
    size = sqrt_fraction(sum(Fraction(v) ** 2 for v in vector))
    direction = tuple(float(v / size) for v in vector)
    axes = [n for n in range(3) if abs(direction[n]) == 1]
    sense = 0 if not axes else int(direction[axes[0]])
    return _answer(Fate.SPIN_UP, state, cause, direction, axes[0] + 1 if axes else 0, sense if axes else 1)


def _about_the_axis(i, D, l, M, state):
    j, k = (i + 1) % 3, (i + 2) % 3
    d, sense = abs(D[i] - D[j]), 1 if M[i] > 0 else -1
    most = (math.hypot(state[j], state[k]) + 8 * math.hypot(*(float(M[n] / D[j]) for n in (j, k)))
            * math.sqrt(D[i] * D[j] / (d * abs(M[i]))))
    most *= 1 + WIDER
    start, gain = sense * state[i], float(abs(M[i]) / D[i])
    bounded = [(-most, most)] * 3
    bounded[i] = (start, math.inf) if sense > 0 else (-math.inf, -start)
    direction = tuple(float(sense * (n == i)) for n in range(3))
    return _answer(Fate.SPIN_UP, state,
                   "the axis of symmetry bears a torque and there is no transverse wheel: the spin about it "
                   "is linear in time",
                   direction, i + 1, sense, SteadyTrap(i + 1, sense, float(start), gain, tuple(bounded)))


def _across_the_axis(i, D, l, M, state):
    if Fraction(state[i]) + l[i] / (D[i] - D[(i + 1) % 3]):
        return _answer(Fate.BOUNDED, state,
                       "the spin about the axis of symmetry is constant and turns the transverse "
                       "torque round")
    return _grows(M, state,
                  "the spin about the axis of symmetry stays where the transverse rate stands still: it "
                  "grows along the transverse torque")


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
