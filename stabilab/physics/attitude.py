"""Attitudes: quaternions inside, the 3-1-2 angles psi, phi, theta at the door.

The rotation from body to space is R = Rz(theta) Rx(psi) Ry(phi) (Galal et al., charged body: eq. (30); its R23 is
misprinted). The angles are singular where cos psi = 0: there phi and theta are not determined one by one.
"""
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .equations import rotation
from .scene import Scene

if TYPE_CHECKING:
    from numpy.typing import ArrayLike


def quaternion(psi: float, phi: float, theta: float) -> np.ndarray:
    """Unit quaternion (4,) from body to space of 3-1-2 angles, rad."""
    (cz, sz), (cx, sx), (cy, sy) = ((np.cos(a / 2), np.sin(a / 2)) for a in (theta, psi, phi))
    a, b, c, d = cz * cx, cz * sx, sz * sx, sz * cx  # Rz Rx
    return np.array([a * cy - c * sy, b * cy - d * sy, a * sy + c * cy, d * cy + b * sy])


def scalar_last(q: ArrayLike) -> np.ndarray:
    """(x, y, z, w) of quaternions (w, x, y, z): (..., 4)."""
    return np.roll(np.asarray(q, float), -1, axis=-1)


def angles(q: ArrayLike) -> np.ndarray:
    """(psi, phi, theta) in (-pi, pi], psi in [-pi/2, pi/2], of quaternions (..., 4): array (..., 3)."""
    r = rotation(np.moveaxis(np.asarray(q, float), -1, 0))
    across = np.hypot(r[2][0], r[2][2])
    return np.stack([np.arctan2(r[2][1], across), np.arctan2(-r[2][0], r[2][2]), np.arctan2(-r[0][1], r[1][1])], axis=-1)


def vertical(found: ArrayLike) -> np.ndarray:
    """Inertial axis 3 in the body (..., 3) at 3-1-2 angles (..., 3), rad: the third row of Rz Rx Ry."""
    psi, phi, _ = np.moveaxis(np.asarray(found, float), -1, 0)
    return np.stack([-np.cos(psi) * np.sin(phi), np.sin(psi), np.cos(psi) * np.cos(phi)], axis=-1)


def beyond(found: ArrayLike) -> np.ndarray:
    """The other 3-1-2 angles (..., 3) of the same attitudes, with cos psi < 0 where `found` has cos psi > 0."""
    psi, phi, theta = np.moveaxis(np.asarray(found, float), -1, 0)
    return np.stack([np.pi - psi, phi + np.pi, theta + np.pi], axis=-1)


def to_space(q: ArrayLike, vectors: ArrayLike) -> np.ndarray:
    """Inertial components of body vectors (..., 3) at quaternions (..., 4)."""
    r = rotation(np.moveaxis(np.asarray(q, float), -1, 0))
    v = np.moveaxis(np.asarray(vectors, float), -1, 0)
    return np.stack([sum(a * b for a, b in zip(row, v)) for row in r], axis=-1)


def unwrapped(wrapped: np.ndarray, start: np.ndarray) -> np.ndarray:
    """Angles (n, 3) made continuous from `start` (3,), each step taken the short way round."""
    turns = np.round(np.diff(np.vstack([start, wrapped]), axis=0) / (2 * np.pi))
    return wrapped - 2 * np.pi * np.cumsum(turns, axis=0)


def body_momentum(scene: Scene, omega: np.ndarray) -> np.ndarray:
    """D omega + momenta carried inside, body frame: (..., 3)."""
    total = np.asarray(scene.body.inertia) * omega
    for effect in scene.effects:
        values = {name: float(v) for name, v in effect.parameters().items()}
        carried = effect.momentum(values)
        total = total if carried is None else total + np.array(carried)
    return total
