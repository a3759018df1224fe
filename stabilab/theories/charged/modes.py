"""A spinning, nearly axisymmetric body with small tilt: its data, its two rates a and b, its frequencies and
resonances.

Euler's equations (Galal et al., charged body: eq. (1)) with r = r0 and the small-angle kinematics (15):

    p' = M1/D1 - a q,    q' = M2/D2 + b p,    Gamma' + i r0 Gamma = p + i q,    Gamma = psi + i phi

    a = [(D3 - D2) r0 + Lambda] / D1,   b = [(D3 - D1) r0 + Lambda] / D2,   Lambda = lambda3 - k,   k = e H
    l^2 cos(sigma)

With X = D3 r0 + Lambda and Y = X - (D1 + D2) r0:   D1 a = X - D2 r0,   D2 b = X - D1 r0,
r0^2 - ab = -XY/(D1 D2),   (b - a)/2 = (D1 - D2) Y/(2 D1 D2).
"""
from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Any, TypeAlias

import numpy as np

from ...errors import InputError, told
from ...numbers.double_double import Twofold, twofold

Batch: TypeAlias = Any  # a number or an array of them, with leading batch axes
FIELDS = {"inertia": 3, "spin": 0, "gyrostat": 0, "charge_moment": 0, "torque": 2, "rates": 2, "attitude": 3,
          "force": 3, "mass": 0, "velocity": 3, "position": 3}


@dataclass(frozen=True, eq=False)
class ChargedBody:
    """The body and the start of its motion; every field may carry leading batch axes, which broadcast
    together.

    inertia: D1, D2, D3, kg m^2, (..., 3). spin: r0 = r(0), rad/s. gyrostat: lambda3, kg m^2/s. charge_moment:
    k = e H l^2 cos(sigma), kg m^2/s (C T m^2). torque: M1, M2, N m, body axes (a torque about the spin axis
    would change r0: this theory has none). rates: p, q at t = 0, rad/s. attitude: psi, phi, theta at t = 0
    (3-1-2 sequence), rad. force: f1, f2, f3, N, body axes. mass: kg, None where no translation is asked for.
    velocity, position: inertial, m/s, m. Raises InputError for numbers that are not finite, and moments or
    masses that are not positive.
    """

    inertia: Batch
    spin: Batch
    gyrostat: Batch = 0.0
    charge_moment: Batch = 0.0
    torque: Batch = (0.0, 0.0)
    rates: Batch = (0.0, 0.0)
    attitude: Batch = (0.0, 0.0, 0.0)
    force: Batch = (0.0, 0.0, 0.0)
    mass: Batch | None = None
    velocity: Batch = (0.0, 0.0, 0.0)
    position: Batch = (0.0, 0.0, 0.0)

    def __post_init__(self):
        for name, components in FIELDS.items():
            value = getattr(self, name)
            if value is not None or name != "mass":
                object.__setattr__(self, name, _checked(name, value, components))
        try:
            np.broadcast_shapes(*self.shapes)
        except ValueError:
            raise InputError(f"batch axes do not broadcast together: {self.shapes}") from None
        if np.any(self.inertia <= 0):
            raise InputError(f"inertia: expected three positive moments, got {self.inertia}")
        if self.mass is not None and np.any(self.mass <= 0):
            raise InputError(f"mass: expected a positive number, got {self.mass}")

    @property
    def shapes(self) -> list:
        """The batch shape of every field."""
        present = [(getattr(self, name), bool(size)) for name,
                   size in FIELDS.items() if getattr(self, name) is not None]
        return [value.shape[:-1] if vector else value.shape for value, vector in present]


def _checked(name, value, components):
    try:
        value = np.array(value, float)  # a copy: what is made of a body is kept with it
    except (TypeError, ValueError):
        raise InputError(f"{name}: expected numbers, got {told(value)}") from None
    if components and value.shape[-1:] != (components,):
        raise InputError(
            f"{name}: expected {components} components along the last axis, got the shape {value.shape}")
    if not np.all(np.isfinite(value)):
        raise InputError(f"{name}: expected finite numbers, got {value}")
    return value


@dataclass(frozen=True, eq=False)
class Modes:
    """What the body's data make of the linear model; twofold where a difference may be small.

    a, b: 1/s. X, Y: kg m^2/s. squared: ab, 1/s^2. root: sgn(a + b) sqrt|ab|, the frequency w where ab >= 0
    and the growth rate s (w = i s) where ab < 0, the unstable band.
    """

    a: Twofold
    b: Twofold
    X: Twofold
    Y: Twofold
    squared: Twofold
    root: Twofold
    unstable: np.ndarray

    @property
    def frequency(self):
        """w as a complex array: real, or imaginary in the unstable band."""
        return self.root.value() * np.where(self.unstable, 1j, 1.0)


@lru_cache(maxsize=64)
def modes(body: ChargedBody) -> Modes:
    """The two rates and the frequency, with relative error far below the last place of the data."""
    D1, D2, D3 = (twofold(body.inertia[..., i]) for i in range(3))
    r0 = twofold(body.spin)
    Lam = twofold(body.gyrostat) - body.charge_moment
    a, b = ((D3 - D2) * r0 + Lam) / D1, ((D3 - D1) * r0 + Lam) / D2
    squared = a * b
    sign = np.where((a + b).high < 0, -1.0, 1.0)
    root = (squared * np.sign(squared.high)).sqrt() * sign
    return Modes(a, b, D3 * r0 + Lam, (D3 - D1 - D2) * r0 + Lam, squared, root, squared.high < 0)


@lru_cache(maxsize=64)
def resonances(body: ChargedBody, tolerance: float = 1e-6) -> tuple[str, ...]:
    """The resonances and the unstable band that the data (any member of the batch) meet, in words.

    tolerance: how near counts, relative to the largest rate among r0, a, b; only the words depend on it.
    Nothing is singular at a resonance: the closed forms pass through it.
    """
    m = modes(body)
    a, b, r0 = m.a.value(), m.b.value(), body.spin
    small = tolerance * np.maximum(np.maximum(np.abs(a), np.abs(b)), np.abs(r0))
    sides = np.sqrt(body.inertia[..., 0] * body.inertia[..., 1])
    found = {
        "r0 = 0: no spin; a transverse torque tilts the body without bound": np.abs(r0) <= small,
        "omega = 0: a or b vanishes; p or q grows steadily under a torque, or the motion drifts": np.abs(m.root.value()) <= small,
        "r0 = -omega, D3 r0 + Lambda = 0: no axial momentum is left to hold the axis; the tilt grows "
        "steadily":
            np.abs(m.X.value()) <= small * sides,
        "r0 = omega, D3 r0 + Lambda = (D1 + D2) r0: frequencies meet, a = b, nothing grows":
            np.abs(m.Y.value()) <= small * sides,
        "unstable band: a b < 0, the spin axis lies between the two others; p and q grow exponentially":
            m.unstable & (np.abs(m.root.value()) > 0),
    }
    return tuple(words for words, here in found.items() if np.any(here))
