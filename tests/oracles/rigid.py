"""Equations of motion of rigid bodies for SciPy's runs, typed in here: in plain floats, which take a tenth of
the time of NumPy's arrays of three numbers. Shares no code with stabilab."""
from __future__ import annotations

import numpy as np


def euler(D, wheel=(0, 0, 0), torque=(0, 0, 0), damping=0):
    """rates(t, omega) about principal axes: D omega' = (D omega + wheel) x omega + torque - damping omega; damping:
    one number, or one for each axis."""
    (a, b, c), (p, q, r), (u, v, w), (f, g, h) = (
        map(float, np.broadcast_to(row, 3)) for row in (D, wheel, torque, damping))

    def rates(_, omega):
        x, y, z = map(float, omega)
        i, j, k = a * x + p, b * y + q, c * z + r
        return [(j * z - k * y + u - f * x) / a, (k * x - i * z + v - g * y) / b, (i * y - j * x + w - h * z) / c]
    return rates


def tensor(J, wheel=(0, 0, 0), torque=(0, 0, 0)):
    """rates(t, omega) about any axes: J omega' = torque - omega x (J omega + wheel), J of shape (3, 3)."""
    (a, b, c), (d, e, f), (g, h, i) = np.array(J, float).tolist()
    (A, B, C), (D, E, F), (G, H, I) = np.linalg.inv(np.array(J, float)).tolist()
    (p, q, r), (u, v, w) = map(float, wheel), map(float, torque)

    def rates(_, omega):
        x, y, z = map(float, omega)
        k, m, n = a * x + b * y + c * z + p, d * x + e * y + f * z + q, g * x + h * y + i * z + r
        s, t, o = u - y * n + z * m, v - z * k + x * n, w - x * m + y * k
        return [A * s + B * t + C * o, D * s + E * t + F * o, G * s + H * t + I * o]
    return rates


def in_space(rates):
    """rates(t, y), y the rates of turning and the rows of R from body to space: R' = R [omega x]."""
    def turned(t, y):
        x, y_, z, *rows = map(float, y)
        turns = (v for a, b, c in zip(*[iter(rows)] * 3) for v in (b * z - c * y_, c * x - a * z, a * y_ - b * x))
        return [*rates(t, (x, y_, z)), *turns]
    return turned


def with_a_direction(D, wheel=(0, 0, 0), torque=(0, 0, 0), arm=(0, 0, 0), eddy=0):
    """rates(t, y), y the rates of turning and a direction at rest in space, gamma' = gamma x omega, with the
    torques arm x gamma, and eddy (omega x gamma) x gamma, in addition."""
    body, (a, b, c), (p, q, r), k = euler(D, wheel, torque), map(float, D), map(float, arm), float(eddy)

    def rates(t, y):
        x, y_, z, f, g, h = map(float, y)
        i, j, l, along, size = *body(t, (x, y_, z)), k * (x * f + y_ * g + z * h), k * (f * f + g * g + h * h)
        return [i + (q * h - r * g + along * f - size * x) / a, j + (r * f - p * h + along * g - size * y_) / b,
                l + (p * g - q * f + along * h - size * z) / c, g * z - h * y_, h * x - f * z, f * y_ - g * x]
    return rates


def damped(D, k, c, wheel=(0, 0, 0), torque=(0, 0, 0)):
    """rates(t, y), y of a body with a spherical rotor in a viscous fluid, of moment k, and of the rotor's spin
    sigma relative to it: H' = H x omega + torque with H = D omega + wheel + k sigma, D that of both, and
    k (omega' + sigma') = -c sigma - k omega x sigma."""
    body = euler([float(d) - k for d in D], wheel, torque)
    k, c, outer = float(k), float(c), [float(d) - k for d in D]

    def rates(t, y):
        x, y_, z, p, q, r = map(float, y)
        # (D omega) x omega is that of D - k: k omega is along omega
        turn = [v + c * s / d for v, s, d in zip(body(t, (x, y_, z)), (p, q, r), outer)]
        return [*turn, -c * p / k - (y_ * r - z * q) - turn[0], -c * q / k - (z * p - x * r) - turn[1],
                -c * r / k - (x * q - y_ * p) - turn[2]]
    return rates
