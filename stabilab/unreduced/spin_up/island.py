"""Bounded islands under a torque of any direction with a wheel: where averaging puts their centre, and when a motion looks like one.

About an extremal axis (`form`; X the spin, I = |eta|^2 the action across, a = l2 M2/d2, b = l3 M3/d3, c = (d3 - d2) M2 M3/(d2 d3), l1 = 0) the
averaged flow is X' = f0 + I f1, I' = -(I f0' + I^2 f1'/2), with the stream function psi = I f0 + I^2 f1/2,

    D1 f0 = M1 + (a + b)/X - c/X^2,    D1 f1 = K/X^3,    K = s (d3 - d2)(a - b)/(4 D1 om sqrt(D2 D3)).

Where M1 c < 0, (a + b)^2 > 4 |M1 c| (both equilibria on one side) and (|d3| - |d2|)(b^2 - a^2) > 0, psi has a centre with I > 0: an elliptic periodic
orbit between two saddle-foci, which tori surround (by averaging, for great X; a wheel is needed). This is a pointer, not a proof.
"""
from __future__ import annotations

import math
from dataclasses import dataclass

SAME, SWINGS, DOUBLINGS, SETTLED = 1.1, 0.9, 3, 10  # see `recurs`; doublings of the steps begin to count after 2^SETTLED of them


@dataclass(frozen=True)
class Centre:
    """The centre of the averaged flow: axis (1, 2, 3), spin about it (signed, rad/s or the motion's unit), action |eta|^2 across."""

    axis: int
    spin: float
    action: float


def centres(scene) -> list[Centre]:
    """The centres of the averaged flow of a scene in physical variables, with the wheel's part along each axis left out (leading order)."""
    if scene.variables == "scaled":
        return []
    D, l, M = ([float(v) for v in vector] for vector in (scene.body.exact, scene.vector("gyrostat"), scene.vector("constant_torque")))
    return [found for i in range(3) if (found := _centre(D, l, M, i))]


def _centre(D, l, M, i):
    j, k = (i + 1) % 3, (i + 2) % 3
    d2, d3, M1 = D[i] - D[j], D[i] - D[k], M[i]
    if not (M1 and d2 * d3 > 0):
        return None
    a, b, c = l[j] * M[j] / d2, l[k] * M[k] / d3, (d3 - d2) * M[j] * M[k] / (d2 * d3)
    total = a + b
    if not (M1 * c < 0 and total**2 > 4 * abs(M1 * c) and (abs(d3) - abs(d2)) * (b * b - a * a) > 0):
        return None
    X = (-total - math.copysign(math.sqrt(total**2 - 12 * M1 * c), total)) / (6 * M1)
    om = math.sqrt(d2 * d3 / (D[j] * D[k]))
    K = math.copysign(1, d2) * (d3 - d2) * (a - b) / (4 * D[i] * om * math.sqrt(D[j] * D[k]))
    action = -(M1 + total / X - c / X**2) * X**3 / K
    return Centre(i + 1, X, action) if action > 0 else None


def recurs(largest, least, steps: int) -> bool:
    """Whether the size of a motion kept its greatest value over the last three doublings of the steps, and swung under it.

    largest, least: of |omega| at the stages of each doubling; one that is parked beside a saddle-focus does not swing.
    """
    last = int(math.log2(1 + steps))
    if last < SETTLED + DOUBLINGS:
        return False
    tops = largest[last - DOUBLINGS:last + 1]
    return max(tops) <= SAME * min(tops) and min(least[last - DOUBLINGS:last + 1]) < SWINGS * max(tops)


def words(scene, t: float) -> str:
    """What is said of a motion that recurs, followed for a time t."""
    told = f"bounded over {t:.4g} {scene.time_unit}, its largest rate no greater in any of the last doublings: an island is seen"
    where = [f"about axis {found.axis} at a spin of {found.spin:.4g}" for found in centres(scene)]
    return told + (f"; averaging has its centre {' or '.join(where)}" if where else "")
