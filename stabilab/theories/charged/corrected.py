"""The charged axisymmetric body with the paper's one frequency, its integrals corrected.

Galal et al., charged body. Its step from (7) to (8) puts zeta1 D1 for zeta2 D2:

    p1' = A1 - W q1,  q1' = A2 + W p1,   W = zeta [r0 + Lambda/(zeta1 D1)],   p = p1/sqrt(zeta2),  q =
    q1/sqrt(zeta1)

In p and q that keeps a and replaces b = zeta2 r0 + Lambda/D2 by zeta2 r0 + Lambda zeta2/(zeta1 D1) = a
zeta2/zeta1: exact for D1 = D2 and for Lambda = 0, otherwise a wrong frequency W for sqrt(ab), and a phase
error that grows with t and does not shrink with the amplitude. `corrected` is this model, solved without
further error: what the paper means where its integrals for velocity and displacement are misprinted.
`model.printed` follows the print itself.
"""
from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ...errors import InputError
from ...numbers.double_double import twofold
from .closed_form import Terms, times, verdict
from .modes import SMALL_ANGLE, ChargedBody, horizon, modes


@dataclass(frozen=True, eq=False)
class CorrectedMotion:
    """The one-frequency model at the asked-for times; units, frames and shapes as in `AxisymmetricMotion`.

    momentum: by (33). velocity, position: the integrals that the paper means (None without a mass).
    frequency: W, rad/s, over the batch. status, reason: how far this model's own tilt is small.
    """

    t: np.ndarray
    omega: np.ndarray
    angles: np.ndarray
    momentum: np.ndarray
    velocity: np.ndarray | None
    position: np.ndarray | None
    frequency: np.ndarray
    status: str
    reason: str


def corrected(body: ChargedBody, t, small_angle: float = SMALL_ANGLE) -> CorrectedMotion:
    """The single-frequency motion at times t (s, any shape), evaluated without loss at its own resonances
    too.

    Raises InputError where D3 lies between D1 and D2 or equals one of them: the paper divides by zeta1 and
    zeta2 and takes the root of their product.
    """
    t = times(t)
    m = one_frequency(body)
    terms = Terms(body, t, m)
    omega, angles = terms.angular_velocity(), terms.angles()
    velocity, position = terms.translation() if body.mass is not None else (None, None)
    frequency = (np.abs(m.root.value()) * np.sign(terms.a)
                 * np.sign(body.inertia[..., 2] - body.inertia[..., 0]))
    return CorrectedMotion(t, omega, angles, momentum(body, omega, angles), velocity, position, frequency,
                           *verdict(np.hypot(angles[..., 0], angles[..., 1]), t, horizon(body, small_angle),
                                    small_angle))


def one_frequency(body: ChargedBody):
    """The modes with the paper's b: a zeta2/zeta1 (twofold)."""
    m = modes(body)
    D1, D2, D3 = (twofold(body.inertia[..., i]) for i in range(3))
    zeta1, zeta2 = (D3 - D2) / D1, (D3 - D1) / D2
    if np.any(zeta1.high * zeta2.high <= 0):
        raise InputError(
            f"the paper's formulas need D3 above both D1 and D2, or below both; got {body.inertia}")
    b = m.a * zeta2 / zeta1
    squared = m.a * b
    root = squared.sqrt() * np.where(m.a.high < 0, -1.0, 1.0)
    return replace(m, b=b, squared=squared, root=root, unstable=squared.high < 0)


def momentum(body, omega, angles):
    """(33): G = e^(i theta) [D1 p + i D2 q - i Gamma (D3 r0 + lambda3)]."""
    D1, D2, D3 = np.moveaxis(body.inertia, -1, 0)
    H3 = D3 * body.spin + body.gyrostat
    G = np.exp(1j * angles[..., 2]) * (D1 * omega[..., 0] + 1j * D2 * omega[..., 1]
                                       - 1j * (angles[..., 0] + 1j * angles[..., 1]) * H3)
    return np.stack(np.broadcast_arrays(G.real, G.imag, H3), axis=-1)
