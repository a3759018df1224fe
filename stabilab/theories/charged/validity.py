"""How long the small-angle motion of the charged axisymmetric body can be believed, and where it points on
average.

Where r0, X and w = sqrt(ab) differ from zero and ab > 0 the tilt is a sum of four rotating parts,
Gamma = steady + coning e^(-i r0 t) + B e^(iwt) + C e^(-iwt), and everything below is read off their sizes.
"""
from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from .modes import ChargedBody, modes

SMALL_ANGLE = 0.1  # rad: cos differs from 1 by 0.5 %, and so the linear rates from the true ones


@lru_cache(maxsize=64)
def horizon(body: ChargedBody, small_angle: float = SMALL_ANGLE):
    """Time in s until which the tilt |Gamma| stays below small_angle (rad), over the batch; inf where it does
    for ever.

    Root of |Gamma0| + |Pi0| t + |mu| t^2/2 = small_angle: for D1 = D2 a lower bound of the true time
    (rotation does not lengthen vectors), for D1 near D2 its leading order; from rest sqrt(2
    small_angle/|mu|).
    """
    room = small_angle - np.hypot(body.attitude[..., 0], body.attitude[..., 1])
    rate = np.hypot(body.rates[..., 0], body.rates[..., 1])
    push = np.hypot(body.torque[..., 0] / body.inertia[..., 0], body.torque[..., 1] / body.inertia[..., 1])
    below = rate + np.sqrt(rate**2 + 2 * push * np.maximum(room, 0.0))
    until = np.where(room <= 0, 0.0, 2 * np.maximum(room, 0.0) / np.where(below == 0, 1.0, below))
    return np.where((largest_tilt(body) <= small_angle) | ((below == 0) & (room > 0)), np.inf, until)


def largest_tilt(body: ChargedBody):
    """The tilt in rad that the motion never exceeds, over the batch: |steady| + |coning| + |B| + |C|, inf
    where it grows.

    For D1 = D2 and r0/w irrational the motion comes as near to it as one likes. From rest and for D1 = D2 it
    is
    2 |M/D| / (product of the two smallest among |r0|, |w|, |r0 + w|).
    """
    parts = tilt_parts(body)
    at_start = np.abs(body.attitude[..., 0] + 1j * body.attitude[..., 1])
    bound = sum(np.abs(x) for x in (parts.steady, parts.coning, parts.B, parts.C))
    return np.where(parts.undriven, at_start, np.where(parts.regular, bound, np.inf))


def spin_words(body: ChargedBody, omega, t) -> str:
    """How far the spin r, held at r0, is from constant: D3 r' = (D1 - D2) p q, so |r - r0| <= |D1 - D2|
    max(p^2 + q^2) |t|/(2 D3) along the rates omega (n, 3) at the times t (n,)."""
    D1, D2, D3 = body.inertia
    if D1 == D2:
        return "D1 = D2: r is constant and p, q are those of Euler's equations"
    change = (abs(D1 - D2) / (2 * D3) * float((omega[..., 0]**2 + omega[..., 1]**2).max(initial=0.0))
              * float(np.abs(t).max(initial=0.0)))
    return (
        f"r is held at r0; with D1 - D2 = {D1 - D2:.6g} kg m^2 it changes by {change:.2g} rad/s at most over "
        f"these times, by the model's p and q")


@dataclass(frozen=True, eq=False)
class TiltParts:
    """The complex amplitudes of the tilt (rad) and of p + iq = rate + plus e^(iwt) + minus e^(-iwt) (rad/s),
    over the batch.

    regular: where they exist (elsewhere they are 0); undriven: where p, q and M are zero and only the coning
    is left.
    """

    steady: np.ndarray
    coning: np.ndarray
    B: np.ndarray
    C: np.ndarray
    rate: np.ndarray
    plus: np.ndarray
    minus: np.ndarray
    frequency: np.ndarray
    regular: np.ndarray
    undriven: np.ndarray


def tilt_parts(body: ChargedBody) -> TiltParts:
    """The four rotating parts of the tilt, from the poles of the linear model; finite through r0 = w."""
    m, r0 = modes(body), body.spin
    D1, D2 = body.inertia[..., 0], body.inertia[..., 1]
    a, b, X, Y, root = (z.value() for z in (m.a, m.b, m.X, m.Y, m.root))
    M = body.torque[..., 0] + 1j * body.torque[..., 1]
    Pi0 = body.rates[..., 0] + 1j * body.rates[..., 1]
    regular = ~m.unstable & (root != 0) & (X != 0) & ((r0 != 0) | (M == 0))
    one = lambda z: np.where(regular & (z != 0), z, 1.0)
    rate = np.where(regular, 1j * body.torque[..., 0] / one(D1 * a) - body.torque[..., 1] / one(D2 * b), 0)
    w, away = one(root), Pi0 - rate
    alpha, beta = (a + b) / 2, (D1 - D2) * Y / (2 * D1 * D2)
    lopsided = (beta * away / one(alpha + w) + np.conj(away)) / (2 * w)
    plus, minus = away + beta * lopsided, -beta * lopsided
    high, low = r0 + w, r0 - w
    # the one of the two that may be small: XY = -D1 D2 (r0 + w)(r0 - w)
    meet = np.where(r0 * w > 0, low, high)
    meet = np.where(r0 * w == 0, meet, -X * Y / (D1 * D2 * one(np.where(r0 * w > 0, high, low))))
    B = plus / (1j * one(np.where(r0 * w > 0, high, meet)))
    C = np.where(r0 * w > 0, (D1 - D2) * high * lopsided / (2j * X * 1.0 + (X == 0)), minus / (1j * one(low)))
    L0 = D1 * body.rates[..., 0] + 1j * D2 * body.rates[..., 1]
    steady = np.where(r0 == 0, 0, rate / (1j * one(r0)))
    coning = body.attitude[..., 0] + 1j * body.attitude[..., 1] + 1j * (L0 + 1j * M / one(r0)) / one(X)
    values = (np.where(regular, z, 0) for z in (steady, coning, B, C, rate, plus, minus, root))
    return TiltParts(*values, regular, (Pi0 == 0) & (M == 0) & np.ones_like(regular))  # type: ignore[call-arg]
